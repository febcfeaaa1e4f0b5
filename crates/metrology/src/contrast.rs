//! Contrast detection: the probability that a camera reproduces a contrast of the scene.
//!
//! After the IEEE P2020 white paper (2018) and the abstracts on its later working draft. Weber contrast of two patches of
//! readings x and y is K = y/x − 1. With K the scene's contrast and K_m that of a pair of pixels, one of each patch:
//!
//! ```text
//! CDP = P(K (1 − ε) ≤ K_m ≤ K (1 + ε))          ε = 0.5 in the white paper
//! P(K_m ≤ k) = Φ(((1 + k) μ_x − μ_y)/√(σ_y² + (1 + k)² σ_x²))       ratio of two Gaussians, x > 0
//! CTA = ⟨K_m⟩/K with ⟨K_m⟩ = μ_y/μ_x − 1        contrast transfer accuracy: 1 if the contrast is preserved (our interpretation)
//! CSNR = (μ_y − μ_x)/√(σ_x² + σ_y²)
//! ```
//!
//! Means and variances of patches replace all pairs of pixels (an error below 0.04 for readings that are nearly Gaussian and
//! positive). Uncertainty: propagated from those of means and variances ([`patch_statistics`](crate::patch_statistics)).

use etendue_core::maths::f64::hypot;
use etendue_stats::normal;

use crate::patch_statistics::{patch_statistics, saturated_percent};
use crate::{Estimate, Image, estimate::propagate};

/// A pair of patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContrastPair {
    /// Mean measured contrast.
    pub measured: Estimate,
    /// Contrast detection probability.
    pub detection: Estimate,
    /// Contrast transfer accuracy.
    pub transfer: Estimate,
    /// Contrast-to-noise ratio.
    pub contrast_snr: Estimate,
}

/// Readings of a patch of uniform luminance.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Readings as stored, proportional to light above black.
    pub readings: Image,
    /// Relative sensitivity of the same pixels, above 0, by which their light is divided; `None`: equal sensitivity.
    pub flat: Option<Image>,
}

impl From<Image> for Patch {
    /// A patch of pixels of equal sensitivity.
    fn from(readings: Image) -> Self {
        Self { readings, flat: None }
    }
}

impl Patch {
    /// Returns the readings of pixels of equal sensitivity.
    fn corrected(&self, black: f64) -> Image {
        let Some(flat) = &self.flat else { return self.readings.clone() };
        let pairs = self.readings.samples().iter().zip(flat.samples());
        let samples = pairs.map(|(reading, gain)| (black + (f64::from(*reading) - black) / f64::from(*gain)) as f32);
        Image::from_samples(self.readings.width(), self.readings.height(), samples.collect()).expect("the patch's size")
    }
}

/// Settings of a contrast measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContrastSettings {
    /// Reading without light.
    pub black: f64,
    /// Reading of a saturated pixel.
    pub full_scale: Option<f64>,
    /// Maximum relative deviation of a measured contrast from the scene's, ε.
    pub tolerance: f64,
    /// Side of the blocks of pixels with equal errors, px; 1: none.
    pub shared_px: usize,
}

/// Reason why a contrast cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContrastError {
    /// A patch of fewer than four pixels.
    #[error("a contrast needs patches of at least four pixels each")]
    TooSmall,
    /// The scene's contrast is zero or not a number.
    #[error("the contrast of the scene must be a number above 0, not {0}: name the darker patch first")]
    Contrast(f64),
    /// The tolerance is outside 0 to 1.
    #[error("the tolerated fraction must be above 0 and at most 1, not {0}")]
    Tolerance(f64),
    /// A patch is clipped.
    #[error(
        "{percent:.1} % of a patch is saturated, which lowers its contrast and its noise: expose less, or leave it out"
    )]
    Saturated {
        /// Percentage of clipped pixels.
        percent: f64,
    },
    /// The patches are in the wrong order.
    #[error("the brighter patch does not read more than the darker one: name the darker patch first")]
    Order,
    /// The darker patch has no light.
    #[error("the darker patch reads no more than black: a Weber contrast needs light in it")]
    Dark,
}

/// Measures the contrast of a darker and a brighter patch against the scene's.
///
/// # Errors
/// If patches are too small or dark, or the scene's contrast or the tolerance is invalid.
pub fn measure_contrast(
    darker: &Patch,
    brighter: &Patch,
    scene_contrast: f64,
    settings: &ContrastSettings,
) -> Result<ContrastPair, ContrastError> {
    if [darker, brighter].iter().any(|patch| patch.readings.samples().len() < 4) {
        return Err(ContrastError::TooSmall);
    }
    if !(scene_contrast > 0.0 && scene_contrast.is_finite()) {
        return Err(ContrastError::Contrast(scene_contrast));
    }
    let &ContrastSettings { black, full_scale, tolerance, shared_px } = settings;
    if !(tolerance > 0.0 && tolerance <= 1.0) {
        return Err(ContrastError::Tolerance(tolerance));
    }
    if let Some(percent) = saturated_percent([&darker.readings, &brighter.readings], full_scale) {
        return Err(ContrastError::Saturated { percent });
    }
    let [x, xx] = moments(&darker.corrected(black), black, shared_px);
    let [y, yy] = moments(&brighter.corrected(black), black, shared_px);
    if x.value <= 0.0 {
        return Err(ContrastError::Dark);
    }
    let lower_bound = x.value - 4.0 * hypot(x.standard_uncertainty, y.standard_uncertainty);
    if y.value <= lower_bound || darker == brighter {
        return Err(ContrastError::Order);
    }
    let figures = propagate(&[x, xx, y, yy], |v| {
        let measured = v[2] / v[0] - 1.0;
        let snr = (v[2] - v[0]) / (v[1] + v[3]).sqrt();
        [measured, detection_probability([v[0], v[1]], [v[2], v[3]], scene_contrast, tolerance), snr]
    });
    let [measured, detection, contrast_snr] = figures;
    Ok(ContrastPair { measured, detection, transfer: measured.scaled(1.0 / scene_contrast), contrast_snr })
}

