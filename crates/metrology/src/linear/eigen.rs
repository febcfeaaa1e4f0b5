//! Eigenvalues of a symmetric matrix by Jacobi's rotations.

use super::Matrix;
use etendue_core::maths::f64::hypot;

/// Eigenvalues in rising order with their unit vectors.
#[derive(Clone, Debug)]
pub struct Eigen {
    /// The eigenvalues.
    pub values: Vec<f64>,
    /// The vector of each.
    pub vectors: Vec<Vec<f64>>,
}

/// All eigenvalues of a symmetric matrix, to some roundings of the largest.
#[must_use]
pub fn eigen(a: &Matrix) -> Eigen {
    const SWEEPS: usize = 60;
    let n = a.rows();
    let mut a = a.clone();
    let mut vectors =
        Matrix::from_rows(n, (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect::<Vec<_>>()));
    for _ in 0..SWEEPS {
        let mut turned = false;
        for p in 0..n {
            for q in p + 1..n {
                turned |= rotate(&mut a, &mut vectors, p, q);
            }
        }
        if !turned {
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

/// Makes the element (p, q) zero; false where it is already, to rounding. Rows of `vectors` are the vectors.
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
    use super::*;
    use crate::linear::matrix::dot;

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
        let found = eigen(&a);
        let fifth = std::f64::consts::PI / 5.0;
        for (k, (value, vector)) in found.values.iter().zip(&found.vectors).enumerate() {
            let want = 2.0 - 2.0 * etendue_core::maths::f64::cos((k + 1) as f64 * fifth);
            assert!((value - want).abs() < 1e-14, "{value} {want}");
            let image = a.times(vector);
            let off: f64 = image.iter().zip(vector).map(|(i, v)| (i - value * v).abs()).sum();
            assert!(off < 1e-14 && (dot(vector, vector) - 1.0).abs() < 1e-14, "{off}");
        }
    }
}
