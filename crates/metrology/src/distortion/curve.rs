//! Figures of a distortion: its curve against field (figure 11 of the paper), the bow of rows and columns, and its local and
//! largest values.

use std::collections::BTreeMap;

use etendue_core::maths::f64::{exp, ln, sin_cos};
use etendue_stats::normal;
use glam::DVec2;

use super::IdealMap;
use crate::{Estimate, linear::dot, target::Node};

/// A point of the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Observed distance from the centre, in half diagonals.
    pub field: f64,
    /// Observed over ideal distance, averaged over the directions in which the chart reaches there.
    pub ratio: Estimate,
    /// Fraction of directions in which the chart reaches there.
    pub covered: f64,
    /// Standard deviation of the ratio over directions: the non-radial part.
    pub spread: f64,
}

/// Number of field steps, and of directions per ring.
const STEPS: i32 = 40;
const DIRECTIONS: i32 = 72;

/// Maximum distance to the nearest point of the chart, in steps at the centre: half a diagonal, with allowance for tilt and
/// distortion.
const MAX_POINT_DISTANCE: f64 = 1.5;

/// The curve at steps of 2.5 % of the half diagonal.
pub(super) fn curve(ideal: &IdealMap, nodes: &[Node], half_diagonal_px: f64) -> Vec<CurvePoint> {
    let visible: BTreeMap<[i64; 2], DVec2> = nodes.iter().map(|n| (n.index.map(|i| i as i64), n.at)).collect();
    (1..=STEPS).filter_map(|i| point(ideal, &visible, f64::from(i) / f64::from(STEPS), half_diagonal_px)).collect()
}

fn point(
    ideal: &IdealMap,
    visible: &BTreeMap<[i64; 2], DVec2>,
    field: f64,
    half_diagonal_px: f64,
) -> Option<CurvePoint> {
    let radius = field * half_diagonal_px;
    let place = |i: i32| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * f64::from(i) / f64::from(DIRECTIONS));
        ideal.centre() + radius * DVec2::new(cos, sin)
    };
    // Between points of the chart, or beyond them by half a step at most. Far outside, the fields may fold back onto the chart: the
    // point must also be visible there.
    let within = |at: &DVec2| {
        let chart = ideal.chart(*at).map(|c| c.to_array().map(|c| c.round() as i64));
        let point = chart.and_then(|chart| visible.get(&chart));
        point.is_some_and(|p| (*p - *at).length() < MAX_POINT_DISTANCE * ideal.step_px())
    };
    let places: Vec<DVec2> = (0..DIRECTIONS).map(place).filter(within).collect();
    // One direction to each corner of the image.
    if places.len() < 4 {
        return None;
    }
    let ratio = |at: &DVec2| Some(radius / (ideal.place(*at)? - ideal.centre()).length());
    let ratios: Vec<f64> = places.iter().map(ratio).collect::<Option<_>>()?;
    let count = ratios.len() as f64;
    let mean = ratios.iter().sum::<f64>() / count;
    let spread = (ratios.iter().map(|r| (r - mean) * (r - mean)).sum::<f64>() / count).sqrt();
    let mut sum: Vec<f64> = Vec::new();
    for (at, ratio) in places.iter().zip(&ratios) {
        let row = ideal.log_distance_row(*at)?;
        sum.resize(row.len(), 0.0);
        sum.iter_mut().zip(&row).for_each(|(s, r)| *s -= ratio * r / count);
    }
    Some(CurvePoint {
        field,
        ratio: Estimate::new(mean, ideal.variance(&sum).sqrt()),
        covered: count / f64::from(DIRECTIONS),
        spread,
    })
}

/// The bow of a row or column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineBow {
    /// True for a row (horizontal), false for a column.
    pub is_row: bool,
    pub index: usize,
    /// Maximum distance of its points from the chord through its ends, relative to the image height; positive if it bows towards
    /// the centre (pincushion), negative away from it (barrel).
    pub bow: f64,
}

/// Bows of every row and column with at least five points.
pub(super) fn bows(nodes: &[Node], size: [usize; 2], centre: DVec2, height_px: f64) -> Vec<LineBow> {
    let line = |axis: usize, index: usize| {
        let points: Vec<DVec2> = nodes.iter().filter(|n| n.index[axis] == index).map(|n| n.at).collect();
        let bow = bow(&points, centre)? / height_px;
        Some(LineBow { is_row: axis == 1, index, bow })
    };
    let rows = (0..size[1]).filter_map(|i| line(1, i));
    rows.chain((0..size[0]).filter_map(|i| line(0, i))).collect()
}

/// Distance between the first and the last row that reach from side to side: at the sides (mean) relative to the middle, less 1;
/// positive for pincushion distortion. The mean of both sides is independent of the chart's tilt to first order.
pub(super) fn image_height(nodes: &[Node], [columns, rows]: [usize; 2]) -> Option<Estimate> {
    let row = |index: usize| {
        let points: Vec<&Node> = nodes.iter().filter(|n| n.index[1] == index).collect();
        let column = |i: usize| points.iter().find(|n| n.index[0] == i).copied();
        Some([column(0)?, column(columns / 2)?, column(columns.checked_sub(1)?)?])
    };
    let complete_rows: Vec<[&Node; 3]> = (0..rows).filter_map(row).collect();
    let (first, last) = (complete_rows.first()?, complete_rows.last()?);
    let [left, middle, right] = [0, 1, 2].map(|i| (last[i].at - first[i].at).length());
    let variance = |i: usize| [first, last].iter().map(|r| r[i].uncertainty_px * r[i].uncertainty_px).sum::<f64>();
    let ratio = 0.5 * (left + right) / middle;
    let relative = (0.25 * (variance(0) + variance(2)) + ratio * ratio * variance(1)).sqrt() / middle;
    (complete_rows.len() > 1 && middle > 0.0).then(|| Estimate::new(ratio - 1.0, relative))
}