/// CDP of two Gaussians (mean, variance) for a contrast of the scene.
#[must_use]
pub fn detection_probability(darker: [f64; 2], brighter: [f64; 2], scene_contrast: f64, tolerance: f64) -> f64 {
    let below = |contrast: f64| {
        let ratio = 1.0 + contrast;
        let spread = (brighter[1] + ratio * ratio * darker[1]).max(0.0).sqrt();
        let distance = ratio * darker[0] - brighter[0];
        // Without noise the probability is a step function.
        if spread > 0.0 { normal::cdf(distance / spread) } else { f64::from(u8::from(distance >= 0.0)) }
    };
    below(scene_contrast * (1.0 + tolerance)) - below(scene_contrast * (1.0 - tolerance))
}

/// Mean less black, and variance, of a patch.
fn moments(patch: &Image, black: f64, shared_px: usize) -> [Estimate; 2] {
    let patch = patch_statistics(patch, shared_px);
    [Estimate::new(patch.mean.value - black, patch.mean.standard_uncertainty), patch.variance]
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
    use rand_distr::{Distribution, Normal};

    #[test]
    fn known_probabilities() {
        // Reference values by simulation, to their third digit.
        let cdp = |s: f64, t: f64| detection_probability([1000.0, s * s], [1500.0, t * t], 0.5, 0.5);
        assert!((cdp(60.0, 75.0) - 0.964).abs() < 1e-3, "{}", cdp(60.0, 75.0));
        assert!((cdp(300.0, 360.0) - 0.338).abs() < 1e-3, "{}", cdp(300.0, 360.0));
        assert_eq!(cdp(0.0, 0.0), 1.0);
    }

    /// Counting all pairs of pixels agrees with the result from means and variances.
    #[test]
    fn counting_pairs_agrees() {
        let patch = |mean: f64, sigma: f64, frame: u32| {
            let normal = Normal::new(mean, sigma).expect("a width");
            let sample = |i: u32| {
                normal.sample(&mut NoiseStream::new(2, 0, frame, 0, Pixel { x: i, y: 0 }, NoiseDraw::Read)) as f32
            };
            Patch::from(Image::from_samples(20, 20, (0..400).map(sample).collect()).expect("a square"))
        };
        let (dark, light) = (patch(1000.0, 120.0, 0), patch(1500.0, 150.0, 1));
        let settings = ContrastSettings { black: 0.0, full_scale: None, tolerance: 0.5, shared_px: 1 };
        let pair = measure_contrast(&dark, &light, 0.5, &settings).expect("patches");
        let [dark_readings, light_readings] = [&dark, &light].map(|patch| patch.readings.samples());
        let contrasts = dark_readings.iter().flat_map(|x| light_readings.iter().map(move |y| f64::from(y / x) - 1.0));
        let counted = contrasts.filter(|k| (0.25..=0.75).contains(k)).count() as f64 / 160_000.0;
        // Some 400 independent pairs: 2 %.
        assert!((pair.detection.value - counted).abs() < 0.03, "{pair:?} {counted}");
        assert!((pair.transfer.value - 1.0).abs() < 3.0 * pair.transfer.standard_uncertainty);
        assert_eq!(measure_contrast(&light, &dark, 0.5, &settings), Err(ContrastError::Order));
        assert_eq!(measure_contrast(&dark, &dark, 0.5, &settings), Err(ContrastError::Order));
        let black = ContrastSettings { black: 2000.0, ..settings };
        assert!(matches!(measure_contrast(&dark, &light, 0.5, &black), Err(ContrastError::Dark)));
        assert!(matches!(measure_contrast(&dark, &light, -0.5, &settings), Err(ContrastError::Contrast(_))));
        let clipped = ContrastSettings { full_scale: Some(1600.0), ..settings };
        assert!(matches!(measure_contrast(&dark, &light, 0.5, &clipped), Err(ContrastError::Saturated { .. })));
    }

    /// Light that falls off across both patches, above a black of 64: division by the flat field restores the contrast exactly.
    #[test]
    fn a_flat_field_removes_fall_off() {
        let fall_off = |i: u32| 1.0 - 0.002 * i as f32;
        let image = |f: &dyn Fn(u32) -> f32| Image::from_samples(10, 10, (0..100).map(f).collect()).expect("a square");
        let patch = |light: f32, first: u32| Patch {
            readings: image(&|i| 64.0 + light * fall_off(first + i)),
            flat: Some(image(&|i| fall_off(first + i))),
        };
        let settings = ContrastSettings { black: 64.0, full_scale: Some(2000.0), tolerance: 0.5, shared_px: 1 };
        let (darker, brighter) = (patch(1000.0, 0), patch(1500.0, 200));
        let corrected = measure_contrast(&darker, &brighter, 0.5, &settings).expect("patches");
        assert!((corrected.measured.value - 0.5).abs() < 1e-6 && corrected.detection.value > 0.999, "{corrected:?}");
        // Mean light without the flat field: 1000 · 0.901 and 1500 · 0.501.
        let uncorrected = [darker, brighter].map(|patch| Patch::from(patch.readings));
        let uncorrected = measure_contrast(&uncorrected[0], &uncorrected[1], 0.5, &settings).expect("patches");
        assert!((uncorrected.measured.value - (751.5 / 901.0 - 1.0)).abs() < 1e-5, "{uncorrected:?}");
    }
}
