//! Where a member of the front stands and how it is turned.

use super::Line;
use core::f64::consts::PI;
use etendue_core::maths::f64::sin_cos;
use glam::{DMat3, DVec3};

/// A frame of its own within the camera frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Its origin in the camera frame, mm.
    pub origin_mm: DVec3,
    /// From it to the camera frame: a rotation.
    pub rotation: DMat3,
}

impl Placement {
    /// A frame that was turned, at first parallel to the camera frame, right-handed about the camera's x, then its y, then
    /// its z axis, degrees.
    #[must_use]
    pub fn turned(origin_mm: DVec3, degrees: [f64; 3]) -> Self {
        let [(sx, cx), (sy, cy), (sz, cz)] = degrees.map(|d| sin_cos(d * PI / 180.0));
        let x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
        let y = DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
        let z = DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
        Self { origin_mm, rotation: z * y * x }
    }

    pub(super) fn inward(&self, line: Line) -> Line {
        let back = self.rotation.transpose();
        Line { point_mm: back * (line.point_mm - self.origin_mm), direction: back * line.direction }
    }

    pub(super) fn outward(&self, line: Line) -> Line {
        Line { point_mm: self.rotation * line.point_mm + self.origin_mm, direction: self.rotation * line.direction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_positive_turn_about_x_leans_the_upper_edge_towards_the_camera() {
        let placement = Placement::turned(DVec3::new(0.0, 0.0, 500.0), [30.0, 0.0, 0.0]);
        let upper = placement.outward(Line { point_mm: DVec3::new(0.0, -100.0, 0.0), direction: DVec3::Z });
        // y is down: the upper edge lies at 500 − 100 sin 30° and its normal looks up.
        assert!((upper.point_mm.z - 450.0).abs() < 1e-12 && (upper.direction.y + 0.5).abs() < 1e-15);
        let back = placement.inward(upper);
        assert!((back.point_mm - DVec3::new(0.0, -100.0, 0.0)).length() < 1e-12);
    }

    #[test]
    fn a_positive_turn_about_y_looks_to_the_right() {
        let placement = Placement::turned(DVec3::ZERO, [0.0, 20.0, 0.0]);
        assert!((placement.rotation * DVec3::Z).x > 0.3);
        assert!((placement.rotation.determinant() - 1.0).abs() < 1e-15);
    }
}
