//! Least squares by Householder reflections, with the conditioning of A, not of AᵀA.

use etendue_core::maths::f64::hypot;

use super::{Matrix, dot};

/// A factored design matrix A = Q R with at least as many rows as columns.
#[derive(Clone, Debug)]
pub struct Orthogonal {
    /// R on and above the diagonal, the reflections' vectors below it (their heads are stored separately).
    packed: Matrix,
    heads: Vec<f64>,
}

/// Solution of a least-squares problem.
#[derive(Clone, Debug)]
pub struct Solution {
    pub parameters: Vec<f64>,
    /// The sum of squared residuals.
    pub residual_squares: f64,
}

impl Orthogonal {
    /// Factors; `None` if there are fewer rows than columns, or if a column depends linearly on those before it to within `least`
    /// of its length.
    #[must_use]
    pub fn factor(a: &Matrix, min_pivot: f64) -> Option<Self> {
        let (m, n) = (a.rows(), a.columns());
        if m < n {
            return None;
        }
        let mut packed = a.clone();
        let mut heads = Vec::with_capacity(n);
        for k in 0..n {
            let column_norm = (0..m).map(|i| a.at(i, k) * a.at(i, k)).sum::<f64>().sqrt();
            let rest = (k..m).map(|i| packed.at(i, k) * packed.at(i, k)).sum::<f64>().sqrt();
            if rest.is_nan() || rest <= min_pivot * column_norm {
                return None;
            }
            let diagonal = if packed.at(k, k) > 0.0 { -rest } else { rest };
            heads.push(packed.at(k, k) - diagonal);
            *packed.at_mut(k, k) = diagonal;
            let column = packed.clone_column(k);
            for j in k + 1..n {
                let part = reflect(&column, heads[k], k, |i| packed.at(i, j));
                part.into_iter().enumerate().for_each(|(i, value)| *packed.at_mut(k + i, j) = value);
            }
        }
        Some(Self { packed, heads })
    }

    /// The least-squares solution for `b`.
    #[must_use]
    pub fn solve(&self, b: &[f64]) -> Solution {
        let (m, n) = (self.packed.rows(), self.packed.columns());
        let mut transformed = b.to_vec();
        for k in 0..n {
            let column = self.packed.clone_column(k);
            let part = reflect(&column, self.heads[k], k, |i| transformed[i]);
            transformed[k..m].copy_from_slice(&part);
        }
        let mut parameters = transformed[..n].to_vec();
        for i in (0..n).rev() {
            let known = dot(&self.packed.row(i)[i + 1..], &parameters[i + 1..]);
            parameters[i] = (parameters[i] - known) / self.packed.at(i, i);
        }
        Solution { parameters, residual_squares: transformed[n..].iter().map(|r| r * r).sum() }
    }

    /// (AᵀA)⁻¹ = R⁻¹ R⁻ᵀ: the covariance of the parameters for observations of unit variance.
    #[must_use]
    pub fn unit_covariance(&self) -> Matrix {
        let n = self.packed.columns();
        let mut inverse = Matrix::zeros(n, n);
        for j in 0..n {
            *inverse.at_mut(j, j) = 1.0 / self.packed.at(j, j);
            for i in (0..j).rev() {
                let known: f64 = (i + 1..=j).map(|k| self.packed.at(i, k) * inverse.at(k, j)).sum();
                *inverse.at_mut(i, j) = -known / self.packed.at(i, i);
            }
        }
        Matrix::from_rows(n, (0..n).map(|i| (0..n).map(|j| dot(inverse.row(i), inverse.row(j))).collect::<Vec<_>>()))
    }
}

impl Matrix {
    fn clone_column(&self, j: usize) -> Vec<f64> {
        (0..self.rows()).map(|i| self.at(i, j)).collect()
    }
}

/// Reflects a column, from row k on, at the plane perpendicular to v = (head, column below the diagonal).
fn reflect(column: &[f64], head: f64, k: usize, value: impl Fn(usize) -> f64) -> Vec<f64> {
    let below = &column[k + 1..];
    let v_v = head * head + below.iter().map(|v| v * v).sum::<f64>();
    let v_b = head * value(k) + below.iter().enumerate().map(|(i, v)| v * value(k + 1 + i)).sum::<f64>();
    let factor = 2.0 * v_b / v_v;
    std::iter::once(value(k) - factor * head)
        .chain(below.iter().enumerate().map(|(i, v)| value(k + 1 + i) - factor * v))
        .collect()
}

