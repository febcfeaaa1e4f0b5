//! Coordinate frames: bases about a direction, camera poses.

use glam::{DMat3, DVec3, Vec3};

/// A right-handed orthonormal basis whose third axis is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// Given axis.
    pub z: Vec3,
}

impl Basis {
    /// A basis about the unit vector `z`, continuous except at z = −Z (Duff et al. 2017, listing 2).
    #[must_use]
    pub fn about(z: Vec3) -> Self {
        let sign = 1.0_f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: Vec3::new(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// Transforms a vector from the basis to the frame that the basis is written in.
    #[must_use]
    pub fn outward(&self, local: Vec3) -> Vec3 {
        self.x * local.x + self.y * local.y + self.z * local.z
    }

    /// Transforms a vector to the basis from the frame that the basis is written in.
    #[must_use]
    pub fn inward(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }
}

/// Pose of a camera: transform from the camera frame (x right, y down, z forward; origin at the centre of the entrance pupil) to the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// Centre of the entrance pupil in the world, m.
    pub position_m: DVec3,
    /// Columns: the camera's x, y and z axes in the world. A rotation.
    pub rotation: DMat3,
}

impl CameraPose {
    /// Returns a camera at `position_m` that looks at `target_m`; `up` is the world direction that appears upwards. `None` if position and target coincide or
    /// the view is along `up`.
    #[must_use]
    pub fn looking_at(position_m: DVec3, target_m: DVec3, up: DVec3) -> Option<Self> {
        let z = (target_m - position_m).try_normalize()?;
        let x = z.cross(up).try_normalize().filter(|_| z.cross(up).length() > 1e-9 * up.length())?;
        Some(Self { position_m, rotation: DMat3::from_cols(x, z.cross(x), z) })
    }

    /// Returns the pose for the rows of a 3 × 4 matrix, translation in m, from the camera frame to the world.
    #[must_use]
    pub fn from_rows(rows: &[[f64; 4]; 3]) -> Self {
        let column = |k: usize| DVec3::new(rows[0][k], rows[1][k], rows[2][k]);
        Self { position_m: column(3), rotation: DMat3::from_cols(column(0), column(1), column(2)) }
    }

    /// Transforms a direction from the camera frame to the world.
    #[must_use]
    pub fn direction_to_world(&self, direction: DVec3) -> DVec3 {
        self.rotation * direction
    }

    /// Transforms a point from the camera frame (m) to the render frame (world axes, origin at the entrance pupil), m.
    #[must_use]
    pub fn point_to_render(&self, point_m: DVec3) -> DVec3 {
        self.rotation * point_m
    }

    /// Transforms a point from the world (m) to the camera frame, m.
    #[must_use]
    pub fn point_to_camera(&self, world_m: DVec3) -> DVec3 {
        self.rotation.transpose() * (world_m - self.position_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_that_looks_forward_has_x_right_and_y_down() {
        let pose = CameraPose::looking_at(DVec3::ZERO, DVec3::X, DVec3::Z).expect("a legal view");
        assert!((pose.rotation * DVec3::X - DVec3::NEG_Y).length() < 1e-12, "right is −y in a y-left world");
        assert!((pose.rotation * DVec3::Y - DVec3::NEG_Z).length() < 1e-12, "down is −z in a z-up world");
        assert!((pose.rotation.determinant() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_camera_that_looks_along_up_is_refused() {
        assert!(CameraPose::looking_at(DVec3::ZERO, DVec3::Z, DVec3::Z).is_none());
        assert!(CameraPose::looking_at(DVec3::ONE, DVec3::ONE, DVec3::Z).is_none());
    }

    #[test]
    fn a_basis_is_orthonormal_and_right_handed() {
        for z in [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::new(0.6, -0.48, -0.64), Vec3::new(-0.36, 0.48, 0.8)] {
            let b = Basis::about(z);
            assert!((b.x.cross(b.y) - b.z).length() < 1e-6);
            assert!(b.x.dot(b.y).abs() < 1e-6 && (b.x.length() - 1.0).abs() < 1e-6);
            assert!((b.outward(b.inward(Vec3::new(1.0, 2.0, 3.0))) - Vec3::new(1.0, 2.0, 3.0)).length() < 1e-5);
        }
    }
}
