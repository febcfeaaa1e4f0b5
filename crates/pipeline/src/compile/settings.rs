//! `[render]`: render settings.

use super::camera::warn_of_margin;
use super::choices::{Choices, max_bounces};
use super::context::{Context, ErrorCode};
use super::samples::{SampleSettings, has_variance, samples};
use crate::plan::{CameraBody, Passes, Products, Route, Settings, WavelengthSampling};
use crate::sizes::block::Blocks;
use crate::sizes::film::FilmLayout;
use etendue_core::wavelength::{MAX_NM, MIN_NM};
use etendue_core::{Bands, Integrator, LightSampling, Quality, WavelengthRange};
use etendue_optics::{DepthOfField, FastBlend, FastParameters, PupilProjection};
use etendue_scene::record::render::{self, Accumulate, DepthMethod};
use etendue_scene::record::{Output, Render};
use etendue_scene::{Place, Placed};
use etendue_tracer::integrator::PathSettings;

/// Default wavelength range of radiance, nm.
const VISIBLE_NM: (f64, f64) = (380.0, 780.0);
const BAND_WIDTH_NM: f64 = 5.0;
const TILE_PX: u64 = 32;

/// Render settings of a camera.
pub(super) fn settings(
    render: &Render,
    body: &CameraBody,
    depth_of_field: &DepthOfField,
    output: &Output,
    products: &mut Products,
    choices: &Choices,
    context: &mut Context<'_>,
) -> Option<(Settings, Option<Passes>)> {
    let SampleSettings { spp, replicates, adaptive, passes } = samples(render, choices, context);
    products.variance &= has_variance(output, replicates, render, context);
    let route = route(render, body, depth_of_field, context)?;
    let (cube, accumulates_electrons) = accumulation(render, body, products, &route, context);
    let range = range(render, body, cube);
    let bands = if cube { Some(bands(render, range, context)?) } else { None };
    check_size(body, &route, &FilmLayout { bands, accumulates_electrons, watched: adaptive.is_some() }, context)?;
    note_losses(products, &route, accumulates_electrons, body, context);
    warn_of_margin(body, context);
    note_unused_band_width(render, cube, context);
    let paths = paths(render, choices);
    let is_watched = adaptive.is_some() && route == Route::Lens;
    let blocks = blocks(paths.integrator, render, body, accumulates_electrons || is_watched);
    let settings = Settings {
        spp,
        replicates,
        paths,
        guiding: guiding(&paths, render, context),
        wavelengths: wavelengths(render, body, &route, context)?,
        // Chosen when all lights are known.
        wavelength_sampling: WavelengthSampling::Uniform,
        spectral_gain: None,
        route,
        range,
        bands,
        accumulates_electrons,
        adaptive,
        tile_px: (render.tile_px.as_ref().map_or(TILE_PX, |t| t.value) as u32)
            .next_multiple_of(if adaptive.is_some() { blocks.cell_px() } else { blocks.tile_px(1) }),
        blocks,
        seed: render.seed.as_ref().map_or(0, |s| s.value),
    };
    Some((settings, passes))
}

/// Wavelengths per path: a single one if the lens treats each differently, because a ray traced for one wavelength does not apply to others.
fn wavelengths(render: &Render, body: &CameraBody, route: &Route, context: &mut Context<'_>) -> Option<u32> {
    let requested = render.wavelengths_per_path.as_ref();
    if !(body.disperses() && *route == Route::Lens) {
        return Some(requested.map_or(4, |n| n.value as u32));
    }
    if let Some(requested) = requested.filter(|n| n.value != 1) {
        let problem = format!("a path cannot carry {} wavelengths through dispersive optics", requested.value);
        context.error(ErrorCode::NotModelled, &requested.place, problem, "remove the key, or give 1");
        return None;
    }
    Some(1)
}

/// Light paths that are simulated. Settings that only paths need have their defaults if none are traced.
fn paths(render: &Render, choices: &Choices) -> PathSettings {
    let keys = &render.paths;
    let flag_or = |key: &Option<Placed<bool>>, default: bool| key.as_ref().map_or(default, |flag| flag.value);
    let settings = PathSettings {
        integrator: render.integrator.as_ref().map_or(Integrator::Path, |key| key.value),
        light_sampling: render.light_sampling.as_ref().map_or(LightSampling::Gloss, |key| key.value),
        max_bounces: 1,
        ..PathSettings::default()
    };
    if settings.integrator != Integrator::Path {
        return settings;
    }
    let by_quality = max_bounces(choices.quality.unwrap_or(Quality::Standard));
    PathSettings {
        max_bounces: keys.max_bounces.as_ref().map_or(by_quality, |key| key.value as u32),
        caustics: flag_or(&keys.caustics, true),
        regularize: flag_or(&keys.regularize, false),
        branches: keys.branches_in_force() as u32,
        ..settings
    }
}

