//! Extensions that the gltf crate hands on as JSON.

use gltf::json::Value;
use gltf::json::material::{Material, NormalTexture};

use super::picture::{TextureUse, UvLayout};

/// KHR_materials_clearcoat.
pub(super) struct Clearcoat {
    pub(super) share: f64,
    pub(super) roughness: f64,
    pub(super) has_picture: bool,
}

/// KHR_materials_sheen.
pub(super) struct Sheen {
    pub(super) colour: [f64; 3],
    pub(super) roughness: f64,
    pub(super) has_picture: bool,
}

/// What a material says of an extension.
pub(super) fn of<'a>(material: &'a Material, name: &str) -> Option<&'a Value> {
    material.extensions.as_ref()?.others.get(name)
}

pub(super) fn clearcoat(material: &Material) -> Option<Clearcoat> {
    let value = of(material, "KHR_materials_clearcoat")?;
    Some(Clearcoat {
        share: share(value, "clearcoatFactor"),
        roughness: share(value, "clearcoatRoughnessFactor"),
        has_picture: ["clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"]
            .iter()
            .any(|k| value.get(k).is_some()),
    })
}

pub(super) fn sheen(material: &Material) -> Option<Sheen> {
    let value = of(material, "KHR_materials_sheen")?;
    let colour = numbers(value.get("sheenColorFactor"), [0.0; 3]);
    Some(Sheen {
        colour: colour.map(|v| v.clamp(0.0, 1.0)),
        roughness: share(value, "sheenRoughnessFactor"),
        has_picture: ["sheenColorTexture", "sheenRoughnessTexture"].iter().any(|k| value.get(k).is_some()),
    })
}

/// How a normal map lies.
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

fn share(value: &Value, key: &str) -> f64 {
    value.get(key).and_then(Value::as_f64).unwrap_or(0.0).clamp(0.0, 1.0)
}

fn numbers<const N: usize>(value: Option<&Value>, default: [f64; N]) -> [f64; N] {
    let list: Option<Vec<f64>> =
        value.and_then(Value::as_array).map(|list| list.iter().filter_map(Value::as_f64).collect());
    list.and_then(|list| list.try_into().ok()).unwrap_or(default)
}
