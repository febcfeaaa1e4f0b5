//! Filters of linear light: glow with its gain control, and tone mapping.
//!
//! Glow: gain control by the histogram, and blooming. The paper (its mgGlowFilter) states only that it "manages simulation of gain control and sensor
//! blooming, based on image histogram balance"; this is **our interpretation** of it, on linear light:
//!
//! ```text
//! g = target / L_p                    L_p: the percentile p of the luminances of the image (nearest rank)
//! e = max(g x − threshold, 0)         excess over the threshold after the gain, by channel
//! y = g x + strength · (k ∗ e)        k: a Gaussian of σ = radius, cut at 5 σ, normalised
//! ```
//!
//! Luminance is 0.2126 R + 0.7152 G + 0.0722 B. For an image whose L_p is 0 or less the gain is 1. Light is added, not moved: unlike the sensor's own
//! blooming, this does not conserve charge. The result is not clipped. A raw ends at its white level, so in a developed image no x exceeds the
//! exposure gain by much, and lamps exceed a threshold near white only if g lifts them there; images of a sensor of high dynamic range hold more.
//!
//! Tone mapping: from the scene's range to the sensor's. The paper states that "a tone mapping filter simulates the sensitivity curve of the sensor"
//! and shows an "original factor" of 0.4 and 1.0; this is **our interpretation** of it, on linear light, channel by channel:
//!
//! ```text
//! y = f · curve(g x) + (1 − f) · x,   f = 1 − original_factor,   clipped to 0 … 1
//! ```
//!
//! An original factor of 1 leaves the image unchanged, clipped to the sensor's range, and 0 maps it fully. The curve is the sensor's: that of film
//! and of a saturating pixel, 1 − exp(−g x), or any [`ToneCurve`] (a measured OECF).

use etendue_core::{Plane, maths::f32::exp_m1, quantity::LinearRgb};
use etendue_spectra::colour::luma;
use rayon::prelude::*;

use super::{FilterError, demand, for_each};
use crate::{detail, tone::ToneCurve};

/// Gain control and blooming.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glow {
    /// Percentile of the luminances used for the gain, above 0 and at most 100.
    pub percentile: f64,
    /// Target luminance of this percentile, fraction of white, above 0.
    pub target: f64,
    /// Values above this glow, fraction of white, 0 or more.
    pub threshold: f64,
    /// σ of the glow, px, above 0 and at most 500.
    pub radius_px: f64,
    /// Fraction of the excess that is added, 0 or more.
    pub strength: f64,
}

