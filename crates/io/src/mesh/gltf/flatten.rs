//! Flattening of placed primitives into one mesh.

use etendue_scene::{asset::MeshAsset, limits};
use glam::{DAffine3, DMat3, DVec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::{json::Root, json::validation::Checked};

use super::super::vertex::{check_corners, check_range, middle_of_far, relative, unit};
use super::accessor::{finite, numbers};
use super::nodes::{PlacedMesh, SkinWeights};
use super::{buffers::Buffers, material::UvLayout};
use crate::Problem;

/// Bytes that a corner and a vertex take during conversion.
const CORNER_BYTES: u64 = 24;
const VERTEX_BYTES: u64 = 120;

/// Vertices of a primitive that its triangles use, in the order of first use.
struct PrimitiveVertices {
    positions: Vec<[f64; 3]>,
    /// One per vertex, or none.
    normals: Vec<[f64; 3]>,
    /// One per vertex, or none.
    uvs: Vec<[f64; 2]>,
    triangles: Vec<[u32; 3]>,
    /// Index of each vertex in the file's accessors.
    sources: Vec<usize>,
    weights: Option<SkinWeights>,
}

/// All placed meshes in the file's axes; `slot_of` gives the slot and texture layout of a material.
pub(super) fn flatten(
    root: &Root,
    buffers: &Buffers,
    placed: &[PlacedMesh],
    mut slot_of: impl FnMut(Option<usize>) -> Result<(u16, UvLayout), Problem>,
) -> Result<MeshAsset, Problem> {
    check_size(root, placed)?;
    let has = |semantic: Semantic| {
        let key = Checked::Valid(semantic);
        placed
            .iter()
            .filter_map(|p| root.meshes.get(p.mesh))
            .flat_map(|m| &m.primitives)
            .any(|p| p.attributes.contains_key(&key))
    };
    let mut builder = GltfMeshBuilder {
        has_normals: has(Semantic::Normals),
        has_uvs: (0..8).any(|set| has(Semantic::TexCoords(set))),
        ..GltfMeshBuilder::default()
    };
    for (number, mesh) in root.meshes.iter().enumerate() {
        let places: Vec<&PlacedMesh> = placed.iter().filter(|p| p.mesh == number).collect();
        if places.is_empty() {
            continue;
        }
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let message = |problem| format!("mesh {number}, primitive {i}: {problem}");
            if !is_surface(primitive) {
                builder.lines += 1;
                continue;
            }
            let (slot, layout) = slot_of(primitive.material.map(|m| m.value()))?;
            let parts = PrimitiveVertices::read(root, buffers, primitive, &layout).map_err(message)?;
            builder.bare_vertices += if parts.uvs.is_empty() { parts.positions.len() * places.len() } else { 0 };
            for place in &places {
                builder.add(&parts, place, slot).map_err(message)?;
            }
        }
    }
    builder.finish()
}

fn is_surface(primitive: &Primitive) -> bool {
    let modes = [Mode::Triangles, Mode::TriangleStrip, Mode::TriangleFan];
    matches!(primitive.mode, Checked::Valid(mode) if modes.contains(&mode))
}

/// Refuses nodes and primitives that share meshes and vertices and would multiply them beyond the limits.
fn check_size(root: &Root, placed: &[PlacedMesh]) -> Result<(), Problem> {
    let count =
        |index: gltf::json::Index<gltf::json::Accessor>| root.accessors.get(index.value()).map_or(0, |a| a.count.0);
    let mut corners = vec![(0_u64, 0_u64); root.meshes.len()];
    for (sum, mesh) in corners.iter_mut().zip(&root.meshes) {
        for primitive in &mesh.primitives {
            let vertices = primitive.attributes.get(&Checked::Valid(Semantic::Positions)).map_or(0, |p| count(*p));
            let listed = primitive.indices.map_or(vertices, count);
            let strip = !matches!(primitive.mode, Checked::Valid(Mode::Triangles));
            sum.0 = sum.0.saturating_add(if strip { listed.saturating_mul(3) } else { listed });
            sum.1 = sum.1.saturating_add(vertices);
        }
    }
    let total = placed
        .iter()
        .filter_map(|p| corners.get(p.mesh))
        .fold((0_u64, 0_u64), |(a, b), (c, v)| (a.saturating_add(*c), b.saturating_add(*v)));
    check_corners(total.0)?;
    let bytes = total.0.saturating_mul(CORNER_BYTES).saturating_add(total.1.saturating_mul(VERTEX_BYTES));
    limits::MESH.check_unpacked(bytes)
}

