//! How good an estimated depth picture is against the truth.
//!
//! With error e = d̂ − d over pixels whose truth is finite and above 0, by range of d and over all:
//!
//! ```text
//! bias ⟨e⟩    MAE ⟨|e|⟩    RMSE √⟨e²⟩    ⟨|e|/d⟩    ⟨e²/d⟩    of logarithms √⟨l²⟩, l = ln d̂ − ln d
//! SILog √(⟨l²⟩ − ⟨l⟩²): what no common factor takes away          (Eigen, Puhrsch & Fergus 2014)
//! δ_k: share of max(d̂/d, d/d̂) < 1.25^k                          (the same)
//! iRMSE √⟨(1/d̂ − 1/d)²⟩                                          (KITTI's depth completion: Uhrig et al. 2017)
//! outliers: |e| > d · share and |e| > least
//! D1: |D̂ − D| > 3 px and > 5 %; EPE ⟨|D̂ − D|⟩, D = B f/d          (KITTI 2015: Menze & Geiger; with a stereo rig's B f)
//! ```
//!
//! Pixels at edges of the truth (where a neighbour within `edge_px` differs by more than `edge_ratio` of the depth, or is infinitely far)
//! are told apart: a pixel sees two depths there, and neither estimate nor truth has one. Truth that is NaN or not above 0 is
//! not known, and makes no edge (sparse truth); infinite truth is sky. Estimates that are NaN, infinite or not above 0 are
//! missing: counted, and in no error. Networks that know depth but for a factor are scaled first, by the median of d/d̂ over the pixels
//! away from edges ([`Alignment::Median`]). Uncertainty: errors of neighbours belong together, so that all means are taken from
//! blocks of 16 × 16 pixels as if these were independent.

mod edges;
mod error;
mod report;
mod settings;
mod sums;
#[cfg(test)]
mod tests;

use crate::Image;
use edges::{edges, known};
use etendue_stats::upper_median;
use sums::Sums;

pub use error::DepthError;
pub use report::{DepthErrors, DepthReport};
pub use settings::{Alignment, DepthSettings};

/// Judges an estimate against the truth, both in m.
///
/// # Errors
/// Where sizes differ, settings are no numbers, limits do not rise, pictures are the same, or nothing can be compared.
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
    let sums = |wanted: &dyn Fn(usize, f64) -> bool| Sums::of(estimate, truth, scale, settings, wanted).errors();
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
