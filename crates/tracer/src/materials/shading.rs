//! The shading frame at a point, seen from one side.
//!
//! Both normals are turned to the viewer's side of the true surface. If interpolation or a normal map has turned the shading normal away from the
//! viewer (at silhouettes of coarse meshes), it is bent back until the viewer is just above its horizon: no black seams. A direction counts only if
//! true surface and shading frame agree on its side: no light leaks through a wall by an interpolated normal. Light that a mirror or glass sends to
//! the wrong side leaves along the true surface instead, so that neither loses light.
//!
//! Normal maps: normals of a finer surface than the mesh, stored as colours.
//!
//! A texel (r, g, b), linear, 0 to 1, is the vector (2r − 1, 2g − 1, 2b − 1) of the tangent frame: x along ∂p/∂u, y along ∂p/∂v, z along the
//! surface's own shading normal. Images have green up in the texture (OpenGL) or down (DirectX). The x and y parts are multiplied by the strength,
//! the result is normalised. Filtered texels are shorter than unit vectors; the spread of normals that their length indicates is left out, as is the
//! displacement itself: outlines and shadows are those of the mesh. If an image repeats mirrored, its slopes are not inverted. Bytes of 127 and 128
//! are both next to 0: |x| below 1/254 is taken as 0, so that a flat map is flat.

use etendue_core::Basis;
use glam::{Vec2, Vec3};

use super::MaterialError;
use crate::geometry::SurfacePoint;
use crate::textures::{ImageTexture, Lookup, TextureId};

/// Minimum cosine of the viewer in the shading frame.
const HORIZON: f32 = 1e-4;

/// A shading frame on the side of the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingFrame {
    basis: Basis,
    geometric_normal: Vec3,
    /// Unit vector towards the viewer, in the frame; z > 0.
    pub wo: Vec3,
    /// True if the viewer is on the side that the surface's own geometric normal points to: the outside of a solid.
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

    /// A unit direction of the render frame, in the shading frame: z > 0 on the viewer's side, z < 0 behind the surface. `None` if true
    /// surface and shading frame disagree on its side.
    #[must_use]
    pub fn inward(&self, direction: Vec3) -> Option<Vec3> {
        let local = self.basis.inward(direction);
        self.agrees(local, direction).then_some(local)
    }

    /// A unit direction of the shading frame, in the render frame and of unit length again; `None` if true surface and shading frame
    /// disagree on its side.
    #[must_use]
    pub fn outward(&self, local: Vec3) -> Option<Vec3> {
        let direction = self.basis.outward(local);
        // One Newton step towards unit length: an error of a rounding or two becomes its square.
        let direction = direction * (1.5 - 0.5 * direction.length_squared());
        self.agrees(local, direction).then_some(direction)
    }

    /// A unit direction of the shading frame, in the render frame, moved to the side of the true surface that it has in the shading frame.
    /// If they disagree, it lies just off the plane of the true surface.
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

/// The shading normal, bent towards the viewer if it faces away.
fn facing(normal: Vec3, geometric_normal: Vec3, to_viewer: Vec3) -> Vec3 {
    let cos = normal.dot(to_viewer);
    if cos >= HORIZON {
        return normal;
    }
    let bent = (normal + to_viewer * (HORIZON - cos)).normalize_or(geometric_normal);
    if bent.dot(to_viewer) > 0.0 { bent } else { geometric_normal }
}

/// Direction of the green channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GreenDirection {
    /// To greater v: y up (OpenGL).
    #[default]
    Up,
    /// To smaller v: y down (DirectX).
    Down,
}

/// A normal map on a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalMap {
    texture: TextureId,
    slopes: Vec2,
}

/// The strongest exaggeration of slopes.
const MAX_STRENGTH: f64 = 10.0;

/// Half the width of a byte's step about 0, of −1 to 1.
const FLAT: f32 = 1.0 / 254.0;

impl NormalMap {
    /// The normals of a texture of linear colours, their slopes multiplied by `strength` (0 to 10, 1 as painted).
    ///
    /// # Errors
    /// If the strength is out of range.
    pub fn new(texture: TextureId, green: GreenDirection, strength: f64) -> Result<Self, MaterialError> {
        if !(0.0..=MAX_STRENGTH).contains(&strength) {
            return Err(MaterialError::NormalStrength { strength });
        }
        let strength = strength as f32;
        let y = if green == GreenDirection::Up { strength } else { -strength };
        Ok(Self { texture, slopes: Vec2::new(strength, y) })
    }

