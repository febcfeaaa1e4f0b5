//! Files in memory: scenes from arrays, cameras from code.

use etendue_io::Sandbox;
use etendue_io::failure::{Error, ErrorCode, Problem};
use etendue_io::hash::hash_bytes;
use etendue_io::source::read_text;
use etendue_scene::asset::{Assets, MeshAsset, MeshFrameAsset, MeshFramePart, SlotMaterial};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Triangles and the attributes of their vertices, in the unit that the job's mesh states (metres by default).
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshTriangles<'a> {
    /// Vertices.
    pub positions: &'a [[f32; 3]],
    /// Three vertex indices per triangle, counter-clockwise as seen from the front.
    pub triangles: &'a [[u32; 3]],
    /// Normals of the vertices, of any length above 0; empty: flat triangles.
    pub normals: &'a [[f32; 3]],
    /// Texture coordinates of the vertices, v upwards; empty: none.
    pub uvs: &'a [[f32; 2]],
}

/// Files in memory that replace those on disk, by the path as the job resolves it: relative to the file that names them.
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles {
    texts: BTreeMap<PathBuf, String>,
    assets: Assets,
}

impl MemoryFiles {
    /// No files.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a job, scene or camera (TOML).
    pub fn add_text(&mut self, path: impl Into<PathBuf>, text: impl Into<String>) {
        self.texts.insert(path.into(), text.into());
    }

    /// Adds a mesh, or one of the numbered files of an animated mesh; the object that shows it names its material.
    ///
    /// # Errors
    /// There is no triangle, an index has no vertex, a number is not finite, or the number of normals or texture coordinates is not that of the
    /// vertices.
    pub fn add_mesh(&mut self, path: impl Into<PathBuf>, mesh: &MeshTriangles<'_>) -> Result<(), Error> {
        let path = path.into();
        check(mesh).map_err(|why| Error::coded(ErrorCode::UnreadableFile, format!("{}: {why}", path.display())))?;
        let asset = MeshAsset {
            origin: [0.0; 3],
            positions: mesh.positions.to_vec(),
            normals: mesh.normals.to_vec(),
            uvs: mesh.uvs.to_vec(),
            triangles: mesh.triangles.to_vec(),
            slots: vec![0; mesh.triangles.len()],
            slot_materials: vec![SlotMaterial { name: String::new(), surface: None }],
            embedded_images: Vec::new(),
            report: Vec::new(),
            warnings: Vec::new(),
            missing_libraries: Vec::new(),
            hash: hash_bytes(&bytes(mesh)),
        };
        self.assets.mesh_frames.insert(path.clone(), frame(mesh, asset.hash));
        self.assets.meshes.insert(path, asset);
        Ok(())
    }

    /// Reads the text of a file, from memory or from disk.
    pub(crate) fn read(&self, path: &Path, sandbox: &Sandbox) -> Result<String, Problem> {
        match self.texts.get(path) {
            Some(text) => Ok(text.clone()),
            None => sandbox.check(path).and_then(|()| read_text(path)),
        }
    }

    pub(crate) fn assets(&self) -> &Assets {
        &self.assets
    }
}

/// The mesh as a frame of an animated mesh.
fn frame(mesh: &MeshTriangles<'_>, hash: [u8; 32]) -> MeshFrameAsset {
    let vertices = mesh.triangles.as_flattened().to_vec();
    let named = |is_present: bool| if is_present { vertices.clone() } else { Vec::new() };
    let part = MeshFramePart {
        material: String::new(),
        arities: vec![3; mesh.triangles.len()],
        uvs: named(!mesh.uvs.is_empty()),
        normal_indices: named(!mesh.normals.is_empty()),
        positions: mesh.positions.iter().map(|p| p.map(f64::from)).collect(),
        normals: mesh.normals.to_vec(),
        vertices,
    };
    let triangles = (0..mesh.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    MeshFrameAsset { parts: vec![part], vertices: mesh.positions.len(), triangles, hash }
}

fn check(mesh: &MeshTriangles<'_>) -> Result<(), String> {
    let vertices = mesh.positions.len();
    if mesh.triangles.is_empty() {
        return Err("the mesh has no triangles".to_owned());
    }
    if let Some(i) = mesh.triangles.as_flattened().iter().find(|i| **i as usize >= vertices) {
        return Err(format!("a triangle refers to vertex {i}, but there are {vertices}"));
    }
    for (name, count) in [("normals", mesh.normals.len()), ("texture coordinates", mesh.uvs.len())] {
        if count != 0 && count != vertices {
            return Err(format!("{count} {name} for {vertices} vertices: expected none or one per vertex"));
        }
    }
    let numbers = [mesh.positions.as_flattened(), mesh.normals.as_flattened(), mesh.uvs.as_flattened()];
    match numbers.iter().flat_map(|list| list.iter()).find(|x| !x.is_finite()) {
        Some(x) => Err(format!("the number {x} is not finite")),
        None => Ok(()),
    }
}

/// The bytes of the arrays that the hash of a plan covers.
fn bytes(mesh: &MeshTriangles<'_>) -> Vec<u8> {
    let lengths = [mesh.positions.len(), mesh.triangles.len(), mesh.normals.len(), mesh.uvs.len()];
    let floats = [mesh.positions.as_flattened(), mesh.normals.as_flattened(), mesh.uvs.as_flattened()];
    let lengths = lengths.into_iter().flat_map(|n| (n as u64).to_le_bytes());
    let floats = floats.into_iter().flatten().flat_map(|x| x.to_le_bytes());
    let indices = mesh.triangles.as_flattened().iter().flat_map(|i| i.to_le_bytes());
    lengths.chain(floats).chain(indices).collect()
}
