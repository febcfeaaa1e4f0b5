//! What of a file has no place in a mesh.

use gltf::json::Root;
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;

/// Extensions of which something is used, or that change nothing that is read.
const USED: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

pub(super) fn unused(root: &Root) -> Vec<String> {
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()).map_or(0, |l| l.lights.len());
    let primitives = || root.meshes.iter().flat_map(|m| &m.primitives);
    let morphed = primitives().filter(|p| p.targets.as_ref().is_some_and(|t| !t.is_empty())).count();
    let has = |semantic: Semantic| {
        let key = Checked::Valid(semantic);
        primitives().filter(|p| p.attributes.contains_key(&key)).count()
    };
    let counts = [
        (lights, "lights", "a mesh has none: `etendue import` writes them as the scene's, or give your own"),
        (root.cameras.len(), "cameras", "a mesh has none: `etendue import` writes them as the job's, or give your own"),
        (
            root.animations.len(),
            "animations",
            "the mesh stands as its nodes do: give its object \"keys\", or a \"frame\" that moves",
        ),
        (root.skins.len(), "skins", "used as they stand at rest"),
        (morphed, "primitives with morph targets", "used without them"),
        (has(Semantic::Colors(0)), "primitives with colours of vertices", "which are not used"),
        (root.scenes.len().saturating_sub(1), "further scenes", "which are not used"),
    ];
    let mut report: Vec<String> = counts
        .into_iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, what, told)| format!("{count} {what}: {told}"))
        .collect();
    let unknown: Vec<&str> = root.extensions_used.iter().map(String::as_str).filter(|e| !USED.contains(e)).collect();
    if !unknown.is_empty() {
        report.push(format!("extensions that are not used: {}", unknown.join(", ")));
    }
    report
}
