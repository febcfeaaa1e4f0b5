//! Effects from the scene to the sensor plane.

use super::lens_errors::{blur_px, distortion_px, lateral_colour_px, vignetting_percent};
use super::planned_effect::{EffectGroup, PlannedEffect, camera_change, required_if, without};
use crate::plan::{CameraPlan, Plan, Route};
use crate::report::FrameCost;
use crate::report::cpu_time::path_cpu_s;
use etendue_core::EffectStatus;
use etendue_optics::effects::{Effect, SpreadMethod};
use etendue_optics::front::{Front, Optic};
use etendue_optics::{DepthOfField, Lens};

const GROUP: EffectGroup = EffectGroup::Lens;

pub(super) fn effects(plan: &Plan, camera: &CameraPlan) -> Vec<PlannedEffect> {
    let cost = FrameCost::new(plan, camera);
    let of_lens = vec![
        distortion(camera),
        vignetting(camera),
        clear_apertures(camera),
        defocus(camera),
        lateral_colour(camera),
        dispersion(camera),
        route(camera, &cost),
    ];
    let before = [mirror(camera), windscreen(camera), drops(camera), dirt(camera)];
    let behind = Effect::ALL.map(|effect| on_irradiance(camera, effect, &cost));
    of_lens.into_iter().chain(before).chain(behind).collect()
}

fn distortion(camera: &CameraPlan) -> PlannedEffect {
    let lens = &camera.body.lens;
    let status = match lens {
        Lens::Prescription(_) => EffectStatus::Modelled("rays are refracted at the lens surfaces".to_owned()),
        Lens::RayTransfer(_) => EffectStatus::Modelled("the ray transfer functions map each ray".to_owned()),
        Lens::Calibrated(_) => EffectStatus::Modelled("ray directions follow the calibrated projection".to_owned()),
        _ => required_if(
            lens.distortion().is_some(),
            "each sample's position on the sensor is displaced before its ray is generated",
            "the lens has no distortion",
        ),
    };
    let effect = PlannedEffect::new(GROUP, "distortion", status).described_by("lens.distortion");
    match distortion_px(&camera.body) {
        Some(shift_px) => {
            effect.dropped_by([without(camera, "lens.distortion")]).with_error("displacement up to", shift_px, "px")
        }
        None => effect,
    }
}

fn vignetting(camera: &CameraPlan) -> PlannedEffect {
    let status = required_if(
        !matches!(camera.body.lens, Lens::Telecentric(_)),
        "each ray is weighted by the solid angle of the pupil seen from its pixel",
        "all pixels of a telecentric camera see the pupil under the same solid angle",
    );
    let effect = PlannedEffect::new(GROUP, "vignetting", status).described_by("lens.type");
    match vignetting_percent(&camera.body) {
        Some(percent) => effect.with_error("missing corner darkening", percent, "%"),
        None => effect,
    }
}

fn clear_apertures(camera: &CameraPlan) -> PlannedEffect {
    let (name, key) = ("mechanical vignetting", "lens.front_aperture");
    let apertures = match &camera.body.lens {
        Lens::Prescription(_) => {
            let status = EffectStatus::Modelled("each surface's clear aperture stops rays".to_owned());
            return PlannedEffect::new(GROUP, name, status).described_by(key);
        }
        Lens::RayTransfer(_) => {
            let status = EffectStatus::Modelled("the ray transfer functions determine which rays pass".to_owned());
            return PlannedEffect::new(GROUP, name, status).described_by(key);
        }
        Lens::Thick(lens) => [lens.parameters().front_aperture.is_some(), lens.parameters().rear_aperture.is_some()],
        _ => [false, false],
    };
    let status = required_if(
        apertures != [false, false],
        "clear apertures in front of and behind the pupil stop rays",
        "no clear aperture is described",
    );
    let keys =
        ["lens.front_aperture", "lens.rear_aperture"].into_iter().zip(apertures).filter(|(_, is_there)| *is_there);
    let effect = PlannedEffect::new(GROUP, name, status).described_by(key);
    effect.dropped_by(keys.map(|(key, _)| without(camera, key)))
}

