//! Tone curves: from linear light to display values, both 0 to 1.
//!
//! | curve | y of linear x, clipped to 0 … 1 |
//! | --- | --- |
//! | [`ToneCurve::Srgb`] | IEC 61966-2-1 |
//! | [`ToneCurve::Gamma`] | x^(1/γ) |
//! | [`ToneCurve::SCurve`] | [`SCurve`] of the sRGB-encoded x |
//! | [`ToneCurve::Table`] | [`Table`]: straight lines between given points |
//! | [`ToneCurve::Oecf`] | [`Oecf`]: a measured opto-electronic conversion function |
//!
//! All are monotone; [`ToneCurve::decode`] is the inverse.
//!
//! A parametric S-curve on an encoded value e.
//!
//! ```text
//! y = 1 / (1 + (m (1 − e) / ((1 − m) e))^c)
//! ```
//!
//! The logistic curve in the logarithm of the odds e/(1 − e): 0 stays 0, 1 stays 1, m becomes 1/2, and contrast c is the constant slope of the
//! log-odds. c = 1 and m = 1/2 change nothing; c above 1 darkens shadows and brightens highlights, c below 1 does the reverse. The inverse has c →
//! 1/c.
//!
//! A measured opto-electronic conversion function (ISO 14524): output level over exposure.
//!
//! Exposures (any unit) increase; the largest is the image's white (linear 1). Between points the output is linear in the logarithm of the exposure, the
//! axis of such measurements; below the first point it is proportional to the exposure. The output is relative to the camera's largest output level
//! (255 for 8 bits).

use etendue_core::maths::f64::{exp, ln};
use etendue_core::quantity::{Display, LinearRgb};
use etendue_core::{Plane, maths::f32::pow};
use etendue_spectra::colour;
use rayon::prelude::*;

/// Encoding of linear light.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ToneCurve {
    /// The curve of IEC 61966-2-1.
    #[default]
    Srgb,
    /// A power; the number is γ, above 0: 2.2 brightens, 1 is linear.
    Gamma(f64),
    /// More contrast about a midpoint, on top of the sRGB curve.
    SCurve(SCurve),
    /// Points joined by straight lines.
    Table(Table),
    /// Measured output over exposure.
    Oecf(Oecf),
}

impl ToneCurve {
    /// Creates a power curve.
    ///
    /// # Errors
    /// If γ is not above 0.
    pub fn gamma(gamma: f64) -> Result<Self, ToneError> {
        if gamma.is_finite() && gamma > 0.0 { Ok(Self::Gamma(gamma)) } else { Err(ToneError::Gamma(gamma)) }
    }

    /// Encodes linear light after clipping to 0 … 1. A NaN stays one.
    #[must_use]
    pub fn encode(&self, linear: f32) -> f32 {
        let x = linear.clamp(0.0, 1.0);
        match self {
            Self::Srgb => colour::encode(x),
            Self::Gamma(gamma) => pow(x, (1.0 / gamma) as f32),
            Self::SCurve(curve) => curve.bend(colour::encode(x)),
            Self::Table(table) => table.at(x),
            Self::Oecf(oecf) => oecf.output(x),
        }
    }

    /// The linear light of an encoded value after clipping to 0 … 1; the darkest where the curve is flat.
    #[must_use]
    pub fn decode(&self, encoded: f32) -> f32 {
        let y = encoded.clamp(0.0, 1.0);
        match self {
            Self::Srgb => colour::decode(y),
            Self::Gamma(gamma) => pow(y, *gamma as f32),
            Self::SCurve(curve) => colour::decode(curve.straighten(y)),
            Self::Table(table) => table.inverse(y),
            Self::Oecf(oecf) => oecf.exposure(y),
        }
    }

    /// Encodes a whole image. Runs in the rayon pool of the caller; the result does not depend on it.
    #[must_use]
    pub fn encode_plane(&self, linear: &Plane<LinearRgb>) -> Plane<Display> {
        let samples = linear.samples().par_iter().map(|rgb| rgb.map(|v| self.encode(v))).collect();
        Plane::from_samples(linear.width(), linear.height(), samples).expect("as many samples as before")
    }
}

#[cfg(test)]
/// 8 bits per channel, row by row: 255 v rounded to the nearest, halves up; 0 for a NaN.
#[must_use]
pub(crate) fn to_8_bit(display: &Plane<Display>) -> Vec<[u8; 3]> {
    display.samples().iter().map(|rgb| rgb.map(|v| (255.0 * v + 0.5) as u8)).collect()
}

/// Error of a curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ToneError {
    /// γ out of range.
    #[error("gamma is {0}, but a finite number above 0 is needed")]
    Gamma(f64),
    /// Parameters of an S-curve out of range.
    #[error("an S-curve of contrast {contrast} about {midpoint}: contrast must be above 0, midpoint between 0 and 1")]
    SCurve {
        /// Slope at the midpoint.
        contrast: f64,
        midpoint: f64,
    },
    /// Too few points.
    #[error("a tone table of {0} points: at least two are needed")]
    Short(usize),
    /// Inputs that do not increase, outputs that decrease, or numbers that are not finite.
    #[error(
        "point {0} of the tone table (from 1): inputs must increase from point to point, and outputs must not decrease"
    )]
    Order(usize),
    /// A table that does not cover the range.
    #[error("a tone table leads from input 0 to input 1 with outputs from 0 to 1; this one has {0}")]
    Range(&'static str),
}

