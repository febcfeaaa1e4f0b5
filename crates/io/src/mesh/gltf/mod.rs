//! Meshes of glTF 2.0 files (`.gltf`, `.glb`).
//!
//! Source: glTF 2.0 Specification, Khronos Group 2021 (ISO/IEC 12113:2022), with KHR_texture_transform, KHR_mesh_quantization and the KHR_materials extensions;
//! docs/gltf.md describes the conversion. The gltf crate reads and checks the JSON. Our code follows all indices into bytes, as the crate's own readers panic
//! on damaged ones.
//!
//! All nodes of the scene become one mesh in the file's axes and units (+y up, +z forward, m): their transforms are applied in f64, skins in their rest pose.
//! Animations and all other unused content are reported. Lights and cameras are read separately ([`read_gltf_stage`]), as are animated nodes
//! ([`read_gltf_motion`]).

mod accessor;
mod buffers;
mod compression;
mod document;
mod flatten;
mod material;
mod motion;
mod nodes;
mod parts;
mod picture;
mod stage;
mod tracks;

use std::path::Path;

use etendue_scene::asset::MeshAsset;

use self::{buffers::Buffers, material::Materials};
use crate::source::{name_notes, read_bytes};
use crate::{Error, Problem, Sandbox, hash};

pub use motion::{GltfMotion, GltfMover, read_gltf_motion};
pub use parts::GltfParts;
pub use stage::{GltfCamera, GltfLight, GltfLightKind, GltfProjection, GltfStage, read_gltf_stage};
pub use tracks::{GLTF_CUBIC_KEYS, GLTF_MIN_TURN, GltfTrack};

/// Reads a glTF file with its buffers and images, which must lie in `sandbox`.
pub(super) fn read_gltf(file: &Path, sandbox: &Sandbox) -> Result<MeshAsset, Error> {
    let bytes = read_bytes(file, "mesh")?;
    read(file, &bytes, sandbox).map_err(|problem| Error::new(file, problem))
}

fn read(file: &Path, bytes: &[u8], sandbox: &Sandbox) -> Result<MeshAsset, Problem> {
    let (root, blob) = document::parse(bytes)?;
    let buffers = Buffers::read(file, &root, blob, sandbox)?;
    let placed = nodes::placed_meshes(&root, &buffers)?;
    let mut materials = Materials::default();
    let mut mesh = flatten::flatten(&root, &buffers, &placed, |index| materials.slot_of(&root, index))?;
    let converted = materials.read(file, &root, &buffers, sandbox)?;
    mesh.slot_materials = converted.slots;
    mesh.embedded_images = converted.images;
    mesh.report.extend(converted.report);
    mesh.report.extend(buffers.notes.iter().cloned());
    mesh.report.extend(document::unused(&root));
    mesh.report.extend(compression::notes(&root));
    name_notes(file, &mut mesh.report);
    let parts =
        std::iter::once(bytes).chain(buffers.external_bytes()).chain(converted.image_bytes.iter().map(Vec::as_slice));
    mesh.hash = hash::hash_parts(parts);
    Ok(mesh)
}
