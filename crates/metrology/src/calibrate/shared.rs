//! Errors shared by the points of one line of the chart, and their effect on the camera's covariance.
//!
//! In a frontal view all points of a column have the same sub-pixel phase, so the pixel raster affects them equally. Row and
//! column noise of the sensor, and a displaced line of the printed chart, are shared as well. The error model is therefore e = ε + a
//! column's + a row's, separately for x and y, independent with variances σ² and τₖ² of four kinds k. They are estimated by
//! moments: with residuals r = M e, M = 1 − J (JᵀJ)⁻¹Jᵀ, and z_g the indicator vector (0 and 1) of line g of n_g points,
//!
//! ```text
//! Σ r²                     = σ² tr M             + Σₖ τₖ² Σ_{h ∈ k} z_hᵀ M z_h                  (on average)
//! Σ_{g ∈ l} (z_g · r)²/n_g = σ² Σ z_gᵀ M z_g/n_g + Σₖ τₖ² Σ_{g ∈ l} Σ_{h ∈ k} (z_gᵀ M z_h)²/n_g
//! ```
//!
//! (Searle, Casella & McCulloch 1992); negative estimates are set to 0. The covariance is that of least squares under such
//! errors, s² (JᵀJ)⁻¹ + Σₖ τₖ² Σ_g v_g v_gᵀ with v_g = (JᵀJ)⁻¹Jᵀz_g and s² the total scatter, Σ r²/ν: never less than for
//! independent errors. As few lines determine τₖ² poorly, it is multiplied by Student's variance, ν/(ν − 2), with ν = Σ z_gᵀ M
//! z_g/n_g free lines.
//!
//! Limitations: errors that drift slowly from line to line (steps of nearly whole pixels) look like camera parameters.

use std::collections::BTreeMap;

use super::problem::CalibrationProblem;
use crate::fit::{Fit, slopes};
use crate::linear::{Matrix, Orthogonal, dot};

/// Coordinates of a point, and directions of lines.
const AXES: [usize; 2] = [0, 1];
const KINDS: usize = 4;
/// Maximum of Student's variance, which is unbounded for fewer than three free lines.
const MAX_STUDENT: f64 = 3.0;

/// A coordinate of the points of a row or column of one view.
struct CoordinateLine {
    kind: usize,
    view: usize,
    points: Vec<usize>,
    /// z · r.
    sum: f64,
    /// Jᵀz, and (JᵀJ)⁻¹ of it.
    gradient: Vec<f64>,
    moved: Vec<f64>,
}

impl CoordinateLine {
    fn count(&self) -> f64 {
        self.points.len() as f64
    }

    /// z_gᵀ M z_h, of lines of one view.
    fn product(&self, other: &Self) -> f64 {
        let same_axis = self.kind / 2 == other.kind / 2;
        let common = || self.points.iter().filter(|p| other.points.binary_search(p).is_ok()).count() as f64;
        let common = if same_axis { common() } else { 0.0 };
        common - dot(&self.gradient, &other.moved)
    }
}

/// The covariance of a fit's parameters under errors that lines share.
pub(super) fn covariance(problem: &CalibrationProblem<'_>, fit: &Fit) -> Matrix {
    let unit = unit_covariance(fit);
    let widened = unit.as_ref().and_then(|unit| {
        let lines = lines(problem, fit, unit)?;
        Some(parameter_covariance(unit, &lines, fit))
    });
    let mut covariance = widened.unwrap_or_else(|| fit.covariance.clone());
    let open = (0..fit.parameters.len()).filter(|i| fit.covariance.at(*i, *i).is_infinite());
    open.for_each(|i| *covariance.at_mut(i, i) = f64::INFINITY);
    covariance
}

/// (JᵀJ)⁻¹, with zeros for undetermined parameters; `None` for exact points.
fn unit_covariance(fit: &Fit) -> Option<Matrix> {
    let variance = fit.sigma * fit.sigma;
    let n = fit.parameters.len();
    let finite = |value: f64| if value.is_finite() { value / variance } else { 0.0 };
    let row = |i: usize| (0..n).map(|j| finite(fit.covariance.at(i, j))).collect::<Vec<f64>>();
    (variance > 0.0).then(|| Matrix::from_rows(n, (0..n).map(row)))
}