/// Contrast about a midpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurve {
    contrast: f64,
    midpoint: f64,
}

impl SCurve {
    /// Creates the curve from a contrast above 0 about an encoded value between 0 and 1.
    ///
    /// # Errors
    /// If a parameter is out of range.
    pub fn new(contrast: f64, midpoint: f64) -> Result<Self, ToneError> {
        let legal = contrast.is_finite() && contrast > 0.0 && midpoint > 0.0 && midpoint < 1.0;
        if legal { Ok(Self { contrast, midpoint }) } else { Err(ToneError::SCurve { contrast, midpoint }) }
    }

    /// The slope of the log-odds.
    #[must_use]
    pub fn contrast(&self) -> f64 {
        self.contrast
    }

    /// The encoded value that maps to 1/2.
    #[must_use]
    pub fn midpoint(&self) -> f64 {
        self.midpoint
    }

    /// The odds of the midpoint.
    fn odds(&self) -> f32 {
        (self.midpoint / (1.0 - self.midpoint)) as f32
    }

    /// y of e, 0 … 1.
    fn bend(&self, e: f32) -> f32 {
        if e <= 0.0 {
            return 0.0;
        }
        1.0 / (1.0 + pow(self.odds() * (1.0 - e) / e, self.contrast as f32))
    }

    /// e of y, 0 … 1.
    fn straighten(&self, y: f32) -> f32 {
        if y <= 0.0 {
            return 0.0;
        }
        1.0 / (1.0 + pow((1.0 - y) / y, (1.0 / self.contrast) as f32) / self.odds())
    }
}

/// Points from input 0 to input 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    points: Vec<(f64, f64)>,
}

impl Table {
    /// Creates a table from inputs (linear) and outputs (encoded); inputs increase from 0 to 1, outputs do not decrease and lie within 0 … 1.
    ///
    /// # Errors
    /// If they violate this.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, ToneError> {
        check_order(&points)?;
        let (first, last) = (points[0], points[points.len() - 1]);
        if first.0 != 0.0 || last.0 != 1.0 {
            return Err(ToneError::Range("inputs that begin or end elsewhere"));
        }
        if first.1 < 0.0 || last.1 > 1.0 {
            return Err(ToneError::Range("outputs outside"));
        }
        Ok(Self { points })
    }

    /// Inputs and outputs.
    #[must_use]
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// The output of an input 0 … 1; NaN for a NaN.
    fn at(&self, x: f32) -> f32 {
        along(&self.points, f64::from(x)) as f32
    }

    /// The smallest input of an output; clamped to the table's outputs.
    fn inverse(&self, y: f32) -> f32 {
        let y = f64::from(y);
        match by_output(&self.points, y) {
            (_, None) => 1.0,
            (None, Some(_)) => 0.0,
            (Some((x0, y0)), Some((x1, y1))) => (x0 + (y - y0) * (x1 - x0) / (y1 - y0)) as f32,
        }
    }
}

/// An input and its output.
type Point = (f64, f64);

/// Linear interpolation between the two points about `x`, or extrapolation from the first or the last two; NaN for a NaN.
fn along(points: &[Point], x: f64) -> f64 {
    let after = points.partition_point(|p| p.0 < x).clamp(1, points.len() - 1);
    let ((x0, y0), (x1, y1)) = (points[after - 1], points[after]);
    y0 + (x - x0) * (y1 - y0) / (x1 - x0)
}

/// The last point whose output is below `y`, and the first whose output is not.
fn by_output(points: &[Point], y: f64) -> (Option<Point>, Option<Point>) {
    let after = points.partition_point(|p| p.1 < y);
    (after.checked_sub(1).map(|before| points[before]), points.get(after).copied())
}

/// Checks for at least two finite points, inputs increasing, outputs not decreasing.
fn check_order(points: &[(f64, f64)]) -> Result<(), ToneError> {
    if points.len() < 2 {
        return Err(ToneError::Short(points.len()));
    }
    if let Some(i) = points.iter().position(|p| !(p.0.is_finite() && p.1.is_finite())) {
        return Err(ToneError::Order(i + 1));
    }
    let position = points.windows(2).position(|p| p[1].0 <= p[0].0 || p[1].1 < p[0].1);
    position.map_or(Ok(()), |i| Err(ToneError::Order(i + 2)))
}

/// Output over exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct Oecf {
    /// ln of the exposure over that of white, output over its largest.
    points: Vec<(f64, f64)>,
}

