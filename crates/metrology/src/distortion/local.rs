//! Distortion at the points of the chart, and the largest.

use super::Ideal;
use crate::Estimate;
use crate::linear::matrix::dot;
use crate::target::Node;
use etendue_core::maths::f64::{exp, ln};
use etendue_stats::normal;
use glam::DVec2;

/// Distortion at one point of the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalDistortion {
    /// Column and row of the point.
    pub index: [usize; 2],
    /// Where it is seen, px.
    pub at: DVec2,
    /// Where it would be seen ideally, px.
    pub ideal: DVec2,
    /// Its distance from the centre, in half diagonals.
    pub field: f64,
    /// (Observed − ideal)/ideal distance from the centre by the fitted map at this place: the point's own scatter is not in it.
    /// Neighbours share most of their errors.
    pub distortion: Estimate,
    /// Standard uncertainty of a coordinate of `at`, px.
    pub uncertainty_px: f64,
}

/// Of every point but those at the centre itself, where a ratio says nothing.
pub(super) fn all(ideal: &Ideal, nodes: &[Node], half_diagonal_px: f64) -> Vec<LocalDistortion> {
    nodes.iter().filter_map(|n| local(ideal, n, half_diagonal_px)).collect()
}

fn local(ideal: &Ideal, node: &Node, half_diagonal_px: f64) -> Option<LocalDistortion> {
    let seen = node.at - ideal.centre();
    let field = seen.length() / half_diagonal_px;
    if field <= 0.02 {
        return None;
    }
    let place = ideal.place(node.at)?;
    let ratio = seen.length() / (place - ideal.centre()).length();
    let relative = ideal.variance(&ideal.log_distance_row(node.at)?).sqrt();
    let distortion = Estimate::new(ratio - 1.0, ratio * relative);
    let (index, uncertainty_px) = (node.index, node.uncertainty_px);
    Some(LocalDistortion { index, at: node.at, ideal: place, field, distortion, uncertainty_px })
}

/// Points that are compared at most: every so many of those that may be the largest.
const COMPARED: usize = 64;
/// The share of cases in which an interval holds the truth.
const COVERED: f64 = 0.95;

/// The largest distortion by magnitude. Which point it is follows from the same errors as its value: of n points that may be it as
/// far as their uncertainties tell, and whose errors are as n′ independent ones (n′ = n²/Σ ρ²ᵢⱼ, ρ their correlations), the uncertainty
/// is that with which 95 % intervals hold all of them at once (Šidák 1967).
pub(super) fn largest(ideal: &Ideal, local: &[LocalDistortion]) -> Option<LocalDistortion> {
    let size = |l: &LocalDistortion| l.distortion.value.abs();
    let found = local.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let may = |l: &&LocalDistortion| {
        let [u, v] = [l, found].map(|l| l.distortion.standard_uncertainty);
        size(l) + 2.0 * u >= size(found) - 2.0 * v
    };
    let rivals: Vec<&LocalDistortion> = local.iter().filter(may).collect();
    let every = rivals.len().div_ceil(COMPARED);
    let rows: Option<Vec<Vec<f64>>> = rivals.iter().step_by(every).map(|l| ideal.log_distance_row(l.at)).collect();
    let single = exp(ln(COVERED) / independent(ideal, &rows?));
    let wider = normal::quantile(0.5 * (1.0 + single)) / normal::quantile(0.5 * (1.0 + COVERED));
    let u = rivals.iter().map(|l| l.distortion.standard_uncertainty).fold(0.0, f64::max);
    Some(LocalDistortion { distortion: Estimate::new(found.distortion.value, wider * u), ..*found })
}

/// How many independent errors those of some ratios are like.
fn independent(ideal: &Ideal, rows: &[Vec<f64>]) -> f64 {
    let levers: Vec<Vec<f64>> = rows.iter().map(|row| ideal.lever(row)).collect();
    let covariance = |i: usize, j: usize| dot(&levers[i], &rows[j]);
    let variances: Vec<f64> = (0..rows.len()).map(|i| covariance(i, i)).collect();
    let square = |i: usize, j: usize| covariance(i, j) * covariance(i, j) / (variances[i] * variances[j]);
    let squares: f64 =
        (0..rows.len()).flat_map(|i| (0..rows.len()).map(move |j| (i, j))).map(|(i, j)| square(i, j)).sum();
    (rows.len() * rows.len()) as f64 / squares
}
