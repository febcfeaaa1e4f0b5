//! Conversion of glTF materials to materials of a scene.
//!
//! α is the square of the roughness, as the specification says. A dielectric is a Lambertian surface under a coat of the stated index, or without a coat for
//! the roughness 1, which exporters write for diffuse surfaces. docs/gltf.md describes the whole mapping.

use std::path::{Path, PathBuf};

use etendue_scene::asset::{
    COAT_INDICES, ImageAsset, SlotColour, SlotEmission, SlotLayers, SlotMaterial, SlotNumber, SlotSolid, SlotSurface,
    SlotTopLayer, SlotTransmission,
};
use gltf::json::material::{AlphaMode, Material};
use gltf::{json::Root, json::validation::Checked};

use super::picture::{GltfImages, TextureUse};
use super::{buffers::Buffers, document};
use crate::mesh::derived_image;
use crate::{Problem, Sandbox};

pub(super) use super::picture::UvLayout;

/// Default refractive index of a coat and of clear substances.
const DEFAULT_INDEX: f64 = 1.5;
/// Default cutoff of an opacity mask.
const DEFAULT_CUTOFF: f64 = 0.5;

/// Materials of the triangles, in the order of first use; `None` is the default material of the specification.
#[derive(Default)]
pub(super) struct Materials {
    numbers: Vec<Option<usize>>,
}

/// Result: the materials of a mesh.
pub(super) struct MeshMaterials {
    pub(super) slots: Vec<SlotMaterial>,
    pub(super) images: Vec<(PathBuf, ImageAsset)>,
    pub(super) image_bytes: Vec<Vec<u8>>,
    pub(super) report: Vec<String>,
}

impl Materials {
    /// Slot and texture layout of a material.
    pub(super) fn slot_of(&mut self, root: &Root, number: Option<usize>) -> Result<(u16, UvLayout), Problem> {
        let slot = self.numbers.iter().position(|n| *n == number).unwrap_or_else(|| {
            self.numbers.push(number);
            self.numbers.len() - 1
        });
        let slot = u16::try_from(slot).map_err(|_| "the mesh has more than 65 536 materials; split it".to_owned())?;
        let first = number.and_then(|n| root.materials.get(n)).and_then(|material| uses(material).first().copied());
        Ok((slot, first.map_or(UvLayout::PLAIN, |first| first.layout)))
    }

    pub(super) fn read(
        &self,
        file: &Path,
        root: &Root,
        buffers: &Buffers,
        sandbox: &Sandbox,
    ) -> Result<MeshMaterials, Problem> {
        let mut images = GltfImages::new(file, root, buffers, sandbox);
        let (mut slots, mut report): (Vec<SlotMaterial>, Vec<String>) = (Vec::new(), Vec::new());
        let silent = Material::default();
        for number in &self.numbers {
            let material = number.and_then(|n| root.materials.get(n)).unwrap_or(&silent);
            let name = name_of(material, *number, &slots);
            let subject = format!("material \"{name}\"");
            let mut reader = MaterialReader { material, images: &mut images, notes: Vec::new() };
            let layers = reader.layers().map_err(|problem| problem.within(&subject))?;
            let notes = std::mem::take(&mut reader.notes);
            report.push(format!("{subject}: {}", layers.describe()));
            report.extend(notes.into_iter().map(|note| format!("{subject}: {note}")));
            slots.push(SlotMaterial { name, surface: Some(SlotSurface::Layers(Box::new(layers))) });
        }
        let GltfImages { used, files, notes, .. } = images;
        report.extend(notes);
        Ok(MeshMaterials { slots, images: used.into_iter().collect(), image_bytes: files, report })
    }
}

/// Name of a material; with its number if it has no name or another one has the same.
fn name_of(material: &Material, number: Option<usize>, others: &[SlotMaterial]) -> String {
    let number = number.map_or_else(|| "default".to_owned(), |n| n.to_string());
    match &material.name {
        None => format!("material {number}"),
        Some(name) if name.is_empty() || others.iter().any(|o| o.name == *name) => format!("{name} {number}"),
        Some(name) => name.clone(),
    }
}

