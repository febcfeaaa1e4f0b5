//! Mean, variance and median of numbers, and the variance of replicates.
//!
//! Mean and unbiased variance of randomised quasi-Monte Carlo:
//!
//! R independently scrambled replicates give R independent, unbiased means. Their mean is the estimate; their sample variance,
//! divided by R, is its variance, with R − 1 degrees of freedom (Owen 1997). The samples *within* a replicate are not
//! independent: s²/n over them overstates the variance by orders of magnitude and is not used in tests.

use crate::student;

/// Count, mean and sum of squared deviations, updated number by number (Welford 1962) and joined (Chan et al. 1979).
///
/// With Kahan summation (1965) neither drifts over 10⁹ numbers: the rounding error of a step is added to the next. A NaN among
/// the numbers makes mean and variance NaN.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: u64,
    mean: CompensatedSum,
    squares: CompensatedSum,
}

/// A sum and its rounding error (positive if the sum is too large).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct CompensatedSum {
    rounded: f64,
    excess: f64,
}

impl CompensatedSum {
    fn new(value: f64) -> Self {
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
    pub fn from_values(values: impl IntoIterator<Item = f64>) -> Self {
        let mut moments = Self::default();
        for value in values {
            moments.push(value);
        }
        moments
    }

    /// Adds a number.
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
        let (fraction, difference) = (other.count as f64 / count as f64, other.mean() - self.mean());
        let between = difference * difference * self.count as f64 * fraction;
        let squares = self.squares.total() + other.squares.total() + between;
        Self {
            count,
            mean: CompensatedSum::new(self.mean() + difference * fraction),
            squares: CompensatedSum::new(squares),
        }
    }

    /// Number of values.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Mean; 0 if there are no values.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean.total()
    }

    /// Unbiased variance of the values; `None` for fewer than two.
    #[must_use]
    pub fn variance(&self) -> Option<f64> {
        (self.count >= 2).then(|| self.squares.total() / (self.count - 1) as f64)
    }

    /// Variance of the mean **of independent values**; `None` for fewer than two. For values of one scrambled sequence it is only
    /// an upper bound: see [`self`].
    #[must_use]
    pub fn variance_of_mean(&self) -> Option<f64> {
        self.variance().map(|v| v / self.count as f64)
    }
}

/// An estimate with the variance of its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReplicateEstimate {
    /// Mean of the replicate means.
    pub mean: f64,
    /// Estimated variance of `mean`.
    pub variance_of_mean: f64,
    /// Degrees of freedom of `variance_of_mean`.
    pub degrees_of_freedom: u32,
}

impl ReplicateEstimate {
    /// The estimate from replicates of equal size. `None` for fewer than two.
    #[must_use]
    pub fn from_replicates(replicate_means: &[f64]) -> Option<Self> {
        let moments = Moments::from_values(replicate_means.iter().copied());
        let variance_of_mean = moments.variance_of_mean()?;
        let degrees_of_freedom = u32::try_from(replicate_means.len() - 1).ok()?;
        Some(Self { mean: moments.mean(), variance_of_mean, degrees_of_freedom })
    }

    /// Standard error of the mean.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        self.variance_of_mean.sqrt()
    }

    /// Half the width of the confidence interval about the mean that contains the true value with probability `confidence`
    /// (Student's t).
    #[must_use]
    pub fn half_width(&self, confidence: f64) -> f64 {
        student::critical(1.0 - confidence, f64::from(self.degrees_of_freedom)) * self.standard_error()
    }

    /// Two-sided p-value of the hypothesis that the true value is `value`. With a variance of zero it is 1 or 0.
    #[must_use]
    pub fn p_of(&self, value: f64) -> f64 {
        let difference = (self.mean - value).abs();
        if difference == 0.0 {
            return 1.0;
        }
        student::two_sided_p(difference / self.standard_error(), f64::from(self.degrees_of_freedom))
    }
}

/// The upper median: the middle number, or for an even count the larger of the two in the middle; `None` for no values.
#[must_use]
pub fn upper_median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_offset_costs_no_digits() {
        // Of 1, 2, …, 9: mean 5, variance 7.5; the same on an offset where squares would lose everything.
        for offset in [0.0, 1e9, -1e12] {
            let moments = Moments::from_values((1..10).map(|i| f64::from(i) + offset));
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
        let joined = Moments::from_values(a.iter().copied()).join(&Moments::from_values(b.iter().copied()));
        let all_moments = Moments::from_values(all.iter().copied());
        assert_eq!(joined.count(), 100);
        assert!((joined.mean() - all_moments.mean()).abs() < 1e-12);
        assert!((joined.squares.total() - all_moments.squares.total()).abs() < 1e-9);
        assert_eq!(Moments::default().join(&all_moments), all_moments);
        assert_eq!(all_moments.join(&Moments::default()), all_moments);
    }

    #[test]
    fn too_few_numbers_have_no_variance() {
        assert_eq!(Moments::default().variance(), None);
        assert_eq!(Moments::from_values([3.0]).variance_of_mean(), None);
        assert!(Moments::from_values([3.0, f64::NAN]).variance().expect("two").is_nan());
    }

    #[test]
    fn four_replicates_by_hand() {
        // Mean 5, variance 20/3, of the mean 5/3.
        let estimate = ReplicateEstimate::from_replicates(&[2.0, 4.0, 6.0, 8.0]).expect("four replicates");
        assert!((estimate.mean - 5.0).abs() < 1e-15 && (estimate.variance_of_mean - 5.0 / 3.0).abs() < 1e-15);
        assert_eq!(estimate.degrees_of_freedom, 3);
        // t of 3 degrees at 95 % is 3.182446.
        assert!((estimate.half_width(0.95) - 3.182_446 * estimate.standard_error()).abs() < 1e-6);
        assert!((estimate.p_of(5.0 + estimate.half_width(0.99)) - 0.01).abs() < 1e-12);
    }

    #[test]
    fn certainty_and_ignorance() {
        let certain = ReplicateEstimate::from_replicates(&[1.0; 4]).expect("four replicates");
        assert_eq!((certain.p_of(1.0), certain.p_of(1.1)), (1.0, 0.0));
        assert!(ReplicateEstimate::from_replicates(&[1.0]).is_none());
    }

    #[test]
    fn the_middle_of_odd_and_even_counts() {
        assert_eq!(upper_median([3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(upper_median([4.0, 1.0, 3.0, 2.0]), Some(3.0));
        assert_eq!(upper_median([]), None);
    }
}
