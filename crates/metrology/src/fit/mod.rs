//! Fits: parameters from observations, with their covariance.
//!
//! | fit | of | file |
//! | --- | --- | --- |
//! | [`levenberg`] | any residuals, by Levenberg and Marquardt | `levenberg.rs` |
//! | [`Homography`] | perspective map from plane to plane | here |
//! | [`fit_mixed_model()`] | linear models in which some coefficients are small | here |
//!
//! Homography: perspective map from plane to plane, x′ ~ H x.
//!
//! By the normalised direct linear transformation (Hartley & Zisserman, Multiple View Geometry, 2nd ed. 2004, algorithm 4.2),
//! both sets moved to their centroid and scaled to a mean distance of √2.
//!
//! Mixed model: linear least squares in which some coefficients are free and the others are small, with a scale estimated from
//! the observations.
//!
//! y = X α + Z β + ε with ε of variance σ² and β of variance τ² = λ σ² each, independent and normal (a mixed linear model;
//! Henderson 1975). For a λ the coefficients solve ([X Z]ᵀ[X Z] + diag(0, 1/λ)) θ = [X Z]ᵀ y with covariance σ² times the
//! inverse, and the restricted likelihood (Patterson & Thompson 1971), σ² at its best, is −2 ln L = ν ln(yᵀ P y) + ln det C + m
//! ln λ, ν = observations less free coefficients, C the matrix above, m the number of β, yᵀ P y = yᵀy − θ · [X Z]ᵀ y, σ² = yᵀ P
//! y/ν.
//!
//! No single λ is selected: coefficients and covariance are averages over a series of λ (uniform in ln λ), weighted by
//! likelihood, with the spread of the coefficients over it included. So the undetermined part of β contributes to the covariance
//! in proportion to the size of β that the determined part suggests: from nothing (if α alone leaves only noise) to all of it.
//! The covariance is that of Student's distribution of ν degrees of freedom.
//!
//! Limitations: no correlated observations, one scale for all β.

pub mod levenberg;

use etendue_core::maths::f64::{exp, exp2, ln};
use glam::{DMat3, DVec2, DVec3};

use crate::linear::{Cholesky, Matrix, dot, eigen};

pub use levenberg::{Fit, FitError, Problem, fit, slopes};

/// A homography, normalised to 1 at the lower right of its matrix unless the origin maps to infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homography {
    /// The matrix that maps (x, y, 1) to a multiple of (x′, y′, 1).
    pub matrix: DMat3,
}

impl Homography {
    /// The point's image; `None` at infinity and beyond (if the third coordinate is not positive).
    #[must_use]
    pub fn image(&self, point: DVec2) -> Option<DVec2> {
        let image = self.matrix * point.extend(1.0);
        (image.z > 0.0).then(|| image.truncate() / image.z)
    }

    /// The homography nearest to pairs of points by the direct linear transformation; `None` if they do not determine one (fewer
    /// than four, or too many on a line).
    #[must_use]
    pub fn direct(pairs: &[[DVec2; 2]]) -> Option<Self> {
        if pairs.len() < 4 {
            return None;
        }
        let [from, to] = [0, 1].map(|side| normalisation(pairs.iter().map(|p| p[side])));
        let rows = pairs.iter().flat_map(|[a, b]| {
            let [x, y] = (from * a.extend(1.0)).truncate().to_array();
            let [u, v] = (to * b.extend(1.0)).truncate().to_array();
            [[x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y, -u], [0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y, -v]]
        });
        let h = null_vector(&Matrix::from_rows(9, rows))?;
        let normalised = DMat3::from_cols_slice(&h).transpose();
        let matrix = to.inverse() * normalised * from;
        let matrix = matrix / matrix.z_axis.z;
        (matrix.is_finite() && matrix.determinant().abs() > 0.0).then_some(Self { matrix })
    }
}

/// The translation and scaling that bring points to the origin at a mean distance of √2.
fn normalisation(points: impl Iterator<Item = DVec2> + Clone) -> DMat3 {
    let count = points.clone().count() as f64;
    let centre = points.clone().sum::<DVec2>() / count;
    let distance = points.map(|p| (p - centre).length()).sum::<f64>() / count;
    let scale = std::f64::consts::SQRT_2 / distance;
    DMat3::from_cols(DVec3::X * scale, DVec3::Y * scale, (-centre * scale).extend(1.0))
}

