//! Noise of an image of a uniform surface.
//!
//! ISO 15739:2023, temporal and fixed-pattern noise from n frames (at least eight) of one patch, y_l frame l, ȳ their average:
//!
//! ```text
//! σ_temp² = n/(n − 1) ⟨(y_l − ȳ)²⟩            over pixels and frames
//! σ_fp²   = Var(ȳ) − σ_temp²/n                over pixels
//! σ_total² = σ_temp² + σ_fp²
//! SNR = (mean − black)/σ
//! ```
//!
//! For SNR at the scene instead of in the image, divide the mean by the relative incremental gain from the OECF; for linear
//! readings both are equal. Uncertainties: of σ_temp from the scatter over pixels, of σ_fp² that of χ² with the numbers of rows,
//! columns and pixels ([`Pattern`]). Limitations: no visual weighting of the standard's annex, no removal of low-frequency
//! shading (use a uniform patch).

use crate::photon_transfer::{Pattern, Stack, TransferError};
use crate::{Estimate, Image, estimate::root, patch_statistics::saturated_percent};

/// Minimum number of frames of the standard.
pub const MIN_FRAMES: usize = 8;
/// Maximum deviation of a frame's mean from the others', relative to the signal: lamps flicker by a few percent.
const MAX_MEAN_DEVIATION: f64 = 0.1;

/// Noise of a patch, in readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Mean reading less black.
    pub signal: Estimate,
    /// Temporal noise.
    pub temporal: Estimate,
    /// Fixed-pattern noise.
    pub fixed: Estimate,
    /// Total noise.
    pub total: Estimate,
}

impl Noise {
    /// Signal over total, temporal and fixed-pattern noise.
    #[must_use]
    pub fn snr(&self) -> [Estimate; 3] {
        [self.total, self.temporal, self.fixed].map(|noise| {
            let ratio = self.signal.value / noise.value;
            let relative = noise.standard_uncertainty / noise.value;
            let own = self.signal.standard_uncertainty / self.signal.value;
            Estimate::new(ratio, ratio.abs() * (relative * relative + own * own).sqrt())
        })
    }
}

/// Reason why noise cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoiseError {
    /// Error of the frames themselves.
    #[error(transparent)]
    Frames(#[from] TransferError),
    /// Fewer than eight frames.
    #[error("noise needs at least {MIN_FRAMES} frames of the same patch (ISO 15739), not {0}")]
    TooFew(usize),
    /// No light.
    #[error(
        "the mean reading {mean:.4} is not above black, {black}: a signal-to-noise ratio needs light; check `black`"
    )]
    Dark {
        /// Mean reading.
        mean: f64,
        /// Reading without light.
        black: f64,
    },
    /// A frame of another subject.
    #[error(
        "frame {frame} of {frames} reads {mean:.4} on average, most read {usual:.4}: give frames of one patch in constant light"
    )]
    Unlike {
        /// Number of the frame, from 1.
        frame: usize,
        /// Number of frames.
        frames: usize,
        /// Its mean reading.
        mean: f64,
        /// The median of all means.
        usual: f64,
    },
    /// A frame is clipped.
    #[error("{percent:.1} % of the pixels are saturated, which clips their noise: expose less")]
    Saturated {
        /// Percentage of saturated pixels.
        percent: f64,
    },
}

/// Checks that the pixels of a frame are not saturated, so that its noise is intact.
///
/// # Errors
/// If they are.
pub fn check_frame(frame: &Image, full_scale: Option<f64>) -> Result<(), NoiseError> {
    saturated_percent([frame], full_scale).map_or(Ok(()), |percent| Err(NoiseError::Saturated { percent }))
}

/// Checks that the frames' means are within [`MAX_MEAN_DEVIATION`] of their median, less black.
fn one_light(means: &[f64], black: f64) -> Result<(), NoiseError> {
    let mut sorted = means.to_vec();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    let off = means.iter().position(|mean| (mean - median).abs() > MAX_MEAN_DEVIATION * (median - black).abs());
    off.map_or(Ok(()), |i| Err(NoiseError::Unlike { frame: i + 1, frames: means.len(), mean: means[i], usual: median }))
}