impl PrimitiveVertices {
    fn read(root: &Root, buffers: &Buffers, primitive: &Primitive, layout: &UvLayout) -> Result<Self, Problem> {
        let accessor = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let positions = accessor(Semantic::Positions).ok_or("has no positions")?;
        let positions = finite(numbers::<3>(root, buffers, positions, "POSITION")?, "position")?;
        let normals = match accessor(Semantic::Normals) {
            Some(index) => finite(numbers::<3>(root, buffers, index, "NORMAL")?, "normal")?,
            None => Vec::new(),
        };
        let uvs = match accessor(Semantic::TexCoords(layout.set)) {
            Some(index) => finite(numbers::<2>(root, buffers, index, "TEXCOORD")?, "texture coordinates")?,
            None => Vec::new(),
        };
        let corners: Vec<u64> = match primitive.indices {
            None => (0..positions.len() as u64).collect(),
            Some(index) => numbers::<1>(root, buffers, index, "indices")?.into_iter().map(|[i]| i as u64).collect(),
        };
        let weights = SkinWeights::read(root, buffers, primitive)?;
        let mut parts = Self {
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            triangles: Vec::new(),
            sources: Vec::new(),
            weights,
        };
        let mut places: Vec<Option<u32>> = vec![None; positions.len()];
        for triangle in triangles(primitive, &corners) {
            let mut vertex = |corner: u64| -> Result<u32, Problem> {
                let source = usize::try_from(corner).ok().filter(|i| *i < positions.len());
                let source = source.ok_or_else(|| {
                    format!("index {corner} is out of range: the primitive has {} vertices", positions.len())
                })?;
                Ok(*places[source].get_or_insert_with(|| {
                    parts.sources.push(source);
                    (parts.sources.len() - 1) as u32 // no more than corners, which are counted
                }))
            };
            let triangle = [vertex(triangle[0])?, vertex(triangle[1])?, vertex(triangle[2])?];
            parts.triangles.push(triangle);
        }
        let short = |what: &str| format!("has fewer {what} than vertices");
        parts.positions = parts.sources.iter().map(|i| positions[*i]).collect();
        if !normals.is_empty() {
            parts.normals = parts
                .sources
                .iter()
                .map(|i| normals.get(*i).copied())
                .collect::<Option<_>>()
                .ok_or_else(|| short("normals"))?;
        }
        if !uvs.is_empty() {
            let uvs: Option<Vec<_>> = parts.sources.iter().map(|i| uvs.get(*i).map(|uv| layout.apply(*uv))).collect();
            parts.uvs = uvs.ok_or_else(|| short("texture coordinates"))?;
        }
        Ok(parts)
    }
}

/// The corners of each triangle, counter-clockwise from the front.
fn triangles<'a>(primitive: &Primitive, corners: &'a [u64]) -> Box<dyn Iterator<Item = [u64; 3]> + 'a> {
    match primitive.mode {
        Checked::Valid(Mode::TriangleStrip) => Box::new(
            corners
                .windows(3)
                .enumerate()
                .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] }),
        ),
        Checked::Valid(Mode::TriangleFan) => Box::new(corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]])),
        _ => Box::new(corners.as_chunks().0.iter().copied()),
    }
}

/// Mesh under construction.
#[derive(Default)]
struct GltfMeshBuilder {
    has_normals: bool,
    has_uvs: bool,
    mesh: MeshAsset,
    positions: Vec<[f64; 3]>,
    lines: usize,
    bare_vertices: usize,
}