/// The unit vector v of least |A v|; `None` if it is not unique, to 1e-12 of the largest.
#[must_use]
pub fn null_vector(a: &Matrix) -> Option<Vec<f64>> {
    let eigenvalues = eigen(&a.gram());
    let n = eigenvalues.values.len();
    let single = eigenvalues.values[1] > 1e-12 * eigenvalues.values[n - 1];
    single.then(|| eigenvalues.vectors[0].clone())
}

/// The coefficients, with their covariance.
#[derive(Clone, Debug)]
pub struct MixedModelFit {
    /// The free coefficients, then the small ones.
    pub parameters: Vec<f64>,
    /// Their covariance.
    pub covariance: Matrix,
    /// Standard deviation of an observation.
    pub sigma: f64,
    /// Standard deviation of a small coefficient: the root of the mean of λ σ².
    pub tau: f64,
}

/// Number of steps of the λ series and its first exponent of 4: τ from a sixteenth of σ to two thousand times.
const LAMBDA_STEPS: i32 = 16;
const FIRST_EXPONENT: i32 = -4;
/// Relative weight below which a step of the series is skipped.
const MIN_WEIGHT: f64 = 1e-2;
/// Rounding error of an observation of size 1.
const ROUNDING: f64 = 1e-12;

/// A λ with its solution.
struct LambdaSolution {
    lambda: f64,
    factor: Cholesky,
    parameters: Vec<f64>,
    variance: f64,
    /// −2 ln L.
    minus_two_log_likelihood: f64,
}

/// Fits `values` by the columns of `design`, the first `free` of which are free.
///
/// # Errors
/// If there are too few observations, or the free columns are linearly dependent.
pub fn fit_mixed_model(design: &Matrix, values: &[f64], free: usize) -> Result<MixedModelFit, FitError> {
    let few = || FitError::Underdetermined { residuals: values.len(), parameters: free };
    // Student's variance, ν/(ν − 2), needs more than two.
    if values.len() < free + 3 {
        return Err(few());
    }
    let freedom = (values.len() - free) as f64;
    let normal = design.gram();
    let right = transposed_times(design, values);
    let size = dot(values, values);
    let solutions = (0..LAMBDA_STEPS).filter_map(|i| {
        lambda_solution(&normal, &right, size, free, freedom, exp2(2.0 * f64::from(FIRST_EXPONENT + i)))
    });
    let solutions: Vec<LambdaSolution> = solutions.collect();
    let best = solutions.iter().map(|r| r.minus_two_log_likelihood).reduce(f64::min).ok_or_else(few)?;
    let weight = |r: &LambdaSolution| exp(0.5 * (best - r.minus_two_log_likelihood));
    let weighted: Vec<(f64, &LambdaSolution)> =
        solutions.iter().map(|r| (weight(r), r)).filter(|(w, _)| *w > MIN_WEIGHT).collect();
    let total_weight: f64 = weighted.iter().map(|(w, _)| w).sum();
    let weighted: Vec<(f64, &LambdaSolution)> = weighted.into_iter().map(|(w, r)| (w / total_weight, r)).collect();
    Ok(mean(&weighted, freedom))
}

fn lambda_solution(
    normal: &Matrix,
    right: &[f64],
    size: f64,
    free: usize,
    freedom: f64,
    lambda: f64,
) -> Option<LambdaSolution> {
    let count = right.len();
    let mut matrix = normal.clone();
    (free..count).for_each(|i| *matrix.at_mut(i, i) += 1.0 / lambda);
    let factor = Cholesky::new(&matrix, 1e-14)?;
    let parameters = factor.solve(right);
    let left = (size - dot(&parameters, right)).max(ROUNDING * ROUNDING * freedom);
    let unlikely = freedom * ln(left) + factor.ln_determinant() + (count - free) as f64 * ln(lambda);
    Some(LambdaSolution { lambda, factor, parameters, variance: left / freedom, minus_two_log_likelihood: unlikely })
}

/// The weighted mean over the λ series.
fn mean(solutions: &[(f64, &LambdaSolution)], freedom: f64) -> MixedModelFit {
    let count = solutions[0].1.parameters.len();
    let over = |value: &dyn Fn(&LambdaSolution) -> f64| solutions.iter().map(|(w, r)| w * value(r)).sum::<f64>();
    let parameters: Vec<f64> = (0..count).map(|i| over(&|r| r.parameters[i])).collect();
    let mut covariance = Matrix::zeros(count, count);
    for (weight, solution) in solutions {
        let unit = solution.factor.inverse();
        let student = weight * solution.variance * freedom / (freedom - 2.0);
        let off: Vec<f64> = solution.parameters.iter().zip(&parameters).map(|(a, b)| a - b).collect();
        for i in 0..count {
            for j in 0..count {
                *covariance.at_mut(i, j) += student * unit.at(i, j) + weight * off[i] * off[j];
            }
        }
    }
    let (sigma, tau) = (over(&|r| r.variance).sqrt(), over(&|r| r.lambda * r.variance).sqrt());
    MixedModelFit { parameters, covariance, sigma, tau }
}

