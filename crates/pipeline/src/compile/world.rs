//! Meshes, shapes and their instances: from records to the tracer's world.

use super::context::{Context, ErrorCode};
use super::frames::Frames;
use super::material::{MaterialTableBuilder, has_picture};
use super::object_motion::placements;
use super::opening::LampWithOpening;
use super::{opening, shape, vertex_animation};
use crate::plan::Identity;
use etendue_core::Accelerator;
use etendue_scene::asset::{MeshAsset, SlotMaterial, SlotReflectance, SlotSurface};
use etendue_scene::record::shape::Shape as ShapeRecord;
use etendue_scene::record::{self, Body, Object, Scene};
use etendue_scene::{CameraSetup, Description};
use etendue_tracer::MaterialId;
use etendue_tracer::accel::{World, WorldBuilder};
use etendue_tracer::geometry::{DroppedTriangles, Instance, Mesh, MeshError, MeshId, Shape};
use etendue_tracer::lights::Lamp;
use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Reflectance of a material whose library does not exist: a neutral grey.
const MISSING_GREY: f64 = 0.5;

/// World with the openings of lamps, the identities of its ground truth in the order of the instance ids from 1, and the lamps of the openings.
pub(super) fn world(
    description: &Description,
    lamps_with_opening: Vec<LampWithOpening>,
    frames: &Frames<'_>,
    material_table: &mut MaterialTableBuilder,
    context: &mut Context<'_>,
) -> Option<(World, Vec<Identity>, Vec<Lamp>)> {
    let (scene, unused) = (&description.scene, &description.unused);
    let builder = WorldBuilder::new().with_tree_quality(tree_quality(&description.cameras));
    let mut assembly = Assembly { builder, meshes: BTreeMap::new(), identities: Vec::new() };
    for mesh in scene.meshes.iter().filter(|mesh| !unused.meshes.contains(&mesh.name.value)) {
        assembly.add_mesh(mesh, context);
    }
    for object in &scene.objects {
        assembly.add_object(object, scene, frames, material_table, context);
    }
    let Assembly { mut builder, mut identities, .. } = assembly;
    let lamps = opening::place_openings(lamps_with_opening, &mut builder, &mut identities, material_table, context);
    if !context.errors.is_empty() {
        return None;
    }
    let built = builder.build();
    let place = scene.place.clone();
    Some((context.accept(&place, built)?, identities, lamps))
}

/// Highest requested quality: all cameras share one world.
fn tree_quality(cameras: &[CameraSetup]) -> Accelerator {
    let accelerator =
        |camera: &CameraSetup| camera.render.accelerator.as_ref().map_or(Accelerator::Default, |key| key.value);
    cameras.iter().map(accelerator).max().unwrap_or_default()
}

struct Assembly {
    builder: WorldBuilder,
    meshes: BTreeMap<String, MeshId>,
    identities: Vec<Identity>,
}

/// Data shared by an object's instances.
struct Prototype {
    shape: Shape,
    materials: Vec<MaterialId>,
    /// Transform from the shape's own frame to the object's.
    to_object: DAffine3,
    /// Rotation from the object's axes to the shape's.
    axes: DMat3,
}

impl Assembly {
    fn add_mesh(&mut self, record: &record::Mesh, context: &mut Context<'_>) {
        let file = record.file();
        let Some(asset) = context.assets.meshes.get(&file.value) else {
            context.error(
                ErrorCode::UnreadableFile,
                &file.place,
                "the mesh was not loaded",
                "give a readable OBJ file",
            );
            return;
        };
        asset.report.iter().for_each(|line| context.note(line));
        asset.warnings.iter().for_each(|line| context.warn(line));
        let mesh = match record.animation() {
            None => mesh_of(asset),
            Some(animation) => match vertex_animation::mesh(animation, asset, context) {
                Some(mesh) => mesh,
                None => return,
            },
        };
        let Some((mesh, dropped_triangles)) = context.accept(&file.place, mesh) else { return };
        let mesh = mesh.with_origin(DVec3::from_array(asset.origin));
        if dropped_triangles != DroppedTriangles::default() {
            let DroppedTriangles { zero_area, duplicate, .. } = dropped_triangles;
            let message = format!("{zero_area} triangles of zero area and {duplicate} duplicates are removed");
            context.warn_on(file.value.display(), message);
        }
        let id = self.builder.add_mesh(mesh);
        self.meshes.insert(record.name.value.clone(), id);
    }

