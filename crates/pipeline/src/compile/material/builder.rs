//! Builds the table of materials, as the scene and its meshes name them.

use super::super::context::{Context, ErrorCode};
use super::super::modulation;
use super::compiler::MaterialCompiler;
use super::picture::Pictures;
use super::slot;
use etendue_scene::Place;
use etendue_scene::UnusedNames;
use etendue_scene::asset::{SlotMaterial, SlotSurface};
use etendue_scene::record::{self, Scene};
use etendue_spectra::upsample;
use etendue_tracer::MaterialId;
use etendue_tracer::materials::{Material, MaterialTable, Modulation, Reflectance, Surface};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Materials and textures found so far, and the place where each was named.
#[derive(Default)]
pub(in super::super) struct MaterialTableBuilder {
    materials: Vec<CompiledMaterial>,
    by_name: BTreeMap<String, MaterialId>,
    /// Materials from mesh files, by mesh file and slot name.
    by_slot: BTreeMap<(PathBuf, String), MaterialId>,
    /// Materials with a stated flux, by the bits of the area that emits it.
    by_area: BTreeMap<(u32, u64), MaterialId>,
    /// Materials with a delayed modulation, by the bits of the delay.
    by_delay: BTreeMap<(u32, u64), MaterialId>,
    /// Material of lamps' openings, once there are any.
    opening_material: Option<MaterialId>,
    pub(super) pictures: Pictures,
}

/// A material with its properties.
struct CompiledMaterial {
    material: Material,
    place: Place,
    name: String,
    /// True if any of its textures uses texture coordinates.
    needs_coordinates: bool,
    /// For a material with a stated flux: number of emissive sides. Its radiance is that of a total area of 1 m² until [`MaterialTableBuilder::with_area`]
    /// replaces it.
    flux_sides: Option<f64>,
    /// For a modulated material: true if each of its objects has its own phase.
    has_random_phases: bool,
}

impl CompiledMaterial {
    fn clone_properties(&self) -> Self {
        Self { material: self.material.clone(), place: self.place.clone(), name: self.name.clone(), ..*self }
    }

    /// Black placeholder for an unused material whose files are not read: material ids do not depend on use.
    fn unused(record: &record::Material) -> Self {
        Self {
            material: Material::new(Reflectance::Spectrum(upsample::reflectance_spectrum([0.0; 3]))),
            place: record.place.clone(),
            name: record.name.value.clone(),
            needs_coordinates: false,
            flux_sides: None,
            has_random_phases: false,
        }
    }
}

impl MaterialTableBuilder {
    /// All materials of a scene; unused ones whose files are not read have only a position in the list.
    pub(in super::super) fn from_scene(scene: &Scene, unused: &UnusedNames, context: &mut Context<'_>) -> Self {
        let mut builder = Self::default();
        for record in &scene.materials {
            if unused.unread.contains(&record.name.value) {
                builder.add(CompiledMaterial::unused(record));
                continue;
            }
            let images = &mut builder.pictures;
            let mut material_compiler = MaterialCompiler {
                scene,
                pictures: images,
                context,
                needs_coordinates: false,
                flux_sides: None,
                has_random_phases: false,
            };
            if let Some(material) = material_compiler.material(record) {
                let MaterialCompiler { needs_coordinates, flux_sides, has_random_phases, .. } = material_compiler;
                let (place, name) = (record.place.clone(), record.name.value.clone());
                let id = builder.add(CompiledMaterial {
                    material,
                    place,
                    name: name.clone(),
                    needs_coordinates,
                    flux_sides,
                    has_random_phases,
                });
                builder.by_name.insert(name, id);
            }
        }
        builder
    }

    /// Material with a name of the scene; `None` if it is invalid.
    pub(in super::super) fn named(&self, name: &str) -> Option<MaterialId> {
        self.by_name.get(name).copied()
    }

    /// Name of a material that has, directly or in a part, a texture with texture coordinates; `None` for others.
    pub(in super::super) fn needs_coordinates(&self, id: MaterialId) -> Option<&str> {
        let mut visited = vec![false; self.materials.len()];
        let mut open = vec![id];
        while let Some(id) = open.pop() {
            // An invalid part has no material.
            let Some(material) = self.materials.get(id.0 as usize) else { continue };
            if material.needs_coordinates {
                return Some(&material.name);
            }
            if let (Surface::Mix(mix), false) = (&material.material.surface, visited[id.0 as usize]) {
                open.extend([mix.a, mix.b]);
            }
            visited[id.0 as usize] = true;
        }
        None
    }

    /// Material that a mesh's own file states for a slot. Records an error at `place` if the file states none.
    pub(in super::super) fn add_slot(
        &mut self,
        file: &Path,
        slot: &SlotMaterial,
        place: &Place,
        context: &mut Context<'_>,
    ) -> Option<MaterialId> {
        let key = (file.to_owned(), slot.name.clone());
        if let Some(id) = self.by_slot.get(&key) {
            return Some(*id);
        }
        let needs_coordinates = slot::has_picture(slot);
        let material = match &slot.surface {
            Some(SlotSurface::Layers(layers)) => self.add_layers(layers, slot, place, context)?,
            _ => Material::new(slot::surface(file, slot, place, &mut self.pictures, context)?),
        };
        let id = self.add(CompiledMaterial {
            material,
            place: place.clone(),
            name: slot.name.clone(),
            needs_coordinates,
            flux_sides: None,
            has_random_phases: false,
        });
        self.by_slot.insert(key, id);
        Some(id)
    }