fn transposed_times(design: &Matrix, values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; design.columns()];
    for (i, value) in values.iter().enumerate() {
        sums.iter_mut().zip(design.row(i)).for_each(|(sum, x)| *sum += x * value);
    }
    sums
}

#[cfg(test)]
mod tests {
    use etendue_stats::normal;

    use super::*;

    fn grid() -> impl Iterator<Item = DVec2> {
        (0..6).flat_map(|i| (0..5).map(move |j| DVec2::new(f64::from(i), f64::from(j)) * 30.0))
    }

    #[test]
    fn exact_pairs_give_the_homography_back() {
        let rows = [[2.0, 0.3, 100.0], [-0.2, 1.8, 700.0], [4e-4, -2e-4, 1.0]];
        let truth = Homography { matrix: DMat3::from_cols_array_2d(&rows).transpose() };
        let pairs: Vec<_> = grid().map(|p| [p, truth.image(p).expect("before the plane")]).collect();
        let homography = Homography::direct(&pairs).expect("determined");
        for [from, to] in &pairs {
            // A thousand pixels, conditioned by normalisation: about a hundred roundings.
            assert!((homography.image(*from).expect("finite") - *to).length() < 1e-9, "{homography:?}");
        }
    }

    #[test]
    fn points_on_a_line_determine_none() {
        let pairs: Vec<_> = (0..9).map(|i| DVec2::new(f64::from(i), 2.0 * f64::from(i))).map(|p| [p, p]).collect();
        assert!(Homography::direct(&pairs).is_none() && Homography::direct(&pairs[..3]).is_none());
    }

    /// A line plus nine waves of one amplitude, at 40 positions, with noise of 0.1.
    fn line(size: f64, seed: u64) -> (Matrix, Vec<f64>) {
        let mut word = seed.wrapping_mul(977) + 1;
        let mut next_random = || {
            word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            normal::quantile(etendue_core::random::unit_f64(word ^ (word >> 29)).clamp(1e-12, 1.0 - 1e-12))
        };
        let wave = |t: f64, k: usize| etendue_core::maths::f64::cos(std::f64::consts::PI * k as f64 * t);
        let sizes: Vec<f64> = (0..9).map(|_| size * next_random()).collect();
        let row = |i: usize| {
            let t = i as f64 / 40.0;
            [1.0, t].into_iter().chain((1..10).map(|k| wave(t, k))).collect::<Vec<f64>>()
        };
        let rows: Vec<Vec<f64>> = (0..40).map(row).collect();
        let values = rows.iter().map(|r| 2.0 + 3.0 * r[1] + dot(&r[2..], &sizes) + 0.1 * next_random()).collect();
        (Matrix::from_rows(11, rows), values)
    }

    /// Mean square error of the slope in standard uncertainties, and the mean uncertainty.
    fn slopes(size: f64) -> (f64, f64) {
        let results = (0..200).map(|seed| {
            let (design, values) = line(size, seed);
            let fit = fit_mixed_model(&design, &values, 2).expect("40 observations");
            let u = fit.covariance.at(1, 1).sqrt();
            ((fit.parameters[1] - 3.0) / u, u)
        });
        let (squares, us) = results.fold((0.0, 0.0), |(a, b), (e, u)| (a + e * e, b + u));
        (squares / 200.0, us / 200.0)
    }

    #[test]
    fn the_uncertainty_follows_the_size_of_what_is_small() {
        // Without waves the uncertainty is the line's own: σ/√Σ(t − t̄)² = 0.1/√(40/12) = 0.055. A mean square of 200 has 10 %.
        let (squares, u) = slopes(0.0);
        assert!((0.6..1.3).contains(&squares) && (0.05..0.09).contains(&u), "{squares} {u}");
        let (squares, large) = slopes(0.5);
        assert!((0.6..1.4).contains(&squares) && large > 2.0 * u, "{squares} {large}");
    }
}