fn guiding(paths: &PathSettings, render: &Render, context: &mut Context<'_>) -> bool {
    let is_requested = paths.integrator == Integrator::Path && render.paths.guiding.as_ref().is_some_and(|g| g.value);
    let is_of_use = paths.max_bounces > 1;
    if is_requested && !is_of_use {
        context.note("\"guiding\" is ignored: with \"max_bounces\" = 1 there is no indirect light");
    }
    is_requested && is_of_use
}

/// Blocks of pixels that share path tails. They carry the same wavelengths: if these are sampled `by_colour`, the pixels have one colour.
fn blocks(integrator: Integrator, render: &Render, body: &CameraBody, by_colour: bool) -> Blocks {
    if integrator != Integrator::Path {
        return Blocks::SINGLE;
    }
    let filter = body.sensor.as_ref().filter(|_| by_colour).map(|sensor| &sensor.parameters().cfa);
    let (columns, rows) =
        filter.map_or((1, 1), |cfa| (cfa.width() as u32, (cfa.channels().len() / cfa.width()) as u32));
    Blocks::new(render.paths.path_reuse_in_force() as u32, columns, rows)
}

/// Maximum bytes of a film.
const MAX_FILM: f64 = 32.0 * 1024.0 * 1024.0 * 1024.0;

/// Refuses an image that exceeds the memory of any present machine.
fn check_size(body: &CameraBody, route: &Route, layout: &FilmLayout, context: &mut Context<'_>) -> Option<()> {
    let (width, height) = match route {
        Route::Lens => (body.film().width(), body.film().height()),
        Route::Pupil(projection) => (projection.width(), projection.height()),
    };
    let bytes = layout.bytes(width, height);
    if bytes <= MAX_FILM {
        return Some(());
    }
    let problem = format!("a film of {width} × {height} pixels takes {:.0} GB", bytes / 1e9);
    context.error(
        ErrorCode::TooLarge,
        &body.place,
        problem,
        "make the image smaller, the bands wider, or the field of view narrower",
    );
    None
}

/// Notes requests that cannot be fulfilled, and data that is computed but not stored.
fn note_losses(
    products: &Products,
    route: &Route,
    accumulates_electrons: bool,
    body: &CameraBody,
    context: &mut Context<'_>,
) {
    if products.variance && products.electrons && !accumulates_electrons {
        let remedy =
            if body.effects.is_idle() { "accumulate = \"auto\" with route = \"lens\"" } else { "the irradiance" };
        context.note(format!("electrons are computed from band means and have no variance; use {remedy}"));
    }
    if matches!(route, Route::Pupil(_)) && !products.radiance {
        context.note("route = \"pupil\" without radiance = true: no radiance is stored for the expose command");
    }
    if products.variance && products.irradiance && *route != Route::Lens {
        context.note("irradiance computed from stored radiance has no variance; the radiance has".to_owned());
    }
}

/// Notes a stated band width without requested bands. Not an error: `--set output.radiance=false` must not require another change of the job.
fn note_unused_band_width(render: &Render, cube: bool, context: &mut Context<'_>) {
    if let (Some(width), false) = (&render.band_width_nm, cube) {
        context.note_on(&width.place, "no spectrum is stored, so the width of bands has no effect");
    }
}

/// Method of blurring objects out of focus; through the lens its rays model it.
pub(super) fn depth_of_field(render: &Render, body: &CameraBody, context: &mut Context<'_>) -> Option<DepthOfField> {
    if render.route.as_ref().is_none_or(|r| r.value != render::Route::Pupil) {
        return Some(DepthOfField::None);
    }
    let blurs = body.lens.entrance_pupil_radius_m() > 0.0;
    match &render.depth_of_field {
        None => Some(if blurs { DepthOfField::Physical } else { DepthOfField::None }),
        Some(render::DepthOfField::Fast(blend)) => {
            if blend.near_m.is_none() && blend.far_m.is_none() {
                context.error(ErrorCode::NoEffect, &blend.place, "this blurs nothing", "add \"near_m\" or \"far_m\"");
                return None;
            }
            context.accept(&blend.place, FastBlend::new(parameters(blend, body.scale))).map(DepthOfField::Fast)
        }
        Some(render::DepthOfField::Named(method)) => match method.value {
            DepthMethod::Physical if blurs => Some(DepthOfField::Physical),
            DepthMethod::Physical => {
                let note = "everything is in focus for this lens, so \"depth_of_field\" has no effect";
                context.note_on(&method.place, note);
                Some(DepthOfField::None)
            }
            DepthMethod::None => Some(DepthOfField::None),
        },
    }
}

