//! Geometry, materials and light sources.

use super::planned_effect::{EffectGroup, PlannedEffect, required_if};
use crate::plan::{CameraPlan, Plan, TimeDependence};
use crate::render::light_counts;
use crate::report::memory::TextureUse;
use etendue_core::EffectStatus;
use etendue_tracer::lights::{LightCounts, Profile};

const GROUP: EffectGroup = EffectGroup::Scene;

pub(super) fn effects(plan: &Plan, camera: &CameraPlan) -> Vec<PlannedEffect> {
    let lights = light_counts(plan, camera);
    vec![
        instances(plan),
        textures(plan),
        normal_maps(plan),
        transparency(plan),
        motion(camera),
        modulation(plan),
        sun(plan, &lights),
        environment(plan, &lights),
        lamps(&lights),
        measured_lamps(plan),
        glowing_surfaces(&lights),
    ]
}

/// Guarded if present.
fn required_if_present(is_there: bool, reason: impl Into<String>, absent_reason: &str) -> EffectStatus {
    if is_there { EffectStatus::WhereNeeded(reason.into()) } else { EffectStatus::LeftOut(absent_reason.to_owned()) }
}

fn instances(plan: &Plan) -> PlannedEffect {
    let (instances, meshes) = (plan.world.instances().len(), plan.world.meshes().len());
    let status = required_if(
        instances > meshes && meshes > 0,
        format!("{instances} instances share {meshes} meshes, each stored once"),
        "no mesh is used more than once",
    );
    PlannedEffect::new(GROUP, "instances", status).described_by("scene.objects")
}

fn textures(plan: &Plan) -> PlannedEffect {
    let count = plan.material_table.textures().len();
    let text = format!("{count} images, evaluated only where the surface hit has one");
    let memory = TextureUse::from_materials(&plan.material_table);
    let text = memory.tiles().map_or(text.clone(), |tiles| format!("{text}; {tiles}"));
    let status = required_if_present(count > 0, text, "no surface has a texture");
    let bytes = memory.memory_bytes() as f64;
    PlannedEffect::new(GROUP, "textures", status).described_by("scene.textures").with_memory(bytes)
}

fn normal_maps(plan: &Plan) -> PlannedEffect {
    let count = plan.material_table.materials().iter().filter(|material| material.normal_map.is_some()).count();
    let text = format!("of {count} materials; tangents are evaluated only for these");
    let status = required_if_present(count > 0, text, "no material has a normal map");
    PlannedEffect::new(GROUP, "normal maps", status).described_by("scene.materials.normal_map")
}

fn transparency(plan: &Plan) -> PlannedEffect {
    let text = "shadow rays evaluate materials with an opacity and thin sheets, which transmit light undeviated; other \
                materials block them";
    let status =
        required_if_present(plan.material_table.has_passages(), text, "no material transmits light undeviated");
    PlannedEffect::new(GROUP, "transparency", status).described_by("scene.materials.opacity")
}

fn motion(camera: &CameraPlan) -> PlannedEffect {
    let status = required_if(
        camera.time == TimeDependence::Motion,
        "motion during the exposure: each sample has a time within the exposure of its row",
        "no motion is visible to the camera",
    );
    PlannedEffect::new(GROUP, "motion", status).described_by("scene.frames")
}

fn modulation(plan: &Plan) -> PlannedEffect {
    let text = "each row receives the mean of a light over its exposure, evaluated only for lights that change";
    let status = required_if_present(plan.is_modulated(), text, "all lights are constant");
    PlannedEffect::new(GROUP, "time-varying lights", status).described_by("scene.lights.modulation")
}

/// The sun of a sky, or suns among the lights. One key leaves out a sky's; those among the lights are named in their list.
fn sun(plan: &Plan, lights: &LightCounts) -> PlannedEffect {
    let status = required_if(lights.suns > 0, format!("{} sampled at each surface", discs(lights.suns)), "none");
    let is_of_sky = plan.sky.is_some_and(|sky| sky.sun_lx > 0.0) && plan.sources.suns.len() == 1;
    let effect = PlannedEffect::new(GROUP, "sun", status).described_by("scene.environment.sun");
    effect.dropped_by(is_of_sky.then(|| "scene.environment.sun=false".to_owned()))
}

fn discs(count: usize) -> String {
    if count == 1 { "its disc is".to_owned() } else { format!("{count} discs are") }
}

fn environment(plan: &Plan, lights: &LightCounts) -> PlannedEffect {
    let (text, is_there) = match lights {
        LightCounts { sky: true, .. } => ("a clear sky, sampled at each surface", true),
        LightCounts { image_environment: true, .. } => ("an environment map, sampled at each surface", true),
        _ => ("uniform radiance from all directions", lights.uniform_environment),
    };
    let status = required_if(is_there, text, "no light comes from infinity");
    let effect = PlannedEffect::new(GROUP, "sky and environment", status).described_by("scene.environment");
    effect.dropped_by(plan.sources.environment.is_some().then(|| "scene.environment=null".to_owned()))
}

/// The list of lights is removed as a whole, including its suns and its luminous openings.
fn lamps(lights: &LightCounts) -> PlannedEffect {
    let count = lights.lamps + lights.openings;
    let text = format!("{count} lights, sampled by their contribution at each surface");
    let status = required_if(count > 0, text, "none");
    let effect = PlannedEffect::new(GROUP, "light sources", status).described_by("scene.lights");
    effect.dropped_by(["scene.lights=null".to_owned()])
}

fn measured_lamps(plan: &Plan) -> PlannedEffect {
    let is_measured =
        |profile: &Profile| matches!(profile, Profile::PhotometricGrid(_) | Profile::Masked(_) | Profile::MaskImage(_));
    let count = plan.sources.lamps.iter().filter(|lamp| is_measured(lamp.profile())).count();
    let text = format!("{count} lights; intensity distributions are evaluated only for these");
    let status = required_if_present(count > 0, text, "no light has a measured distribution");
    PlannedEffect::new(GROUP, "photometric distributions", status).described_by("scene.lights.file")
}

fn glowing_surfaces(lights: &LightCounts) -> PlannedEffect {
    let count = lights.triangles + lights.spheres;
    let status = required_if(count > 0, format!("{count} triangles and spheres emit light"), "no surface emits light");
    PlannedEffect::new(GROUP, "emissive surfaces", status).described_by("scene.materials.emission")
}