fn defocus(camera: &CameraPlan) -> PlannedEffect {
    let (body, name) = (&camera.body, "defocus");
    let blurs = body.lens.entrance_pupil_radius_m() > 0.0;
    let is_modelled = blurs && (camera.settings.route == Route::Lens || camera.depth_of_field != DepthOfField::None);
    let (text, key) = match camera.settings.route {
        Route::Lens => ("each sample passes through its own point of the pupil", "lens.focus_distance_m"),
        Route::Pupil(_) => ("the stored radiance is blurred in order of depth", "render.depth_of_field"),
    };
    let status =
        required_if(is_modelled, text, if blurs { "depth_of_field = \"none\"" } else { "everything is in focus" });
    let set = match (&camera.settings.route, &body.lens) {
        (Route::Pupil(_), _) => vec![camera_change(camera, "render.depth_of_field", "none")],
        (Route::Lens, Lens::Thin(_) | Lens::Thick(_)) => pinhole(camera),
        (Route::Lens, Lens::Calibrated(_)) => vec![without(camera, "lens.focus_distance_m")],
        (Route::Lens, _) => Vec::new(),
    };
    let effect = PlannedEffect::new(GROUP, name, status).described_by(key).dropped_by(set);
    effect.with_error("blur at infinity", blur_px(body, f64::INFINITY), "px").with_error(
        "blur at 1 m",
        blur_px(body, 1.0),
        "px",
    )
}

/// Changes to a pinhole of the same image size and brightness on the axis: π τ L/(4 N²) for π τ L/(1 + 4 N²).
fn pinhole(camera: &CameraPlan) -> Vec<String> {
    let lens = &camera.body.lens;
    let working = lens.working_f_number();
    let f_number = (working * working + 0.25).sqrt();
    let keys = [
        ("lens.type", "pinhole".to_owned()),
        ("lens.focal_length_mm", format!("{:?}", lens.principal_distance_mm())),
        ("lens.f_number", format!("{f_number:?}")),
    ];
    keys.iter().map(|(key, value)| camera_change(camera, key, value)).collect()
}

fn lateral_colour(camera: &CameraPlan) -> PlannedEffect {
    let lens = &camera.body.lens;
    let status = match lens {
        Lens::RayTransfer(lens) if lens.disperses() => {
            EffectStatus::Modelled("the ray transfer functions depend on wavelength".to_owned())
        }
        Lens::Prescription(_) => EffectStatus::Modelled("refraction in the glasses depends on wavelength".to_owned()),
        _ => required_if(
            lens.lateral_colour().is_some(),
            "image size depends on wavelength",
            "image size is the same for all wavelengths",
        ),
    };
    let effect = PlannedEffect::new(GROUP, "lateral colour", status).described_by("lens.lateral_colour");
    match lateral_colour_px(&camera.body, camera.settings.range) {
        Some(px) => {
            effect.dropped_by([without(camera, "lens.lateral_colour")]).with_error("missing lateral colour", px, "px")
        }
        None => effect,
    }
}

fn dispersion(camera: &CameraPlan) -> PlannedEffect {
    let is_there = camera.body.disperses() && camera.settings.route == Route::Lens;
    let absent_reason =
        format!("{} wavelengths share each path: the lens treats all wavelengths equally", camera.settings.wavelengths);
    let text = "each path carries one wavelength: rays through the lens depend on wavelength";
    PlannedEffect::new(GROUP, "one wavelength per path", required_if(is_there, text, absent_reason))
        .described_by("render.wavelengths_per_path")
}

fn route(camera: &CameraPlan, cost: &FrameCost) -> PlannedEffect {
    let is_there = matches!(camera.settings.route, Route::Pupil(_));
    let text = "radiance is rendered at the centre of the entrance pupil, and the lens is applied to the image";
    let status = required_if(is_there, text, "each sample is traced through the lens");
    let effect = PlannedEffect::new(GROUP, "lens applied after rendering", status).described_by("render.route");
    PlannedEffect { cpu_s: is_there.then(|| part_s(cost, "lens applied to the image")), ..effect }
        .dropped_by([camera_change(camera, "render.route", "lens")])
}

fn part_s(cost: &FrameCost, name: &str) -> f64 {
    cost.parts.iter().filter(|part| part.name == name).map(|part| part.cpu_s).sum()
}

fn optic(camera: &CameraPlan) -> Option<&Optic> {
    camera.body.front.as_ref().and_then(Front::optic)
}

/// An element before the lens: dropping the last one removes the whole section.
fn external_optics(camera: &CameraPlan, name: &'static str, key: &'static str, status: EffectStatus) -> PlannedEffect {
    let front = camera.body.front.as_ref();
    let elements = front.map_or(0, |front| usize::from(front.dirt().is_some()) + usize::from(front.optic().is_some()));
    let key_name = if elements == 1 { "external_optics" } else { key };
    PlannedEffect::new(GROUP, name, status).described_by(key).dropped_by([without(camera, key_name)])
}