/// Returns the parameters of the blur, which shrinks with the image of a camera whose pixels are `scale` times as large.
fn parameters(blend: &render::FastBlend, scale: u64) -> FastParameters {
    let [blurred_near_m, sharp_near_m] = blend.near_m.as_ref().map_or([0.0; 2], |range| range.value);
    let [sharp_far_m, blurred_far_m] = blend.far_m.as_ref().map_or([f64::INFINITY; 2], |range| range.value);
    FastParameters {
        sharp_near_m,
        sharp_far_m,
        blurred_near_m,
        blurred_far_m,
        blur_px: blend.blur_px.value / scale as f64,
    }
}

fn route(
    render: &Render,
    body: &CameraBody,
    depth_of_field: &DepthOfField,
    context: &mut Context<'_>,
) -> Option<Route> {
    match render.route.as_ref().map(|r| (r.value, &r.place)) {
        None | Some((render::Route::Lens, _)) => Some(Route::Lens),
        Some((render::Route::Pupil, place)) => {
            context.accept(place, body.check_front_on_picture())?;
            let range = range(render, body, true);
            let margin = body.whole_margin_px(body.blur_margin_px(depth_of_field));
            let covering = PupilProjection::covering(&body.lens, &body.raster, margin, range);
            let covering = context.accept(place, covering)?;
            Some(Route::Pupil(covering.overscanned(render.overscan.as_ref().map_or(0.0, |o| o.value))))
        }
    }
}

/// Returns whether a spectral cube is stored, and whether pixels accumulate electrons.
fn accumulation(
    render: &Render,
    body: &CameraBody,
    products: &Products,
    route: &Route,
    context: &mut Context<'_>,
) -> (bool, bool) {
    let spectral = products.needs_radiance() || products.irradiance;
    let pupil = matches!(route, Route::Pupil(_));
    let effects = !body.effects.is_idle();
    let electrons = body.sensor.is_some() && (products.electrons || products.raw || products.picture);
    let requested = render.accumulate.as_ref().map(|a| (a.value, &a.place));
    match requested {
        Some((Accumulate::Cube, _)) => (true, false),
        Some((Accumulate::Electrons, place)) => {
            if pupil || body.sensor.is_none() {
                let problem = "\"electrons\" needs a sensor with electronics and route = \"lens\"";
                context.error(ErrorCode::Contradiction, place, problem, "use \"auto\" or \"cube\"");
            } else if spectral {
                let problem = "\"electrons\" stores no spectrum, but radiance or irradiance is requested";
                context.error(
                    ErrorCode::Contradiction,
                    place,
                    problem,
                    "use \"auto\", which stores both, or do not request them",
                );
            } else if effects {
                let problem = "\"electrons\" stores no spectrum, but the camera's [effects] require one";
                context.error(
                    ErrorCode::Contradiction,
                    place,
                    problem,
                    "use \"auto\" or \"cube\", or remove [effects]",
                );
            }
            (false, true)
        }
        None | Some((Accumulate::Auto, _)) => (spectral || pupil || effects, electrons && !pupil && !effects),
    }
}

/// Wavelengths to sample, nm: those to which the sensor responds, and the visible range if radiance itself is requested.
fn range(render: &Render, body: &CameraBody, cube: bool) -> WavelengthRange {
    if let Some(range) = &render.wavelength_range_nm {
        return WavelengthRange::new(range.value[0], range.value[1]);
    }
    let sensor = body.sensor.as_ref().and_then(etendue_sensor::Sensor::support_nm);
    let (low, high) = match (sensor, cube) {
        (Some(sensor), true) => (sensor.0.min(VISIBLE_NM.0), sensor.1.max(VISIBLE_NM.1)),
        (Some(sensor), false) => sensor,
        (None, _) => VISIBLE_NM,
    };
    if !cube {
        return WavelengthRange::new(low, high);
    }
    let step = render.band_width_nm.as_ref().map_or(BAND_WIDTH_NM, |w| w.value);
    WavelengthRange::new(((low / step).floor() * step).max(MIN_NM), ((high / step).ceil() * step).min(MAX_NM))
}

fn bands(render: &Render, range: WavelengthRange, context: &mut Context<'_>) -> Option<Bands> {
    let width_nm = render.band_width_nm.as_ref().map_or(BAND_WIDTH_NM, |w| w.value);
    let WavelengthRange { low_nm, high_nm } = range;
    let bands = Bands::covering(low_nm, high_nm, width_nm);
    if bands.is_none() {
        let place = render.band_width_nm.as_ref().map_or_else(|| range_place(render), |w| &w.place);
        let problem = format!(
            "{low_nm} to {high_nm} nm is not a whole number of bands of {width_nm} nm within {MIN_NM} to {MAX_NM} nm"
        );
        context.error(ErrorCode::NotAMultiple, place, problem, "change \"band_width_nm\" or \"wavelength_range_nm\"");
    }
    bands
}

fn range_place(render: &Render) -> &Place {
    render.wavelength_range_nm.as_ref().map_or(&render.place, |r| &r.place)
}