/// Measures the noise of a stack of frames of a patch.
///
/// # Errors
/// If there are too few frames or pixels.
pub fn measure_noise(stack: &Stack, black: f64) -> Result<Noise, NoiseError> {
    if stack.frames() < MIN_FRAMES {
        return Err(NoiseError::TooFew(stack.frames()));
    }
    one_light(stack.frame_means(), black)?;
    let (statistics, pattern) = (stack.statistics()?, Pattern::from_stack(stack)?);
    let (temporal, fixed) = (statistics.variance_dn2, pattern.variances_dn2().total);
    let variance = temporal.value + fixed.value.max(0.0);
    let u = (temporal.standard_uncertainty * temporal.standard_uncertainty
        + fixed.standard_uncertainty * fixed.standard_uncertainty)
        .sqrt();
    let mean = statistics.mean_dn;
    if mean.value <= black {
        return Err(NoiseError::Dark { mean: mean.value, black });
    }
    Ok(Noise {
        signal: Estimate::new(mean.value - black, mean.standard_uncertainty),
        temporal: root(temporal),
        fixed: root(fixed),
        total: root(Estimate::new(variance, u)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
    use rand_distr::{Distribution, Normal};

    fn stack(frames: u32) -> Stack {
        let normal = Normal::new(0.0, 1.0).expect("a width");
        let mut stack = Stack::new(64, 64);
        for frame in 0..frames {
            let noise_at = |i: usize, frame, purpose| {
                let pixel = Pixel { x: (i % 64) as u32, y: (i / 64) as u32 };
                normal.sample(&mut NoiseStream::new(5, 0, frame, 0, pixel, purpose))
            };
            let sample = |i: usize| {
                (200.0 + 4.0 * noise_at(i, frame, NoiseDraw::Read) + 3.0 * noise_at(i, 0, NoiseDraw::PixelOffset))
                    as f32
            };
            let image = Image::from_samples(64, 64, (0..64 * 64).map(sample).collect()).expect("a square");
            stack.push(&image).expect("a frame");
        }
        stack
    }

    #[test]
    fn a_frame_of_another_light_is_refused() {
        let mut frames = stack(9);
        assert!(measure_noise(&frames, 0.0).is_ok());
        let mean = frames.frame_means()[0];
        let other: Vec<f32> = (0..64 * 64).map(|i| (0.8 * mean) as f32 + (i % 7) as f32).collect();
        frames.push(&Image::from_samples(64, 64, other).expect("filled")).expect("a frame");
        assert!(matches!(measure_noise(&frames, 0.0), Err(NoiseError::Unlike { frame: 10, frames: 10, .. })));
    }

    #[test]
    fn noise_components_are_separated() {
        let noise = measure_noise(&stack(8), 40.0).expect("eight frames");
        for (measured, truth) in [(noise.temporal, 4.0), (noise.fixed, 3.0), (noise.total, 5.0)] {
            assert!((measured.value - truth).abs() < 3.0 * measured.standard_uncertainty, "{measured:?} {truth}");
            assert!(measured.standard_uncertainty < 0.02 * truth, "{measured:?}");
        }
        let [total, ..] = noise.snr();
        assert!((total.value - 32.0).abs() < 3.0 * total.standard_uncertainty);
        assert_eq!(measure_noise(&stack(7), 40.0), Err(NoiseError::TooFew(7)));
        assert!(matches!(measure_noise(&stack(8), 5000.0), Err(NoiseError::Dark { .. })));
        let frame = Image::from_samples(4, 1, vec![10.0, 20.0, 30.0, 30.0]).expect("a row");
        assert_eq!(check_frame(&frame, Some(30.0)), Err(NoiseError::Saturated { percent: 50.0 }));
        assert_eq!(check_frame(&frame, Some(31.0)), Ok(()));
    }
}
