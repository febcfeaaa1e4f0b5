//! Non-linear least squares after Levenberg (1944) and Marquardt (1963).
//!
//! The step solves (JᵀJ + λ D) δ = −Jᵀ r, D the diagonal of JᵀJ; λ decreases tenfold after a step that lowers Σ r², and increases
//! tenfold until one does. J is computed by central differences, with an error of about 1e-9 of its columns. Residuals are
//! grouped in blocks, so that a parameter of one view costs one evaluation of that view.
//!
//! Uncertainty: covariance = s² (JᵀJ)⁻¹ with s² = Σ r²/ν, ν residuals less parameters. The uncertainty follows from the residuals
//! themselves (GUM, type A), assuming that they are independent, of equal variance, and that the model holds. A direction in
//! which JᵀJ, scaled to a unit diagonal, has less than 1e-9 is undetermined by the observations: its parameters have infinite
//! uncertainty.
//!
//! Limitations: no bounds (a problem answers `None` where it cannot be evaluated, and the step is shortened), no robust losses (a
//! problem may weight its residuals).

use crate::Estimate;
use crate::linear::{Cholesky, Matrix, eigen};

/// A least-squares problem.
pub trait Problem {
    /// Model state of a set of parameters, computed once for all blocks.
    type State;

    /// Computes the state; `None` if the parameters are invalid.
    fn state(&self, parameters: &[f64]) -> Option<Self::State>;

    /// Computes the state with one parameter changed, for problems in which that costs less.
    fn changed(&self, _state: &Self::State, parameters: &[f64], _changed: usize) -> Option<Self::State> {
        self.state(parameters)
    }

    /// The number of blocks of residuals.
    fn blocks(&self) -> usize;

    /// The residuals of a block, always the same number; `None` if they cannot be evaluated.
    fn residuals(&self, state: &Self::State, block: usize) -> Option<Vec<f64>>;

    /// True if a block depends on a parameter.
    fn depends(&self, block: usize, parameter: usize) -> bool;

    /// A change of a parameter over which the residuals are nearly linear: the difference's step is 1e-3 of it.
    fn reach(&self, parameter: usize) -> f64;
}

/// Result of a fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Parameters at the minimum of the sum of squares.
    pub parameters: Vec<f64>,
    /// Covariance of the parameters; infinite on the diagonal (with 0 off the diagonal) for undetermined ones.
    pub covariance: Matrix,
    /// √(Σ r²/ν), in the residuals' unit.
    pub sigma: f64,
    /// ν: residuals less parameters.
    pub degrees_of_freedom: usize,
    /// The residuals of each block.
    pub residuals: Vec<Vec<f64>>,
}

impl Fit {
    /// A parameter with its standard uncertainty.
    #[must_use]
    pub fn estimate(&self, parameter: usize) -> Estimate {
        Estimate::new(self.parameters[parameter], self.covariance.at(parameter, parameter).sqrt())
    }
}

/// Reason why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Too few observations.
    #[error(
        "{residuals} observed values do not determine {parameters} parameters: give more points or views, or fit fewer coefficients"
    )]
    Underdetermined {
        /// Number of residuals.
        residuals: usize,
        /// Number of parameters.
        parameters: usize,
    },
    /// The initial guess cannot be evaluated.
    #[error(
        "the fit cannot be evaluated at its initial values: the points do not suit the model; choose another model"
    )]
    BadInitialGuess,
    /// No convergence.
    #[error(
        "the fit does not converge in {steps} steps: the model does not suit the points; choose another model, or fit fewer coefficients"
    )]
    NotConverged {
        /// Number of steps.
        steps: usize,
    },
}

/// Minimum relative decrease of Σ r² that counts as progress.
const MIN_DECREASE: f64 = 1e-9;
const MAX_STEPS: usize = 200;

/// Fits from an initial guess.
///
/// # Errors
/// [`FitError`].
pub fn fit<P: Problem>(problem: &P, start: &[f64]) -> Result<Fit, FitError> {
    let mut at = start.to_vec();
    let mut residuals = evaluate(problem, &at).ok_or(FitError::BadInitialGuess)?;
    let count: usize = residuals.iter().map(Vec::len).sum();
    if count <= at.len() {
        return Err(FitError::Underdetermined { residuals: count, parameters: at.len() });
    }
    let mut lambda = 1e-3;
    for _ in 0..MAX_STEPS {
        let (normal, gradient) = normal_equations(problem, &at, &residuals).ok_or(FitError::BadInitialGuess)?;
        let Some(better) = improved_step(problem, &at, &residuals, &normal, &gradient, &mut lambda) else {
            return Ok(finished(at, residuals, &normal, count));
        };
        let settled = squares(&residuals) - squares(&better.1) <= MIN_DECREASE * squares(&residuals);
        (at, residuals) = better;
        if settled {
            let (normal, _) = normal_equations(problem, &at, &residuals).ok_or(FitError::BadInitialGuess)?;
            return Ok(finished(at, residuals, &normal, count));
        }
    }
    let (normal, _) = normal_equations(problem, &at, &residuals).ok_or(FitError::BadInitialGuess)?;
    let fit = finished(at, residuals, &normal, count);
    // An unbounded valley: the covariance marks undetermined parameters.
    let open = (0..fit.parameters.len()).any(|i| fit.covariance.at(i, i).is_infinite());
    if open { Ok(fit) } else { Err(FitError::NotConverged { steps: MAX_STEPS }) }
}

