//! Effects of light transport.

use super::planned_effect::{EffectGroup, PlannedEffect, camera_change, required_if};
use crate::plan::{CameraPlan, Plan, Settings};
use crate::render::training;
use crate::report::FrameCost;
use crate::report::cpu_time::{DIRECT_PATH_CPU_S, FLAT_PATH_CPU_S, TWO_BOUNCES_CPU_S, branches_fraction, path_cpu_s};
use crate::sizes::block::Blocks;
use etendue_core::EffectStatus;
use etendue_core::{Integrator, LightSampling};
use etendue_tracer::integrator::PathSettings;

const GROUP: EffectGroup = EffectGroup::LightTransport;

pub(super) fn effects(plan: &Plan, camera: &CameraPlan) -> Vec<PlannedEffect> {
    let paths = FrameCost::new(plan, camera).paths;
    vec![
        first_surfaces(paths),
        shadows(camera, paths),
        indirect_light(camera, paths),
        later_bounces(camera, paths),
        beyond_the_limit(&camera.settings),
        caustics(camera),
        regularization(camera),
        light_sampling(camera),
        guiding(camera),
        branches(camera, paths),
        path_reuse(camera),
        adaptive_sampling(camera),
        never("polarisation"),
        never("fluorescence"),
    ]
}

fn first_surfaces(paths: f64) -> PlannedEffect {
    let status = EffectStatus::Modelled("the first surface that each camera ray hits is shaded".to_owned());
    let cpu_s = paths * FLAT_PATH_CPU_S;
    PlannedEffect { cpu_s: Some(cpu_s), ..PlannedEffect::new(GROUP, "primary rays and shading", status) }
}

fn shadows(camera: &CameraPlan, paths: f64) -> PlannedEffect {
    let integrator = camera.settings.paths.integrator;
    let status = required_if(
        integrator != Integrator::Flat,
        "a shadow ray to each sampled light finds occluders",
        "integrator = \"flat\" traces no shadow rays",
    );
    let cpu_s = paths * (DIRECT_PATH_CPU_S - FLAT_PATH_CPU_S);
    let effect = PlannedEffect::new(GROUP, "shadows", status).described_by("render.integrator").with_cpu_time(cpu_s);
    effect.dropped_by([camera_change(camera, "render.integrator", "flat")]).with_saving(saved_by(
        camera,
        paths,
        FLAT_PATH_CPU_S,
    ))
}

fn indirect_light(camera: &CameraPlan, paths: f64) -> PlannedEffect {
    let settings = &camera.settings;
    let status = required_if(
        settings.paths.integrator == Integrator::Path && settings.paths.max_bounces > 1,
        format!("paths continue by BSDF sampling, over at most {} surfaces", settings.paths.max_bounces),
        match settings.paths.integrator {
            Integrator::Path => "a path of one bounce ends at the first surface",
            Integrator::Flat | Integrator::Direct => "requires integrator = \"path\"",
        },
    );
    PlannedEffect::new(GROUP, "indirect light", status)
        .described_by("render.integrator")
        .dropped_by([camera_change(camera, "render.integrator", "direct")])
        .with_cpu_time(paths * (path_cpu_s(camera) - DIRECT_PATH_CPU_S))
        .with_saving(saved_by(camera, paths, DIRECT_PATH_CPU_S))
}

/// Time saved by an integrator of `sample_s` per sample, s: branches, and paths that train the guiding, go with the paths.
fn saved_by(camera: &CameraPlan, paths: f64, sample_s: f64) -> f64 {
    paths * path_cpu_s(camera) + branches_cpu_s(camera, paths) - branched_paths(camera, paths) * sample_s
}

/// Limit of two surfaces: direct light, and light reflected once.
const TWO_BOUNCES: u32 = 2;

fn later_bounces(camera: &CameraPlan, paths: f64) -> PlannedEffect {
    let PathSettings { integrator, max_bounces, .. } = camera.settings.paths;
    let status = if integrator == Integrator::Path && max_bounces > TWO_BOUNCES {
        let text = format!("surfaces 3 to {max_bounces} of a path, unless Russian roulette ends it");
        EffectStatus::WhereNeeded(text)
    } else {
        EffectStatus::LeftOut("a path hits at most two surfaces".to_owned())
    };
    let of_path_s = path_cpu_s(camera) - TWO_BOUNCES_CPU_S;
    PlannedEffect::new(GROUP, "bounces beyond the second", status)
        .described_by("render.max_bounces")
        .dropped_by([camera_change(camera, "render.max_bounces", "2")])
        .with_cpu_time(paths * of_path_s)
        .with_saving(of_path_s * (paths + branched_paths(camera, paths) * branches_fraction(camera)))
}

fn beyond_the_limit(settings: &Settings) -> PlannedEffect {
    let absent_reason = format!("light scattered by more than {} surfaces is missing", settings.paths.max_bounces);
    let effect = PlannedEffect::new(GROUP, "bounces beyond the limit", EffectStatus::LeftOut(absent_reason));
    effect.described_by("render.max_bounces")
}

