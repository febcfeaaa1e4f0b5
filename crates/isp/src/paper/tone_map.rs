//! Tone mapping: from the scene's range to the sensor's. The paper says that "a tone mapping filter simulates the
//! sensitivity curve of the sensor" and shows an "original factor" of 0.4 and 1.0; this is **our reading** of it, on
//! linear light, channel by channel:
//!
//! ```text
//! y = f · curve(g x) + (1 − f) · x,   f = 1 − original_factor,   clipped to 0 … 1
//! ```
//!
//! So an original factor of 1 leaves the picture as it was, clipped to the sensor's range, and 0 maps it wholly. The curve
//! is the sensor's: one of film and of a saturating pixel, 1 − exp(−g x), or any [`ToneCurve`] (a measured OECF).

use super::{FilterError, demand, for_each};
use crate::tone::ToneCurve;
use etendue_core::Plane;
use etendue_core::maths::f32::exp_m1;
use etendue_core::quantity::LinearRgb;

/// The sensor's curve.
#[derive(Clone, Debug, PartialEq)]
pub enum Sensitivity {
    /// 1 − exp(−x).
    Exponential,
    /// A tone curve of x clipped to 0 … 1.
    Curve(ToneCurve),
}

/// From the scene's range to the sensor's.
#[derive(Clone, Debug, PartialEq)]
pub struct ToneMap {
    /// Share of the unmapped picture, 0 to 1.
    pub original_factor: f64,
    /// g, above 0.
    pub gain: f64,
    /// The sensor's curve.
    pub sensitivity: Sensitivity,
}

impl ToneMap {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        let factor = self.original_factor;
        demand((0.0..=1.0).contains(&factor), "original_factor", factor, "from 0 to 1")?;
        demand(self.gain > 0.0, "gain", self.gain, "above 0")
    }

    pub(super) fn apply(&self, picture: &mut Plane<LinearRgb>) {
        let (original, gain) = (self.original_factor as f32, self.gain as f32);
        let mapped = |x: f32| match &self.sensitivity {
            Sensitivity::Exponential => -exp_m1(-(gain * x).max(0.0)),
            Sensitivity::Curve(curve) => curve.encode(gain * x),
        };
        for_each(picture, |_, rgb| rgb.map(|x| ((1.0 - original) * mapped(x) + original * x).clamp(0.0, 1.0)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mapped(original_factor: f64, sensitivity: Sensitivity) -> Vec<f32> {
        let light = [-0.1, 0.0, 0.25, 0.5, 1.0, 4.0];
        let mut picture = Plane::from_samples(6, 1, light.map(|v| [v; 3]).to_vec()).expect("filled");
        ToneMap { original_factor, gain: 2.0, sensitivity }.apply(&mut picture);
        picture.samples().iter().map(|rgb| rgb[0]).collect()
    }

    #[test]
    fn the_original_factor_blends() {
        assert_eq!(mapped(1.0, Sensitivity::Exponential), [0.0, 0.0, 0.25, 0.5, 1.0, 1.0]);
        let whole = mapped(0.0, Sensitivity::Exponential);
        // 1 − e^(−2x).
        for (found, want) in whole.iter().zip([0.0, 0.0, 0.393_469, 0.632_121, 0.864_665, 0.999_665]) {
            assert!((found - want).abs() < 1e-6, "{found} {want}");
        }
        let blend = mapped(0.4, Sensitivity::Exponential);
        assert!((2..5).all(|i| (blend[i] - 0.6 * whole[i] - 0.4 * [0.25, 0.5, 1.0][i - 2]).abs() < 1e-6));
    }

    #[test]
    fn any_tone_curve_can_be_the_sensor_s() {
        let linear = ToneCurve::gamma(1.0).expect("legal");
        assert_eq!(mapped(0.0, Sensitivity::Curve(linear)), [0.0, 0.0, 0.5, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let legal = ToneMap { original_factor: 0.4, gain: 1.0, sensitivity: Sensitivity::Exponential };
        assert!(legal.check().is_ok());
        assert!(ToneMap { original_factor: 1.1, ..legal.clone() }.check().is_err());
        assert!(ToneMap { gain: 0.0, ..legal }.check().is_err());
    }
}