    fn add_object(
        &mut self,
        object: &Object,
        scene: &Scene,
        frames: &Frames<'_>,
        material_table: &mut MaterialTableBuilder,
        context: &mut Context<'_>,
    ) {
        let prototype = match &object.body {
            Body::Mesh(name) => self.mesh_object(object, &name.value, scene, material_table, context),
            Body::Shape(shape) => self.shape_object(object, shape, material_table, context),
        };
        let Some(prototype) = prototype else { return };
        let class = class_of(object, scene);
        let Some(placements) = placements(object, frames, context) else { return };
        let many = placements.len() > 1;
        for (number, (to_world, name)) in placements.into_iter().enumerate() {
            let numbered =
                if many { format!("{} {}", object.name.value, number + 1) } else { object.name.value.clone() };
            let name = name.map_or(numbered, |n| n.value.clone());
            let class_name = object.class.as_ref().map(|c| c.value.clone());
            self.identities.push(Identity { name, class: class_name, axes: prototype.axes });
            let mut instance = Instance {
                shape: prototype.shape,
                to_world: to_world.after(&prototype.to_object),
                materials: prototype.materials.clone(),
                instance_id: self.identities.len() as u32,
                semantic_id: class,
            };
            self.apply_flux_area(&mut instance, object, material_table, context);
            delay_light(&mut instance, object, number, material_table, context);
            self.builder.add_instance(instance);
        }
    }

    /// Replaces materials with a stated flux by variants for their area on this instance.
    fn apply_flux_area(
        &self,
        instance: &mut Instance,
        object: &Object,
        material_table: &mut MaterialTableBuilder,
        context: &mut Context<'_>,
    ) {
        let shared: Vec<_> =
            instance.materials.iter().copied().filter(|id| material_table.has_stated_flux(*id)).collect();
        for id in shared {
            match self.builder.area_m2(instance, id) {
                // None of its surfaces has the material, or another slot with the same material was processed.
                Some(0.0) => {}
                Some(area_m2) => {
                    let like = material_table.with_area(id, area_m2);
                    instance.materials.iter_mut().filter(|m| **m == id).for_each(|m| *m = like);
                }
                None if !instance.to_world.keeps_areas() => context.error(
                    ErrorCode::NotModelled,
                    &object.place,
                    "the flux of a light requires a constant area, but the scale of this surface changes over time",
                    "give its keys one scale, or give the light's luminance or radiance",
                ),
                None => context.error(
                    ErrorCode::NotModelled,
                    &object.place,
                    "the flux of a light requires a known area, but this sphere is scaled non-uniformly",
                    "scale it uniformly, or give the light's luminance or radiance",
                ),
            }
        }
    }

    fn mesh_object(
        &self,
        object: &Object,
        name: &str,
        scene: &Scene,
        material_table: &mut MaterialTableBuilder,
        context: &mut Context<'_>,
    ) -> Option<Prototype> {
        let record = scene.meshes.iter().find(|m| m.name.value == name)?;
        let asset = context.assets.meshes.get(&record.file().value)?;
        let shape = Shape::Mesh(*self.meshes.get(name)?);
        let materials = slot_materials(object, record, asset, material_table, context)?;
        check_coordinates(record, asset, &materials, material_table, object, context);
        if record.animation().is_some() && materials.iter().any(|id| material_table.is_emissive(*id)) {
            let problem =
                format!("the vertices of \"{name}\" move, but an emissive surface must have a constant shape");
            context.error(
                ErrorCode::NotModelled,
                &object.place,
                problem,
                "give it a material without emission, or a mesh of one \"file\"",
            );
            return None;
        }
        let to_object = DAffine3::from_mat3(record.to_object()) * DAffine3::from_translation(asset.origin.into());
        Some(Prototype { shape, materials, to_object, axes: record.axes().transpose() })
    }

    fn shape_object(
        &mut self,
        object: &Object,
        record: &ShapeRecord,
        material_table: &MaterialTableBuilder,
        context: &mut Context<'_>,
    ) -> Option<Prototype> {
        let material = material_table.named(&object.material.as_ref()?.value)?;
        let shape = match record {
            ShapeRecord::Sphere(sphere) => Shape::Sphere { radius_m: sphere.radius_m.value },
            ShapeRecord::Quad(quad) => self.own_mesh(shape::quad(quad.size_m.value).into_mesh(), object, context)?,
            ShapeRecord::Box(cuboid) => {
                self.own_mesh(shape::cuboid(cuboid.size_m.value).into_mesh(), object, context)?
            }
            ShapeRecord::Disc(disc) => self.own_mesh(shape::disc(disc.radius_m.value), object, context)?,
        };
        Some(Prototype { shape, materials: vec![material], to_object: DAffine3::IDENTITY, axes: DMat3::IDENTITY })
    }

    fn own_mesh(
        &mut self,
        mesh: Result<(Mesh, DroppedTriangles), MeshError>,
        object: &Object,
        context: &mut Context<'_>,
    ) -> Option<Shape> {
        let (mesh, _) = context.accept(&object.place, mesh)?;
        Some(Shape::Mesh(self.builder.add_mesh(mesh)))
    }
}

/// Delays the modulated light of an object's instance as it states.
fn delay_light(
    instance: &mut Instance,
    object: &Object,
    number: usize,
    material_table: &mut MaterialTableBuilder,
    context: &mut Context<'_>,
) {
    let own = object.instances.get(number).and_then(|place| place.modulation_delay_s.as_ref());
    let own_s = own.map_or(0.0, |delay| delay.value);
    let name = format!("{} {}", object.name.value, number + 1);
    let mut is_modulated = false;
    for id in instance.materials.iter_mut() {
        if !material_table.is_modulated(*id) {
            continue;
        }
        is_modulated = true;
        *id = material_table.with_delay(*id, own_s, &name);
    }
    if let (Some(delay), false) = (own, is_modulated) {
        let problem = "\"modulation_delay_s\" has no effect on an object whose light does not change";
        context.error(
            ErrorCode::NoEffect,
            &delay.place,
            problem,
            "remove it, or add \"modulation\" to the emission of its material",
        );
    }
}

