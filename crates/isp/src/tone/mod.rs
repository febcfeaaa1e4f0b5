//! Tone curves: from linear light to what a display takes, both 0 to 1.
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

mod error;
mod oecf;
mod s_curve;
mod table;

use etendue_core::Plane;
use etendue_core::maths::f32::pow;
use etendue_core::quantity::{Display, LinearRgb};
use etendue_spectra::colour;
use rayon::prelude::*;

pub use error::ToneError;
pub use oecf::Oecf;
pub use s_curve::SCurve;
pub use table::Table;

/// How linear light is encoded.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ToneCurve {
    /// The curve of IEC 61966-2-1.
    #[default]
    Srgb,
    /// A power; the number is γ, above 0: 2.2 brightens, 1 is linear.
    Gamma(f64),
    /// More contrast about a middle, on top of the sRGB curve.
    SCurve(SCurve),
    /// Points joined by straight lines.
    Table(Table),
    /// Measured output over exposure.
    Oecf(Oecf),
}

impl ToneCurve {
    /// A power curve.
    ///
    /// # Errors
    /// Where γ is not above 0.
    pub fn gamma(gamma: f64) -> Result<Self, ToneError> {
        if gamma.is_finite() && gamma > 0.0 { Ok(Self::Gamma(gamma)) } else { Err(ToneError::Gamma(gamma)) }
    }

    /// Encodes linear light, clipped to 0 … 1 before. A NaN stays one.
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

    /// The linear light of an encoded value, clipped to 0 … 1 before. Where the curve is flat, the darkest.
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

    /// A whole picture. Runs in the rayon pool of the caller; the result does not depend on it.
    #[must_use]
    pub fn encode_plane(&self, linear: &Plane<LinearRgb>) -> Plane<Display> {
        let samples = linear.samples().par_iter().map(|rgb| rgb.map(|v| self.encode(v))).collect();
        Plane::from_samples(linear.width(), linear.height(), samples).expect("as many samples as before")
    }
}

#[cfg(test)]
/// 8 bits a channel, row by row: 255 v rounded to the nearest, halves up; of a NaN, 0.
#[must_use]
pub(crate) fn to_8_bit(display: &Plane<Display>) -> Vec<[u8; 3]> {
    display.samples().iter().map(|rgb| rgb.map(|v| (255.0 * v + 0.5) as u8)).collect()
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
}
