//! Accuracy of an estimated depth image against ground truth.
//!
//! With error e = d̂ − d over pixels whose true depth is finite and above 0, by range of d and over all:
//!
//! ```text
//! bias ⟨e⟩    MAE ⟨|e|⟩    RMSE √⟨e²⟩    ⟨|e|/d⟩    ⟨e²/d⟩    of logarithms √⟨l²⟩, l = ln d̂ − ln d
//! SILog √(⟨l²⟩ − ⟨l⟩²): independent of a common factor          (Eigen, Puhrsch & Fergus 2014)
//! δ_k: fraction with max(d̂/d, d/d̂) < 1.25^k                      (the same)
//! iRMSE √⟨(1/d̂ − 1/d)²⟩                                          (KITTI's depth completion: Uhrig et al. 2017)
//! outliers: |e| > d · ratio and |e| > least
//! D1: |D̂ − D| > 3 px and > 5 %; EPE ⟨|D̂ − D|⟩, D = B f/d          (KITTI 2015: Menze & Geiger; with a stereo rig's B f)
//! ```
//!
//! Pixels at edges of the true depth (a neighbour within `edge_px` differs by more than `edge_ratio` of the depth, or is
//! infinitely far) are reported separately: such a pixel contains two depths, and its depth is ambiguous. True depth that is NaN
//! or not above 0 is unknown, and makes no edge (sparse ground truth); infinite depth is sky. Estimates that are NaN, infinite or
//! not above 0 are missing: counted, but excluded from the errors. Networks that estimate depth up to a factor are scaled first,
//! by the median of d/d̂ over the pixels away from edges ([`Alignment::Median`]). Uncertainty: as errors of neighbours are
//! correlated, all means are taken over blocks of 16 × 16 pixels, which are treated as independent.

#[cfg(test)]
mod tests;

use etendue_core::maths::f64::ln;
use etendue_stats::{Moments, upper_median};

use crate::{Estimate, Image};

/// Compares an estimate with ground truth, both in m.
///
/// # Errors
/// If sizes differ, settings are not valid numbers, limits do not increase, the images are equal, or nothing can be compared.
pub fn measure_depth(estimate: &Image, truth: &Image, settings: &DepthSettings) -> Result<DepthReport, DepthError> {
    let size = |image: &Image| (image.width(), image.height());
    if size(estimate) != size(truth) {
        return Err(DepthError::Size { estimate: size(estimate), truth: size(truth) });
    }
    settings.check()?;
    let bits = |image: &Image| image.samples().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    if bits(estimate) == bits(truth) {
        return Err(DepthError::Same);
    }
    let edges = edges(truth, settings);
    let scale = match settings.alignment {
        Alignment::None => 1.0,
        Alignment::Median => median_ratio(estimate, truth, &edges).ok_or(DepthError::Nothing)?,
    };
    let sums = |includes: &dyn Fn(usize, f64) -> bool| {
        DepthSums::from_pixels(estimate, truth, scale, settings, includes).errors()
    };
    let all = sums(&|i, _| !edges[i]);
    if all.pixels == 0 {
        return Err(DepthError::Nothing);
    }
    let range = |pair: &[f64]| {
        let (low, high) = (pair[0], pair[1]);
        (low, high, sums(&|i, depth| !edges[i] && depth >= low && depth < high))
    };
    let ranges = settings.ranges_m.windows(2).map(range).collect();
    Ok(DepthReport { all, ranges, edges: sums(&|i, _| edges[i]), scale })
}

fn median_ratio(estimate: &Image, truth: &Image, edges: &[bool]) -> Option<f64> {
    let pairs = estimate.samples().iter().zip(truth.samples()).zip(edges);
    let pairs = pairs.map(|((a, b), edge)| (f64::from(*a), f64::from(*b), *edge));
    upper_median(pairs.filter(|(a, b, edge)| !edge && known(*a) && known(*b)).map(|(a, b, _)| b / a))
}

fn known(depth: f64) -> bool {
    depth.is_finite() && depth > 0.0
}

/// Marks pixels at an edge of the true depth; sky next to an object is an edge, too.
fn edges(truth: &Image, settings: &DepthSettings) -> Vec<bool> {
    let (width, height) = (truth.width(), truth.height());
    let at = |x: usize, y: usize| f64::from(truth.at(x, y));
    let sky = |depth: f64| depth == f64::INFINITY;
    let jump = |a: f64, b: f64| match (known(a), known(b)) {
        (true, true) => (a - b).abs() > settings.edge_ratio * a.min(b),
        (true, false) => sky(b),
        (false, true) => sky(a),
        _ => false,
    };
    let mut edges = vec![false; width * height];
    let mut mark = |x: usize, y: usize| {
        let reach = settings.edge_px;
        for row in y.saturating_sub(reach)..(y + reach + 1).min(height) {
            edges[row * width + x.saturating_sub(reach)..row * width + (x + reach + 1).min(width)].fill(true);
        }
    };
    for y in 0..height {
        for x in 0..width {
            let right = x + 1 < width && jump(at(x, y), at(x + 1, y));
            let below = y + 1 < height && jump(at(x, y), at(x, y + 1));
            if right || below {
                mark(x, y);
            }
            if right {
                mark(x + 1, y);
            }
            if below {
                mark(x, y + 1);
            }
        }
    }
    edges
}

