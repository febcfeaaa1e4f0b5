//! How good an estimated depth picture is against the truth.
//!
//! With error e = d̂ − d over pixels whose truth is finite and above 0, by range of d and over all:
//!
//! ```text
//! bias ⟨e⟩    RMSE √⟨e²⟩    ⟨|e|/d⟩    outliers: |e| > d · share and |e| > least   (KITTI 2015: 5 % and 3 px; here in m)
//! δ_k: share of max(d̂/d, d/d̂) < 1.25^k                       (Eigen, Puhrsch & Fergus 2014)
//! ```
//!
//! Pixels at edges of the truth (where a neighbour within `edge_px` differs by more than `edge_share` of the depth) are told apart: a
//! pixel sees two depths there, and neither estimate nor truth has one. Estimates that are NaN or not above 0 are missing: counted, and in no
//! error; infinite ones too. Uncertainty: errors of neighbours belong together, so that of bias and RMSE is taken from blocks of 16 × 16
//! pixels as if these were independent.

use crate::{Estimate, Image};
use etendue_stats::Moments;

/// Side of the blocks whose scatter gives uncertainties, px.
const BLOCK_PX: usize = 16;

/// How depth is judged.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthSettings {
    /// Limits of the ranges, m, rising.
    pub ranges_m: Vec<f64>,
    /// An outlier is off by more than this share of the depth …
    pub outlier_share: f64,
    /// … and by more than this, m.
    pub outlier_least_m: f64,
    /// A jump of more than this share of the depth is an edge.
    pub edge_share: f64,
    /// Pixels this near to a jump are edge pixels.
    pub edge_px: usize,
}

impl Default for DepthSettings {
    fn default() -> Self {
        Self {
            ranges_m: vec![0.0, 5.0, 10.0, 20.0, 40.0, 80.0, f64::INFINITY],
            outlier_share: 0.05,
            outlier_least_m: 0.0,
            edge_share: 0.1,
            edge_px: 2,
        }
    }
}

/// Errors of a set of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthErrors {
    /// Pixels with truth and estimate.
    pub pixels: usize,
    /// Pixels with truth and no estimate.
    pub missing: usize,
    /// Mean error, m.
    pub bias_m: Estimate,
    /// Root mean square error, m.
    pub rmse_m: Estimate,
    /// Mean magnitude of the relative error.
    pub relative: f64,
    /// Share of outliers.
    pub outliers: f64,
    /// Shares of ratios within 1.25, 1.25², 1.25³.
    pub within: [f64; 3],
}

/// Errors over all, by range, and at edges.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthReport {
    /// All pixels but those at edges.
    pub all: DepthErrors,
    /// The same by range: lower and upper limit, m.
    pub ranges: Vec<(f64, f64, DepthErrors)>,
    /// Pixels at edges.
    pub edges: DepthErrors,
}

/// Why depth cannot be judged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DepthError {
    /// Pictures of different sizes.
    #[error("the estimate is {} × {} pixels, the truth {} × {}: both must have one size", estimate.0, estimate.1, truth.0, truth.1)]
    Size {
        /// Width and height of the estimate.
        estimate: (usize, usize),
        /// Width and height of the truth.
        truth: (usize, usize),
    },
    /// No pixel has both.
    #[error("no pixel away from edges has a finite depth above zero in both pictures: are these depths in metres?")]
    Nothing,
    /// Ranges that do not rise.
    #[error("the limits of the ranges must rise from 0 or more, two or more of them")]
    Ranges,
}

/// Judges an estimate against the truth, both in m.
///
/// # Errors
/// Where sizes differ, limits do not rise, or nothing can be compared.
pub fn measure_depth(estimate: &Image, truth: &Image, settings: &DepthSettings) -> Result<DepthReport, DepthError> {
    let size = |image: &Image| (image.width(), image.height());
    if size(estimate) != size(truth) {
        return Err(DepthError::Size { estimate: size(estimate), truth: size(truth) });
    }
    let limits = &settings.ranges_m;
    let rising = limits.len() >= 2 && limits[0] >= 0.0 && limits.windows(2).all(|pair| pair[0] < pair[1]);
    if !rising {
        return Err(DepthError::Ranges);
    }
    let edges = edges(truth, settings);
    let sums = |wanted: &dyn Fn(usize, f64) -> bool| Sums::of(estimate, truth, settings, wanted).errors();
    let all = sums(&|i, _| !edges[i]);
    if all.pixels == 0 {
        return Err(DepthError::Nothing);
    }
    let range = |pair: &[f64]| {
        let (low, high) = (pair[0], pair[1]);
        (low, high, sums(&|i, depth| !edges[i] && depth >= low && depth < high))
    };
    Ok(DepthReport { all, ranges: limits.windows(2).map(range).collect(), edges: sums(&|i, _| edges[i]) })
}

fn known(depth: f64) -> bool {
    depth.is_finite() && depth > 0.0
}