fn class_of(object: &Object, scene: &Scene) -> u32 {
    let number =
        |class: &str| scene.classes.iter().find(|(name, _)| name.value == class).map(|(_, id)| id.value as u32);
    object.class.as_ref().and_then(|class| number(&class.value)).unwrap_or(0)
}

/// Material of each slot: the object's, the one that it names for the slot, or that of the mesh's own file.
fn slot_materials(
    object: &Object,
    mesh: &record::Mesh,
    asset: &MeshAsset,
    material_table: &mut MaterialTableBuilder,
    context: &mut Context<'_>,
) -> Option<Vec<MaterialId>> {
    if let Some(material) = &object.material {
        return Some(vec![material_table.named(&material.value)?; asset.slot_materials.len().max(1)]);
    }
    for (slot, _) in &object.materials {
        check_slot(slot, mesh, asset, context);
    }
    let named = |slot: &str| object.materials.iter().find(|(name, _)| name.value == slot).map(|(_, m)| m);
    let visible = asset.shown_slots();
    asset
        .slot_materials
        .iter()
        .zip(visible)
        .map(|(slot, is_shown)| match named(&slot.name) {
            Some(material) => material_table.named(&material.value),
            None => {
                let slot = match is_shown || !has_picture(slot) {
                    true => slot_or_grey(slot, mesh, asset, context),
                    false => Cow::Owned(unused_slot(slot)),
                };
                material_table.add_slot(&mesh.file().value, &slot, &object.place, context)
            }
        })
        .collect()
}

/// Black placeholder for a material of an image that no triangle has and that is not read.
fn unused_slot(slot: &SlotMaterial) -> SlotMaterial {
    let reflectance = SlotReflectance::LinearSrgb([0.0; 3]);
    SlotMaterial { name: slot.name.clone(), surface: Some(SlotSurface::Diffuse { reflectance }) }
}

/// A slot, or a grey placeholder if the library that defines it does not exist.
fn slot_or_grey<'a>(
    slot: &'a SlotMaterial,
    mesh: &record::Mesh,
    asset: &MeshAsset,
    context: &mut Context<'_>,
) -> Cow<'a, SlotMaterial> {
    if slot.surface.is_some() || slot.name.is_empty() || asset.missing_libraries.is_empty() {
        return Cow::Borrowed(slot);
    }
    let subject = format!("{}, material \"{}\"", mesh.file().value.display(), slot.name);
    let missing = asset.missing_libraries.join("; ");
    context.warn_on(subject, format!("{missing}: grey of reflectance {MISSING_GREY} is used instead"));
    let reflectance = SlotReflectance::LinearSrgb([MISSING_GREY; 3]);
    Cow::Owned(SlotMaterial { name: slot.name.clone(), surface: Some(SlotSurface::Diffuse { reflectance }) })
}

/// Refuses a texture on a mesh without texture coordinates: it would show one texel everywhere.
fn check_coordinates(
    mesh: &record::Mesh,
    asset: &MeshAsset,
    materials: &[MaterialId],
    material_table: &MaterialTableBuilder,
    object: &Object,
    context: &mut Context<'_>,
) {
    if let (true, Some(name)) =
        (asset.uvs.is_empty(), materials.iter().find_map(|id| material_table.needs_coordinates(*id)))
    {
        let file = mesh.file();
        let problem =
            format!("{} has no texture coordinates, but its material \"{name}\" requires them", file.value.display());
        context.error(
            ErrorCode::UnsuitableFile,
            &object.place,
            problem,
            "export them with the mesh, or use a material without textures and multiplexed rows",
        );
    }
}

fn check_slot(slot: &etendue_scene::Placed<String>, mesh: &record::Mesh, asset: &MeshAsset, context: &mut Context<'_>) {
    if asset.slot_materials.iter().all(|s| s.name != slot.value) {
        let known: Vec<&str> = asset.slot_materials.iter().map(|s| s.name.as_str()).filter(|n| !n.is_empty()).collect();
        let problem = format!("{} has no material \"{}\"", mesh.file().value.display(), slot.value);
        let remedy = match known.is_empty() {
            true => "the file names no materials; give \"material\" instead of \"materials\"".to_owned(),
            false => format!("give one of {}", known.join(", ")),
        };
        context.error(ErrorCode::UnknownName, &slot.place, problem, remedy);
    }
}

fn mesh_of(asset: &MeshAsset) -> Result<(Mesh, DroppedTriangles), etendue_tracer::geometry::MeshError> {
    let vectors = |list: &[[f32; 3]]| list.iter().copied().map(Vec3::from).collect();
    let uvs = asset.uvs.iter().copied().map(Vec2::from).collect();
    Mesh::new(vectors(&asset.positions), vectors(&asset.normals), uvs, asset.triangles.clone(), asset.slots.clone())
}
