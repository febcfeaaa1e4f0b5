//! Error metrics of a study, with uncertainties.

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
    /// Mean of numbers in groups with correlated errors (the pixels of a tile), with the uncertainty from the scatter of the groups (Cochran 1977, equation
    /// 9.18: a ratio of sums over clusters). Each group is a sum and a count. NaN without numbers; the uncertainty is NaN for a single group.
    #[must_use]
    pub fn from_groups(groups: &[(f64, usize)]) -> Self {
        let count: usize = groups.iter().map(|(_, n)| n).sum();
        let sum: f64 = groups.iter().map(|(sum, _)| sum).sum();
        let (n, value) = (groups.len() as f64, sum / count as f64);
        let squares: f64 = groups.iter().map(|(sum, n)| (sum - value * *n as f64) * (sum - value * *n as f64)).sum();
        Self { value, uncertainty: (squares * n / (n - 1.0)).sqrt() / count as f64 }
    }

    /// Multiplies by an exact number.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, uncertainty: self.uncertainty * factor.abs() }
    }

    /// Adds an estimate with an independent error.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, uncertainty: hypot(self.uncertainty, other.uncertainty) }
    }

    /// Multiplies by an estimate with an independent error.
    #[must_use]
    pub fn product(self, other: Self) -> Self {
        let uncertainty = hypot(self.uncertainty * other.value, other.uncertainty * self.value);
        Self { value: self.value * other.value, uncertainty }
    }

    /// Divides by an estimate with an independent error.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        self.product(Self { value: inverse, uncertainty: other.uncertainty * inverse * inverse })
    }

    /// Root of a mean square; 0 for a value below 0, which differs from 0 only within its uncertainty.
    #[must_use]
    pub fn root(self) -> Self {
        if self.value.is_nan() {
            return self;
        }
        let value = self.value.max(0.0).sqrt();
        // d√x = dx/(2√x), limited to √dx, its value at 0.
        let upper = self.uncertainty.sqrt();
        let lower = if value > 0.0 { self.uncertainty / (2.0 * value) } else { upper };
        let uncertainty = if lower < upper { lower } else { upper };
        Self { value, uncertainty }
    }

    /// Returns true if the value exceeds 0 by this many uncertainties.
    #[must_use]
    pub fn exceeds(&self, uncertainties: f64) -> bool {
        self.value > uncertainties * self.uncertainty
    }
}

/// One value per error metric; all are mean squares over the pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorMetrics<T> {
    /// Error of a pixel's light, over the square of the mean light of the pixels of its colour in its cell (8 × 8 px).
    pub relative: T,
    /// Error of a pixel's electrons, over the variance of the sensor's noise there; over pixels below white. `None` without electrons.
    pub sensor: Option<T>,
    /// Error of the mean of the pixels of one colour in 8 × 8 px, over its square: that of a patch measurement.
    pub patch: T,
}

impl<T> ErrorMetrics<T> {
    /// Applies a function to each metric.
    pub fn map<U>(&self, each: impl Fn(&T) -> U) -> ErrorMetrics<U> {
        ErrorMetrics {
            relative: each(&self.relative),
            sensor: self.sensor.as_ref().map(&each),
            patch: each(&self.patch),
        }
    }

    /// Combines each metric with that of another value.
    pub fn with<U, V>(&self, other: &ErrorMetrics<U>, each: impl Fn(&T, &U) -> V) -> ErrorMetrics<V> {
        ErrorMetrics {
            relative: each(&self.relative, &other.relative),
            sensor: self.sensor.as_ref().zip(other.sensor.as_ref()).map(|(a, b)| each(a, b)),
            patch: each(&self.patch, &other.patch),
        }
    }

    /// The deciding metric: that of the sensor if there is one.
    pub fn main_metric(&self) -> &T {
        self.sensor.as_ref().unwrap_or(&self.relative)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn correlated_groups_have_a_larger_uncertainty() {
        let values = [1.0, 1.1, 3.0, 2.9, 5.0, 5.1, 7.0, 6.9];
        let single = Estimate::from_groups(&values.map(|v| (v, 1)));
        let pairs: Vec<_> = values.chunks(2).map(|pair| (pair.iter().sum(), 2)).collect();
        let grouped = Estimate::from_groups(&pairs);
        assert!((single.value - 4.0).abs() < 1e-12 && (grouped.value - single.value).abs() < 1e-12);
        // Effectively four independent numbers: their deviation is 2.556, that of the mean 1.278.
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
