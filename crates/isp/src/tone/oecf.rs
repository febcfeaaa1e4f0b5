//! A measured opto-electronic conversion function (ISO 14524): output level over exposure.
//!
//! Exposures (any unit) rise, the largest is the picture's white (linear 1). Between points the output is linear in the
//! logarithm of the exposure, the axis along which such functions are measured; below the first point it is proportional
//! to the exposure. The output is over the largest output level that the camera can give (255 of 8 bits).

use super::ToneError;
use super::table::{along, by_output, check_order};
use etendue_core::maths::f64::{exp, ln};

/// Output over exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct Oecf {
    /// ln of the exposure over white's, output over its largest.
    points: Vec<(f64, f64)>,
}

impl Oecf {
    /// Pairs of exposure (above 0, rising) and output (0 or more, never falling), and the largest output level.
    ///
    /// # Errors
    /// Where they are not such pairs or an output exceeds the largest level.
    pub fn new(points: Vec<(f64, f64)>, largest_output: f64) -> Result<Self, ToneError> {
        check_order(&points)?;
        let (first, last) = (points[0], points[points.len() - 1]);
        if first.0 <= 0.0 {
            return Err(ToneError::Range("an exposure that is not above 0"));
        }
        if first.1 < 0.0 || !(largest_output.is_finite() && last.1 <= largest_output) {
            return Err(ToneError::Range("an output outside 0 … the largest level"));
        }
        Ok(Self { points: points.iter().map(|(h, y)| (ln(h / last.0), y / largest_output)).collect() })
    }

    /// Exposures, of which the largest is 1, and outputs over the largest level.
    #[must_use]
    pub fn points(&self) -> Vec<(f64, f64)> {
        self.points.iter().map(|(log, y)| (exp(*log), *y)).collect()
    }

    /// The output of linear light 0 … 1; of a NaN a NaN.
    pub(super) fn output(&self, x: f32) -> f32 {
        let x = f64::from(x);
        let (lowest, floor) = self.points[0];
        if x <= exp(lowest) {
            return (floor * x / exp(lowest)) as f32;
        }
        along(&self.points, ln(x)) as f32
    }

    /// The darkest linear light of an output; 1 beyond the largest.
    pub(super) fn exposure(&self, y: f32) -> f32 {
        let y = f64::from(y);
        match by_output(&self.points, y) {
            (_, None) => 1.0,
            (None, Some((h1, y1))) if y1 > 0.0 => (exp(h1) * y / y1) as f32,
            (None, Some(_)) => 0.0,
            (Some((h0, y0)), Some((h1, y1))) => exp(h0 + (y - y0) * (h1 - h0) / (y1 - y0)) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measured_points_are_met_and_halves_are_halfway() {
        let oecf = Oecf::new(vec![(2.0, 10.0), (8.0, 50.0), (32.0, 100.0)], 100.0).expect("legal");
        for (exposure, output) in [(1.0, 0.05), (2.0, 0.1), (4.0, 0.3), (8.0, 0.5), (16.0, 0.75), (32.0, 1.0)] {
            assert!((oecf.output(exposure / 32.0) - output).abs() < 1e-6, "{exposure}");
            assert!((oecf.exposure(output) * 32.0 - exposure).abs() < 1e-5, "{exposure}");
        }
    }

    #[test]
    fn measurements_that_are_none_are_refused() {
        assert!(matches!(Oecf::new(vec![(0.0, 0.0), (1.0, 9.0)], 255.0), Err(ToneError::Range(_))));
        assert!(matches!(Oecf::new(vec![(1.0, 0.0), (2.0, 256.0)], 255.0), Err(ToneError::Range(_))));
        assert_eq!(Oecf::new(vec![(1.0, 5.0), (2.0, 4.0)], 255.0), Err(ToneError::Order(2)));
    }
}