/// Reason why depth cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DepthError {
    /// Images of different sizes.
    #[error("the estimate has {} × {} pixels, the ground truth {} × {}: both must have the same size", estimate.0, estimate.1, truth.0, truth.1)]
    Size {
        /// Width and height of the estimate.
        estimate: (usize, usize),
        /// Width and height of the ground truth.
        truth: (usize, usize),
    },
    /// No pixel has both.
    #[error(
        "no pixel away from edges has a finite depth above zero in both images: check that both store depth in metres"
    )]
    Nothing,
    /// Ranges that do not increase.
    #[error("the limits of the ranges must increase and be 0 or more; at least two are needed")]
    Ranges,
    /// An invalid setting.
    #[error("{name}: expected a finite number of {least} or more, not {value}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        value: f64,
        /// Allowed minimum.
        least: &'static str,
    },
    /// The same image twice.
    #[error("the estimate equals the ground truth in every pixel: give two different images")]
    Same,
}

/// Errors of a set of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthErrors {
    /// Pixels with true depth and estimate.
    pub pixels: usize,
    /// Pixels with true depth and no estimate.
    pub missing: usize,
    /// Mean error, m.
    pub bias_m: Estimate,
    /// Mean magnitude of the error, m.
    pub mean_m: Estimate,
    /// Root mean square error, m.
    pub rmse_m: Estimate,
    /// Mean magnitude of the relative error.
    pub relative: Estimate,
    /// Mean of e²/d, m.
    pub squared_relative_m: Estimate,
    /// Root mean square difference of natural logarithms.
    pub rmse_log: Estimate,
    /// Their standard deviation: SILog.
    pub scale_invariant: Estimate,
    /// Root mean square error of 1/d, 1/km.
    pub inverse_rmse_per_km: Estimate,
    /// Fraction of outliers.
    pub outliers: Estimate,
    /// Fractions of ratios within 1.25, 1.25², 1.25³.
    pub within: [Estimate; 3],
    /// Fraction of disparities with an error above 3 px and 5 %, and mean error of disparity, px, for a stereo rig.
    pub disparity: Option<[Estimate; 2]>,
}

/// Errors over all, by range, and at edges.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthReport {
    /// All pixels except those at edges.
    pub all: DepthErrors,
    /// The same by range: lower and upper limit, m.
    pub ranges: Vec<(f64, f64, DepthErrors)>,
    /// Pixels at edges.
    pub edges: DepthErrors,
    /// Factor applied to the estimate.
    pub scale: f64,
}

/// Settings of a depth comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthSettings {
    /// Limits of the ranges, m, increasing.
    pub ranges_m: Vec<f64>,
    /// Minimum error of an outlier as a fraction of the depth …
    pub outlier_ratio: f64,
    /// … and its minimum error, m.
    pub min_outlier_m: f64,
    /// Minimum depth jump at an edge, as a fraction of the depth.
    pub edge_ratio: f64,
    /// Distance from a jump within which pixels are edge pixels.
    pub edge_px: usize,
    /// Focal length times baseline of a stereo rig, px m, for errors of disparity.
    pub focal_baseline_px_m: Option<f64>,
    /// Alignment of the estimate before the comparison.
    pub alignment: Alignment,
}

/// Alignment of an estimate before the comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Alignment {
    /// None: it is in metres.
    #[default]
    None,
    /// Multiplication by the median of true depth over estimate.
    Median,
}

impl Default for DepthSettings {
    fn default() -> Self {
        Self {
            ranges_m: vec![0.0, 5.0, 10.0, 20.0, 40.0, 80.0, f64::INFINITY],
            outlier_ratio: 0.05,
            min_outlier_m: 0.0,
            edge_ratio: 0.1,
            edge_px: 2,
            focal_baseline_px_m: None,
            alignment: Alignment::None,
        }
    }
}

impl DepthSettings {
    fn check(&self) -> Result<(), DepthError> {
        let limits = &self.ranges_m;
        let rising = limits.len() >= 2 && limits[0] >= 0.0 && limits.windows(2).all(|pair| pair[0] < pair[1]);
        if !rising {
            return Err(DepthError::Ranges);
        }
        let fractions = [
            ("outlier ratio", self.outlier_ratio),
            ("minimum error of an outlier", self.min_outlier_m),
            ("edge ratio", self.edge_ratio),
        ];
        let wrong = fractions.into_iter().find(|(_, value)| !(value.is_finite() && *value >= 0.0));
        let wrong = wrong.map(|(name, value)| DepthError::Setting { name, value, least: "0" });
        let rig = self.focal_baseline_px_m.filter(|value| !(value.is_finite() && *value > 0.0));
        let rig =
            rig.map(|value| DepthError::Setting { name: "focal length times baseline", value, least: "more than 0" });
        wrong.or(rig).map_or(Ok(()), Err)
    }
}

