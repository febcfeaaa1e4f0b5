//! A measured number and how well it is known.

use etendue_core::maths::f64::hypot;

/// A measured number with its standard uncertainty (GUM, JCGM 100:2008, 2.3.1), both in the unit that their owner states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// One standard deviation of what is not known; infinite where the picture says nothing about it.
    pub standard_uncertainty: f64,
}

impl Estimate {
    /// A number known to a standard uncertainty.
    #[must_use]
    pub fn new(value: f64, standard_uncertainty: f64) -> Self {
        Self { value, standard_uncertainty }
    }

    /// The same in a unit that is `factor` times smaller.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { value: self.value * factor, standard_uncertainty: self.standard_uncertainty * factor.abs() }
    }

    /// How far this is from `other` in expanded uncertainties (k = 2) of the difference, E_n of ISO 13528: at most 1 in
    /// magnitude where the two agree. They must not share errors. Infinite where both claim to be exact and differ, 0
    /// where they are exact and equal.
    #[must_use]
    pub fn normalised_error(self, other: Self) -> f64 {
        let difference = self.value - other.value;
        let expanded = 2.0 * hypot(self.standard_uncertainty, other.standard_uncertainty);
        if difference == 0.0 { 0.0 } else { difference / expanded }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalised_error_counts_expanded_uncertainties() {
        let e_n = Estimate::new(10.5, 0.3).normalised_error(Estimate::new(9.5, 0.4));
        assert!((e_n - 1.0).abs() < 1e-15, "{e_n}");
        assert_eq!(Estimate::new(1.0, 0.0).normalised_error(Estimate::new(1.0, 0.0)), 0.0);
        assert_eq!(Estimate::new(2.0, 0.0).normalised_error(Estimate::new(1.0, 0.0)), f64::INFINITY);
    }
}
