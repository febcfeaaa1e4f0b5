//! What every hit on a triangle asks of it, in one place in memory.

use glam::{DVec3, Vec3};

/// Angle, rad, by which vertices' normals may lean for their triangle to be taken for flat: files give places and normals
/// in some six digits.
const FLAT_RAD: f64 = 1e-5;

/// A triangle's own normal and material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Facet {
    /// Unit normal in the mesh's frame, by the winding.
    pub(crate) normal: Vec3,
    /// The material slot.
    pub(crate) slot: u16,
    /// Whether normals between the vertices' are all along the triangle's own.
    pub(crate) is_flat: bool,
}

impl Facet {
    /// Of a triangle's corners, its vertices' normals where they have any, and its material slot.
    pub(super) fn new([a, b, c]: [Vec3; 3], normals: Option<[Vec3; 3]>, slot: u16) -> Self {
        let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        Self { normal: normal.as_vec3(), slot, is_flat: normals.is_none_or(|normals| are_along(normals, normal)) }
    }
}

/// Whether vertices' normals all lie along a triangle's own: on either side, but all on one.
fn are_along(normals: [Vec3; 3], normal: DVec3) -> bool {
    let along = normals.map(|own| {
        let own = own.as_dvec3().normalize_or_zero();
        let along = own.dot(normal);
        if own.cross(normal).length() <= FLAT_RAD { along } else { 0.0 }
    });
    along.iter().all(|x| *x > 0.5) || along.iter().all(|x| *x < -0.5)
}
