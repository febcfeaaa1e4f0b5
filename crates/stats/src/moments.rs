//! Mean and variance of a stream of numbers.

/// Count, mean and sum of squared deviations, updated number by number (Welford 1962) and joined (Chan et al. 1979).
///
/// Of 10⁹ numbers neither drifts: what rounding takes from a step is added to the next (Kahan 1965). A NaN among the numbers makes mean and variance NaN: nothing is passed over.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: u64,
    mean: Sum,
    squares: Sum,
}

/// A sum, and by how much rounding made it too large.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sum {
    rounded: f64,
    excess: f64,
}

impl Sum {
    fn of(value: f64) -> Self {
        Self { rounded: value, excess: 0.0 }
    }

    fn add(&mut self, step: f64) {
        let step = step - self.excess;
        let sum = self.rounded + step;
        self.excess = (sum - self.rounded) - step;
        self.rounded = sum;
    }

    fn total(self) -> f64 {
        self.rounded - self.excess
    }
}

impl Moments {
    /// The moments of `values`, taken in order.
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut moments = Self::default();
        for value in values {
            moments.push(value);
        }
        moments
    }

    /// Takes one more number in.
    pub fn push(&mut self, value: f64) {
        self.count += 1;
        let before = value - self.mean.total();
        self.mean.add(before / self.count as f64);
        self.squares.add(before * (value - self.mean.total()));
    }

    /// The moments of this stream followed by `other`. Not bit-equal to pushing the numbers one by one.
    #[must_use]
    pub fn join(&self, other: &Self) -> Self {
        if self.count == 0 || other.count == 0 {
            return if self.count == 0 { *other } else { *self };
        }
        let count = self.count + other.count;
        let (share, difference) = (other.count as f64 / count as f64, other.mean() - self.mean());
        let between = difference * difference * self.count as f64 * share;
        let squares = self.squares.total() + other.squares.total() + between;
        Self { count, mean: Sum::of(self.mean() + difference * share), squares: Sum::of(squares) }
    }

    /// How many numbers there were.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; 0 where there were none.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean.total()
    }

    /// Unbiased variance of the numbers; `None` where fewer than two.
    #[must_use]
    pub fn variance(&self) -> Option<f64> {
        (self.count >= 2).then(|| self.squares.total() / (self.count - 1) as f64)
    }

    /// Variance of the mean **where the numbers are independent**; `None` where fewer than two. For numbers of one
    /// scrambled sequence it is an upper bound only: see [`crate::replicates`].
    #[must_use]
    pub fn variance_of_mean(&self) -> Option<f64> {
        self.variance().map(|v| v / self.count as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_offset_costs_no_digits() {
        // Of 1, 2, …, 9: mean 5, variance 7.5; the same on an offset where squares would lose everything.
        for offset in [0.0, 1e9, -1e12] {
            let moments = Moments::of((1..10).map(|i| f64::from(i) + offset));
            assert!((moments.mean() - 5.0 - offset).abs() < 1e-15 * offset.abs().max(10.0));
            // The mean is rounded at 1e-16 of the offset, twice in a deviation of up to 4.
            let variance = moments.variance().expect("nine numbers");
            assert!((variance - 7.5).abs() < 1e-15 + 2e-15 * offset.abs(), "{variance}");
        }
    }

    #[test]
    fn streams_join() {
        let all: Vec<f64> = (0..100).map(|i| f64::from(i * i % 37)).collect();
        let (a, b) = all.split_at(30);
        let joined = Moments::of(a.iter().copied()).join(&Moments::of(b.iter().copied()));
        let whole = Moments::of(all.iter().copied());
        assert_eq!(joined.count(), 100);
        assert!((joined.mean() - whole.mean()).abs() < 1e-12);
        assert!((joined.squares.total() - whole.squares.total()).abs() < 1e-9);
        assert_eq!(Moments::default().join(&whole), whole);
        assert_eq!(whole.join(&Moments::default()), whole);
    }

    #[test]
    fn too_few_numbers_have_no_variance() {
        assert_eq!(Moments::default().variance(), None);
        assert_eq!(Moments::of([3.0]).variance_of_mean(), None);
        assert!(Moments::of([3.0, f64::NAN]).variance().expect("two").is_nan());
    }
}
