//! Triangle meshes.
//!
//! A mesh is checked once, when it is built: after that every index is in range, every coordinate finite, every triangle has an area, and no two
//! triangles are the same. Triangles that cannot be intersected (zero area) or distinguished (exact duplicates, in any order of their corners) are
//! dropped and counted.

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::{MeshError, VertexAnimation, repeats::duplicates};

/// Maximum coordinate of a mesh: products of three coordinates must stay finite in f32.
const MAX_COORDINATE_M: f32 = 1e12;
/// Trees name leaves by 30 bits, and have no more of them than pieces of triangles.
const MAX_TRIANGLES: usize = (1 << 29) - 1;

/// Triangles over shared vertices, in the mesh's own frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    slots: Vec<u16>,
    facets: Vec<TriangleFacet>,
    /// Needed for every instance, so computed once.
    bounds: Option<(Vec3, Vec3)>,
    slot_count: usize,
    origin: DVec3,
    /// Vertex animation, if its vertices move.
    animation: Option<Box<VertexAnimation>>,
}

/// Number of triangles left out of a mesh, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DroppedTriangles {
    /// Triangles whose corners lie on one line or point.
    pub zero_area: usize,
    /// Triangles with the same three corners as an earlier one, in any order.
    pub duplicate: usize,
}

impl Mesh {
    /// Returns the size of its vertices and triangles, bytes; with vertex animation that of all frames.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let vertices = size_of_val(self.positions.as_slice()) + size_of_val(self.normals.as_slice());
        let triangles = size_of_val(self.triangles.as_slice()) + size_of_val(self.slots.as_slice());
        let frames = self.animation.as_ref().map_or(0, |animation| animation.frames().len() * vertices);
        vertices + size_of_val(self.uvs.as_slice()) + triangles + size_of_val(self.facets.as_slice()) + frames
    }

    /// A checked mesh. `normals` and `uvs` are one per vertex or empty; `slots` (material slots) one per triangle, or empty for slot 0
    /// throughout. Remaining triangles stay in their order; primitives are counted among them. Runs on the caller's thread pool.
    pub fn new(
        positions: Vec<Vec3>,
        normals: Vec<Vec3>,
        uvs: Vec<Vec2>,
        triangles: Vec<[u32; 3]>,
        slots: Vec<u16>,
    ) -> Result<(Self, DroppedTriangles), MeshError> {
        check_counts(&positions, &normals, &uvs, &triangles, &slots)?;
        check_vertices(&positions, &uvs)?;
        check_indices(positions.len(), &triangles)?;
        let slots = if slots.is_empty() { vec![0; triangles.len()] } else { slots };
        let (facets, bounds, slot_count, origin, animation) = (vec![], None, 0, DVec3::ZERO, None);
        let mut mesh =
            Self { positions, normals, uvs, triangles, slots, facets, bounds, slot_count, origin, animation };
        let dropped = mesh.drop_unusable();
        mesh.complete();
        Ok((mesh, dropped))
    }

    /// A checked mesh whose vertices move; its own are those of the first frame. As [`Mesh::new`], but triangles are dropped only if they
    /// have no area in any frame, or the same three vertices as an earlier one.
    pub fn animated(
        animation: VertexAnimation,
        uvs: Vec<Vec2>,
        triangles: Vec<[u32; 3]>,
        slots: Vec<u16>,
    ) -> Result<(Self, DroppedTriangles), MeshError> {
        for frame in animation.frames() {
            check_counts(&frame.positions, &frame.normals, &uvs, &triangles, &slots)?;
            check_vertices(&frame.positions, &uvs)?;
        }
        let first = animation.frames()[0].clone();
        check_indices(first.positions.len(), &triangles)?;
        let slots = if slots.is_empty() { vec![0; triangles.len()] } else { slots };
        let mut mesh = Self {
            positions: first.positions,
            normals: first.normals,
            uvs,
            triangles,
            slots,
            facets: vec![],
            bounds: None,
            slot_count: 0,
            origin: DVec3::ZERO,
            animation: Some(Box::new(animation)),
        };
        let dropped = mesh.drop_unusable();
        mesh.complete();
        Ok((mesh, dropped))
    }

    /// Computes the facets and bounds of the remaining triangles.
    fn complete(&mut self) {
        self.facets = (0..self.triangles.len()).into_par_iter().map(|i| self.new_facet(i)).collect();
        self.bounds = self.find_bounds();
        self.slot_count = self.slots.iter().max().map_or(0, |s| usize::from(*s) + 1);
    }

    /// Vertex animation; `None` if its vertices do not move.
    #[must_use]
    pub fn animation(&self) -> Option<&VertexAnimation> {
        self.animation.as_deref()
    }

    /// Sets the offset `origin` from this mesh's coordinates to those of its file: projected textures stay in place in the file's
    /// coordinates.
    #[must_use]
    pub fn with_origin(self, origin: DVec3) -> Self {
        Self { origin, ..self }
    }

    /// The offset from this mesh's coordinates to those of its file.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Vertex positions, m; for vertices that move, those of the first frame.
    #[must_use]
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Vertex normals, as given; empty if there are none.
    #[must_use]
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Texture coordinates, one per vertex; empty if there are none.
    #[must_use]
    pub fn uvs(&self) -> &[Vec2] {
        &self.uvs
    }

    /// The vertices of each triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The material slot of each triangle.
    #[must_use]
    pub fn slots(&self) -> &[u16] {
        &self.slots
    }

    fn new_facet(&self, i: usize) -> TriangleFacet {
        let normals = (!self.normals.is_empty()).then(|| self.triangles[i].map(|v| self.normals[v as usize]));
        TriangleFacet::new(self.corners(i as u32), normals, self.slots[i])
    }

    /// Precomputed data of a triangle.
    pub(crate) fn facet(&self, primitive: u32) -> &TriangleFacet {
        &self.facets[primitive as usize]
    }

    /// The corners of a triangle; for vertices that move, in the first frame.
    #[must_use]
    pub fn corners(&self, primitive: u32) -> [Vec3; 3] {
        self.triangles[primitive as usize].map(|v| self.positions[v as usize])
    }

    /// Number of material slots in use: the highest one and those below it.
    #[must_use]
    pub fn slot_count(&self) -> usize {
        self.slot_count
    }

    /// Minimum and maximum coordinates of the triangles, for vertices that move at any time; `None` without triangles.
    #[must_use]
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
    }

    /// The positions in every frame, or the only ones.
    fn all_positions(&self) -> Vec<&[Vec3]> {
        let Some(animation) = self.animation() else { return vec![&self.positions] };
        animation.frames().iter().map(|frame| &frame.positions[..]).collect()
    }

    fn find_bounds(&self) -> Option<(Vec3, Vec3)> {
        let of_frame = |positions: &[Vec3]| {
            let corners = self.triangles.iter().flatten().map(|v| positions[*v as usize]);
            corners.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        };
        let frames = self.all_positions().into_iter().filter_map(of_frame);
        frames.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    fn drop_unusable(&mut self) -> DroppedTriangles {
        let count = self.triangles.len();
        let frames = self.all_positions();
        let has_area = |triangle: u32| {
            let vertices = self.triangles[triangle as usize];
            frames.iter().any(|positions| !is_flat(vertices.map(|v| positions[v as usize])))
        };
        let mut is_kept: Vec<bool> = (0..count as u32).into_par_iter().map(has_area).collect();
        let usable = is_kept.iter().filter(|is_kept| **is_kept).count();
        let repeated = duplicates(&is_kept, |triangle| match self.animation {
            None => unordered_bits(self.corners(triangle)),
            Some(_) => unordered_vertices(self.triangles[triangle as usize]),
        });
        repeated.iter().for_each(|triangle| is_kept[*triangle as usize] = false);
        let mut keep = is_kept.iter();
        self.triangles.retain(|_| *keep.next().unwrap_or(&true));
        let mut keep = is_kept.iter();
        self.slots.retain(|_| *keep.next().unwrap_or(&true));
        DroppedTriangles { zero_area: count - usable, duplicate: repeated.len() }
    }
}