fn mirror(camera: &CameraPlan) -> PlannedEffect {
    let is_there = matches!(optic(camera), Some(Optic::Mirror(_)));
    let status = required_if(is_there, "each ray is reflected at the mirror", "none is described");
    external_optics(camera, "mirror in front of the lens", "external_optics.mirror", status)
}

fn windscreen(camera: &CameraPlan) -> PlannedEffect {
    let is_there = matches!(optic(camera), Some(Optic::Windscreen(_)));
    let status = required_if(is_there, "each ray is traced through the windscreen's layers", "none is described");
    external_optics(camera, "windscreen", "external_optics.windscreen", status)
}

fn drops(camera: &CameraPlan) -> PlannedEffect {
    let drops = match optic(camera) {
        Some(Optic::Windscreen(glass)) => glass.drops(),
        _ => None,
    };
    let status = match drops {
        Some(drops) => {
            let count = drops.droplets().len();
            EffectStatus::WhereNeeded(format!("{count} drops, looked up in a grid where a ray crosses the glass"))
        }
        None => EffectStatus::LeftOut("none is described".to_owned()),
    };
    let key = "external_optics.windscreen.drops";
    PlannedEffect::new(GROUP, "drops on the windscreen", status).described_by(key).dropped_by([without(camera, key)])
}

fn dirt(camera: &CameraPlan) -> PlannedEffect {
    let is_there = camera.body.front.as_ref().is_some_and(|front| front.dirt().is_some());
    let status = required_if(is_there, "each ray is weighted by the mask", "none is described");
    external_optics(camera, "dirt in front of the lens", "external_optics.dirt", status)
}

/// An effect on the irradiance: dropping the last one removes the whole section, with its margin.
fn on_irradiance(camera: &CameraPlan, effect: Effect, cost: &FrameCost) -> PlannedEffect {
    let effects = &camera.body.effects;
    let described = [
        (Effect::PointSpread, effects.psf().is_some()),
        (Effect::Glare, effects.glare().is_some()),
        (Effect::Ghosts, effects.ghosts().is_some()),
    ];
    let is_last = described.iter().filter(|(_, is_there)| *is_there).count() == 1;
    let (key, own) = match effect {
        Effect::PointSpread => ("effects.psf", without(camera, "effects.psf")),
        Effect::Glare => ("effects.glare", without(camera, "effects.glare")),
        Effect::Ghosts => ("effects.ghosts", camera_change(camera, "effects.ghosts", "false")),
    };
    let file =
        (effect == Effect::Ghosts && camera.products.ghosts).then(|| camera_change(camera, "output.ghosts", "false"));
    let set = [if is_last { without(camera, "effects") } else { own }].into_iter().chain(file);
    let cpu_s = part_s(cost, effect.name());
    let margin_s = if is_last { margin_s(camera, cost) } else { 0.0 };
    PlannedEffect::new(GROUP, effect.name(), irradiance_effect_status(camera, effect))
        .described_by(key)
        .dropped_by(set)
        .with_cpu_time(cpu_s)
        .with_saving(cpu_s + margin_s)
}

/// Time of the paths of the margin, s.
fn margin_s(camera: &CameraPlan, cost: &FrameCost) -> f64 {
    if camera.settings.route != Route::Lens {
        return 0.0;
    }
    let (film, image_raster) = (camera.body.film(), &camera.body.raster);
    let pixels = |width: usize, height: usize| width as f64 * height as f64;
    let part = 1.0 - pixels(image_raster.width(), image_raster.height()) / pixels(film.width(), film.height());
    cost.paths * path_cpu_s(camera) * part
}

/// Returns the status of an effect on the irradiance, with the reason and the method of the point spread.
pub(in crate::report) fn irradiance_effect_status(camera: &CameraPlan, effect: Effect) -> EffectStatus {
    match (effect, camera.body.effects.status(effect)) {
        (Effect::PointSpread, EffectStatus::Modelled(of)) => EffectStatus::Modelled(of + &spread_by(camera)),
        (_, status) => status,
    }
}

/// Method of the point spread, and the contrast error of applying it to the film.
fn spread_by(camera: &CameraPlan) -> String {
    let Some((by, width)) = camera.body.effects.spread_by() else { return String::new() };
    let by = if camera.settings.route == Route::Lens { by } else { SpreadMethod::Film };
    let error = width.film_error;
    match by {
        SpreadMethod::Samples => {
            format!(
                ", applied by displacing samples (applied to the film, the contrast error would be up to {error:.2})"
            )
        }
        SpreadMethod::Film => format!(", applied to the film (contrast error up to {error:.3})"),
    }
}