    /// Returns true if a material's light is stated as a flux, so that [`MaterialTableBuilder::with_area`] must make a variant.
    pub(in super::super) fn has_stated_flux(&self, id: MaterialId) -> bool {
        self.materials.get(id.0 as usize).is_some_and(|material| material.flux_sides.is_some())
    }

    /// Variant of a material with a stated flux for an object on which it has `area_m2` on one side.
    pub(in super::super) fn with_area(&mut self, id: MaterialId, area_m2: f64) -> MaterialId {
        let key = (id.0, area_m2.to_bits());
        if let Some(known) = self.by_area.get(&key) {
            return *known;
        }
        let material = &self.materials[id.0 as usize];
        let sides = material.flux_sides.unwrap_or(1.0);
        let mut like = material.clone_properties();
        if let Some(emission) = &mut like.material.emission {
            emission.radiance = emission.radiance.scaled(1.0 / (sides * area_m2));
        }
        let added = self.add(like);
        self.by_area.insert(key, added);
        added
    }

    /// Returns true if a material emits light.
    pub(in super::super) fn is_emissive(&self, id: MaterialId) -> bool {
        self.materials.get(id.0 as usize).is_some_and(|material| material.material.emission.is_some())
    }

    /// Returns true if the strength of a material's light varies over time.
    pub(in super::super) fn is_modulated(&self, id: MaterialId) -> bool {
        self.modulation(id).is_some()
    }

    fn modulation(&self, id: MaterialId) -> Option<&Modulation> {
        self.materials.get(id.0 as usize)?.material.emission.as_ref()?.modulation.as_ref()
    }

    /// Variant of a modulated material for an object `name`, delayed by `own_s` and by the phase that the material requires.
    pub(in super::super) fn with_delay(&mut self, id: MaterialId, own_s: f64, name: &str) -> MaterialId {
        let material = &self.materials[id.0 as usize];
        let waveform = self.modulation(id).filter(|_| material.has_random_phases).map(Modulation::waveform);
        let random_s = waveform.map_or(0.0, |w| modulation::random_delay_s(w, &format!("{name}, {}", material.name)));
        let delay_s = own_s + random_s;
        if delay_s == 0.0 {
            return id;
        }
        let key = (id.0, delay_s.to_bits());
        if let Some(known) = self.by_delay.get(&key) {
            return *known;
        }
        let mut like = material.clone_properties();
        if let Some(emission) = &mut like.material.emission {
            emission.modulation = emission.modulation.take().map(|modulation| modulation.later(delay_s));
        }
        let added = self.add(like);
        self.by_delay.insert(key, added);
        added
    }

    /// Black material of lamps' openings, which do not emit by their material.
    pub(in super::super) fn lamp_opening(&mut self, place: &Place) -> MaterialId {
        if let Some(known) = self.opening_material {
            return known;
        }
        let id = self.add(CompiledMaterial {
            material: Material::new(Surface::Absorber),
            place: place.clone(),
            name: "lamp opening".to_owned(),
            needs_coordinates: false,
            flux_sides: None,
            has_random_phases: false,
        });
        self.opening_material = Some(id);
        id
    }

    /// The material table, and the names of the materials in the order of their ids.
    pub(in super::super) fn finish(self, context: &mut Context<'_>) -> Option<(MaterialTable, Vec<String>)> {
        let names = self.materials.iter().map(|material| material.name.clone()).collect();
        let places: Vec<_> = self.materials.iter().map(|material| material.place.clone()).collect();
        let materials = self.materials.into_iter().map(|material| material.material).collect();
        match MaterialTable::new(materials, self.pictures.into_textures()) {
            Ok(material_table) => Some((material_table, names)),
            Err(error) => {
                if let Some(place) = error.material().and_then(|i| places.get(i)) {
                    context.error(ErrorCode::OutOfRange, place, error.to_string(), "");
                }
                None
            }
        }
    }

    /// A part of a material of a mesh's file, referenced by its mixes.
    pub(super) fn add_part(
        &mut self,
        material: Material,
        name: &str,
        place: &Place,
        needs_coordinates: bool,
    ) -> MaterialId {
        self.add(CompiledMaterial {
            material,
            place: place.clone(),
            name: name.to_owned(),
            needs_coordinates,
            flux_sides: None,
            has_random_phases: false,
        })
    }

    fn add(&mut self, material: CompiledMaterial) -> MaterialId {
        self.materials.push(material);
        MaterialId((self.materials.len() - 1) as u32)
    }
}

impl MaterialCompiler<'_, '_> {
    fn material(&mut self, record: &record::Material) -> Option<Material> {
        let surface = self.surface(&record.surface.0);
        let emission = record.emission.as_ref().map(|e| self.emission(e));
        let opacity = record.opacity.as_ref().map(|o| self.factor(o));
        let normal_map = record.normal_map.as_ref().map(|map| self.normal_map(map));
        Some(Material {
            surface: surface?,
            emission: transpose_valid(emission)?,
            opacity: transpose_valid(opacity)?,
            normal_map: transpose_valid(normal_map)?,
        })
    }
}

/// Distinguishes a valid or absent value from an invalid one (`None`).
#[allow(clippy::option_option, reason = "the outer level tells faults, the inner what is not given")]
fn transpose_valid<T>(value: Option<Option<T>>) -> Option<Option<T>> {
    match value {
        None => Some(None),
        Some(surface) => surface.map(Some),
    }
}