/// Whether each pixel lies at an edge of the truth; sky beside something is an edge, too.
fn edges(truth: &Image, settings: &DepthSettings) -> Vec<bool> {
    let (width, height) = (truth.width(), truth.height());
    let at = |x: usize, y: usize| f64::from(truth.at(x, y));
    let jump = |a: f64, b: f64| {
        if known(a) && known(b) { (a - b).abs() > settings.edge_share * a.min(b) } else { known(a) != known(b) }
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

/// Sums over pixels, and by block.
struct Sums {
    missing: usize,
    outliers: usize,
    within: [usize; 3],
    relative: f64,
    /// (pixels, Σ e, Σ e²) of each block.
    blocks: Vec<[f64; 3]>,
}

impl Sums {
    fn of(estimate: &Image, truth: &Image, settings: &DepthSettings, wanted: &dyn Fn(usize, f64) -> bool) -> Self {
        let (width, height) = (truth.width(), truth.height());
        let columns = width.div_ceil(BLOCK_PX);
        let blocks = vec![[0.0; 3]; columns * height.div_ceil(BLOCK_PX)];
        let mut sums = Self { missing: 0, outliers: 0, within: [0; 3], relative: 0.0, blocks };
        for (i, (guess, depth)) in estimate.samples().iter().zip(truth.samples()).enumerate() {
            let (guess, depth) = (f64::from(*guess), f64::from(*depth));
            if known(depth) && wanted(i, depth) {
                sums.add(guess, depth, (i / width / BLOCK_PX) * columns + i % width / BLOCK_PX, settings);
            }
        }
        sums
    }

    fn add(&mut self, guess: f64, depth: f64, block: usize, settings: &DepthSettings) {
        if !known(guess) {
            self.missing += 1;
            return;
        }
        let error = guess - depth;
        let outlier = error.abs() > settings.outlier_share * depth && error.abs() > settings.outlier_least_m;
        self.outliers += usize::from(outlier);
        let ratio = (guess / depth).max(depth / guess);
        let limits = [1.25, 1.25 * 1.25, 1.25 * 1.25 * 1.25];
        self.within.iter_mut().zip(limits).for_each(|(count, limit)| *count += usize::from(ratio < limit));
        self.relative += error.abs() / depth;
        let block = &mut self.blocks[block];
        *block = [block[0] + 1.0, block[1] + error, block[2] + error * error];
    }

    fn errors(&self) -> DepthErrors {
        let [count, sum, squares] = self.blocks.iter().fold([0.0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
        let share = |n: usize| n as f64 / count;
        let bias = sum / count;
        let rmse = (squares / count).sqrt();
        // A block's pull on the mean: its share of the pixels times its distance from the whole.
        let scatter = |value: usize, mean: f64| {
            let pulls = self.blocks.iter().filter(|b| b[0] > 0.0).map(|b| (b[value] - mean * b[0]) / count);
            let moments = Moments::of(pulls);
            (moments.variance().unwrap_or(f64::INFINITY) * moments.count() as f64).sqrt()
        };
        DepthErrors {
            pixels: count as usize,
            missing: self.missing,
            bias_m: Estimate::new(bias, scatter(1, bias)),
            rmse_m: Estimate::new(rmse, scatter(2, squares / count) / (2.0 * rmse).max(f64::MIN_POSITIVE)),
            relative: self.relative / count,
            outliers: share(self.outliers),
            within: self.within.map(share),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall at 4 m on the left half, 30 m on the right, sky above.
    fn truth() -> Image {
        let depth = |x: usize, y: usize| match (x, y) {
            (_, 0..8) => f32::INFINITY,
            (0..32, _) => 4.0,
            _ => 30.0,
        };
        Image::from_samples(64, 64, (0..64 * 64).map(|i| depth(i % 64, i / 64)).collect()).expect("a square")
    }

    #[test]
    fn errors_are_told_by_range_and_without_edges() {
        let truth = truth();
        // 10 cm too near on the left, 3 m too far on the right, the border smeared, one pixel missing.
        let samples = truth.samples().iter().enumerate().map(|(i, d)| match i % 64 {
            30..34 => 15.0,
            0 if i / 64 == 40 => f32::NAN,
            0..30 => d - 0.1,
            _ => d + 3.0,
        });
        let estimate = Image::from_samples(64, 64, samples.collect()).expect("a square");
        let report = measure_depth(&estimate, &truth, &DepthSettings::default()).expect("depths");
        let near = report.ranges[0].2;
        // Rows 11 to 63 keep off the sky, columns 0 to 28 off the jump, less the missing pixel.
        assert_eq!((near.pixels, near.missing), (53 * 29 - 1, 1));
        assert!((near.bias_m.value + 0.1).abs() < 1e-6 && (near.rmse_m.value - 0.1).abs() < 1e-6);
        assert_eq!((near.outliers, near.within[0]), (0.0, 1.0));
        let far = report.ranges[3].2;
        assert!((far.bias_m.value - 3.0).abs() < 1e-5 && far.outliers == 1.0 && (far.relative - 0.1).abs() < 1e-6);
        assert!(report.edges.rmse_m.value > 5.0 && report.ranges[1].2.pixels == 0);
        assert_eq!(report.all.pixels, near.pixels + far.pixels);
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let truth = truth();
        let measure = |estimate: &Image, ranges: &[f64]| {
            let settings = DepthSettings { ranges_m: ranges.to_vec(), ..DepthSettings::default() };
            measure_depth(estimate, &truth, &settings)
        };
        assert!(matches!(measure(&Image::new(64, 32), &[0.0, 9.0]), Err(DepthError::Size { .. })));
        assert_eq!(measure(&Image::new(64, 64), &[0.0, 9.0]), Err(DepthError::Nothing));
        assert_eq!(measure(&truth, &[9.0, 1.0]), Err(DepthError::Ranges));
    }
}
