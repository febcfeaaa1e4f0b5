//! A parametric S-curve on an encoded value e.
//!
//! ```text
//! y = 1 / (1 + (m (1 − e) / ((1 − m) e))^c)
//! ```
//!
//! The logistic curve in the logarithm of the odds e/(1 − e): 0 stays 0, 1 stays 1, m becomes 1/2, contrast c is the slope
//! of the log-odds everywhere. c = 1 and m = 1/2 change nothing; c above 1 darkens shadows and brightens lights, c below 1
//! does the reverse. The inverse has c → 1/c.

use super::ToneError;
use etendue_core::maths::f32::pow;

/// Contrast about a middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurve {
    contrast: f64,
    midpoint: f64,
}

impl SCurve {
    /// Contrast above 0 about an encoded value between 0 and 1.
    ///
    /// # Errors
    /// Where a parameter is out of range.
    pub fn new(contrast: f64, midpoint: f64) -> Result<Self, ToneError> {
        let legal = contrast.is_finite() && contrast > 0.0 && midpoint > 0.0 && midpoint < 1.0;
        if legal { Ok(Self { contrast, midpoint }) } else { Err(ToneError::SCurve { contrast, midpoint }) }
    }

    /// The slope of the log-odds.
    #[must_use]
    pub fn contrast(&self) -> f64 {
        self.contrast
    }

    /// The encoded value that becomes 1/2.
    #[must_use]
    pub fn midpoint(&self) -> f64 {
        self.midpoint
    }

    /// The odds of the middle.
    fn odds(&self) -> f32 {
        (self.midpoint / (1.0 - self.midpoint)) as f32
    }

    /// y of e, 0 … 1.
    pub(super) fn bend(&self, e: f32) -> f32 {
        if e <= 0.0 {
            return 0.0;
        }
        1.0 / (1.0 + pow(self.odds() * (1.0 - e) / e, self.contrast as f32))
    }

    /// e of y, 0 … 1.
    pub(super) fn straighten(&self, y: f32) -> f32 {
        if y <= 0.0 {
            return 0.0;
        }
        1.0 / (1.0 + pow((1.0 - y) / y, (1.0 / self.contrast) as f32) / self.odds())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_is_a_half_and_the_neutral_curve_changes_nothing() {
        let curve = SCurve::new(2.0, 0.25).expect("legal");
        assert!((curve.bend(0.25) - 0.5).abs() < 1e-6);
        // Odds of 0.5 over those of 0.25 are 3: y = 9/10.
        assert!((curve.bend(0.5) - 0.9).abs() < 1e-6);
        let neutral = SCurve::new(1.0, 0.5).expect("legal");
        assert!((0..=100).map(|i| i as f32 / 100.0).all(|e| (neutral.bend(e) - e).abs() < 1e-6));
    }

    #[test]
    fn parameters_out_of_range_are_refused() {
        for (contrast, midpoint) in [(0.0, 0.5), (-1.0, 0.5), (1.0, 0.0), (1.0, 1.0), (f64::NAN, 0.5), (1.0, f64::NAN)]
        {
            assert!(SCurve::new(contrast, midpoint).is_err(), "{contrast} {midpoint}");
        }
    }
}
