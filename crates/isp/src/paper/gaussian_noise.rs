//! Additive Gaussian noise, by the paper's formula on the brightness x of each pixel, n standard normal:
//!
//! ```text
//! x + p₁ n
//! ```
//!
//! One n a pixel, all channels alike; p₁ in DN of an 8-bit picture, clipped to 0 … 255. n by Box & Muller 1958.

use super::{Change, FilterAddress, FilterError, change_brightness, demand};
use core::f64::consts::TAU;
use etendue_core::Plane;
use etendue_core::maths::f64::{cos, ln};
use etendue_core::quantity::Display;
use etendue_core::random::{NoiseDraw, NoiseStream};

/// A normal number added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianNoise {
    /// p₁, the standard deviation, DN of an 8-bit picture, 0 to 255.
    pub sigma_dn: f64,
}

impl GaussianNoise {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        demand((0.0..=255.0).contains(&self.sigma_dn), "sigma_dn", self.sigma_dn, "from 0 to 255")
    }

    pub(super) fn apply(&self, picture: &mut Plane<Display>, address: FilterAddress) {
        change_brightness(picture, address, NoiseDraw::PaperGaussian, |stream| Change {
            factor: 1.0,
            offset_dn: self.sigma_dn * standard_normal(stream),
        });
    }
}

fn standard_normal(stream: &mut NoiseStream) -> f64 {
    let radius = (-2.0 * ln(1.0 - stream.unit_f64())).sqrt();
    radius * cos(TAU * stream.unit_f64())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::tests::address;

    #[test]
    fn mean_spread_and_shape_are_those_of_a_normal_number() {
        let mut picture = Plane::filled(200, 200, [0.5; 3]);
        GaussianNoise { sigma_dn: 10.0 }.apply(&mut picture, address(3, 0, 1));
        let values: Vec<f64> = picture.samples().iter().map(|rgb| (f64::from(rgb[1]) - 0.5) * 25.5).collect();
        assert!(picture.samples().iter().all(|rgb| rgb[0] == rgb[1] && rgb[1] == rgb[2]));
        let n = values.len() as f64;
        let moment = |k: i32| values.iter().map(|v| (0..k).fold(1.0, |p, _| p * v)).sum::<f64>() / n;
        // 4.5 standard errors of moments of 40 000 normal numbers: 1/√n, √(2/n), √(15/n), √(96/n).
        assert!(moment(1).abs() < 0.0225 && (moment(2) - 1.0).abs() < 0.032);
        assert!(moment(3).abs() < 0.087 && (moment(4) - 3.0).abs() < 0.22);
    }

    #[test]
    fn another_frame_has_other_noise_and_the_same_has_the_same() {
        let noisy = |frame| {
            let mut picture = Plane::filled(8, 8, [0.5; 3]);
            GaussianNoise { sigma_dn: 10.0 }.apply(&mut picture, address(3, 0, frame));
            picture
        };
        assert!(noisy(0) == noisy(0) && noisy(0) != noisy(1));
    }
}
