//! Compiles a description and its assets to a plan.
//!
//! Names are resolved, models are built, and all contradictions are collected with their places. After this no error in the user's input remains.

mod air;
mod annotations;
mod camera;
mod camera_path;
mod choices;
mod coded_error;
mod context;
mod course;
mod coverage;
mod effects;
mod fingerprint;
mod frames;
mod front;
mod lamp;
mod lamp_motion;
mod lens;
mod light;
mod material;
mod medium;
mod modulation;
#[cfg(test)]
mod motion_tests;
mod object_motion;
mod opening;
mod picture;
mod point_spread_files;
mod precipitation;
mod processing;
mod products;
mod row_exposure;
mod samples;
mod scale;
mod sensor;
mod settings;
mod shape;
pub(crate) mod shared_light;
mod sky;
mod spectrum;
mod stated;
mod surroundings;
#[cfg(test)]
mod tests;
mod timing;
mod vertex_animation;
mod wavelengths;
mod weather;
mod world;

pub use choices::{Choices, Refinement};
pub use lens::stated_projection;

use crate::plan::note::grouped;
use crate::plan::{
    CameraBody, CameraPasses, CameraPlan, LightOwner, Plan, SourceSpectra, TimeDependence, hash_with_passes,
};
use camera_path::{camera_path, mount};
use context::{Context, ErrorCode};
use etendue_core::{CameraPath, Epoch, TimeInterval};
use etendue_scene::asset::Assets;
use etendue_scene::record::Camera;
use etendue_scene::{CameraSetup, Description, DescriptionError};
use etendue_tracer::accel::World;
use etendue_tracer::geometry::{Mesh, VertexAnimation};
use etendue_tracer::lights::spectral_fluxes;
use etendue_tracer::media::Medium;
use fingerprint::fingerprint;
use frames::Frames;
use material::MaterialTableBuilder;
use std::sync::Arc;
pub use weather::compile_weather;

/// Plan of a description.
///
/// # Errors
/// All contradictions, with their places.
pub fn compile(description: &Description, assets: &Assets, choices: &Choices) -> Result<Plan, Vec<DescriptionError>> {
    let mut context = Context::new(assets, timing::epoch(description.sequence.as_ref()));
    let plan = compile_plan(description, choices, &mut context);
    let errors = context.into_errors();
    plan.filter(|_| errors.is_empty()).ok_or(errors)
}

/// A single camera, for a stored radiance image.
///
/// # Errors
/// All contradictions, with their places.
pub fn compile_camera(camera: &Camera, assets: &Assets) -> Result<CameraBody, Vec<DescriptionError>> {
    compile_camera_with_remarks(camera, assets).map(|(body, _)| body)
}

/// Compiles a single camera, with the notes and warnings that a plan would have for it.
///
/// # Errors
/// As [`compile_camera`].
pub fn compile_camera_with_remarks(
    camera: &Camera,
    assets: &Assets,
) -> Result<(CameraBody, Vec<String>), Vec<DescriptionError>> {
    let mut context = Context::new(assets, Epoch::default());
    let body = camera::body(camera, &mut context);
    let notes = grouped(&context.notes).iter().map(ToString::to_string).collect();
    let errors = context.into_errors();
    body.filter(|_| errors.is_empty()).map(|body| (body, notes)).ok_or(errors)
}