/// Lines of two points or more.
fn lines(problem: &CalibrationProblem<'_>, fit: &Fit, unit: &Matrix) -> Option<Vec<CoordinateLine>> {
    let slopes = slopes(problem, &fit.parameters)?;
    let mut lines = Vec::new();
    for (view, columns) in slopes.iter().enumerate() {
        for direction in AXES {
            for points in points_on_lines(problem, view, direction) {
                lines.extend(AXES.map(|axis| {
                    let at = |list: &[f64]| points.iter().map(|p| list[2 * p + axis]).sum::<f64>();
                    let mut gradient = vec![0.0; fit.parameters.len()];
                    columns.iter().for_each(|(i, slope)| gradient[*i] = at(slope));
                    let (sum, moved) = (at(&fit.residuals[view]), unit.times(&gradient));
                    CoordinateLine { kind: 2 * axis + direction, view, points: points.clone(), sum, gradient, moved }
                }));
            }
        }
    }
    Some(lines)
}

/// Points of a view that share one of their chart's coordinates.
fn points_on_lines(
    problem: &CalibrationProblem<'_>,
    view: usize,
    direction: usize,
) -> impl Iterator<Item = Vec<usize>> {
    let mut lines: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
    for (p, point) in problem.views[view].points.iter().enumerate() {
        lines.entry(point.chart[direction].to_bits()).or_default().push(p);
    }
    lines.into_values().filter(|points| points.len() > 1)
}

fn parameter_covariance(unit: &Matrix, lines: &[CoordinateLine], fit: &Fit) -> Matrix {
    let free: [f64; KINDS] = std::array::from_fn(|k| {
        lines.iter().filter(|line| line.kind == k).map(|line| line.product(line) / line.count()).sum()
    });
    let [_, shared @ ..] = components(lines, fit);
    // The total scatter, so that poor estimates from few lines do not reduce any uncertainty.
    let variance = fit.sigma * fit.sigma;
    let n = fit.parameters.len();
    let mut covariance = Matrix::zeros(n, n);
    for i in 0..n {
        for j in 0..n {
            let line_covariance = |l: &CoordinateLine| shared[l.kind] * student(free[l.kind]) * l.moved[i] * l.moved[j];
            *covariance.at_mut(i, j) = variance * unit.at(i, j) + lines.iter().map(line_covariance).sum::<f64>();
        }
    }
    covariance
}

fn student(freedom: f64) -> f64 {
    if freedom > 3.0 { (freedom / (freedom - 2.0)).min(MAX_STUDENT) } else { MAX_STUDENT }
}

/// σ² and the four τ² of the model.
fn components(lines: &[CoordinateLine], fit: &Fit) -> [f64; 1 + KINDS] {
    let mut moments = Matrix::zeros(1 + KINDS, 1 + KINDS);
    let mut observed = [0.0; 1 + KINDS];
    observed[0] = fit.sigma * fit.sigma * fit.degrees_of_freedom as f64;
    *moments.at_mut(0, 0) = fit.degrees_of_freedom as f64;
    for line in lines {
        let (row, own) = (1 + line.kind, line.product(line));
        observed[row] += line.sum * line.sum / line.count();
        *moments.at_mut(0, row) += own;
        *moments.at_mut(row, 0) += own / line.count();
        for other in lines.iter().filter(|other| other.view == line.view) {
            let product = line.product(other);
            *moments.at_mut(row, 1 + other.kind) += product * product / line.count();
        }
    }
    not_negative(&moments, observed)
        .unwrap_or_else(|| std::array::from_fn(|k| if k == 0 { fit.sigma * fit.sigma } else { 0.0 }))
}

/// The solution with negative components set to 0.
fn not_negative(moments: &Matrix, observed: [f64; 1 + KINDS]) -> Option<[f64; 1 + KINDS]> {
    let mut active: Vec<usize> = (0..=KINDS).filter(|k| moments.at(*k, *k) > 0.0).collect();
    loop {
        let rows = active.iter().map(|i| active.iter().map(|j| moments.at(*i, *j)).collect::<Vec<f64>>());
        let values: Vec<f64> = active.iter().map(|k| observed[*k]).collect();
        let solved = Orthogonal::factor(&Matrix::from_rows(active.len(), rows), 1e-12)?.solve(&values).parameters;
        let most_negative =
            (1..active.len()).min_by(|a, b| solved[*a].total_cmp(&solved[*b])).filter(|i| solved[*i] < 0.0);
        let Some(most_negative) = most_negative else {
            let mut all = [0.0; 1 + KINDS];
            active.iter().zip(&solved).for_each(|(k, value)| all[*k] = *value);
            return (all[0] > 0.0).then_some(all);
        };
        active.remove(most_negative);
    }
}
