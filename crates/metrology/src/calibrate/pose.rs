//! Pose of a chart in front of the camera.

use etendue_core::maths::f64::sin_cos;
use glam::{DMat3, DVec2, DVec3};

use crate::{fit::null_vector, linear::Matrix};

/// Transform from the chart's frame to the camera's: X_camera = turn · X_chart + place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    pub rotation: DMat3,
    /// The chart's origin in the camera's frame, in the caller's unit of length.
    pub translation: DVec3,
}

impl Pose {
    /// The pose of a rotation vector (angle in rad times axis; Rodrigues) and a position.
    pub(super) fn from_numbers(numbers: &[f64]) -> Self {
        let vector = DVec3::new(numbers[0], numbers[1], numbers[2]);
        Self { rotation: rotation_from_vector(vector), translation: DVec3::new(numbers[3], numbers[4], numbers[5]) }
    }

    /// Its six parameters.
    pub(super) fn numbers(&self) -> [f64; 6] {
        let [v, p] = [vector(self.rotation), self.translation];
        [v.x, v.y, v.z, p.x, p.y, p.z]
    }

    /// A point of the chart in the camera's frame.
    #[must_use]
    pub fn camera(&self, chart: DVec2) -> DVec3 {
        self.rotation.x_axis * chart.x + self.rotation.y_axis * chart.y + self.translation
    }

    /// The distance of the camera from the chart's plane, positive if the chart is in front of it.
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.rotation.z_axis.dot(self.translation)
    }

    /// The pose that maps points of the chart to directions, by the homography of least |d × (H x)|; `None` if they do not
    /// determine one.
    pub(super) fn direct(points: &[(DVec2, DVec3)]) -> Option<Self> {
        let centre = points.iter().map(|p| p.0).sum::<DVec2>() / points.len() as f64;
        let size = points.iter().map(|p| (p.0 - centre).length()).sum::<f64>() / points.len() as f64;
        let rows = points.iter().flat_map(|(chart, d)| {
            let [x, y] = ((*chart - centre) / size).to_array();
            let point = [x, y, 1.0];
            let row = |a: usize, b: usize| {
                // Component c of d × (H x) = d_a (H x)_b − d_b (H x)_a.
                let mut row = [0.0; 9];
                for (k, value) in point.iter().enumerate() {
                    row[3 * b + k] = d[a] * value;
                    row[3 * a + k] = -d[b] * value;
                }
                row
            };
            [row(1, 2), row(2, 0), row(0, 1)]
        });
        let h = null_vector(&Matrix::from_rows(9, rows))?;
        let column = |k: usize| DVec3::new(h[k], h[3 + k], h[6 + k]);
        let ahead: f64 = points
            .iter()
            .map(|(c, d)| d.dot(column(0) * (c.x - centre.x) + column(1) * (c.y - centre.y) + column(2) * size))
            .sum();
        let sign = if ahead < 0.0 { -1.0 } else { 1.0 };
        let [a, b, place] = [0, 1, 2].map(|k| sign * column(k));
        let scale = 0.5 * (a.length() + b.length()) / size;
        // The orthonormal pair nearest to two vectors: along their sum and difference.
        let (sum, difference) = (a.normalize() + b.normalize(), a.normalize() - b.normalize());
        let (sum, difference) = (sum.try_normalize()?, difference.try_normalize()?);
        let half = core::f64::consts::FRAC_1_SQRT_2;
        let (x, y) = ((sum + difference) * half, (sum - difference) * half);
        let rotation = DMat3::from_cols(x, y, x.cross(y));
        let place = place / scale - rotation.x_axis * centre.x - rotation.y_axis * centre.y;
        place.is_finite().then_some(Self { rotation, translation: place })
    }
}

/// The rotation by |v| about v.
fn rotation_from_vector(v: DVec3) -> DMat3 {
    let angle = v.length();
    let cross = DMat3::from_cols(v.cross(DVec3::X), v.cross(DVec3::Y), v.cross(DVec3::Z));
    if angle < 1e-8 {
        return DMat3::IDENTITY + cross;
    }
    let (sin, cos) = sin_cos(angle);
    DMat3::IDENTITY + cross * (sin / angle) + cross * cross * ((1.0 - cos) / (angle * angle))
}

/// The rotation vector of a rotation of less than half a turn.
fn vector(rotation: DMat3) -> DVec3 {
    let [x, y, z] = [rotation.x_axis, rotation.y_axis, rotation.z_axis];
    let twice_sine = DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
    let cosine = 0.5 * (x.x + y.y + z.z - 1.0);
    let sine = 0.5 * twice_sine.length();
    let angle = etendue_core::maths::f64::atan2(sine, cosine);
    if sine > 1e-6 {
        return twice_sine * (0.5 * angle / sine);
    }
    if cosine > 0.0 {
        return 0.5 * twice_sine;
    }
    // Half a turn: 1 + R = 2 a aᵀ, whose longest column is along the axis.
    let sum = rotation + DMat3::IDENTITY;
    let axis = [sum.x_axis, sum.y_axis, sum.z_axis]
        .into_iter()
        .fold(DVec3::ZERO, |a, c| if c.length() > a.length() { c } else { a });
    axis.normalize() * angle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_and_vectors_are_each_other_s_inverse() {
        for v in [[0.0, 0.0, 0.0], [1e-9, 0.0, 0.0], [0.3, -0.2, 0.9], [2.0, 1.0, -1.5], [0.0, 3.12, 0.0]] {
            let rotation = rotation_from_vector(v.into());
            assert!(
                (rotation * rotation.transpose() - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-14)
            );
            let back = rotation_from_vector(vector(rotation));
            assert!((rotation - back).to_cols_array().iter().all(|x| x.abs() < 1e-7), "{v:?}");
        }
    }

    #[test]
    fn exact_directions_give_the_pose_back() {
        let pose = Pose {
            rotation: rotation_from_vector(DVec3::new(0.3, -0.4, 1.0)),
            translation: DVec3::new(0.1, -0.3, 2.0),
        };
        let points: Vec<_> = (0..30).map(|i| DVec2::new(f64::from(i % 6), f64::from(i / 6)) * 0.1).collect();
        let directions: Vec<_> = points.iter().map(|p| (*p, pose.camera(*p).normalize())).collect();
        let result = Pose::direct(&directions).expect("determined");
        assert!((result.translation - pose.translation).length() < 1e-9, "{result:?}");
        assert!((result.rotation - pose.rotation).to_cols_array().iter().all(|x| x.abs() < 1e-9), "{result:?}");
    }
}