fn compile_plan(description: &Description, choices: &Choices, context: &mut Context<'_>) -> Option<Plan> {
    let scene = &description.scene;
    let unused = &description.unused;
    unused.notes().into_iter().for_each(|note| context.note(note));
    let mut builder = MaterialTableBuilder::from_scene(scene, unused, context);
    let frames = Frames::new(scene, unused, context);
    let (mut sources, lamps_with_opening, sky) = light::sources(scene, &frames, context);
    let mut media = medium::media(scene, &frames, context);
    let precipitation = precipitation::precipitation(scene.precipitation.as_ref(), &mut media, context);
    let setups = (0..).zip(&description.cameras);
    let mut camera = |(index, setup)| camera_plan(index, setup, description, &frames, choices, context);
    let mut cameras: Vec<_> = setups.filter_map(&mut camera).collect();
    let (world, identities, opened) = world::world(description, lamps_with_opening, &frames, &mut builder, context)?;
    sources.lamps.extend(opened);
    for setup in &description.cameras {
        let Some(path) = camera_path(&setup.pose, &frames, context) else { continue };
        context.accept(setup.pose.stated_at(), world.check_reach_along(&path, whole_motion(&world, &path)));
    }
    let (material_table, materials) = builder.finish(context)?;
    let is_modulated = sources.is_modulated() || material_table.is_modulated();
    annotations::resolve(description, &mut cameras, context);
    let air_moves = precipitation.is_some() || media.iter().any(Medium::moves);
    timing::set_time_dependence(&mut cameras, &world, &sources, is_modulated, air_moves, context);
    let source_spectra = SourceSpectra::from_fluxes(spectral_fluxes(&world, &material_table, &sources));
    wavelengths::choose(&mut cameras, &source_spectra, description, context);
    shared_light::share_equal_light(&mut cameras);
    air::layers(description, &mut cameras, !media.is_empty(), precipitation.is_some(), context);
    air::note_light_loss(&cameras, &media, context);
    camera::note_rounded_positions(&cameras, context);
    surroundings::note_enclosed_cameras(&cameras, &world, &material_table, &materials, context);
    surroundings::warn_of_enclosed_media(scene, &frames, &world, &material_table, context);
    let classes = scene.classes.iter().map(|(name, id)| (name.value.clone(), id.value as u32)).collect();
    let rendered = cameras.iter().map(|camera| camera.settings.range);
    if let Some(note) = rendered.reduce(coverage::union).and_then(|range| context.coverage.note(range)) {
        context.note(note);
    }
    let notes = std::mem::take(&mut context.notes);
    let overridden_keys = [&description.overridden_keys[..], &context.overridden_keys].concat();
    if context.errors.is_empty() {
        refuse_unread_files(description, context);
    }
    let setups = description.cameras.iter().zip(&cameras);
    let passes: Vec<_> = setups.map(|(setup, camera)| camera_passes(setup, camera)).collect();
    let described = context.errors.is_empty().then(|| fingerprint(description, context.assets, choices, &passes))?;
    let hash = hash_with_passes(&described, &passes);
    Some(Plan {
        world: Arc::new(world),
        material_table: Arc::new(material_table),
        sources,
        source_spectra,
        media,
        precipitation,
        sky,
        cameras,
        identities,
        materials,
        classes,
        notes,
        overridden_keys,
        film_limit: None,
        hash,
        described,
        passes,
    })
}

/// Passes of a camera's samples.
fn camera_passes(setup: &CameraSetup, camera: &CameraPlan) -> CameraPasses {
    let is_open = setup.render.samples.replicates.as_ref().is_none_or(|key| !key.place.is_command_line());
    CameraPasses { replicates: camera.settings.replicates, is_open, passes: camera.passes.clone() }
}

/// Refuses files that are named but were not read, even if no step requested them: two contents would have one hash.
fn refuse_unread_files(description: &Description, context: &mut Context<'_>) {
    for request in context.assets.missing(&description.assets()) {
        let problem = format!("the file {} was not read", request.path.display());
        context.error(ErrorCode::UnreadableFile, &request.place, problem, "read all files that the description names");
    }
}

/// Interval from the first key of all motions to the last; an instant if nothing moves.
fn whole_motion(world: &World, camera: &CameraPath) -> TimeInterval {
    let moving = world.instances().iter().filter_map(|instance| instance.to_world.motion_interval());
    let animations = world.meshes().iter().filter_map(Mesh::animation).map(VertexAnimation::motion_interval);
    moving.chain(animations).chain(camera.motion_interval()).reduce(|all, one| all.union(&one)).unwrap_or_default()
}

fn camera_plan(
    index: u32,
    setup: &CameraSetup,
    description: &Description,
    frames: &Frames<'_>,
    choices: &Choices,
    context: &mut Context<'_>,
) -> Option<CameraPlan> {
    let body = camera::body(&setup.camera, context)?;
    let mut products = products::products(&setup.output, &body, context);
    let depth_of_field = settings::depth_of_field(&setup.render, &body, context)?;
    camera::warn_of_blur(&setup.name, &depth_of_field, &body, context);
    let (settings, passes) =
        settings::settings(&setup.render, &body, &depth_of_field, &setup.output, &mut products, choices, context)?;
    effects::check_spread_by(setup.camera.effects.as_ref(), &settings.route, context);
    let path = camera_path(&setup.pose, frames, context)?;
    let timing = timing::timing(index, setup, description.sequence.as_ref(), &body, settings.seed, context);
    let name = setup.name.value.clone();
    let light = LightOwner { camera: name.clone(), index };
    let time = TimeDependence::None;
    let mount = mount(&setup.pose);
    let camera =
        CameraPlan { name, index, light, path, mount, timing, time, body, settings, passes, depth_of_field, products };
    camera::check_video(&setup.output, &camera, context);
    Some(camera)
}