impl Oecf {
    /// Creates the function from pairs of exposure (above 0, increasing) and output (0 or more, not decreasing), and the largest output level.
    ///
    /// # Errors
    /// If the pairs violate this or an output exceeds the largest level.
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

    /// Exposures, scaled to a largest value of 1, and outputs over the largest level.
    #[must_use]
    pub fn points(&self) -> Vec<(f64, f64)> {
        self.points.iter().map(|(log, y)| (exp(*log), *y)).collect()
    }

    /// The output of linear light 0 … 1; NaN for a NaN.
    fn output(&self, x: f32) -> f32 {
        let x = f64::from(x);
        let (lowest, floor) = self.points[0];
        if x <= exp(lowest) {
            return (floor * x / exp(lowest)) as f32;
        }
        along(&self.points, ln(x)) as f32
    }

    /// The darkest linear light of an output; 1 beyond the largest.
    fn exposure(&self, y: f32) -> f32 {
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
    fn known_codes() {
        let linear = [[0.0, 0.18, 1.0], [-0.1, 0.5, 1.7], [f32::NAN, 0.002, f32::INFINITY]];
        let plane = Plane::from_samples(3, 1, linear.to_vec()).expect("three pixels");
        // 255 · encode(0.18) = 117.6, of 0.5 = 187.5 (187.516), of 0.002 = 6.59.
        let codes = to_8_bit(&ToneCurve::Srgb.encode_plane(&plane));
        assert_eq!(codes, [[0, 118, 255], [0, 188, 255], [0, 7, 255]]);
    }

    fn curves() -> Vec<ToneCurve> {
        let points = [(0.0, 0.0), (0.1, 0.4), (0.5, 0.8), (1.0, 1.0)];
        let measured = [(0.5, 9.0), (1.0, 20.0), (2.0, 44.0), (4.0, 90.0), (8.0, 160.0), (16.0, 230.0), (32.0, 255.0)];
        vec![
            ToneCurve::Srgb,
            ToneCurve::gamma(2.2).expect("legal"),
            ToneCurve::gamma(0.5).expect("legal"),
            ToneCurve::SCurve(SCurve::new(1.6, 0.45).expect("legal")),
            ToneCurve::Table(Table::new(points.to_vec()).expect("legal")),
            ToneCurve::Oecf(Oecf::new(measured.to_vec(), 255.0).expect("legal")),
        ]
    }

    #[test]
    fn every_curve_inverts_and_rises() {
        for curve in curves() {
            let mut last = -1.0;
            for i in 0..=1000 {
                let encoded = i as f32 / 1000.0;
                let linear = curve.decode(encoded);
                // f32 rounding of 1e-7, amplified by the steepest slope (12.92 of sRGB, more of a power near 0).
                assert!((curve.encode(linear) - encoded).abs() < 4e-6, "{curve:?} {encoded} {linear}");
                assert!(linear >= last && (0.0..=1.0).contains(&linear), "{curve:?} {encoded}");
                last = linear;
            }
            assert_eq!((curve.encode(-1.0), curve.encode(0.0)), (0.0, 0.0), "{curve:?}");
            assert_eq!((curve.encode(1.0), curve.encode(9.0)), (1.0, 1.0), "{curve:?}");
            assert!(curve.encode(f32::NAN).is_nan(), "{curve:?}");
        }
    }

    #[test]
    fn gammas_that_are_none_are_refused() {
        for gamma in [0.0, -2.2, f64::NAN, f64::INFINITY] {
            assert!(ToneCurve::gamma(gamma).is_err());
        }
    }

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

    #[test]
    fn lines_join_the_points() {
        let table = Table::new(vec![(0.0, 0.1), (0.5, 0.5), (0.75, 0.5), (1.0, 0.9)]).expect("legal");
        assert_eq!([0.0, 0.25, 0.6, 1.0].map(|x| table.at(x)), [0.1, 0.3, 0.5, 0.9]);
        // The darkest in a flat piece; the ends beyond the outputs.
        assert_eq!([0.0, 0.3, 0.5, 1.0].map(|y| table.inverse(y)), [0.0, 0.25, 0.5, 1.0]);
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        assert_eq!(Table::new(vec![(0.0, 0.0)]), Err(ToneError::Short(1)));
        assert_eq!(Table::new(vec![(0.0, 0.0), (0.5, 0.6), (1.0, 0.5)]), Err(ToneError::Order(3)));
        assert_eq!(Table::new(vec![(0.0, 0.0), (0.0, 0.6), (1.0, 1.0)]), Err(ToneError::Order(2)));
        assert_eq!(Table::new(vec![(0.0, 0.0), (f64::NAN, 0.6), (1.0, 1.0)]), Err(ToneError::Order(2)));
        assert!(matches!(Table::new(vec![(0.0, 0.0), (0.9, 1.0)]), Err(ToneError::Range(_))));
        assert!(matches!(Table::new(vec![(0.0, 0.0), (1.0, 1.1)]), Err(ToneError::Range(_))));
    }

    #[test]
    fn measured_points_are_hit_and_halves_are_halfway() {
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