fn evaluate<P: Problem>(problem: &P, at: &[f64]) -> Option<Vec<Vec<f64>>> {
    let state = problem.state(at)?;
    let residuals: Vec<_> = (0..problem.blocks()).map(|b| problem.residuals(&state, b)).collect::<Option<_>>()?;
    residuals.iter().flatten().all(|r| r.is_finite()).then_some(residuals)
}

fn squares(residuals: &[Vec<f64>]) -> f64 {
    residuals.iter().flatten().map(|r| r * r).sum()
}

type Iterate = (Vec<f64>, Vec<Vec<f64>>);

/// The first step, with increasing λ, that lowers the sum of squares; `None` if none does.
fn improved_step<P: Problem>(
    problem: &P,
    at: &[f64],
    residuals: &[Vec<f64>],
    normal: &Matrix,
    gradient: &[f64],
    lambda: &mut f64,
) -> Option<Iterate> {
    const MAX_LAMBDA: f64 = 1e12;
    while *lambda < MAX_LAMBDA {
        let candidate = step(normal, gradient, *lambda).and_then(|step| {
            let next: Vec<f64> = at.iter().zip(&step).map(|(p, d)| p + d).collect();
            let next_residuals = evaluate(problem, &next)?;
            (squares(&next_residuals) < squares(residuals)).then_some((next, next_residuals))
        });
        match candidate {
            Some(better) => {
                *lambda = (*lambda * 0.1).max(1e-12);
                return Some(better);
            }
            None => *lambda *= 10.0,
        }
    }
    None
}

fn step(normal: &Matrix, gradient: &[f64], lambda: f64) -> Option<Vec<f64>> {
    let n = gradient.len();
    let scale = scales(normal);
    let mut damped = scaled(normal, &scale);
    (0..n).for_each(|i| *damped.at_mut(i, i) += lambda);
    let right: Vec<f64> = gradient.iter().zip(&scale).map(|(g, s)| -g * s).collect();
    let step = Cholesky::new(&damped, 1e-15)?.solve(&right);
    Some(step.iter().zip(&scale).map(|(d, s)| d * s).collect())
}

/// 1/√ of the diagonal; 0 for a parameter without effect.
fn scales(normal: &Matrix) -> Vec<f64> {
    let inverse = |d: f64| if d > 0.0 { 1.0 / d.sqrt() } else { 0.0 };
    (0..normal.rows()).map(|i| inverse(normal.at(i, i))).collect()
}

fn scaled(normal: &Matrix, scale: &[f64]) -> Matrix {
    let n = scale.len();
    Matrix::from_rows(n, (0..n).map(|i| (0..n).map(|j| normal.at(i, j) * scale[i] * scale[j]).collect::<Vec<_>>()))
}

/// Columns of J of one block, with the index of their parameter.
pub type Columns = Vec<(usize, Vec<f64>)>;

/// Columns of J, block by block, for the parameters on which a block depends; `None` if they cannot be evaluated.
pub fn slopes<P: Problem>(problem: &P, at: &[f64]) -> Option<Vec<Columns>> {
    let blocks = problem.blocks();
    let base_state = problem.state(at)?;
    let mut columns: Vec<Columns> = vec![Vec::new(); blocks];
    for parameter in 0..at.len() {
        let step = 1e-3 * problem.reach(parameter);
        let moved = |sign: f64| {
            let mut moved = at.to_vec();
            moved[parameter] += sign * step;
            problem.changed(&base_state, &moved, parameter)
        };
        let (up, down) = (moved(1.0)?, moved(-1.0)?);
        for block in (0..blocks).filter(|b| problem.depends(*b, parameter)) {
            let (up, down) = (problem.residuals(&up, block)?, problem.residuals(&down, block)?);
            let slope = up.iter().zip(&down).map(|(u, d)| (u - d) / (2.0 * step)).collect();
            columns[block].push((parameter, slope));
        }
    }
    Some(columns)
}

/// JᵀJ and Jᵀr.
fn normal_equations<P: Problem>(problem: &P, at: &[f64], residuals: &[Vec<f64>]) -> Option<(Matrix, Vec<f64>)> {
    let n = at.len();
    let columns = slopes(problem, at)?;
    let (mut normal, mut gradient) = (Matrix::zeros(n, n), vec![0.0; n]);
    for (columns, residuals) in columns.iter().zip(residuals) {
        for (k, (i, a)) in columns.iter().enumerate() {
            gradient[*i] += crate::linear::dot(a, residuals);
            for (j, b) in &columns[..=k] {
                let product = crate::linear::dot(a, b);
                *normal.at_mut(*i, *j) += product;
                if i != j {
                    *normal.at_mut(*j, *i) += product;
                }
            }
        }
    }
    Some((normal, gradient))
}

