//! Means over pixels with the scatter of their blocks.

use super::{DepthErrors, DepthSettings, known};
use crate::{Estimate, Image};
use etendue_core::maths::f64::ln;
use etendue_stats::Moments;

/// Side of the blocks whose scatter gives uncertainties, px.
const BLOCK_PX: usize = 16;

/// Numbers of a pixel whose means are taken, in the order of [`values`].
const COUNT: usize = 14;

/// An outlier of disparity, px and share (KITTI 2015).
const DISPARITY_PX: f64 = 3.0;
const DISPARITY_SHARE: f64 = 0.05;

/// Sums over pixels, by block.
pub(super) struct Sums {
    missing: usize,
    has_disparity: bool,
    /// Pixels, and the sum of each number.
    blocks: Vec<(f64, [f64; COUNT])>,
}

fn values(guess: f64, depth: f64, settings: &DepthSettings) -> [f64; COUNT] {
    let error = guess - depth;
    let log = ln(guess) - ln(depth);
    let inverse = 1.0 / guess - 1.0 / depth;
    let outlier = error.abs() > settings.outlier_ratio * depth && error.abs() > settings.outlier_least_m;
    let ratio = (guess / depth).max(depth / guess);
    let within = |limit: f64| f64::from(u8::from(ratio < limit));
    let rig = settings.focal_base_px_m.unwrap_or(0.0);
    let disparity = rig * inverse.abs();
    let far = disparity > DISPARITY_PX && disparity > DISPARITY_SHARE * rig / depth;
    [
        error,
        error * error,
        error.abs(),
        error.abs() / depth,
        error * error / depth,
        log,
        log * log,
        inverse * inverse,
        f64::from(u8::from(outlier)),
        within(1.25),
        within(1.25 * 1.25),
        within(1.25 * 1.25 * 1.25),
        f64::from(u8::from(far)),
        disparity,
    ]
}

impl Sums {
    pub(super) fn of(
        estimate: &Image,
        truth: &Image,
        scale: f64,
        settings: &DepthSettings,
        wanted: &dyn Fn(usize, f64) -> bool,
    ) -> Self {
        let (width, height) = (truth.width(), truth.height());
        let columns = width.div_ceil(BLOCK_PX);
        let mut blocks = vec![(0.0, [0.0; COUNT]); columns * height.div_ceil(BLOCK_PX)];
        let mut missing = 0;
        for (i, (guess, depth)) in estimate.samples().iter().zip(truth.samples()).enumerate() {
            let (guess, depth) = (scale * f64::from(*guess), f64::from(*depth));
            if !(known(depth) && wanted(i, depth)) {
                continue;
            }
            if !known(guess) {
                missing += 1;
                continue;
            }
            let block = &mut blocks[(i / width / BLOCK_PX) * columns + i % width / BLOCK_PX];
            block.0 += 1.0;
            block.1.iter_mut().zip(values(guess, depth, settings)).for_each(|(sum, v)| *sum += v);
        }
        Self { missing, has_disparity: settings.focal_base_px_m.is_some(), blocks }
    }

    fn count(&self) -> f64 {
        self.blocks.iter().map(|b| b.0).sum()
    }

    /// The mean of a number that follows from those of a pixel, in a straight line: weights of the sums.
    fn mean(&self, weights: &[(usize, f64)]) -> Estimate {
        let count = self.count();
        let of = |block: &(f64, [f64; COUNT])| weights.iter().map(|(i, w)| w * block.1[*i]).sum::<f64>();
        let mean = self.blocks.iter().map(of).sum::<f64>() / count;
        // A block's pull on the mean: its share of the pixels times its distance from the whole.
        let pulls = self.blocks.iter().filter(|b| b.0 > 0.0).map(|b| (of(b) - mean * b.0) / count);
        let moments = Moments::of(pulls);
        let scatter = (moments.variance().unwrap_or(f64::INFINITY) * moments.count() as f64).sqrt();
        Estimate::new(mean, scatter)
    }

    pub(super) fn errors(&self) -> DepthErrors {
        let of = |i: usize| self.mean(&[(i, 1.0)]);
        let root = |square: Estimate| {
            let root = square.value.max(0.0).sqrt();
            Estimate::new(root, square.standard_uncertainty / (2.0 * root).max(f64::MIN_POSITIVE))
        };
        // ⟨l²⟩ − ⟨l⟩², to first order in both means.
        let (log, log_square) = (of(5), of(6));
        let variance = Estimate::new(
            log_square.value - log.value * log.value,
            self.mean(&[(6, 1.0), (5, -2.0 * log.value)]).standard_uncertainty,
        );
        DepthErrors {
            pixels: self.count() as usize,
            missing: self.missing,
            bias_m: of(0),
            rmse_m: root(of(1)),
            mean_m: of(2),
            relative: of(3),
            squared_relative_m: of(4),
            rmse_log: root(log_square),
            scale_invariant: root(variance),
            inverse_rmse_per_km: root(of(7)).scaled(1e3),
            outliers: of(8),
            within: [9, 10, 11].map(of),
            disparity: self.has_disparity.then(|| [12, 13].map(of)),
        }
    }
}
