//! Meshes with moving vertices: from the files of their frames to the tracer's mesh.
//!
//! Faces, texture coordinates and materials are those of the first file. A vertex of the mesh represents all corners that share one vertex, one pair of
//! texture coordinates, and in every file one normal: exporters write equal normals once, and normals that are equal in one file may differ in the next.

use super::context::{Context, ErrorCode};
use etendue_core::Epoch;
use etendue_scene::asset::{MeshAsset, MeshFrameAsset};
use etendue_scene::record;
use etendue_scene::record::vertex_animation::FrameRepeat;
use etendue_tracer::geometry::{DroppedTriangles, Mesh, MeshError, Repeat, VertexAnimation, VertexFrame};
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::path::PathBuf;

/// Mesh; `None` with the errors recorded. `asset` is the first file as a mesh.
pub(super) fn mesh(
    record: &record::VertexAnimation,
    asset: &MeshAsset,
    context: &mut Context<'_>,
) -> Option<Result<(Mesh, DroppedTriangles), MeshError>> {
    let files: Vec<PathBuf> = record.frame_files().into_iter().map(|file| file.value).collect();
    let mesh_frames: Vec<&MeshFrameAsset> =
        files.iter().filter_map(|file| context.assets.mesh_frames.get(file)).collect();
    if mesh_frames.len() < files.len() {
        context.error(
            ErrorCode::UnreadableFile,
            &record.files.place,
            "a file of the mesh was not loaded",
            "give readable OBJ files",
        );
        return None;
    }
    let before = context.errors.len();
    for (file, frame) in files.iter().zip(&mesh_frames).skip(1) {
        if let Some([own, first]) = frame.difference(mesh_frames[0]) {
            let problem = format!("{} has {own}, but {} has {first}", file.display(), files[0].display());
            context.error(
                ErrorCode::UnsuitableFile,
                &record.files.place,
                problem,
                "export all files from one mesh with unchanged faces",
            );
        }
    }
    if context.errors.len() > before {
        return None;
    }
    Some(WeldedVertices::new(&mesh_frames, asset).mesh(record, asset, context.epoch))
}

/// A corner of a face.
#[derive(Clone, Copy)]
struct MeshCorner {
    /// Index of the part of the mesh.
    part: usize,
    /// Index of the corner in the part.
    corner: usize,
}

/// Identity of a vertex: part, vertex, texture coordinates, and the normal in each file, or the triangle if a normal is missing.
type VertexKey = (usize, u32, u32, Vec<u32>);

/// Vertices of a mesh in all its files.
struct WeldedVertices<'a> {
    files: &'a [&'a MeshFrameAsset],
    origin: DVec3,
    has_normals: bool,
    indices_by_key: HashMap<VertexKey, u32>,
    frames: Vec<VertexFrame>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
}

impl<'a> WeldedVertices<'a> {
    fn new(files: &'a [&'a MeshFrameAsset], asset: &MeshAsset) -> Self {
        let mut weld = Self {
            files,
            origin: DVec3::from_array(asset.origin),
            has_normals: !asset.normals.is_empty(),
            indices_by_key: HashMap::new(),
            frames: vec![VertexFrame::default(); files.len()],
            uvs: Vec::new(),
            triangles: Vec::new(),
        };
        let first = files[0];
        let parts = first.parts.iter().enumerate();
        let corners: Vec<MeshCorner> =
            parts.flat_map(|(part, p)| (0..p.vertices.len()).map(move |corner| MeshCorner { part, corner })).collect();
        for (triangle, own) in first.triangles.iter().zip(&asset.triangles) {
            let places = triangle.map(|corner| corners[corner as usize]);
            let uvs = own.map(|v| asset.uvs.get(v as usize).copied().map(Vec2::from));
            weld.triangle(places, uvs);
        }
        weld
    }

    fn triangle(&mut self, corners: [MeshCorner; 3], uvs: [Option<Vec2>; 3]) {
        let facing: Vec<Vec3> = match self.has_normals {
            true => self.files.iter().map(|file| facing(file, corners)).collect(),
            false => Vec::new(),
        };
        let vertices = core::array::from_fn(|i| self.vertex(corners[i], uvs[i], &facing));
        self.triangles.push(vertices);
    }

    /// Vertex of a corner; if a file gives it no usable normal, of this triangle alone, which faces `facing` in each file.
    fn vertex(&mut self, place: MeshCorner, uv: Option<Vec2>, facing: &[Vec3]) -> u32 {
        let MeshCorner { part, corner } = place;
        let own = &self.files[0].parts[part];
        let normals: Vec<Option<Vec3>> = match self.has_normals {
            true => self.files.iter().map(|file| normal(file, place)).collect(),
            false => Vec::new(),
        };
        let is_shared = normals.iter().all(Option::is_some);
        let named = |file: &&MeshFrameAsset| file.parts[part].normal_indices.get(corner).copied().unwrap_or(0);
        let apart = match (self.has_normals, is_shared) {
            (false, _) => Vec::new(),
            (true, true) => self.files.iter().map(named).collect(),
            (true, false) => vec![u32::MAX, self.triangles.len() as u32],
        };
        let key = (part, own.vertices[corner], own.uvs.get(corner).copied().unwrap_or(0), apart);
        let next = self.frames[0].positions.len() as u32; // no more than corners, which are counted
        let vertex = *self.indices_by_key.entry(key).or_insert(next);
        if vertex == next {
            self.add(place, &normals, facing);
            self.uvs.extend(uv);
        }
        vertex
    }

    fn add(&mut self, corner: MeshCorner, normals: &[Option<Vec3>], facing: &[Vec3]) {
        let MeshCorner { part, corner } = corner;
        for (number, (frame, file)) in self.frames.iter_mut().zip(self.files).enumerate() {
            let part = &file.parts[part];
            let place = DVec3::from_array(part.positions[part.vertices[corner] as usize]);
            frame.positions.push((place - self.origin).as_vec3());
            frame.normals.extend(normals.get(number).map(|normal| normal.unwrap_or(facing[number])));
        }
    }

    fn mesh(
        self,
        record: &record::VertexAnimation,
        asset: &MeshAsset,
        epoch: Epoch,
    ) -> Result<(Mesh, DroppedTriangles), MeshError> {
        let repeat = match record.repeats() {
            FrameRepeat::Hold => Repeat::Hold,
            FrameRepeat::Loop => Repeat::Loop,
        };
        let animation = VertexAnimation::new(self.frames, record.frame_times_s(epoch), repeat)?;
        Mesh::animated(animation, self.uvs, self.triangles, asset.slots.clone())
    }
}

/// Normal that a file gives a corner; `None` if it gives none, or one of zero length.
fn normal(file: &MeshFrameAsset, corner: MeshCorner) -> Option<Vec3> {
    let MeshCorner { part, corner } = corner;
    let part = &file.parts[part];
    let normal = part.normals[*part.normal_indices.get(corner)? as usize];
    (normal != [0.0; 3]).then_some(Vec3::from(normal))
}

/// Unit normal of a triangle in a file; z for a triangle without area.
fn facing(file: &MeshFrameAsset, corners: [MeshCorner; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|MeshCorner { part, corner }| {
        let part = &file.parts[part];
        DVec3::from_array(part.positions[part.vertices[corner] as usize])
    });
    (b - a).cross(c - a).normalize_or(DVec3::Z).as_vec3()
}
