//! A = L Lᵀ of a symmetric positive definite matrix.

use super::Matrix;
use super::matrix::dot;

/// The lower factor.
#[derive(Clone, Debug)]
pub struct Cholesky {
    lower: Matrix,
}

impl Cholesky {
    /// Factors a symmetric matrix; `None` where a pivot is less than `least` of its diagonal element: there the columns before
    /// it explain the column, to rounding.
    #[must_use]
    pub fn of(a: &Matrix, least: f64) -> Option<Self> {
        let n = a.rows();
        let mut lower = Matrix::zeros(n, n);
        for j in 0..n {
            let explained: f64 = lower.row(j)[..j].iter().map(|l| l * l).sum();
            let pivot = a.at(j, j) - explained;
            if pivot.is_nan() || pivot <= least * a.at(j, j) {
                return None;
            }
            let root = pivot.sqrt();
            *lower.at_mut(j, j) = root;
            for i in j + 1..n {
                let shared = dot(&lower.row(i)[..j], &lower.row(j)[..j]);
                *lower.at_mut(i, j) = (a.at(i, j) - shared) / root;
            }
        }
        Some(Self { lower })
    }

    /// x of A x = b.
    #[must_use]
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = b.len();
        let mut x = b.to_vec();
        for i in 0..n {
            let known: f64 = (0..i).map(|k| self.lower.at(i, k) * x[k]).sum();
            x[i] = (x[i] - known) / self.lower.at(i, i);
        }
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| self.lower.at(k, i) * x[k]).sum();
            x[i] = (x[i] - known) / self.lower.at(i, i);
        }
        x
    }

    /// ln det A.
    #[must_use]
    pub fn ln_determinant(&self) -> f64 {
        (0..self.lower.rows()).map(|i| 2.0 * etendue_core::maths::f64::ln(self.lower.at(i, i))).sum()
    }

    /// A⁻¹ = L⁻ᵀ L⁻¹.
    #[must_use]
    pub fn inverse(&self) -> Matrix {
        let n = self.lower.rows();
        // Row j holds column j of L⁻¹, from the diagonal on.
        let mut columns = Matrix::zeros(n, n);
        for j in 0..n {
            for i in j..n {
                let known = dot(&self.lower.row(i)[j..i], &columns.row(j)[j..i]);
                let unit = f64::from(u8::from(i == j));
                *columns.at_mut(j, i) = (unit - known) / self.lower.at(i, i);
            }
        }
        let at = |i: usize, j: usize| dot(&columns.row(i)[i.max(j)..], &columns.row(j)[i.max(j)..]);
        Matrix::from_rows(n, (0..n).map(|i| (0..n).map(|j| at(i.min(j), i.max(j))).collect::<Vec<_>>()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hilbert_s_inverse_is_whole() {
        let hilbert = Matrix::from_rows(3, (0..3).map(|i| [0, 1, 2].map(|j| 1.0 / f64::from(i + j + 1))));
        let inverse = Cholesky::of(&hilbert, 1e-12).expect("positive definite").inverse();
        let want = [[9.0, -36.0, 30.0], [-36.0, 192.0, -180.0], [30.0, -180.0, 180.0]];
        for (i, row) in want.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                // Condition number 524: some hundred roundings of the largest element.
                assert!((inverse.at(i, j) - value).abs() < 1e-10, "{i} {j}");
            }
        }
        let determinant = Cholesky::of(&hilbert, 1e-12).expect("positive definite").ln_determinant();
        assert!((determinant + etendue_core::maths::f64::ln(2160.0)).abs() < 1e-10, "{determinant}");
        let singular = Matrix::from_rows(2, [[1.0, 2.0], [2.0, 4.0]]);
        assert!(Cholesky::of(&singular, 1e-12).is_none());
    }
}