/// px; `None` for fewer than five points.
fn bow(points: &[DVec2], centre: DVec2) -> Option<f64> {
    const MIN_LINE_POINTS: usize = 5;
    let (first, last) = (points.first()?, points.last()?);
    let along = (*last - *first).try_normalize().filter(|_| points.len() >= MIN_LINE_POINTS)?;
    let offset = |p: &DVec2| along.perp_dot(*p - *first);
    let largest = points.iter().map(offset).fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let side = offset(&centre);
    Some(if largest * side >= 0.0 { largest.abs() } else { -largest.abs() })
}

/// Distortion at one point of the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalDistortion {
    /// Column and row of the point.
    pub index: [usize; 2],
    /// Observed position, px.
    pub at: DVec2,
    /// Ideal position, px.
    pub ideal: DVec2,
    /// Distance from the centre, in half diagonals.
    pub field: f64,
    /// (Observed − ideal)/ideal distance from the centre by the fitted map at this position, without the point's own scatter.
    /// Neighbours share most of their errors.
    pub distortion: Estimate,
    /// Standard uncertainty of a coordinate of `at`, px.
    pub uncertainty_px: f64,
}

/// Local distortion at every point except those at the centre itself, where the ratio is undefined.
pub(super) fn all(ideal: &IdealMap, nodes: &[Node], half_diagonal_px: f64) -> Vec<LocalDistortion> {
    nodes.iter().filter_map(|n| local(ideal, n, half_diagonal_px)).collect()
}

fn local(ideal: &IdealMap, node: &Node, half_diagonal_px: f64) -> Option<LocalDistortion> {
    let offset = node.at - ideal.centre();
    let field = offset.length() / half_diagonal_px;
    if field <= 0.02 {
        return None;
    }
    let place = ideal.place(node.at)?;
    let ratio = offset.length() / (place - ideal.centre()).length();
    let relative = ideal.variance(&ideal.log_distance_row(node.at)?).sqrt();
    let distortion = Estimate::new(ratio - 1.0, ratio * relative);
    let (index, uncertainty_px) = (node.index, node.uncertainty_px);
    Some(LocalDistortion { index, at: node.at, ideal: place, field, distortion, uncertainty_px })
}

/// Maximum number of compared points: a regular subset of those that may be the largest.
const MAX_COMPARED: usize = 64;
/// Coverage probability of an interval.
const COVERAGE: f64 = 0.95;

/// The largest distortion by magnitude. The selection of the point depends on the same errors as its value. Of the points that
/// may be the largest within their uncertainties, n in number and with errors equivalent to n′ independent ones (n′ = n²/Σ ρ²ᵢⱼ,
/// ρ their correlations), the uncertainty is that for which 95 % intervals cover all of them simultaneously (Šidák 1967).
pub(super) fn largest(ideal: &IdealMap, local: &[LocalDistortion]) -> Option<LocalDistortion> {
    let size = |l: &LocalDistortion| l.distortion.value.abs();
    let max_local = local.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let may = |l: &&LocalDistortion| {
        let [u, v] = [l, max_local].map(|l| l.distortion.standard_uncertainty);
        size(l) + 2.0 * u >= size(max_local) - 2.0 * v
    };
    let rivals: Vec<&LocalDistortion> = local.iter().filter(may).collect();
    let every = rivals.len().div_ceil(MAX_COMPARED);
    let rows: Option<Vec<Vec<f64>>> = rivals.iter().step_by(every).map(|l| ideal.log_distance_row(l.at)).collect();
    let single = exp(ln(COVERAGE) / independent(ideal, &rows?));
    let wider = normal::quantile(0.5 * (1.0 + single)) / normal::quantile(0.5 * (1.0 + COVERAGE));
    let u = rivals.iter().map(|l| l.distortion.standard_uncertainty).fold(0.0, f64::max);
    Some(LocalDistortion { distortion: Estimate::new(max_local.distortion.value, wider * u), ..*max_local })
}

/// Effective number of independent errors of several ratios.
fn independent(ideal: &IdealMap, rows: &[Vec<f64>]) -> f64 {
    let influences: Vec<Vec<f64>> = rows.iter().map(|row| ideal.influence(row)).collect();
    let covariance = |i: usize, j: usize| dot(&influences[i], &rows[j]);
    let variances: Vec<f64> = (0..rows.len()).map(|i| covariance(i, i)).collect();
    let square = |i: usize, j: usize| covariance(i, j) * covariance(i, j) / (variances[i] * variances[j]);
    let squares: f64 =
        (0..rows.len()).flat_map(|i| (0..rows.len()).map(move |j| (i, j))).map(|(i, j)| square(i, j)).sum();
    (rows.len() * rows.len()) as f64 / squares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_bows_to_the_centre_is_a_pincushion_s() {
        let arc = |sign: f64| -> Vec<Node> {
            let at = |i: usize| {
                DVec2::new(i as f64 * 10.0, 20.0 + sign * (16.0 - (i as f64 - 4.0) * (i as f64 - 4.0)) / 4.0)
            };
            (0..9).map(|i| Node { index: [i, 0], at: at(i), uncertainty_px: 0.0 }).collect()
        };
        let bow = |sign| bows(&arc(sign), [9, 1], DVec2::new(40.0, 100.0), 200.0)[0].bow;
        assert!((bow(1.0) - 0.02).abs() < 1e-12 && (bow(-1.0) + 0.02).abs() < 1e-12);
    }
}