/// Side of the blocks whose scatter gives the uncertainties, px.
const BLOCK_PX: usize = 16;

/// Number of averaged values per pixel, in the order of [`values`].
const COUNT: usize = 14;

/// An outlier of disparity, px and fraction (KITTI 2015).
const DISPARITY_PX: f64 = 3.0;
const DISPARITY_FRACTION: f64 = 0.05;

/// Sums over pixels, by block.
struct DepthSums {
    missing: usize,
    has_disparity: bool,
    /// Pixels, and the sum of each number.
    blocks: Vec<(f64, [f64; COUNT])>,
}

fn values(guess: f64, depth: f64, settings: &DepthSettings) -> [f64; COUNT] {
    let error = guess - depth;
    let log = ln(guess) - ln(depth);
    let inverse = 1.0 / guess - 1.0 / depth;
    let outlier = error.abs() > settings.outlier_ratio * depth && error.abs() > settings.min_outlier_m;
    let ratio = (guess / depth).max(depth / guess);
    let within = |limit: f64| f64::from(u8::from(ratio < limit));
    let rig = settings.focal_baseline_px_m.unwrap_or(0.0);
    let disparity = rig * inverse.abs();
    let far = disparity > DISPARITY_PX && disparity > DISPARITY_FRACTION * rig / depth;
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

impl DepthSums {
    fn from_pixels(
        estimate: &Image,
        truth: &Image,
        scale: f64,
        settings: &DepthSettings,
        includes: &dyn Fn(usize, f64) -> bool,
    ) -> Self {
        let (width, height) = (truth.width(), truth.height());
        let columns = width.div_ceil(BLOCK_PX);
        let mut blocks = vec![(0.0, [0.0; COUNT]); columns * height.div_ceil(BLOCK_PX)];
        let mut missing = 0;
        for (i, (guess, depth)) in estimate.samples().iter().zip(truth.samples()).enumerate() {
            let (guess, depth) = (scale * f64::from(*guess), f64::from(*depth));
            if !(known(depth) && includes(i, depth)) {
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
        Self { missing, has_disparity: settings.focal_baseline_px_m.is_some(), blocks }
    }

    fn count(&self) -> f64 {
        self.blocks.iter().map(|b| b.0).sum()
    }

    /// The mean of a value that is a linear combination of those of a pixel, by weights of the sums.
    fn mean(&self, weights: &[(usize, f64)]) -> Estimate {
        let count = self.count();
        let block_mean = |block: &(f64, [f64; COUNT])| weights.iter().map(|(i, w)| w * block.1[*i]).sum::<f64>();
        let mean = self.blocks.iter().map(block_mean).sum::<f64>() / count;
        // Contribution of a block to the mean: its fraction of the pixels times its deviation from the overall mean.
        let influences = self.blocks.iter().filter(|b| b.0 > 0.0).map(|b| (block_mean(b) - mean * b.0) / count);
        let moments = Moments::from_values(influences);
        let scatter = (moments.variance().unwrap_or(f64::INFINITY) * moments.count() as f64).sqrt();
        Estimate::new(mean, scatter)
    }

    fn errors(&self) -> DepthErrors {
        let value_mean = |i: usize| self.mean(&[(i, 1.0)]);
        let root = |square: Estimate| {
            let root = square.value.max(0.0).sqrt();
            Estimate::new(root, square.standard_uncertainty / (2.0 * root).max(f64::MIN_POSITIVE))
        };
        // ⟨l²⟩ − ⟨l⟩², to first order in both means.
        let (log, log_square) = (value_mean(5), value_mean(6));
        let variance = Estimate::new(
            log_square.value - log.value * log.value,
            self.mean(&[(6, 1.0), (5, -2.0 * log.value)]).standard_uncertainty,
        );
        DepthErrors {
            pixels: self.count() as usize,
            missing: self.missing,
            bias_m: value_mean(0),
            rmse_m: root(value_mean(1)),
            mean_m: value_mean(2),
            relative: value_mean(3),
            squared_relative_m: value_mean(4),
            rmse_log: root(log_square),
            scale_invariant: root(variance),
            inverse_rmse_per_km: root(value_mean(7)).scaled(1e3),
            outliers: value_mean(8),
            within: [9, 10, 11].map(value_mean),
            disparity: self.has_disparity.then(|| [12, 13].map(value_mean)),
        }
    }
}
