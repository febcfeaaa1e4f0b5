//! Affine maps of colours: 4 × 4 matrices whose last row is 0 0 0 1.

/// The upper three rows; the fourth column is what is added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine(pub [[f64; 4]; 3]);

impl Affine {
    /// Changes nothing.
    pub const IDENTITY: Self = Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);

    /// A matrix and what is added.
    #[must_use]
    pub fn new(rows: [[f64; 3]; 3], offset: [f64; 3]) -> Self {
        Self([0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2], offset[i]]))
    }

    /// The colour's image.
    #[must_use]
    pub fn apply(&self, v: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2] + row[3])
    }

    /// This map, then `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self(next.0.map(|row| {
            core::array::from_fn(|j| {
                let sum: f64 = (0..3).map(|k| row[k] * self.0[k][j]).sum();
                if j == 3 { sum + row[3] } else { sum }
            })
        }))
    }

    /// The map back; `None` where there is none.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let m = &self.0;
        let minor = |i: usize, j: usize| {
            let ([a, b], [c, d]) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
            m[a][c] * m[b][d] - m[a][d] * m[b][c]
        };
        let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
        if determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| minor(j, i) / determinant));
        let offset = rows.map(|row| -(0..3).map(|k| row[k] * m[k][3]).sum::<f64>());
        Some(Self::new(rows, offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_undoes_and_a_flat_map_has_none() {
        let map = Affine::new([[2.0, 1.0, 0.0], [0.0, 1.0, -1.0], [1.0, 0.0, 1.0]], [0.1, -0.2, 0.3]);
        let back = map.then(&map.inverse().expect("determinant 1"));
        for (row, want) in back.0.iter().zip(Affine::IDENTITY.0) {
            assert!((0..4).all(|j| (row[j] - want[j]).abs() < 1e-14), "{back:?}");
        }
        assert_eq!(map.apply([1.0, 2.0, 3.0]), [4.1, -1.2, 4.3]);
        assert_eq!(Affine::new([[1.0; 3]; 3], [0.0; 3]).inverse(), None);
    }
}