impl GltfMeshBuilder {
    fn add(&mut self, parts: &PrimitiveVertices, place: &PlacedMesh, slot: u16) -> Result<(), Problem> {
        let to_file = |vertex: usize| match (&place.joints, &parts.weights) {
            (Some(joints), Some(weights)) => weights.blend(parts.sources[vertex], joints),
            _ => Ok(place.to_file),
        };
        let places = (0..parts.positions.len()).map(to_file).collect::<Result<Vec<DAffine3>, _>>()?;
        let positions: Vec<DVec3> = places
            .iter()
            .zip(&parts.positions)
            .map(|(to_file, p)| to_file.transform_point3(DVec3::from_array(*p)))
            .collect();
        if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
            return Err(format!("the position of vertex {vertex} is not finite; correct the model").into());
        }
        for (vertex, position) in positions.iter().enumerate() {
            check_range(&position.to_array()).map_err(|problem| format!("vertex {vertex}: {problem}"))?;
        }
        let mirrored = place.joints.is_none() && place.to_file.matrix3.determinant() < 0.0;
        let facing = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| positions[i as usize]);
            (b - a).cross(c - a)
        };
        let turned: Vec<[u32; 3]> =
            parts.triangles.iter().map(|[a, b, c]| if mirrored { [*a, *c, *b] } else { [*a, *b, *c] }).collect();
        // Without normals, if others have them, a vertex belongs to its triangle alone.
        let split = self.has_normals && parts.normals.is_empty();
        let mut normals = vec![DVec3::ZERO; if split { 0 } else { positions.len() }];
        for (normal, (own, to_file)) in normals.iter_mut().zip(parts.normals.iter().zip(&places)) {
            *normal = cofactors(to_file.matrix3) * DVec3::from_array(*own);
        }
        let first = self.positions.len();
        let mut push = |vertex: usize, normal: DVec3| {
            self.positions.push(positions[vertex].to_array());
            if self.has_normals {
                self.mesh.normals.push(unit(normal.to_array()));
            }
            if self.has_uvs {
                self.mesh.uvs.push(parts.uvs.get(vertex).copied().unwrap_or_default().map(|v| v as f32));
            }
        };
        if split {
            turned.iter().for_each(|t| t.iter().for_each(|i| push(*i as usize, facing(*t))));
            let own = |i: usize| [0, 1, 2].map(|corner| (first + 3 * i + corner) as u32);
            self.mesh.triangles.extend((0..turned.len()).map(own));
        } else {
            for triangle in &turned {
                let unusable = |i: &&u32| normals[**i as usize].length_squared() == 0.0;
                triangle
                    .iter()
                    .filter(unusable)
                    .map(|i| *i as usize)
                    .collect::<Vec<_>>()
                    .into_iter()
                    .for_each(|i| normals[i] = facing(*triangle));
            }
            normals.iter().enumerate().for_each(|(vertex, normal)| push(vertex, *normal));
            self.mesh.triangles.extend(turned.iter().map(|t| t.map(|i| first as u32 + i)));
        }
        self.mesh.slots.resize(self.mesh.triangles.len(), slot);
        Ok(())
    }

    fn finish(self) -> Result<MeshAsset, Problem> {
        let Self { mut mesh, positions, lines, bare_vertices, has_uvs, .. } = self;
        if mesh.triangles.is_empty() {
            return Err("the scene contains no triangles; export the model with its meshes".into());
        }
        mesh.origin = middle_of_far(|axis| positions.iter().map(move |p| p[axis]));
        let origin = mesh.origin;
        mesh.positions = positions.iter().map(|p| relative(*p, origin)).collect();
        if mesh.uvs.iter().flatten().any(|v| !v.is_finite()) {
            return Err("a texture coordinate is not finite; correct the model".into());
        }
        if lines > 0 {
            mesh.report.push(format!("primitives of points or lines, which are not used: {lines}"));
        }
        if has_uvs && bare_vertices > 0 {
            mesh.report.push(format!("vertices without texture coordinates, which use u = v = 0: {bare_vertices}"));
        }
        Ok(mesh)
    }
}

/// Matrix that transforms normals: the cofactors, whatever the sign of the determinant.
fn cofactors(m: DMat3) -> DMat3 {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if m.determinant() < 0.0 { -cofactors } else { cofactors }
}
