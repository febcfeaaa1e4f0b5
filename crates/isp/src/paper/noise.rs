//! Noise of the paper: Gaussian, pulse and uniform.
//!
//! Additive Gaussian noise, by the paper's formula on the brightness x of each pixel, n standard normal:
//!
//! ```text
//! x + p₁ n
//! ```
//!
//! One n per pixel for all channels; p₁ in DN of an 8-bit image, clipped to 0 … 255. n by Box & Muller 1958.
//!
//! Pulse noise, by the paper's formula on the brightness x of each pixel, u uniform on 0 … 1:
//!
//! ```text
//! u ≤ p₂: x + p₁    p₂ < u < 1 − p₂: x    u ≥ 1 − p₂: x − p₁
//! ```
//!
//! One u per pixel for all channels; p₁ in DN of an 8-bit image, clipped to 0 … 255; p₂ at most 1/2, beyond which the two cases overlap (at 1/2
//! itself the first holds).
//!
//! Multiplicative uniform noise, by the paper's formula on the brightness x of each pixel, u uniform on 0 … 1:
//!
//! ```text
//! (1 + p₁ (u − 1/2)) x
//! ```
//!
//! One u per pixel for all channels; p₁ has no unit (the factor is the same at any scale of DN); clipped to 0 … 255.

use core::f64::consts::TAU;

use etendue_core::maths::f64::{cos, ln};
use etendue_core::random::{NoiseDraw, NoiseStream};
use etendue_core::{Plane, quantity::Display};

use super::{BrightnessChange, FilterAddress, FilterError, change_brightness, demand};

/// A normal number added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianNoise {
    /// p₁, the standard deviation, DN of an 8-bit image, 0 to 255.
    pub sigma_dn: f64,
}

impl GaussianNoise {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        demand((0.0..=255.0).contains(&self.sigma_dn), "sigma_dn", self.sigma_dn, "from 0 to 255")
    }

    pub(super) fn apply(&self, image: &mut Plane<Display>, address: FilterAddress) {
        change_brightness(image, address, NoiseDraw::PaperGaussian, |stream| BrightnessChange {
            factor: 1.0,
            offset_dn: self.sigma_dn * standard_normal(stream),
        });
    }
}

fn standard_normal(stream: &mut NoiseStream) -> f64 {
    let radius = (-2.0 * ln(1.0 - stream.unit_f64())).sqrt();
    radius * cos(TAU * stream.unit_f64())
}

/// Some pixels brighter, some darker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseNoise {
    /// p₁, DN of an 8-bit image, 0 to 255.
    pub amplitude_dn: f64,
    /// p₂, the fraction of pixels made brighter, and of those made darker, 0 to 0.5.
    pub probability: f64,
}

impl PulseNoise {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        demand((0.0..=255.0).contains(&self.amplitude_dn), "amplitude_dn", self.amplitude_dn, "from 0 to 255")?;
        demand((0.0..=0.5).contains(&self.probability), "probability", self.probability, "from 0 to 0.5")
    }

    pub(super) fn apply(&self, image: &mut Plane<Display>, address: FilterAddress) {
        change_brightness(image, address, NoiseDraw::PaperPulse, |stream| {
            let u = stream.unit_f64();
            let sign = if u <= self.probability {
                1.0
            } else if u >= 1.0 - self.probability {
                -1.0
            } else {
                0.0
            };
            BrightnessChange { factor: 1.0, offset_dn: sign * self.amplitude_dn }
        });
    }
}

/// A uniform number as a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformNoise {
    /// p₁, the width of the factor's range, 0 to 2 (at 2 it spans 0 to 2).
    pub range: f64,
}

