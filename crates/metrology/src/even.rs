//! Mean and variance of an even patch, with uncertainties that hold for developed pictures as well.
//!
//! Demosaicking, filters and JPEG make neighbours alike: n pixels then say as much as fewer independent ones. With ρ the correlation of the
//! deviations from the mean at a distance of d pixels,
//!
//! ```text
//! u²(mean) = σ²/n Σ ρ(d)      |d_x|, |d_y| ≤ 3, no less than 1      u²(σ²) = 2 σ⁴/(n − 1) Σ ρ(d)
//! ```
//!
//! (the first exact where correlations reach no farther, Priestley 1981; the second an upper bound, for Σ ρ² is in its place). Premise: no
//! correlations beyond three pixels. Noise that whole rows or columns share, and light or dirt that is uneven, are not in it; a slope within
//! the patch counts as noise.

use crate::{Estimate, Image};
use etendue_stats::Moments;

/// How far neighbours are looked at, px.
const REACH: usize = 3;
/// Correlations are taken from the middle of large patches, px: tens of thousands of pixels tell them to a few per cent.
const ENOUGH: usize = 256;

/// What an even patch says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Even {
    /// Mean reading.
    pub mean: Estimate,
    /// Variance of a pixel.
    pub variance: Estimate,
}

/// Mean and variance of a patch.
#[must_use]
pub fn even(patch: &Image) -> Even {
    let moments = Moments::of(patch.samples().iter().map(|s| f64::from(*s)));
    let (count, variance) = (moments.count() as f64, moments.variance().unwrap_or(0.0));
    let alike = alike(patch);
    Even {
        mean: Estimate::new(moments.mean(), (variance / count * alike).sqrt()),
        variance: Estimate::new(variance, variance * (2.0 / (count - 1.0) * alike).sqrt()),
    }
}

/// Σ ρ over neighbours, 1 or more: how many pixels say what one independent one would.
fn alike(patch: &Image) -> f64 {
    let middle = |length: usize| (length.saturating_sub(ENOUGH) / 2, length.min(ENOUGH));
    let ((left, width), (top, height)) = (middle(patch.width()), middle(patch.height()));
    let part = patch.part(left, top, width, height);
    let mean = Moments::of(part.samples().iter().map(|s| f64::from(*s))).mean();
    let deviations: Vec<f64> = part.samples().iter().map(|s| f64::from(*s) - mean).collect();
    let pairs = |dx: usize, dy: usize, back: bool| -> f64 {
        let columns = width.saturating_sub(dx);
        let [a, b] = if back { [dx, 0] } else { [0, dx] };
        let row = |y: usize| {
            let (first, second) =
                (&deviations[y * width + a..][..columns], &deviations[(y + dy) * width + b..][..columns]);
            first.iter().zip(second).map(|(p, q)| p * q).sum::<f64>()
        };
        (0..height.saturating_sub(dy)).map(row).sum()
    };
    let own = pairs(0, 0, false);
    if own <= 0.0 || width <= 2 * REACH || height <= 2 * REACH {
        return 1.0;
    }
    // Each distance and its opposite.
    let along = (1..=REACH).map(|dx| pairs(dx, 0, false)).sum::<f64>();
    let across = (1..=REACH)
        .map(|dy| pairs(0, dy, false) + (1..=REACH).map(|dx| pairs(dx, dy, false) + pairs(dx, dy, true)).sum::<f64>());
    (1.0 + 2.0 * (along + across.sum::<f64>()) / own).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pixel twice along and twice down: four pixels are one.
    #[test]
    fn repeated_pixels_count_once() {
        let noise = |x: usize, y: usize| ((x * 7919 + y * 104_729 + x * y * 31) % 97) as f32;
        let of =
            |f: &dyn Fn(usize) -> f32| Image::from_samples(96, 96, (0..96 * 96).map(f).collect()).expect("a square");
        let (single, double) = (of(&|i| noise(i % 96, i / 96)), of(&|i| noise(i % 96 / 2, i / 96 / 2)));
        assert!((alike(&double) / alike(&single) - 4.0).abs() < 1.0, "{} {}", alike(&double), alike(&single));
        let [a, b] = [even(&single), even(&double)].map(|e| e.mean.standard_uncertainty);
        assert!((b / a - 2.0).abs() < 0.3, "{a} {b}");
    }

    #[test]
    fn a_patch_of_one_value_is_known() {
        let even = even(&Image::filled(12, 12, 7.0));
        assert_eq!((even.mean, even.variance), (Estimate::new(7.0, 0.0), Estimate::new(0.0, 0.0)));
    }
}