/// Textures of a material; the first sets the layout of all.
fn uses(material: &Material) -> Vec<TextureUse> {
    let pbr = &material.pbr_metallic_roughness;
    let transmission = material.extensions.as_ref().and_then(|e| e.transmission.as_ref());
    let infos = [
        pbr.base_color_texture.as_ref(),
        pbr.metallic_roughness_texture.as_ref(),
        material.emissive_texture.as_ref(),
        transmission.and_then(|t| t.transmission_texture.as_ref()),
    ];
    let normals = material.normal_texture.as_ref().map(document::normal_texture);
    infos.into_iter().flatten().map(TextureUse::new).chain(normals).collect()
}

/// Refractive index whose reflectance at normal incidence, (n − 1)²/(n + 1)², is a fraction of that of another.
fn index_of_scaled_reflectance(index: f64, factor: f64) -> f64 {
    let amplitude = (index - 1.0) / (index + 1.0) * factor.sqrt();
    (1.0 + amplitude) / (1.0 - amplitude)
}

struct MaterialReader<'m, 'p, 'a> {
    material: &'m Material,
    images: &'p mut GltfImages<'a>,
    notes: Vec<String>,
}

impl MaterialReader<'_, '_, '_> {
    fn layers(&mut self) -> Result<SlotLayers, Problem> {
        let (material, pbr) = (self.material, &self.material.pbr_metallic_roughness);
        let factor = pbr.base_color_factor.0.map(|v| f64::from(v).clamp(0.0, 1.0));
        let colour = [factor[0], factor[1], factor[2]];
        let texture = pbr.base_color_texture.as_ref().map(|info| info.index.value());
        let base = match texture {
            None => SlotColour::LinearSrgb(colour),
            Some(texture) if colour == [1.0; 3] => SlotColour::Picture(self.images.original(texture, true)?),
            Some(texture) => {
                let make = |image: &ImageAsset| derived_image::tinted(image, colour);
                SlotColour::Picture(self.images.derived(texture, &format!("times {colour:?}"), false, make)?)
            }
        };
        let is_unlit = material.extensions.as_ref().is_some_and(|e| e.unlit.is_some());
        let metal = if is_unlit {
            SlotNumber::Number(0.0)
        } else {
            self.channel_number(2, f64::from(pbr.metallic_factor.0), false)?
        };
        let roughness = f64::from(pbr.roughness_factor.0);
        let alpha = if is_unlit { SlotNumber::Number(1.0) } else { self.channel_number(1, roughness, true)? };
        let layers = SlotLayers {
            top_layer: if is_unlit { SlotTopLayer::Nothing } else { self.over(&alpha) },
            transmission: self.transmission()?,
            emission: self.emission()?,
            opacity: self.opacity(texture, factor[3])?,
            normals: self.normals()?,
            base,
            metal,
            alpha,
        };
        self.note_unused(is_unlit, &layers);
        Ok(layers)
    }

    /// Metalness (blue) or roughness (green) of the metallic-roughness image times its factor; α is the square of the roughness.
    fn channel_number(&mut self, channel: usize, factor: f64, squared: bool) -> Result<SlotNumber, Problem> {
        let factor = factor.clamp(0.0, 1.0);
        let rule = |v: f64| if squared { v * factor * (v * factor) } else { v * factor };
        let info = self.material.pbr_metallic_roughness.metallic_roughness_texture.as_ref();
        match info.filter(|_| factor > 0.0) {
            None => Ok(SlotNumber::Number(rule(1.0))),
            Some(info) => self.number(info.index.value(), channel, &format!("{channel}, {factor}, {squared}"), rule),
        }
    }

    /// Channel of an image by a rule; a number if it is constant.
    fn number(
        &mut self,
        texture: usize,
        channel: usize,
        what: &str,
        rule: impl Fn(f64) -> f64,
    ) -> Result<SlotNumber, Problem> {
        let rule = |v: f32| rule(f64::from(v)) as f32;
        let picture = self.images.derived(texture, &format!("channel {what}"), false, |image| {
            derived_image::channel(image, channel, rule)
        })?;
        let only = self.images.used.get(&picture.file).and_then(derived_image::only_value);
        Ok(only.map_or(SlotNumber::Picture(picture), SlotNumber::Number))
    }

    fn index(&mut self) -> f64 {
        let stated = self.material.extensions.as_ref().and_then(|e| e.ior.as_ref()).map(|ior| f64::from(ior.ior.0));
        match stated {
            Some(index) if !(1.0..=4.0).contains(&index) => {
                self.notes
                    .push(format!("the refractive index (ior) {index} is outside 1 … 4; {DEFAULT_INDEX} is used"));
                DEFAULT_INDEX
            }
            stated => stated.unwrap_or(DEFAULT_INDEX),
        }
    }

    fn over(&mut self, alpha: &SlotNumber) -> SlotTopLayer {
        let index = self.index();
        if let Some(sheen) = document::sheen(self.material).filter(|s| s.colour != [0.0; 3]) {
            if sheen.has_image {
                self.notes.push("the sheen textures are not used".to_owned());
            }
            return SlotTopLayer::Sheen {
                colour: sheen.colour,
                alpha: (sheen.roughness * sheen.roughness).clamp(0.1, 1.0),
            };
        }
        let specular = self.material.extensions.as_ref().and_then(|e| e.specular.as_ref());
        let factor = specular.map_or(1.0, |s| f64::from(s.specular_factor.0).clamp(0.0, 1.0));
        if specular.is_some_and(|s| {
            s.specular_color_factor.0 != [1.0; 3] || s.specular_color_texture.is_some() || s.specular_texture.is_some()
        }) {
            self.notes.push("the colour and the textures of the specular reflection are not used".to_owned());
        }
        let index = if factor < 1.0 { index_of_scaled_reflectance(index, factor) } else { index };
        let coat = document::clearcoat(self.material).filter(|coat| coat.weight > 0.0);
        if coat.as_ref().is_some_and(|coat| coat.has_image) {
            self.notes.push("the clear-coat textures are not used".to_owned());
        }
        match coat {
            Some(coat) => {
                let alpha = coat.roughness * coat.roughness;
                SlotTopLayer::TwoCoats {
                    index: index.clamp(DEFAULT_INDEX, *COAT_INDICES.end()),
                    fraction: coat.weight,
                    alpha,
                }
            }
            None if *alpha == SlotNumber::Number(1.0) || !COAT_INDICES.contains(&index) => SlotTopLayer::Nothing,
            None => SlotTopLayer::Coat { index },
        }
    }

    fn transmission(&mut self) -> Result<Option<SlotTransmission>, Problem> {
        let Some(extensions) = &self.material.extensions else { return Ok(None) };
        let Some(transmission) = extensions.transmission.as_ref().filter(|t| t.transmission_factor.0 > 0.0) else {
            return Ok(None);
        };
        let factor = f64::from(transmission.transmission_factor.0).clamp(0.0, 1.0);
        let fraction = match &transmission.transmission_texture {
            None => SlotNumber::Number(factor),
            Some(info) => self.number(info.index.value(), 0, &format!("0, {factor}"), |v| v * factor)?,
        };
        let solid = extensions.volume.as_ref().filter(|v| v.thickness_factor.0 > 0.0).map(|volume| {
            let distance_m = f64::from(volume.attenuation_distance.0);
            SlotSolid {
                colour: volume.attenuation_color.0.map(|v| f64::from(v).clamp(0.0, 1.0)),
                distance_m: Some(distance_m).filter(|d| d.is_finite() && *d > 0.0 && *d < f64::from(f32::MAX)),
            }
        });
        match solid {
            None => self.notes.push("a thin pane: transmitted light is not blurred".to_owned()),
            Some(_) => self.notes.push(
                "a solid of clear material: the mesh must be closed; the base colour does not tint it".to_owned(),
            ),
        }
        Ok(Some(SlotTransmission { fraction, index: self.index(), solid, tint: None }))
    }

    fn emission(&mut self) -> Result<Option<SlotEmission>, Problem> {
        let strength = self.material.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |s| f64::from(s.emissive_strength.0));
        let rgb_cd_m2 = self.material.emissive_factor.0.map(|v| f64::from(v).max(0.0) * strength);
        if !rgb_cd_m2.iter().all(|v| v.is_finite() && *v >= 0.0) {
            return Err("the emission is not a finite number of 0 or more; correct the model".into());
        }
        if rgb_cd_m2 == [0.0; 3] {
            return Ok(None);
        }
        let image = match &self.material.emissive_texture {
            None => None,
            Some(info) => Some(self.images.original(info.index.value(), true)?),
        };
        Ok(Some(SlotEmission { rgb_cd_m2, picture: image, both_sides: self.material.double_sided }))
    }

    fn opacity(&mut self, texture: Option<usize>, factor: f64) -> Result<Option<SlotNumber>, Problem> {
        let cutoff = self.material.alpha_cutoff.map_or(DEFAULT_CUTOFF, |c| f64::from(c.0));
        let Checked::Valid(mode) = self.material.alpha_mode else { return Ok(None) };
        let rule = |v: f64| match mode {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask => f64::from(v * factor >= cutoff),
            AlphaMode::Blend => v * factor,
        };
        if mode == AlphaMode::Opaque {
            return Ok(None);
        }
        let is_clear = match texture {
            None => false,
            Some(texture) => derived_image::has_opacity(self.images.image(texture)?),
        };
        let opacity = match texture.filter(|_| is_clear) {
            None => SlotNumber::Number(rule(1.0)),
            Some(texture) => self.number(texture, 3, &format!("3, {mode:?}, {factor}, {cutoff}"), rule)?,
        };
        Ok(Some(opacity).filter(|o| *o != SlotNumber::Number(1.0)))
    }

    fn normals(&mut self) -> Result<Option<(etendue_scene::asset::SlotPicture, f64)>, Problem> {
        const MAX_STRENGTH: f64 = 10.0;
        let Some(map) = &self.material.normal_texture else { return Ok(None) };
        let strength = f64::from(map.scale);
        if !(0.0..=MAX_STRENGTH).contains(&strength) {
            self.notes
                .push(format!("the normal map is not used: its scale is {strength}; expected 0 … {MAX_STRENGTH}"));
            return Ok(None);
        }
        Ok(Some((self.images.original(map.index.value(), false)?, strength)))
    }

    fn note_unused(&mut self, is_unlit: bool, layers: &SlotLayers) {
        let material = self.material;
        let used = uses(material);
        let others = used.iter().skip(1).filter(|u| u.layout != used[0].layout).count();
        let has = |name: &str| document::extension(material, name).is_some();
        let is_metal = layers.metal == SlotNumber::Number(1.0);
        let coated = matches!(layers.top_layer, SlotTopLayer::TwoCoats { .. } | SlotTopLayer::Sheen { .. });
        let mut notes = vec![
            (
                others > 0,
                format!(
                    "{others} textures have other coordinates or transforms than the first; those of the first are used for all"
                ),
            ),
            (
                material.occlusion_texture.is_some(),
                "the occlusion texture is not used: occlusion is computed by ray tracing".to_owned(),
            ),
            (is_unlit, "unlit is not physical: the material is rendered as diffuse in its base colour".to_owned()),
            (is_metal && coated, "the clear coat or sheen over metal is not used".to_owned()),
            (
                layers.emission.is_some() && !is_unlit,
                "the emission is in cd/m², as in the specification: 1 cd/m² is as dark as dusk".to_owned(),
            ),
        ];
        for name in [
            "KHR_materials_anisotropy",
            "KHR_materials_iridescence",
            "KHR_materials_dispersion",
            "KHR_materials_pbrSpecularGlossiness",
        ] {
            notes.push((has(name), format!("{name} is not used")));
        }
        self.notes.extend(notes.into_iter().filter(|(is, _)| *is).map(|(_, note)| note));
    }
}