impl Glow {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        let percentile = self.percentile;
        demand(percentile > 0.0 && percentile <= 100.0, "percentile", percentile, "above 0 and at most 100")?;
        demand(self.target > 0.0, "target", self.target, "above 0")?;
        demand(self.threshold >= 0.0, "threshold", self.threshold, "of 0 or more")?;
        let radius = self.radius_px;
        demand(radius > 0.0 && radius <= 500.0, "radius_px", radius, "above 0 and at most 500")?;
        demand(self.strength >= 0.0, "strength", self.strength, "of 0 or more")
    }

    pub(super) fn apply(&self, image: &mut Plane<LinearRgb>) {
        let (gain, threshold, strength) = (self.gain(image) as f32, self.threshold as f32, self.strength as f32);
        for_each(image, |_, rgb| rgb.map(|v| gain * v));
        let excess: Vec<[f32; 3]> =
            image.samples().par_iter().map(|rgb| rgb.map(|v| (v - threshold).max(0.0))).collect();
        let glow = detail::gaussian(&excess, image.width(), self.radius_px);
        for_each(image, |i, rgb| core::array::from_fn(|c| rgb[c] + strength * glow[i][c]));
    }

    /// The gain that brings the percentile to the target.
    fn gain(&self, image: &Plane<LinearRgb>) -> f64 {
        let mut luminances: Vec<f32> = image.samples().par_iter().map(|rgb| luma(*rgb)).collect();
        let Some(last) = luminances.len().checked_sub(1) else { return 1.0 };
        let rank = (self.percentile / 100.0 * luminances.len() as f64).ceil() as usize;
        let (_, value, _) = luminances.select_nth_unstable_by(rank.saturating_sub(1).min(last), f32::total_cmp);
        if *value > 0.0 { self.target / f64::from(*value) } else { 1.0 }
    }
}

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
    /// Fraction of the unmapped image, 0 to 1.
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

    pub(super) fn apply(&self, image: &mut Plane<LinearRgb>) {
        let (original, gain) = (self.original_factor as f32, self.gain as f32);
        let mapped = |x: f32| match &self.sensitivity {
            Sensitivity::Exponential => -exp_m1(-(gain * x).max(0.0)),
            Sensitivity::Curve(curve) => curve.encode(gain * x),
        };
        for_each(image, |_, rgb| rgb.map(|x| ((1.0 - original) * mapped(x) + original * x).clamp(0.0, 1.0)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLOW: Glow = Glow { percentile: 50.0, target: 0.2, threshold: 1.0, radius_px: 2.0, strength: 0.5 };

    /// Mostly 0.1, with a light of 10 at the centre.
    fn night() -> Plane<LinearRgb> {
        let mut image = Plane::filled(41, 41, [0.1; 3]);
        image.set(20, 20, [10.0, 5.0, 0.0]);
        image
    }

    #[test]
    fn the_median_is_brought_to_the_target_and_the_lamp_emits() {
        let mut image = night();
        GLOW.apply(&mut image);
        // Far from the light only the gain of 2 acts; half of the excess of 19, 9 and 0 is added.
        assert!(image.at(0, 0).iter().all(|v| (v - 0.2).abs() < 1e-6));
        let added = |c: usize| -> f32 {
            let total: f32 = image.samples().iter().map(|rgb| rgb[c]).sum();
            let gained: f32 = night().samples().iter().map(|rgb| 2.0 * rgb[c]).sum();
            total - gained
        };
        // Sums of 1 681 values of f32.
        assert!((added(0) - 9.5).abs() < 1e-2 && (added(1) - 4.5).abs() < 1e-2 && added(2).abs() < 1e-2);
        assert!(image.at(22, 20)[0] > 0.3 && image.at(22, 20)[2] < 0.21);
    }

    #[test]
    fn a_black_image_stays_black() {
        let mut black = Plane::filled(5, 5, [0.0; 3]);
        GLOW.apply(&mut black);
        assert!(black.samples().iter().all(|rgb| *rgb == [0.0; 3]));
        GLOW.apply(&mut Plane::new(0, 0));
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        assert!(GLOW.check().is_ok());
        for wrong in [
            Glow { percentile: 0.0, ..GLOW },
            Glow { percentile: 101.0, ..GLOW },
            Glow { target: 0.0, ..GLOW },
            Glow { threshold: -1.0, ..GLOW },
            Glow { radius_px: 0.0, ..GLOW },
            Glow { strength: f64::INFINITY, ..GLOW },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
    }

    mod tone_map {
        use super::super::*;

        fn mapped(original_factor: f64, sensitivity: Sensitivity) -> Vec<f32> {
            let light = [-0.1, 0.0, 0.25, 0.5, 1.0, 4.0];
            let mut image = Plane::from_samples(6, 1, light.map(|v| [v; 3]).to_vec()).expect("filled");
            ToneMap { original_factor, gain: 2.0, sensitivity }.apply(&mut image);
            image.samples().iter().map(|rgb| rgb[0]).collect()
        }

        #[test]
        fn the_original_factor_blends() {
            assert_eq!(mapped(1.0, Sensitivity::Exponential), [0.0, 0.0, 0.25, 0.5, 1.0, 1.0]);
            let mapped_values = mapped(0.0, Sensitivity::Exponential);
            // 1 − e^(−2x).
            for (actual, expected) in mapped_values.iter().zip([0.0, 0.0, 0.393_469, 0.632_121, 0.864_665, 0.999_665]) {
                assert!((actual - expected).abs() < 1e-6, "{actual} {expected}");
            }
            let blend = mapped(0.4, Sensitivity::Exponential);
            assert!((2..5).all(|i| (blend[i] - 0.6 * mapped_values[i] - 0.4 * [0.25, 0.5, 1.0][i - 2]).abs() < 1e-6));
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
}