/// Eigenvalues in increasing order with their unit vectors.
#[derive(Clone, Debug)]
pub struct Eigen {
    /// The eigenvalues.
    pub values: Vec<f64>,
    /// Eigenvector of each.
    pub vectors: Vec<Vec<f64>>,
}

/// All eigenvalues of a symmetric matrix, to a few roundings of the largest.
#[must_use]
pub fn eigen(a: &Matrix) -> Eigen {
    const SWEEPS: usize = 60;
    let n = a.rows();
    let mut a = a.clone();
    let mut vectors =
        Matrix::from_rows(n, (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect::<Vec<_>>()));
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                rotated |= rotate(&mut a, &mut vectors, p, q);
            }
        }
        if !rotated {
            break;
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|i, j| a.at(*i, *i).total_cmp(&a.at(*j, *j)));
    Eigen {
        values: order.iter().map(|i| a.at(*i, *i)).collect(),
        vectors: order.iter().map(|i| vectors.row(*i).to_vec()).collect(),
    }
}

/// Sets the element (p, q) to zero; false if it is zero already, to rounding. Rows of `vectors` are the vectors.
fn rotate(a: &mut Matrix, vectors: &mut Matrix, p: usize, q: usize) -> bool {
    let (off, difference) = (a.at(p, q), a.at(q, q) - a.at(p, p));
    if off.abs() <= 1e-17 * (a.at(p, p).abs() + a.at(q, q).abs()) || off.abs() < f64::MIN_POSITIVE {
        return false;
    }
    let theta = difference / (2.0 * off);
    let t = if theta >= 0.0 { 1.0 } else { -1.0 } / (theta.abs() + hypot(theta, 1.0));
    let c = 1.0 / hypot(t, 1.0);
    let s = t * c;
    for k in 0..a.rows() {
        let (kp, kq) = (a.at(k, p), a.at(k, q));
        (*a.at_mut(k, p), *a.at_mut(k, q)) = (c * kp - s * kq, s * kp + c * kq);
    }
    for m in [a, vectors] {
        for k in 0..m.columns() {
            let (pk, qk) = (m.at(p, k), m.at(q, k));
            (*m.at_mut(p, k), *m.at_mut(q, k)) = (c * pk - s * qk, s * pk + c * qk);
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::super::dot;
    use super::*;

    #[test]
    fn a_line_through_points_with_its_uncertainty() {
        // y = 1 + 2 x, residuals +1, −2, +1: Σ = 6; (AᵀA)⁻¹ of x = 0, 1, 2 by hand: [5/6, −1/2; −1/2, 1/2].
        let a = Matrix::from_rows(2, [[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]]);
        let fit = Orthogonal::factor(&a, 1e-12).expect("two columns");
        let solution = fit.solve(&[2.0, 1.0, 6.0]);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
        assert!(near(solution.parameters[0], 1.0) && near(solution.parameters[1], 2.0), "{solution:?}");
        assert!((solution.residual_squares - 6.0).abs() < 1e-13, "{solution:?}");
        let c = fit.unit_covariance();
        assert!(near(c.at(0, 0), 5.0 / 6.0) && near(c.at(0, 1), -0.5) && near(c.at(1, 1), 0.5), "{c:?}");
        assert!(Orthogonal::factor(&Matrix::from_rows(2, [[1.0, 2.0], [2.0, 4.0], [3.0, 6.0]]), 1e-12).is_none());
        assert!(Orthogonal::factor(&Matrix::from_rows(2, [[1.0, 2.0]]), 1e-12).is_none());
    }

    #[test]
    fn a_chain_of_masses_has_its_known_frequencies() {
        // −1, 2, −1: eigenvalues 2 − 2 cos(kπ/5).
        let a = Matrix::from_rows(
            4,
            (0..4).map(|i: i32| {
                [0, 1, 2, 3].map(|j: i32| match (i - j).abs() {
                    0 => 2.0,
                    1 => -1.0,
                    _ => 0.0,
                })
            }),
        );
        let result = eigen(&a);
        let fifth = std::f64::consts::PI / 5.0;
        for (k, (value, vector)) in result.values.iter().zip(&result.vectors).enumerate() {
            let expected = 2.0 - 2.0 * etendue_core::maths::f64::cos((k + 1) as f64 * fifth);
            assert!((value - expected).abs() < 1e-14, "{value} {expected}");
            let image = a.times(vector);
            let off: f64 = image.iter().zip(vector).map(|(i, v)| (i - value * v).abs()).sum();
            assert!(off < 1e-14 && (dot(vector, vector) - 1.0).abs() < 1e-14, "{off}");
        }
    }
}
