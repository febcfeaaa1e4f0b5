//! Parser of a file into its checked JSON, its extensions and its binary chunk; lists the content that a mesh cannot hold.

use etendue_scene::limits;
use gltf::json::material::{Material, NormalTexture};
use gltf::json::{Root, Value};
use gltf::{json::mesh::Semantic, json::validation::Checked};

use super::compression;
use super::picture::{TextureUse, UvLayout};
use crate::Problem;

const MAGIC: &[u8] = b"glTF";
const HEAD: usize = 12;
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;

/// Extensions that a file may require: supported, or omitted with a note.
const KNOWN: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_mesh_quantization",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "MSFT_texture_dds",
];

/// The JSON, checked by the rules of the specification, and the binary chunk.
pub(super) fn parse(bytes: &[u8]) -> Result<(Root, Option<Vec<u8>>), Problem> {
    let (json, blob) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
    limits::DESCRIPTION.check_size(json.len() as u64).map_err(|problem| problem.within("its JSON"))?;
    check_objects(json)?;
    let mut root: Root =
        gltf::json::deserialize::from_slice(json).map_err(|cause| format!("not a glTF file: invalid JSON: {cause}"))?;
    if root.asset.version.split('.').next() != Some("2") {
        return Err(format!("the glTF version is {}; expected 2.0: export the file again", root.asset.version).into());
    }
    compression::check(&root)?;
    let unknown: Vec<&str> =
        root.extensions_required.iter().map(String::as_str).filter(|e| !KNOWN.contains(e)).collect();
    if !unknown.is_empty() {
        return Err(format!(
            "requires {}, which is not supported; export it without (supported: {})",
            unknown.join(", "),
            KNOWN.join(", ")
        )
        .into());
    }
    check_positions(&root)?;
    add_bounds(&mut root);
    // The crate supports fewer of them.
    root.extensions_required.clear();
    let document = gltf::Document::from_json(root).map_err(|cause| format!("not a valid glTF file: {cause}"))?;
    Ok((document.into_json(), blob.map(<[u8]>::to_vec)))
}

/// The JSON as in the file.
pub(super) fn json_of(bytes: &[u8]) -> Result<serde_json::Value, Problem> {
    let (json, _) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
    serde_json::from_slice(json).map_err(|cause| format!("not a glTF file: invalid JSON: {cause}").into())
}

/// Adds missing bounds of positions, which the specification requires and nothing here uses: some writers omit them, and the crate would refuse the file.
fn add_bounds(root: &mut Root) {
    let Root { meshes, accessors, .. } = root;
    let primitives = meshes.iter().flat_map(|mesh| &mesh.primitives);
    let positions = primitives.filter_map(|primitive| primitive.attributes.get(&Checked::Valid(Semantic::Positions)));
    for index in positions.map(|index| index.value()) {
        let Some(accessor) = accessors.get_mut(index) else { continue };
        for bound in [&mut accessor.min, &mut accessor.max] {
            bound.get_or_insert_with(|| Value::from(vec![0.0; 3]));
        }
    }
}

/// Refuses missing positions: the crate's own check assumes them.
fn check_positions(root: &Root) -> Result<(), Problem> {
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let positions = primitives.filter_map(|primitive| primitive.attributes.get(&Checked::Valid(Semantic::Positions)));
    match positions.map(|index| index.value()).find(|index| *index >= root.accessors.len()) {
        Some(index) => Err(format!("accessor {index} (POSITION) does not exist; export the file again").into()),
        None => Ok(()),
    }
}

/// Refuses JSON whose objects would fill the memory: two brackets may describe a material of many hundred bytes, in a growing list.
fn check_objects(json: &[u8]) -> Result<(), Problem> {
    const OBJECT_BYTES: u64 = 1024;
    let objects = json.iter().filter(|byte| **byte == b'{').count() as u64;
    limits::MESH
        .check_unpacked(objects * OBJECT_BYTES)
        .map_err(|problem| problem.within(format_args!("JSON of {objects} objects")))
}

/// The chunks of a GLB file.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Problem> {
    let word = |at: usize| bytes.get(at..at + 4).map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]]));
    let truncated = || "the file is truncated; export or copy it again".to_owned();
    let (version, length) = (word(4).ok_or_else(truncated)?, word(8).ok_or_else(truncated)? as usize);
    if version != 2 {
        return Err(format!("the GLB version is {version}; expected 2: export the file again").into());
    }
    if length > bytes.len() {
        return Err(format!(
            "the file has {} bytes, but its header states {length}: it is truncated; export or copy it again",
            bytes.len()
        )
        .into());
    }
    let (mut json, mut blob, mut at) = (None, None, HEAD);
    while at + 8 <= length {
        let (size, kind) = (word(at).ok_or_else(truncated)? as usize, word(at + 4).ok_or_else(truncated)?);
        let chunk = bytes[..length].get(at + 8..at + 8 + size).ok_or_else(truncated)?;
        match kind {
            JSON_CHUNK if at == HEAD => json = Some(chunk),
            BINARY_CHUNK if blob.is_none() => blob = Some(chunk),
            _ => {}
        }
        at += 8 + size.next_multiple_of(4);
    }
    Ok((json.ok_or("the first chunk of the GLB is not JSON; export the file again")?, blob))
}

