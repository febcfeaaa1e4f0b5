//! Pulse noise, by the paper's formula on the brightness x of each pixel, u uniform on 0 … 1:
//!
//! ```text
//! u ≤ p₂: x + p₁    p₂ < u < 1 − p₂: x    u ≥ 1 − p₂: x − p₁
//! ```
//!
//! One u a pixel, all channels alike; p₁ in DN of an 8-bit picture, clipped to 0 … 255; p₂ at most 1/2, beyond which the
//! two cases overlap (at 1/2 itself the first holds).

use super::{Change, FilterAddress, FilterError, change_brightness, demand};
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_core::random::NoiseDraw;

/// Some pixels brighter, some darker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseNoise {
    /// p₁, DN of an 8-bit picture, 0 to 255.
    pub amplitude_dn: f64,
    /// p₂, the share of pixels that get brighter, and of those that get darker, 0 to 0.5.
    pub probability: f64,
}

impl PulseNoise {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        demand((0.0..=255.0).contains(&self.amplitude_dn), "amplitude_dn", self.amplitude_dn, "from 0 to 255")?;
        demand((0.0..=0.5).contains(&self.probability), "probability", self.probability, "from 0 to 0.5")
    }

    pub(super) fn apply(&self, picture: &mut Plane<Display>, address: FilterAddress) {
        change_brightness(picture, address, NoiseDraw::PaperPulse, |stream| {
            let u = stream.unit_f64();
            let sign = if u <= self.probability {
                1.0
            } else if u >= 1.0 - self.probability {
                -1.0
            } else {
                0.0
            };
            Change { factor: 1.0, offset_dn: sign * self.amplitude_dn }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::tests::address;

    #[test]
    fn pixels_rise_and_fall_as_often_as_said_and_all_channels_alike() {
        let noise = PulseNoise { amplitude_dn: 51.0, probability: 0.2 };
        let mut picture = Plane::filled(200, 200, [0.4, 0.5, 0.6]);
        noise.apply(&mut picture, address(5, 1, 2));
        let (mut up, mut down) = (0, 0);
        for rgb in picture.samples() {
            let change = rgb[0] - 0.4;
            assert!((rgb[1] - 0.5 - change).abs() < 1e-6 && (rgb[2] - 0.6 - change).abs() < 1e-6);
            up += usize::from((change - 0.2).abs() < 1e-6);
            down += usize::from((change + 0.2).abs() < 1e-6);
        }
        // 40 000 pixels of probability 0.2: σ = 80, so 4.5 σ.
        assert!(up.abs_diff(8000) < 360 && down.abs_diff(8000) < 360, "{up} {down}");
    }

    #[test]
    fn half_and_half_leaves_no_pixel_and_the_ends_clip() {
        let noise = PulseNoise { amplitude_dn: 255.0, probability: 0.5 };
        let mut picture = Plane::filled(40, 40, [0.5; 3]);
        noise.apply(&mut picture, FilterAddress::default());
        assert!(picture.samples().iter().all(|rgb| *rgb == [0.0; 3] || *rgb == [1.0; 3]));
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let legal = PulseNoise { amplitude_dn: 10.0, probability: 0.5 };
        assert!(legal.check().is_ok());
        assert!(PulseNoise { probability: 0.51, ..legal }.check().is_err());
        assert!(PulseNoise { amplitude_dn: -1.0, ..legal }.check().is_err());
    }
}
