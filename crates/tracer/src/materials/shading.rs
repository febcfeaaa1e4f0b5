//! The shading frame at a point, seen from one side.
//!
//! Both normals are turned to the viewer's side of the true surface. Where interpolation or a normal map has turned the
//! shading normal away from the viewer (at silhouettes of coarse meshes), it is bent back until the viewer is just above
//! its horizon: no black seams. A direction counts only where true surface and shading frame agree on its side: no
//! light leaks through a wall by an interpolated normal. What a mirror or glass sends to the wrong side leaves along the
//! true surface instead, so that neither loses light.

use etendue_core::Basis;
use glam::Vec3;

use crate::geometry::SurfacePoint;

/// Cosine that the viewer has at least in the shading frame.
const HORIZON: f32 = 1e-4;

/// A shading frame on the side of the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingFrame {
    basis: Basis,
    geometric_normal: Vec3,
    /// Towards the viewer, in the frame; z > 0.
    pub wo: Vec3,
    /// Whether the viewer is on the side that the surface's own geometric normal points to: the outside of a solid.
    pub front: bool,
}

impl ShadingFrame {
    /// The frame at `point` about `shading_normal` (unit, on the side of the point's geometric normal: the point's own,
    /// or one bent by a normal map) for a viewer in the unit direction `to_viewer` (render frame).
    #[must_use]
    #[inline(always)]
    pub fn new(point: &SurfacePoint, shading_normal: Vec3, to_viewer: Vec3) -> Self {
        let side = 1.0_f32.copysign(point.geometric_normal.dot(to_viewer));
        let geometric_normal = point.geometric_normal * side;
        let basis = Basis::about(facing(shading_normal * side, geometric_normal, to_viewer));
        let wo = basis.inward(to_viewer);
        let wo = Vec3::new(wo.x, wo.y, wo.z.max(0.5 * HORIZON));
        Self { basis, geometric_normal, wo, front: side > 0.0 }
    }

    /// The shading normal on the side of the viewer, unit, in the render frame.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.basis.z
    }

    /// A vector of the shading frame, in the render frame.
    pub(crate) fn turned_outward(&self, local: Vec3) -> Vec3 {
        self.basis.outward(local)
    }

    /// Cosine of a unit direction (render frame) to the normal of the true surface on the viewer's side.
    #[must_use]
    pub fn true_cos(&self, direction: Vec3) -> f32 {
        self.geometric_normal.dot(direction)
    }

    /// A unit direction of the render frame, in the shading frame: z > 0 on the viewer's side, z < 0 behind the
    /// surface. `None` where true surface and shading frame disagree on its side.
    #[must_use]
    pub fn inward(&self, direction: Vec3) -> Option<Vec3> {
        let local = self.basis.inward(direction);
        self.agrees(local, direction).then_some(local)
    }

    /// A unit direction of the shading frame, in the render frame and of unit length again; `None` where true surface and shading
    /// frame disagree on its side.
    #[must_use]
    pub fn outward(&self, local: Vec3) -> Option<Vec3> {
        let direction = self.basis.outward(local);
        // One step of Newton's towards unit length: what is off by a rounding or two is then off by its square.
        let direction = direction * (1.5 - 0.5 * direction.length_squared());
        self.agrees(local, direction).then_some(direction)
    }

    /// A unit direction of the shading frame, in the render frame, brought to the side of the true surface that it has in the shading frame: where
    /// they disagree, just off the plane of the true surface.
    #[must_use]
    pub fn outward_to_horizon(&self, local: Vec3) -> Vec3 {
        let normal = self.geometric_normal * 1.0_f32.copysign(local.z);
        let direction = self.basis.outward(local);
        (direction + normal * (HORIZON - normal.dot(direction))).normalize_or(normal)
    }

    fn agrees(&self, local: Vec3, direction: Vec3) -> bool {
        let above = self.geometric_normal.dot(direction);
        (local.z > 0.0 && above > 0.0) || (local.z < 0.0 && above < 0.0)
    }
}

/// The shading normal, bent towards the viewer where it looks away.
fn facing(normal: Vec3, geometric_normal: Vec3, to_viewer: Vec3) -> Vec3 {
    let cos = normal.dot(to_viewer);
    if cos >= HORIZON {
        return normal;
    }
    let bent = (normal + to_viewer * (HORIZON - cos)).normalize_or(geometric_normal);
    if bent.dot(to_viewer) > 0.0 { bent } else { geometric_normal }
}
