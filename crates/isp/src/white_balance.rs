//! White balance: gains that make a grey surface grey.
//!
//! Gains are normalised so that the smallest is 1. A saturated pixel is then at least 1 in every channel and becomes white when clipped at 1
//! **before** demosaic and colour matrix: without the clip, highlights turn magenta.
//!
//! | rule | gains |
//! | --- | --- |
//! | [`WhiteBalance::Gains`] | as given, or [from an illuminant](white_balance_from_illuminant) |
//! | [`WhiteBalance::GreyWorld`] | those that make the image's mean grey |
//!
//! Grey world (Buchsbaum 1980): the mean of a scene is assumed to be grey.
//!
//! Means are taken over unsaturated pixels, because a saturated one has lost its colour. An image in which a channel has no mean above black (a dark
//! frame) has gains of 1. For an infrared channel the rule is a convention only.

use etendue_spectra::Spectrum;
use rayon::prelude::*;

use crate::raw::{MAX_CHANNELS, Mosaic};

/// White-balance rule.
#[derive(Clone, Debug, PartialEq)]
pub enum WhiteBalance {
    /// Gains of the channels, each at least 1.
    Gains(Vec<f64>),
    /// The mean of each image becomes grey.
    GreyWorld,
}

/// The gains that equalise channels of these strengths; the smallest is 1. `None` if a channel has none.
fn equalising_gains(strengths: &[f64]) -> Option<Vec<f64>> {
    let largest = strengths.iter().copied().fold(0.0, f64::max);
    strengths.iter().all(|s| *s > 0.0).then(|| strengths.iter().map(|s| largest / s).collect())
}

/// The gains, one per channel, for samples with black at 0 and saturation at 1.
pub(crate) fn grey_world(samples: &[f32], width: usize, mosaic: &Mosaic) -> Vec<f64> {
    let rows: Vec<ChannelSums> =
        samples.par_chunks(width.max(1)).enumerate().map(|(y, row)| ChannelSums::from_row(row, y, mosaic)).collect();
    // Rows are added in order, so the result does not depend on threads.
    let total = rows.iter().fold(ChannelSums::default(), |sum, row| sum.plus(row));
    let means: Vec<f64> = (0..mosaic.channels()).map(|c| total.values[c] / total.counts[c].max(1) as f64).collect();
    equalising_gains(&means).unwrap_or_else(|| vec![1.0; mosaic.channels()])
}

/// Sums and counts of the samples of each channel.
#[derive(Clone, Copy, Default)]
struct ChannelSums {
    values: [f64; MAX_CHANNELS],
    counts: [u64; MAX_CHANNELS],
}

impl ChannelSums {
    fn from_row(row: &[f32], y: usize, mosaic: &Mosaic) -> Self {
        let mut sums = Self::default();
        for (x, v) in row.iter().enumerate().filter(|(_, v)| **v < 1.0) {
            let channel = mosaic.channel_at(x, y);
            sums.values[channel] += f64::from(*v);
            sums.counts[channel] += 1;
        }
        sums
    }

    fn plus(self, other: &Self) -> Self {
        Self {
            values: core::array::from_fn(|c| self.values[c] + other.values[c]),
            counts: core::array::from_fn(|c| self.counts[c] + other.counts[c]),
        }
    }
}

/// A channel without response to the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "channel {0} (0 red, 1 green, 2 blue) does not respond to the illuminant, so no gain makes it grey: choose an illuminant to which every \
     channel responds"
)]
pub struct NoResponse(pub usize);

/// Gains of the channels for which a spectrally flat reflector under `illuminant` (any scale) is neutral; the smallest is 1.
///
/// # Errors
/// If a channel does not respond to the illuminant.
pub fn white_balance_from_illuminant(
    responsivities: &[&Spectrum],
    illuminant: &Spectrum,
) -> Result<Vec<f64>, NoResponse> {
    let white: Vec<f64> = responsivities.iter().map(|r| response(r, illuminant, None)).collect();
    equalising_gains(&white).ok_or_else(|| NoResponse(white.iter().position(|w| *w <= 0.0).unwrap_or(0)))
}

/// ∫ responsivity × illuminant × reflectance dλ, by the trapezoidal rule with 1 nm steps (the ends, at 300 and 1 100 nm, count in full); for white if
/// no reflectance is given.
pub(crate) fn response(responsivity: &Spectrum, illuminant: &Spectrum, reflectance: Option<&Spectrum>) -> f64 {
    let light = responsivity.nodes().iter().zip(illuminant.nodes()).map(|(r, i)| f64::from(*r) * f64::from(*i));
    match reflectance {
        None => light.sum(),
        Some(reflectance) => light.zip(reflectance.nodes()).map(|(l, r)| l * f64::from(*r)).sum(),
    }
}

#[cfg(test)]
mod tests {
    use etendue_spectra::{camera, illuminant};

    use super::*;
    use crate::raw::Filter::{Blue, Green, Red};

    fn bayer() -> Mosaic {
        Mosaic::tile(2, 2, vec![Red, Green, Green, Blue]).expect("Bayer")
    }

    fn test_image(rgb: [f32; 3]) -> Vec<f32> {
        (0..64).map(|i| rgb[bayer().channel_at(i % 8, i / 8)]).collect()
    }

    #[test]
    fn the_mean_comes_out_grey() {
        assert_eq!(grey_world(&test_image([0.25, 0.5, 0.125]), 8, &bayer()), [2.0, 1.0, 4.0]);
    }

    #[test]
    fn saturated_pixels_do_not_count_and_darkness_tells_nothing() {
        let mut samples = test_image([0.25, 0.5, 0.125]);
        samples[0] = 1.0;
        samples[9] = 1.0;
        assert_eq!(grey_world(&samples, 8, &bayer()), [2.0, 1.0, 4.0]);
        assert_eq!(grey_world(&test_image([0.25, 0.5, -0.1]), 8, &bayer()), [1.0; 3]);
        assert_eq!(grey_world(&test_image([1.0; 3]), 8, &bayer()), [1.0; 3]);
    }

    #[test]
    fn a_grey_is_neutral_and_the_smallest_gain_is_one() {
        let canon = camera::by_name("canon-eos-5d-mark-ii").expect("a camera");
        let channels = [&canon.r, &canon.g, &canon.b];
        let light = illuminant::by_name("A").unwrap_or(illuminant::d65());
        let gains = white_balance_from_illuminant(&channels, light).expect("light in all channels");
        let grey = Spectrum::constant(0.18);
        let balanced: [f64; 3] = core::array::from_fn(|c| gains[c] * response(channels[c], light, Some(&grey)));
        assert!((balanced[0] / balanced[1] - 1.0).abs() < 1e-12 && (balanced[2] / balanced[1] - 1.0).abs() < 1e-12);
        assert_eq!(gains.into_iter().fold(f64::INFINITY, f64::min), 1.0);
    }

    #[test]
    fn a_blind_channel_is_refused() {
        let (flat, blind) = (Spectrum::constant(1.0), Spectrum::constant(0.0));
        let refused = white_balance_from_illuminant(&[&flat, &flat, &blind], illuminant::d65());
        assert_eq!(refused, Err(NoResponse(2)));
    }
}