impl UniformNoise {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        demand((0.0..=2.0).contains(&self.range), "range", self.range, "from 0 to 2")
    }

    pub(super) fn apply(&self, image: &mut Plane<Display>, address: FilterAddress) {
        change_brightness(image, address, NoiseDraw::PaperUniform, |stream| BrightnessChange {
            factor: 1.0 + self.range * (stream.unit_f64() - 0.5),
            offset_dn: 0.0,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::address;
    use super::*;

    #[test]
    fn mean_spread_and_shape_are_those_of_a_normal_number() {
        let mut image = Plane::filled(200, 200, [0.5; 3]);
        GaussianNoise { sigma_dn: 10.0 }.apply(&mut image, address(3, 0, 1));
        let values: Vec<f64> = image.samples().iter().map(|rgb| (f64::from(rgb[1]) - 0.5) * 25.5).collect();
        assert!(image.samples().iter().all(|rgb| rgb[0] == rgb[1] && rgb[1] == rgb[2]));
        let n = values.len() as f64;
        let moment = |k: i32| values.iter().map(|v| (0..k).fold(1.0, |p, _| p * v)).sum::<f64>() / n;
        // 4.5 standard errors of moments of 40 000 normal numbers: 1/√n, √(2/n), √(15/n), √(96/n).
        assert!(moment(1).abs() < 0.0225 && (moment(2) - 1.0).abs() < 0.032);
        assert!(moment(3).abs() < 0.087 && (moment(4) - 3.0).abs() < 0.22);
    }

    #[test]
    fn another_frame_has_other_noise_and_the_same_has_the_same() {
        let noisy = |frame| {
            let mut image = Plane::filled(8, 8, [0.5; 3]);
            GaussianNoise { sigma_dn: 10.0 }.apply(&mut image, address(3, 0, frame));
            image
        };
        assert!(noisy(0) == noisy(0) && noisy(0) != noisy(1));
    }

    #[test]
    fn pixels_rise_and_fall_as_often_as_said_and_all_channels_alike() {
        let noise = PulseNoise { amplitude_dn: 51.0, probability: 0.2 };
        let mut image = Plane::filled(200, 200, [0.4, 0.5, 0.6]);
        noise.apply(&mut image, address(5, 1, 2));
        let (mut up, mut down) = (0, 0);
        for rgb in image.samples() {
            let change = rgb[0] - 0.4;
            assert!((rgb[1] - 0.5 - change).abs() < 1e-6 && (rgb[2] - 0.6 - change).abs() < 1e-6);
            up += usize::from((change - 0.2).abs() < 1e-6);
            down += usize::from((change + 0.2).abs() < 1e-6);
        }
        // 40 000 pixels of probability 0.2: σ = 80; tolerance 4.5 σ.
        assert!(up.abs_diff(8000) < 360 && down.abs_diff(8000) < 360, "{up} {down}");
    }

    #[test]
    fn half_and_half_leaves_no_pixel_and_the_ends_clip() {
        let noise = PulseNoise { amplitude_dn: 255.0, probability: 0.5 };
        let mut image = Plane::filled(40, 40, [0.5; 3]);
        noise.apply(&mut image, FilterAddress::default());
        assert!(image.samples().iter().all(|rgb| *rgb == [0.0; 3] || *rgb == [1.0; 3]));
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let legal = PulseNoise { amplitude_dn: 10.0, probability: 0.5 };
        assert!(legal.check().is_ok());
        assert!(PulseNoise { probability: 0.51, ..legal }.check().is_err());
        assert!(PulseNoise { amplitude_dn: -1.0, ..legal }.check().is_err());
    }

    #[test]
    fn factors_fill_their_range_evenly_and_keep_the_hue() {
        let mut image = Plane::filled(200, 200, [0.2, 0.4, 0.6]);
        UniformNoise { range: 0.5 }.apply(&mut image, address(9, 0, 0));
        let mut bins = [0_u32; 10];
        for rgb in image.samples() {
            let factor = f64::from(rgb[1]) / 0.4;
            assert!((f64::from(rgb[2]) / 0.6 - factor).abs() < 1e-6);
            bins[(((factor - 0.75) / 0.05) as usize).min(9)] += 1;
        }
        let chi2: f64 = bins.iter().map(|n| (f64::from(*n) - 4000.0) * (f64::from(*n) - 4000.0) / 4000.0).sum();
        // 9 degrees of freedom: 27.9 is exceeded once in a thousand.
        assert!(chi2 < 27.9, "{bins:?}");
    }

    #[test]
    fn the_ends_clip_and_ranges_have_bounds() {
        let mut image = Plane::filled(30, 30, [1.0; 3]);
        UniformNoise { range: 2.0 }.apply(&mut image, FilterAddress::default());
        assert!(image.samples().iter().flatten().all(|v| (0.0..=1.0).contains(v)));
        assert!(UniformNoise { range: 2.1 }.check().is_err() && UniformNoise { range: f64::NAN }.check().is_err());
    }
}