fn check_counts(
    positions: &[Vec3],
    normals: &[Vec3],
    uvs: &[Vec2],
    triangles: &[[u32; 3]],
    slots: &[u16],
) -> Result<(), MeshError> {
    check_count("normals", normals.len(), positions.len())?;
    check_count("texture coordinates", uvs.len(), positions.len())?;
    check_count("material slots", slots.len(), triangles.len())?;
    if triangles.len() > MAX_TRIANGLES {
        return Err(MeshError::TooManyTriangles { triangles: triangles.len() });
    }
    Ok(())
}

fn check_count(what: &'static str, actual: usize, expected: usize) -> Result<(), MeshError> {
    if actual != 0 && actual != expected {
        return Err(MeshError::Count { what, actual, expected });
    }
    Ok(())
}

fn check_vertices(positions: &[Vec3], uvs: &[Vec2]) -> Result<(), MeshError> {
    if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
        return Err(MeshError::NonFinitePosition { vertex });
    }
    if let Some(vertex) = positions.iter().position(|p| p.abs().max_element() > MAX_COORDINATE_M) {
        return Err(MeshError::TooFar { vertex });
    }
    match uvs.iter().position(|uv| !uv.is_finite()) {
        Some(vertex) => Err(MeshError::NonFiniteUv { vertex }),
        None => Ok(()),
    }
}

fn check_indices(vertices: usize, triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(vertex) = corners.iter().copied().find(|v| *v as usize >= vertices) {
            return Err(MeshError::IndexOutOfRange { triangle, vertex, vertices });
        }
    }
    Ok(())
}

