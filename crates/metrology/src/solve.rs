//! Weighted linear least squares by the normal equations.

use crate::linear::{Cholesky, Matrix};

/// A pivot below this share of its diagonal element is rounding: the equations do not determine their unknowns.
const MIN_PIVOT: f64 = 1e-12;

/// AᵀWA and AᵀWb, gathered row by row.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    matrix: Matrix,
    right: Vec<f64>,
}

impl Normal {
    /// For so many unknowns.
    pub(crate) fn new(unknowns: usize) -> Self {
        Self { matrix: Matrix::zeros(unknowns, unknowns), right: vec![0.0; unknowns] }
    }

    /// Takes in the equation row · x = b of a weight.
    pub(crate) fn add(&mut self, row: &[f64], b: f64, weight: f64) {
        let places: Vec<usize> = (0..row.len()).collect();
        self.add_at(&places, row, b, weight);
    }

    /// The same for a row that is zero but at some places.
    pub(crate) fn add_at(&mut self, places: &[usize], values: &[f64], b: f64, weight: f64) {
        for (i, a) in places.iter().zip(values) {
            let weighted = weight * a;
            self.right[*i] += weighted * b;
            places.iter().zip(values).for_each(|(j, other)| *self.matrix.at_mut(*i, *j) += weighted * other);
        }
    }

    /// The solution; `None` where the equations do not determine it.
    pub(crate) fn solve(&self) -> Option<Vec<f64>> {
        Some(Cholesky::of(&self.matrix, MIN_PIVOT)?.solve(&self.right))
    }

    /// The inverse of AᵀWA: the covariance of the solution for weights that are inverse variances.
    pub(crate) fn inverse(&self) -> Option<Matrix> {
        Some(Cholesky::of(&self.matrix, MIN_PIVOT)?.inverse())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_comes_back_with_its_covariance() {
        let mut normal = Normal::new(2);
        for i in 0..5 {
            normal.add(&[1.0, f64::from(i)], 3.0 + 2.0 * f64::from(i), 4.0);
        }
        let x = normal.solve().expect("two unknowns, five points");
        assert!((x[0] - 3.0).abs() < 1e-12 && (x[1] - 2.0).abs() < 1e-12);
        // Σ(x − x̄)² = 10, weight 4.
        let covariance = normal.inverse().expect("it is determined");
        assert!((covariance.at(1, 1) - 1.0 / 40.0).abs() < 1e-14);
        let mut singular = Normal::new(2);
        singular.add(&[1.0, 2.0], 1.0, 1.0);
        assert!(singular.solve().is_none());
    }
}