    /// The texture that holds the normals.
    #[must_use]
    pub fn texture(&self) -> TextureId {
        self.texture
    }

    /// The normal about the unit `normal`, with unit tangents along u and v. The result is unit, and on the side of `normal`; it is
    /// `normal` itself if the tangents or the texel give no direction.
    pub(super) fn at(&self, textures: &[ImageTexture], lookup: &Lookup, normal: Vec3, [u, v]: [Vec3; 2]) -> Vec3 {
        let [r, g, b] = textures[self.texture.0 as usize].sample(lookup);
        let slopes = Vec3::new(centred(r) * self.slopes.x, centred(g) * self.slopes.y, centred(b).max(0.0));
        // Tangents of the shading normal's own plane, so that a flat map changes nothing.
        let along = |t: Vec3| (t - normal * normal.dot(t)).normalize_or_zero();
        let bent = along(u) * slopes.x + along(v) * slopes.y + normal * slopes.z;
        bent.try_normalize().filter(|n| n.dot(normal) > 0.0).unwrap_or(normal)
    }
}

fn centred(channel: f32) -> f32 {
    let x = 2.0 * channel - 1.0;
    if x.abs() < FLAT { 0.0 } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::textures::{Sampling, Texels};

    fn mapped_normal(byte: [u8; 3], green: GreenDirection, strength: f64, normal: Vec3, tangents: [Vec3; 2]) -> Vec3 {
        let texture = ImageTexture::new(1, 1, Texels::Linear8(vec![byte]), Sampling::default()).expect("a texel");
        let map = NormalMap::new(TextureId(0), green, strength).expect("a map");
        map.at(&[texture], &Lookup::point(Vec2::splat(0.5)), normal, tangents)
    }

    #[test]
    fn colours_tell_directions_of_the_texture() {
        let flat = [Vec3::X, Vec3::Y];
        for byte in [[127, 127, 255], [128, 128, 255], [127, 128, 255]] {
            assert_eq!(mapped_normal(byte, GreenDirection::Up, 1.0, Vec3::Z, flat), Vec3::Z);
        }
        // (2 · 204/255 − 1, 0, 2 · 230/255 − 1) = (0.6, 0, 0.804).
        let right = mapped_normal([204, 128, 230], GreenDirection::Up, 1.0, Vec3::Z, flat);
        assert!((right - Vec3::new(0.6, 0.0, 0.803_922).normalize()).length() < 1e-5, "{right}");
        let up = mapped_normal([128, 204, 230], GreenDirection::Up, 1.0, Vec3::Z, flat);
        let down = mapped_normal([128, 204, 230], GreenDirection::Down, 1.0, Vec3::Z, flat);
        assert!(up.y > 0.5 && (up.y + down.y).abs() < 1e-7 && up.z == down.z);
        let strong = mapped_normal([204, 128, 230], GreenDirection::Up, 2.0, Vec3::Z, flat);
        assert!((strong.x / strong.z - 2.0 * right.x / right.z).abs() < 1e-5);
        assert_eq!(mapped_normal([204, 128, 230], GreenDirection::Up, 0.0, Vec3::Z, flat), Vec3::Z);
    }

    #[test]
    fn leaning_and_useless_tangents_are_borne() {
        let normal = Vec3::new(0.6, 0.0, 0.8);
        let n = mapped_normal([204, 128, 230], GreenDirection::Up, 1.0, normal, [Vec3::X, Vec3::Y]);
        assert!((n.length() - 1.0).abs() < 1e-6 && n.dot(Vec3::new(0.8, 0.0, -0.6)) > 0.5, "{n}");
        assert_eq!(mapped_normal([204, 230, 230], GreenDirection::Up, 1.0, normal, [normal, Vec3::ZERO]), normal);
        assert_eq!(
            mapped_normal([0, 0, 0], GreenDirection::Up, 1.0, Vec3::Z, [Vec3::X, Vec3::Y]),
            Vec3::Z,
            "below the surface"
        );
        assert!(NormalMap::new(TextureId(0), GreenDirection::Up, f64::NAN).is_err());
    }
}
