//! Grey world (Buchsbaum 1980): the mean of a scene is taken to be grey.
//!
//! Means are taken over the pixels that are not saturated, since a saturated one does not know its colour. A picture in
//! which a channel has no mean above black (a dark frame) tells nothing: its gains are 1. Of an infrared channel the rule
//! is a convention only.

use super::balancing;
use crate::mosaic::{MAX_CHANNELS, Mosaic};
use rayon::prelude::*;

/// The gains, one a channel, for samples with black at 0 and saturation at 1.
pub(crate) fn grey_world(samples: &[f32], width: usize, mosaic: &Mosaic) -> Vec<f64> {
    let rows: Vec<Sums> =
        samples.par_chunks(width.max(1)).enumerate().map(|(y, row)| Sums::of_row(row, y, mosaic)).collect();
    // Rows are added one after the other, so that threads do not show.
    let total = rows.iter().fold(Sums::default(), |sum, row| sum.plus(row));
    let means: Vec<f64> = (0..mosaic.channels()).map(|c| total.values[c] / total.counts[c].max(1) as f64).collect();
    balancing(&means).unwrap_or_else(|| vec![1.0; mosaic.channels()])
}

/// Sums and counts of the samples of each channel.
#[derive(Clone, Copy, Default)]
struct Sums {
    values: [f64; MAX_CHANNELS],
    counts: [u64; MAX_CHANNELS],
}

impl Sums {
    fn of_row(row: &[f32], y: usize, mosaic: &Mosaic) -> Self {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mosaic::Filter::{Blue, Green, Red};

    fn bayer() -> Mosaic {
        Mosaic::tile(2, 2, vec![Red, Green, Green, Blue]).expect("Bayer")
    }

    fn picture(rgb: [f32; 3]) -> Vec<f32> {
        (0..64).map(|i| rgb[bayer().channel_at(i % 8, i / 8)]).collect()
    }

    #[test]
    fn the_mean_comes_out_grey() {
        assert_eq!(grey_world(&picture([0.25, 0.5, 0.125]), 8, &bayer()), [2.0, 1.0, 4.0]);
    }

    #[test]
    fn saturated_pixels_do_not_count_and_darkness_tells_nothing() {
        let mut samples = picture([0.25, 0.5, 0.125]);
        samples[0] = 1.0;
        samples[9] = 1.0;
        assert_eq!(grey_world(&samples, 8, &bayer()), [2.0, 1.0, 4.0]);
        assert_eq!(grey_world(&picture([0.25, 0.5, -0.1]), 8, &bayer()), [1.0; 3]);
        assert_eq!(grey_world(&picture([1.0; 3]), 8, &bayer()), [1.0; 3]);
    }
}