fn finished(parameters: Vec<f64>, residuals: Vec<Vec<f64>>, normal: &Matrix, count: usize) -> Fit {
    let degrees_of_freedom = count - parameters.len();
    let sigma = (squares(&residuals) / degrees_of_freedom as f64).sqrt();
    let covariance = covariance(normal, sigma * sigma);
    Fit { parameters, covariance, sigma, degrees_of_freedom, residuals }
}

/// Minimum eigenvalue of the scaled normal matrix of a determined direction.
const MIN_EIGENVALUE: f64 = 1e-9;

fn covariance(normal: &Matrix, variance: f64) -> Matrix {
    let n = normal.rows();
    let scale = scales(normal);
    let eigenvalues = eigen(&scaled(normal, &scale));
    let mut covariance = Matrix::zeros(n, n);
    let mut open = vec![false; n];
    for (value, vector) in eigenvalues.values.iter().zip(&eigenvalues.vectors) {
        if *value < MIN_EIGENVALUE {
            // A component above 1e-3 of a unit vector: smaller ones do not affect a parameter beyond its other uncertainties.
            open.iter_mut().zip(vector).for_each(|(open, v)| *open |= v.abs() > 1e-3);
            continue;
        }
        for i in 0..n {
            for j in 0..n {
                *covariance.at_mut(i, j) += variance * vector[i] * vector[j] / value * scale[i] * scale[j];
            }
        }
    }
    for i in (0..n).filter(|i| open[*i]) {
        for j in 0..n {
            (*covariance.at_mut(i, j), *covariance.at_mut(j, i)) = (0.0, 0.0);
        }
        *covariance.at_mut(i, i) = f64::INFINITY;
    }
    covariance
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::maths::f64::exp;

    /// y = a exp(−b t), with a third parameter that adds to a if `doubled`.
    struct Decay {
        times: Vec<f64>,
        values: Vec<f64>,
        doubled: bool,
    }

    impl Problem for Decay {
        type State = Vec<f64>;
        fn state(&self, parameters: &[f64]) -> Option<Vec<f64>> {
            Some(parameters.to_vec())
        }
        fn blocks(&self) -> usize {
            1
        }
        fn residuals(&self, p: &Vec<f64>, _: usize) -> Option<Vec<f64>> {
            let height = p[0] + if self.doubled { p[2] } else { 0.0 };
            Some(self.times.iter().zip(&self.values).map(|(t, y)| height * exp(-p[1] * t) - y).collect())
        }
        fn depends(&self, _: usize, _: usize) -> bool {
            true
        }
        fn reach(&self, _: usize) -> f64 {
            0.1
        }
    }

    fn decay(noise: &[f64]) -> Decay {
        let times: Vec<f64> = (0..noise.len()).map(|i| i as f64 * 0.25).collect();
        let values = times.iter().zip(noise).map(|(t, n)| 3.0 * exp(-0.7 * t) + n).collect();
        Decay { times, values, doubled: false }
    }

    #[test]
    fn exact_observations_give_exact_parameters() {
        let fit = fit(&decay(&[0.0; 20]), &[1.0, 0.1]).expect("settles");
        assert!((fit.parameters[0] - 3.0).abs() < 1e-9 && (fit.parameters[1] - 0.7).abs() < 1e-9, "{fit:?}");
        assert!(matches!(
            super::fit(&decay(&[0.0; 2]), &[1.0, 0.1]),
            Err(FitError::Underdetermined { residuals: 2, parameters: 2 })
        ));
    }

    #[test]
    fn the_uncertainty_is_that_of_many_repetitions() {
        use etendue_stats::normal;
        let (mut squares, mut estimated, runs) = (0.0, 0.0, 400);
        let mut word = 12_345_u64;
        for _ in 0..runs {
            let noise: Vec<f64> = (0..20)
                .map(|_| {
                    word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    0.05 * normal::quantile(etendue_core::random::unit_f64(word).clamp(1e-12, 1.0 - 1e-12))
                })
                .collect();
            let rate = fit(&decay(&noise), &[2.0, 0.5]).expect("settles").estimate(1);
            squares += (rate.value - 0.7) * (rate.value - 0.7);
            estimated += rate.standard_uncertainty * rate.standard_uncertainty;
        }
        // Mean squares of 400 runs have a relative standard deviation of √(2/400) = 7 %; the limit is three of them, plus curvature.
        let ratio = squares / estimated;
        assert!((ratio - 1.0).abs() < 0.23, "{ratio}");
    }

    #[test]
    fn indistinguishable_parameters_are_infinitely_uncertain() {
        let problem = Decay { doubled: true, ..decay(&[0.01, -0.01, 0.02, 0.0, -0.02, 0.01, 0.0, -0.01]) };
        let fit = fit(&problem, &[1.0, 0.5, 0.5]).expect("settles");
        assert!(
            fit.estimate(0).standard_uncertainty.is_infinite() && fit.estimate(2).standard_uncertainty.is_infinite()
        );
        assert!(fit.estimate(1).standard_uncertainty < 0.1, "{:?}", fit.estimate(1));
    }
}
