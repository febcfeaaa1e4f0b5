//! Multiplicative uniform noise, by the paper's formula on the brightness x of each pixel, u uniform on 0 … 1:
//!
//! ```text
//! (1 + p₁ (u − 1/2)) x
//! ```
//!
//! One u a pixel, all channels alike; p₁ has no unit (the factor is the same at any scale of DN); clipped to 0 … 255.

use super::{Change, FilterAddress, FilterError, change_brightness, demand};
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_core::random::NoiseDraw;

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

    pub(super) fn apply(&self, picture: &mut Plane<Display>, address: FilterAddress) {
        change_brightness(picture, address, NoiseDraw::PaperUniform, |stream| Change {
            factor: 1.0 + self.range * (stream.unit_f64() - 0.5),
            offset_dn: 0.0,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::tests::address;

    #[test]
    fn factors_fill_their_range_evenly_and_keep_the_hue() {
        let mut picture = Plane::filled(200, 200, [0.2, 0.4, 0.6]);
        UniformNoise { range: 0.5 }.apply(&mut picture, address(9, 0, 0));
        let mut bins = [0_u32; 10];
        for rgb in picture.samples() {
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
        let mut picture = Plane::filled(30, 30, [1.0; 3]);
        UniformNoise { range: 2.0 }.apply(&mut picture, FilterAddress::default());
        assert!(picture.samples().iter().flatten().all(|v| (0.0..=1.0).contains(v)));
        assert!(UniformNoise { range: 2.1 }.check().is_err() && UniformNoise { range: f64::NAN }.check().is_err());
    }
}
