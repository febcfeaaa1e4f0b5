//! Plane to plane in perspective: x′ ~ H x.
//!
//! By the normalised direct linear transformation (Hartley & Zisserman, Multiple View Geometry, 2nd ed. 2004,
//! algorithm 4.2), both sets moved to their centroid and scaled to a mean distance of √2.

use crate::linear::{Matrix, eigen};
use glam::{DMat3, DVec2, DVec3};

/// A homography, with 1 at the lower right of its matrix where the origin is not at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homography {
    /// The matrix that takes (x, y, 1) to a multiple of (x′, y′, 1).
    pub matrix: DMat3,
}

impl Homography {
    /// The point's image; `None` at infinity and beyond (where the third number is not positive).
    #[must_use]
    pub fn image(&self, point: DVec2) -> Option<DVec2> {
        let image = self.matrix * point.extend(1.0);
        (image.z > 0.0).then(|| image.truncate() / image.z)
    }

    /// The homography nearest to pairs of points by the direct linear transformation; `None` where they do not determine one
    /// (fewer than four, or too many on a line).
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

/// The moving and scaling that brings points to the origin at a mean distance of √2.
fn normalisation(points: impl Iterator<Item = DVec2> + Clone) -> DMat3 {
    let count = points.clone().count() as f64;
    let centre = points.clone().sum::<DVec2>() / count;
    let distance = points.map(|p| (p - centre).length()).sum::<f64>() / count;
    let scale = std::f64::consts::SQRT_2 / distance;
    DMat3::from_cols(DVec3::X * scale, DVec3::Y * scale, (-centre * scale).extend(1.0))
}

/// The unit vector v of least |A v|; `None` where a second one is as good, to 1e-12 of the largest.
#[must_use]
pub fn null_vector(a: &Matrix) -> Option<Vec<f64>> {
    let found = eigen(&a.gram());
    let n = found.values.len();
    let single = found.values[1] > 1e-12 * found.values[n - 1];
    single.then(|| found.vectors[0].clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> impl Iterator<Item = DVec2> {
        (0..6).flat_map(|i| (0..5).map(move |j| DVec2::new(f64::from(i), f64::from(j)) * 30.0))
    }

    #[test]
    fn exact_pairs_give_the_homography_back() {
        let rows = [[2.0, 0.3, 100.0], [-0.2, 1.8, 700.0], [4e-4, -2e-4, 1.0]];
        let truth = Homography { matrix: DMat3::from_cols_array_2d(&rows).transpose() };
        let pairs: Vec<_> = grid().map(|p| [p, truth.image(p).expect("before the plane")]).collect();
        let found = Homography::direct(&pairs).expect("determined");
        for [from, to] in &pairs {
            // A thousand pixels, conditioned by normalisation: some hundred roundings.
            assert!((found.image(*from).expect("finite") - *to).length() < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn points_on_a_line_determine_none() {
        let pairs: Vec<_> = (0..9).map(|i| DVec2::new(f64::from(i), 2.0 * f64::from(i))).map(|p| [p, p]).collect();
        assert!(Homography::direct(&pairs).is_none() && Homography::direct(&pairs[..3]).is_none());
    }
}
