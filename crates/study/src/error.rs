//! Errors in the currencies of a study, with what is known of them.

use etendue_core::maths::f64::hypot;
use serde::Serialize;

/// A number with its standard uncertainty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard uncertainty.
    pub uncertainty: f64,
}

impl Estimate {
    /// The mean of numbers that fall into groups which err alike (the pixels of a tile), by the scatter of the groups (Cochran 1977, equation 9.18: a ratio of
    /// sums over clusters). Each group is a sum and a count. Not a number where there is none; its uncertainty is, where there is one.
    #[must_use]
    pub fn of_groups(groups: &[(f64, usize)]) -> Self {
        let count: usize = groups.iter().map(|(_, n)| n).sum();
        let sum: f64 = groups.iter().map(|(sum, _)| sum).sum();
        let (n, value) = (groups.len() as f64, sum / count as f64);
        let squares: f64 = groups.iter().map(|(sum, n)| (sum - value * *n as f64) * (sum - value * *n as f64)).sum();
        Self { value, uncertainty: (squares * n / (n - 1.0)).sqrt() / count as f64 }
    }

    /// Times a number that is known.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, uncertainty: self.uncertainty * factor.abs() }
    }

    /// The sum with one that errs independently.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, uncertainty: hypot(self.uncertainty, other.uncertainty) }
    }

    /// The product with one that errs independently.
    #[must_use]
    pub fn product(self, other: Self) -> Self {
        let uncertainty = hypot(self.uncertainty * other.value, other.uncertainty * self.value);
        Self { value: self.value * other.value, uncertainty }
    }

    /// This over one that errs independently.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        self.product(Self { value: inverse, uncertainty: other.uncertainty * inverse * inverse })
    }

    /// The root of a mean square; 0 of one below 0, which differs from 0 by its uncertainty at most.
    #[must_use]
    pub fn root(self) -> Self {
        if self.value.is_nan() {
            return self;
        }
        let value = self.value.max(0.0).sqrt();
        // d√x = dx/(2√x), and not more than √dx, which it is at 0.
        let most = self.uncertainty.sqrt();
        let least = if value > 0.0 { self.uncertainty / (2.0 * value) } else { most };
        let uncertainty = if least < most { least } else { most };
        Self { value, uncertainty }
    }

    /// Whether it lies this many uncertainties above 0.
    #[must_use]
    pub fn exceeds(&self, uncertainties: f64) -> bool {
        self.value > uncertainties * self.uncertainty
    }
}

/// One number in each currency, all of them mean squares over the pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Currencies<T> {
    /// Of a pixel's light, over the square of the mean light of the pixels of its colour about it (8 × 8 px).
    pub relative: T,
    /// Of a pixel's electrons, over the variance that the sensor's noise has there; of pixels below white. `None` where no electrons are made.
    pub sensor: Option<T>,
    /// Of the mean of the pixels of one colour in 8 × 8 px, over its square: what a reading of a patch sees.
    pub patch: T,
}

impl<T> Currencies<T> {
    /// Each in turn.
    pub fn map<U>(&self, each: impl Fn(&T) -> U) -> Currencies<U> {
        Currencies { relative: each(&self.relative), sensor: self.sensor.as_ref().map(&each), patch: each(&self.patch) }
    }

    /// Each with that of another.
    pub fn with<U, V>(&self, other: &Currencies<U>, each: impl Fn(&T, &U) -> V) -> Currencies<V> {
        Currencies {
            relative: each(&self.relative, &other.relative),
            sensor: self.sensor.as_ref().zip(other.sensor.as_ref()).map(|(a, b)| each(a, b)),
            patch: each(&self.patch, &other.patch),
        }
    }

    /// What decides: the sensor's currency where there is one.
    pub fn deciding(&self) -> &T {
        self.sensor.as_ref().unwrap_or(&self.relative)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_that_err_alike_tell_a_larger_uncertainty() {
        let values = [1.0, 1.1, 3.0, 2.9, 5.0, 5.1, 7.0, 6.9];
        let single = Estimate::of_groups(&values.map(|v| (v, 1)));
        let pairs: Vec<_> = values.chunks(2).map(|pair| (pair.iter().sum(), 2)).collect();
        let grouped = Estimate::of_groups(&pairs);
        assert!((single.value - 4.0).abs() < 1e-12 && (grouped.value - single.value).abs() < 1e-12);
        // Four independent numbers in truth, with the deviation 2.556 and so 1.278 of the mean.
        assert!((grouped.uncertainty - 1.278).abs() < 1e-3, "{grouped:?}");
        assert!((single.uncertainty - 0.837).abs() < 1e-3, "{single:?}");
    }

    #[test]
    fn roots_keep_what_is_known() {
        let root = Estimate { value: 4.0, uncertainty: 0.4 }.root();
        assert!((root.value - 2.0).abs() < 1e-12 && (root.uncertainty - 0.1).abs() < 1e-12);
        let ratio = Estimate { value: 6.0, uncertainty: 0.3 }.over(Estimate { value: 2.0, uncertainty: 0.0 });
        assert!((ratio.value - 3.0).abs() < 1e-12 && (ratio.uncertainty - 0.15).abs() < 1e-12, "{ratio:?}");
        let none = Estimate { value: -0.01, uncertainty: 0.04 }.root();
        assert!(none.value == 0.0 && (none.uncertainty - 0.2).abs() < 1e-12);
    }
}
