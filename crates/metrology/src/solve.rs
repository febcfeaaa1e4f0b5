//! Weighted linear least squares by the normal equations.

/// AᵀWA and AᵀWb, gathered row by row.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl Normal {
    /// For so many unknowns.
    pub(crate) fn new(unknowns: usize) -> Self {
        Self { matrix: vec![vec![0.0; unknowns]; unknowns], right: vec![0.0; unknowns] }
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
            let line = &mut self.matrix[*i];
            places.iter().zip(values).for_each(|(j, other)| line[*j] += weighted * other);
        }
    }

    /// AᵀWA.
    pub(crate) fn matrix(&self) -> &[Vec<f64>] {
        &self.matrix
    }

    /// The solution; `None` where the equations do not determine it.
    pub(crate) fn solve(&self) -> Option<Vec<f64>> {
        Some(substitute(&cholesky(&self.matrix)?, &self.right))
    }

    /// The inverse of AᵀWA: the covariance of the solution for weights that are inverse variances.
    pub(crate) fn inverse(&self) -> Option<Vec<Vec<f64>>> {
        let lower = cholesky(&self.matrix)?;
        let count = self.right.len();
        let unit = |i: usize| (0..count).map(|j| f64::from(u8::from(i == j))).collect::<Vec<_>>();
        Some((0..count).map(|i| substitute(&lower, &unit(i))).collect())
    }
}

/// The lower factor of a symmetric matrix; `None` where it is singular to rounding.
fn cholesky(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let count = matrix.len();
    let mut lower = vec![vec![0.0; count]; count];
    for i in 0..count {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = matrix[i][j] - known;
            if i == j {
                if rest.is_nan() || rest <= 1e-12 * matrix[i][i] {
                    return None;
                }
                lower[i][i] = rest.sqrt();
            } else {
                lower[i][j] = rest / lower[j][j];
            }
        }
    }
    Some(lower)
}

fn substitute(lower: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let count = right.len();
    let mut x = right.to_vec();
    for i in 0..count {
        let known: f64 = (0..i).map(|k| lower[i][k] * x[k]).sum();
        x[i] = (x[i] - known) / lower[i][i];
    }
    for i in (0..count).rev() {
        let known: f64 = (i + 1..count).map(|k| lower[k][i] * x[k]).sum();
        x[i] = (x[i] - known) / lower[i][i];
    }
    x
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
        assert!((covariance[1][1] - 1.0 / 40.0).abs() < 1e-14);
        let mut singular = Normal::new(2);
        singular.add(&[1.0, 2.0], 1.0, 1.0);
        assert!(singular.solve().is_none());
    }
}