/// KHR_materials_clearcoat.
pub(super) struct Clearcoat {
    pub(super) weight: f64,
    pub(super) roughness: f64,
    pub(super) has_image: bool,
}

/// KHR_materials_sheen.
pub(super) struct Sheen {
    pub(super) colour: [f64; 3],
    pub(super) roughness: f64,
    pub(super) has_image: bool,
}

/// Returns an extension of a material.
pub(super) fn extension<'a>(material: &'a Material, name: &str) -> Option<&'a Value> {
    material.extensions.as_ref()?.others.get(name)
}

pub(super) fn clearcoat(material: &Material) -> Option<Clearcoat> {
    let value = extension(material, "KHR_materials_clearcoat")?;
    Some(Clearcoat {
        weight: unit_factor(value, "clearcoatFactor"),
        roughness: unit_factor(value, "clearcoatRoughnessFactor"),
        has_image: ["clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"]
            .iter()
            .any(|k| value.get(k).is_some()),
    })
}

pub(super) fn sheen(material: &Material) -> Option<Sheen> {
    let value = extension(material, "KHR_materials_sheen")?;
    let colour = numbers(value.get("sheenColorFactor"), [0.0; 3]);
    Some(Sheen {
        colour: colour.map(|v| v.clamp(0.0, 1.0)),
        roughness: unit_factor(value, "sheenRoughnessFactor"),
        has_image: ["sheenColorTexture", "sheenRoughnessTexture"].iter().any(|k| value.get(k).is_some()),
    })
}

/// Texture and coordinates of a normal map.
pub(super) fn normal_texture(texture: &NormalTexture) -> TextureUse {
    let transform = texture.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
    let mut layout = UvLayout { set: texture.tex_coord, ..UvLayout::PLAIN };
    if let Some(transform) = transform {
        layout.offset = numbers(transform.get("offset"), layout.offset);
        layout.scale = numbers(transform.get("scale"), layout.scale);
        layout.rotation = transform.get("rotation").and_then(Value::as_f64).unwrap_or(0.0);
        layout.set = transform.get("texCoord").and_then(Value::as_u64).map_or(layout.set, |set| set as u32);
    }
    TextureUse { texture: texture.index.value(), layout }
}

fn unit_factor(value: &Value, key: &str) -> f64 {
    value.get(key).and_then(Value::as_f64).unwrap_or(0.0).clamp(0.0, 1.0)
}

fn numbers<const N: usize>(value: Option<&Value>, default: [f64; N]) -> [f64; N] {
    let list: Option<Vec<f64>> =
        value.and_then(Value::as_array).map(|list| list.iter().filter_map(Value::as_f64).collect());
    list.and_then(|list| list.try_into().ok()).unwrap_or(default)
}

/// Extensions that are used in part, or that do not affect what is read.
const USED: &[&str] = &[
    "EXT_texture_webp",
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
    "MSFT_texture_dds",
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
        (lights, "lights", "not part of a mesh: `etendue import` writes them to the scene, or add your own"),
        (root.cameras.len(), "cameras", "not part of a mesh: `etendue import` writes them to the job, or add your own"),
        (
            root.animations.len(),
            "animations",
            "not used; the nodes keep their rest transforms: give the object \"keys\", or a \"frame\" that moves",
        ),
        (root.skins.len(), "skins", "used in their rest pose"),
        (morphed, "primitives with morph targets", "used without them"),
        (has(Semantic::Colors(0)), "primitives with vertex colours", "which are not used"),
        (root.scenes.len().saturating_sub(1), "further scenes", "which are not used"),
    ];
    let mut report: Vec<String> = counts
        .into_iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, what, note)| format!("{count} {what}: {note}"))
        .collect();
    let unknown: Vec<&str> = root
        .extensions_used
        .iter()
        .map(String::as_str)
        .filter(|e| !USED.contains(e) && compression::find(e).is_none())
        .collect();
    if !unknown.is_empty() {
        report.push(format!("extensions that are not used: {}", unknown.join(", ")));
    }
    report
}
