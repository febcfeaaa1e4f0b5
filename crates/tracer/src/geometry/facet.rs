//! What every hit on a triangle asks of it, in one place in memory.

use super::Mesh;
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

/// The facets of a mesh, one a triangle.
pub(super) fn facets(mesh: &Mesh) -> Vec<Facet> {
    (0..mesh.triangles().len()).map(|i| facet(mesh, i)).collect()
}

fn facet(mesh: &Mesh, i: usize) -> Facet {
    let [a, b, c] = mesh.corners(i as u32).map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
    Facet { normal: normal.as_vec3(), slot: mesh.slots()[i], is_flat: is_flat(mesh, i, normal) }
}

/// On either side, but all on one.
fn is_flat(mesh: &Mesh, i: usize, normal: DVec3) -> bool {
    if mesh.normals().is_empty() {
        return true;
    }
    let along = mesh.triangles()[i].map(|v| {
        let own = mesh.normals()[v as usize].as_dvec3().normalize_or_zero();
        let along = own.dot(normal);
        if own.cross(normal).length() <= FLAT_RAD { along } else { 0.0 }
    });
    along.iter().all(|x| *x > 0.5) || along.iter().all(|x| *x < -0.5)
}
