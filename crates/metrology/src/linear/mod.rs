//! Small dense linear algebra in `f64`, for fits of a few hundred parameters.
//!
//! | item | purpose | file |
//! | --- | --- | --- |
//! | [`Matrix`] | row-major storage | here |
//! | [`Cholesky`] | normal equations, covariance | here |
//! | [`Orthogonal`] | ill-conditioned least squares | `orthogonal.rs` |
//! | [`eigen()`] | null vectors, undetermined directions of a fit | `orthogonal.rs` |
//!
//! Golub & Van Loan, Matrix Computations (4th ed., 2013): algorithms 4.2.1, 5.2.1 and 8.5.2. Sums run in index order.
//! Limitations: no pivoting, no sparse matrices, not for more than a few thousand columns.

mod orthogonal;

pub use orthogonal::{Eigen, Orthogonal, Solution, eigen};

/// A matrix, stored row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Matrix {
    /// A matrix of zeros.
    #[must_use]
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![0.0; rows * columns] }
    }

    /// The matrix with these rows, each of `columns` numbers. Panics if one is longer or shorter.
    #[must_use]
    pub fn from_rows<R: AsRef<[f64]>>(columns: usize, rows: impl IntoIterator<Item = R>) -> Self {
        let mut matrix = Self::zeros(0, columns);
        for row in rows {
            assert_eq!(row.as_ref().len(), columns, "a row of a matrix of {columns} columns");
            matrix.values.extend_from_slice(row.as_ref());
            matrix.rows += 1;
        }
        matrix
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Element in row `i`, column `j`.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.columns + j]
    }

    /// Mutable element in row `i`, column `j`.
    pub fn at_mut(&mut self, i: usize, j: usize) -> &mut f64 {
        &mut self.values[i * self.columns + j]
    }

    /// Row `i`.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..][..self.columns]
    }

    /// The product with a vector.
    #[must_use]
    pub fn times(&self, v: &[f64]) -> Vec<f64> {
        (0..self.rows).map(|i| dot(self.row(i), v)).collect()
    }

    /// AᵀA.
    #[must_use]
    pub fn gram(&self) -> Self {
        let n = self.columns;
        let mut gram = Self::zeros(n, n);
        for r in 0..self.rows {
            let row = self.row(r);
            for (i, a) in row.iter().enumerate() {
                let sums = &mut gram.values[i * n..][..=i];
                sums.iter_mut().zip(row).for_each(|(sum, b)| *sum += a * b);
            }
        }
        for i in 0..n {
            for j in 0..i {
                *gram.at_mut(j, i) = gram.at(i, j);
            }
        }
        gram
    }

    /// The product with a symmetric matrix.
    #[must_use]
    pub fn times_symmetric(&self, other: &Self) -> Self {
        Self::from_rows(other.columns, (0..self.rows).map(|i| other.times(self.row(i))))
    }

    /// The product with a scalar.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.values.iter_mut().for_each(|value| *value *= factor);
        self
    }

    /// vᵀ A v.
    #[must_use]
    pub fn form(&self, v: &[f64]) -> f64 {
        dot(v, &self.times(v))
    }
}

/// The inner product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The lower factor.
#[derive(Clone, Debug)]
pub struct Cholesky {
    lower: Matrix,
}

impl Cholesky {
    /// Factors a symmetric matrix; `None` if a pivot is less than `min_pivot` of its diagonal element: there the column depends
    /// linearly on those before it, to rounding.
    #[must_use]
    pub fn new(a: &Matrix, min_pivot: f64) -> Option<Self> {
        let n = a.rows();
        let mut lower = Matrix::zeros(n, n);
        for j in 0..n {
            let explained: f64 = lower.row(j)[..j].iter().map(|l| l * l).sum();
            let pivot = a.at(j, j) - explained;
            if pivot.is_nan() || pivot <= min_pivot * a.at(j, j) {
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

    /// Solves A x = b.
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
        // Row j contains column j of L⁻¹, from the diagonal on.
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

/// Minimum pivot relative to its diagonal element; below it the equations do not determine their unknowns.
const MIN_PIVOT: f64 = 1e-12;

/// Normal equations AᵀWA and AᵀWb, accumulated row by row.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    matrix: Matrix,
    right: Vec<f64>,
}

impl Normal {
    /// For this number of unknowns.
    pub(crate) fn new(unknowns: usize) -> Self {
        Self { matrix: Matrix::zeros(unknowns, unknowns), right: vec![0.0; unknowns] }
    }

    /// Adds the equation row · x = b with a weight.
    pub(crate) fn add(&mut self, row: &[f64], b: f64, weight: f64) {
        let places: Vec<usize> = (0..row.len()).collect();
        self.add_at(&places, row, b, weight);
    }

    /// The same for a row that is zero except at some indices.
    pub(crate) fn add_at(&mut self, places: &[usize], values: &[f64], b: f64, weight: f64) {
        for (i, a) in places.iter().zip(values) {
            let weighted = weight * a;
            self.right[*i] += weighted * b;
            places.iter().zip(values).for_each(|(j, other)| *self.matrix.at_mut(*i, *j) += weighted * other);
        }
    }

    /// The solution; `None` if the equations do not determine it.
    pub(crate) fn solve(&self) -> Option<Vec<f64>> {
        Some(Cholesky::new(&self.matrix, MIN_PIVOT)?.solve(&self.right))
    }

    /// The inverse of AᵀWA: the covariance of the solution for weights that are inverse variances.
    pub(crate) fn inverse(&self) -> Option<Matrix> {
        Some(Cholesky::new(&self.matrix, MIN_PIVOT)?.inverse())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hilbert_s_inverse_is_whole() {
        let hilbert = Matrix::from_rows(3, (0..3).map(|i| [0, 1, 2].map(|j| 1.0 / f64::from(i + j + 1))));
        let inverse = Cholesky::new(&hilbert, 1e-12).expect("positive definite").inverse();
        let expected = [[9.0, -36.0, 30.0], [-36.0, 192.0, -180.0], [30.0, -180.0, 180.0]];
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                // Condition number 524: about a hundred roundings of the largest element.
                assert!((inverse.at(i, j) - value).abs() < 1e-10, "{i} {j}");
            }
        }
        let determinant = Cholesky::new(&hilbert, 1e-12).expect("positive definite").ln_determinant();
        assert!((determinant + etendue_core::maths::f64::ln(2160.0)).abs() < 1e-10, "{determinant}");
        let singular = Matrix::from_rows(2, [[1.0, 2.0], [2.0, 4.0]]);
        assert!(Cholesky::new(&singular, 1e-12).is_none());
    }

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