fn caustics(camera: &CameraPlan) -> PlannedEffect {
    let settings = &camera.settings;
    let status = if settings.paths.integrator == Integrator::Path && settings.paths.caustics {
        let text = "light that reaches diffuse surfaces via smooth ones, for paths that leave a diffuse surface and \
                    hit a smooth one";
        EffectStatus::WhereNeeded(text.to_owned())
    } else {
        EffectStatus::LeftOut(match settings.paths.integrator {
            Integrator::Path => "caustics = false omits light that smooth surfaces cast on diffuse ones, and mirrors \
                                 on much less glossy ones"
                .to_owned(),
            Integrator::Flat | Integrator::Direct => "requires integrator = \"path\"".to_owned(),
        })
    };
    let effect = PlannedEffect::new(GROUP, "caustics", status).described_by("render.caustics");
    effect.dropped_by([camera_change(camera, "render.caustics", "false")])
}

fn regularization(camera: &CameraPlan) -> PlannedEffect {
    let status = required_if(
        camera.settings.paths.regularize,
        "metals, coats, glass and paint that a path hits after a wider lobe are roughened (biased)".to_owned(),
        "BSDF lobes are not roughened",
    );
    let effect = PlannedEffect::new(GROUP, "regularisation", status).described_by("render.regularize");
    effect.dropped_by([camera_change(camera, "render.regularize", "false")])
}

fn guiding(camera: &CameraPlan) -> PlannedEffect {
    let paths = if camera.settings.guiding { training::paths_of(camera) } else { 0 };
    let status = required_if(
        paths > 0,
        format!("directions at diffuse surfaces are sampled from a distribution learned from {paths} training paths"),
        "directions at diffuse surfaces are cosine-weighted samples",
    );
    let effect = PlannedEffect::new(GROUP, "path guiding", status).described_by("render.guiding");
    effect
        .dropped_by([camera_change(camera, "render.guiding", "false")])
        .with_cpu_time(paths as f64 * path_cpu_s(camera))
}

/// Paths of a camera that may branch: all except those that train the guiding.
fn branched_paths(camera: &CameraPlan, paths: f64) -> f64 {
    let learning = if camera.settings.guiding { training::paths_of(camera) as f64 } else { 0.0 };
    (paths - learning).max(0.0)
}

/// CPU time of all branches except the first of each path, s.
fn branches_cpu_s(camera: &CameraPlan, paths: f64) -> f64 {
    branched_paths(camera, paths) * branches_fraction(camera) * path_cpu_s(camera)
}

fn branches(camera: &CameraPlan, paths: f64) -> PlannedEffect {
    let branches = camera.settings.paths.branches;
    let status = required_if(
        branches > 1,
        format!("{branches} lights are sampled and {branches} paths continue at the first surface of each sample"),
        "one light is sampled and one path continues at the first surface of each sample",
    );
    let effect = PlannedEffect::new(GROUP, "branched paths", status).described_by("render.branches");
    effect.dropped_by([camera_change(camera, "render.branches", "1")]).with_cpu_time(branches_cpu_s(camera, paths))
}

fn light_sampling(camera: &CameraPlan) -> PlannedEffect {
    let status = match camera.settings.paths.light_sampling {
        LightSampling::Gloss => {
            let text = "at glossy surfaces, lights are also sampled by the radiance that the BSDF reflects";
            EffectStatus::WhereNeeded(text.to_owned())
        }
        LightSampling::Irradiance => EffectStatus::LeftOut(
            "lights are sampled by their irradiance only: reflections of lights are noisier".to_owned(),
        ),
    };
    let effect =
        PlannedEffect::new(GROUP, "BSDF-weighted light sampling", status).described_by("render.light_sampling");
    effect.dropped_by([camera_change(camera, "render.light_sampling", "irradiance")])
}

fn path_reuse(camera: &CameraPlan) -> PlannedEffect {
    let blocks = camera.settings.blocks;
    let status = required_if(
        blocks != Blocks::SINGLE,
        format!("blocks of {} pixels share path tails, so their errors are correlated", blocks.len_px()),
        "each pixel has its own paths",
    );
    let effect = PlannedEffect::new(GROUP, "path reuse", status).described_by("render.path_reuse_px");
    effect.dropped_by([camera_change(camera, "render.path_reuse_px", "1")])
}

fn adaptive_sampling(camera: &CameraPlan) -> PlannedEffect {
    let (name, key) = ("adaptive sampling", "render.noise_threshold");
    let Some(limit) = camera.settings.adaptive else {
        let status = EffectStatus::LeftOut(format!("every pixel receives {} samples", camera.settings.spp));
        return PlannedEffect::new(GROUP, name, status).described_by(key);
    };
    let text = format!("pixels whose error is small enough stop at {} samples", limit.min_spp);
    PlannedEffect::new(GROUP, name, EffectStatus::WhereNeeded(text)).described_by(key).dropped_by([camera_change(
        camera,
        "render.spp",
        &limit.min_spp.to_string(),
    )])
}

fn never(name: &'static str) -> PlannedEffect {
    PlannedEffect::new(GROUP, name, EffectStatus::LeftOut("not modelled by this program".to_owned()))
}