/// True if the corners are collinear, in f64.
fn is_flat(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a) == DVec3::ZERO
}

/// The corners' bits in an order that does not depend on the triangle's.
fn unordered_bits(corners: [Vec3; 3]) -> [[u32; 3]; 3] {
    // Adding +0 makes −0 into +0.
    let mut bits = corners.map(|p| p.to_array().map(|x| (x + 0.0).to_bits()));
    bits.sort_unstable();
    bits
}

/// The vertices in an order that does not depend on the triangle's.
fn unordered_vertices(mut vertices: [u32; 3]) -> [[u32; 3]; 3] {
    vertices.sort_unstable();
    vertices.map(|vertex| [vertex, 0, 0])
}

/// Maximum angle, rad, of the vertices' normals to their triangle for it to count as flat: files give positions and normals in some six
/// digits.
const MAX_FLAT_ANGLE_RAD: f64 = 1e-5;

/// A triangle's own normal and material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TriangleFacet {
    /// Unit normal in the mesh's frame, by the winding.
    pub(crate) normal: Vec3,
    pub(crate) slot: u16,
    /// True if normals interpolated between the vertices' are all along the triangle's own.
    pub(crate) is_flat: bool,
}

impl TriangleFacet {
    /// From a triangle's corners, its vertices' normals if they have any, and its material slot.
    pub(super) fn new([a, b, c]: [Vec3; 3], normals: Option<[Vec3; 3]>, slot: u16) -> Self {
        let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        Self { normal: normal.as_vec3(), slot, is_flat: normals.is_none_or(|normals| are_along(normals, normal)) }
    }
}

/// True if vertices' normals all lie along a triangle's own: on either side, but all on one.
fn are_along(normals: [Vec3; 3], normal: DVec3) -> bool {
    let along = normals.map(|own| {
        let own = own.as_dvec3().normalize_or_zero();
        let along = own.dot(normal);
        if own.cross(normal).length() <= MAX_FLAT_ANGLE_RAD { along } else { 0.0 }
    });
    along.iter().all(|x| *x > 0.5) || along.iter().all(|x| *x < -0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<Vec3> {
        vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]
    }

    fn bare(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<(Mesh, DroppedTriangles), MeshError> {
        Mesh::new(positions, vec![], vec![], triangles, vec![])
    }

    #[test]
    fn what_cannot_be_hit_or_told_apart_is_dropped_and_counted() {
        let mut positions = square();
        positions.push(Vec3::new(-0.0, 0.0, -0.0)); // vertex 0 again, with another zero
        positions.push(Vec3::new(0.5, 0.0, 0.0)); // on the edge 0–1
        let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 0, 1], [0, 5, 1], [2, 0, 1], [1, 4, 2], [0, 3, 2]];
        let (mesh, dropped) =
            Mesh::new(positions, vec![], vec![], triangles, vec![0, 1, 2, 3, 4, 5, 6]).expect("legal");
        assert_eq!(dropped, DroppedTriangles { zero_area: 2, duplicate: 3 });
        assert_eq!((mesh.triangles(), mesh.slots()), (&[[0, 1, 2], [0, 2, 3]][..], &[0, 1][..]));
    }

    #[test]
    fn errors_name_the_vertex_or_triangle() {
        assert_eq!(
            bare(square(), vec![[0, 1, 2], [0, 2, 4]]),
            Err(MeshError::IndexOutOfRange { triangle: 1, vertex: 4, vertices: 4 })
        );
        let with = |value: f32| {
            let mut positions = square();
            positions[3].z = value;
            bare(positions, vec![[0, 1, 2]])
        };
        assert_eq!(with(f32::NAN), Err(MeshError::NonFinitePosition { vertex: 3 }));
        assert_eq!(with(f32::NEG_INFINITY), Err(MeshError::NonFinitePosition { vertex: 3 }));
        assert_eq!(with(-1e13), Err(MeshError::TooFar { vertex: 3 }));
        let uvs = vec![Vec2::ZERO, Vec2::NAN, Vec2::ZERO, Vec2::ZERO];
        assert_eq!(
            Mesh::new(square(), vec![], uvs, vec![[0, 1, 2]], vec![]),
            Err(MeshError::NonFiniteUv { vertex: 1 })
        );
        assert_eq!(
            Mesh::new(square(), vec![Vec3::Z; 3], vec![], vec![[0, 1, 2]], vec![]),
            Err(MeshError::Count { what: "normals", actual: 3, expected: 4 })
        );
    }

    #[test]
    fn a_mesh_of_nothing_is_legal_and_has_no_bounds() {
        let (mesh, dropped) = bare(vec![], vec![]).expect("legal");
        assert_eq!((mesh.bounds(), mesh.slot_count(), dropped), (None, 0, DroppedTriangles::default()));
    }
}
