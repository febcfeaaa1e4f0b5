//! CPU time of a path, and of the work on a finished film: the effects of the lens, depth of field, ground truth, cubes of bands.
//!
//! Each part of the work is counted in its own unit from the plan's numbers, and each unit has one measured time (docs/evidence/performance.md, "What is done on the
//! film": AMD EPYC, AVX2, one thread, release build, 2026-11-22, `etendue render --threads 1` by `/usr/bin/time`, fractions of its parts by `perf record -e
//! cpu-clock`; other programs were running, so the uncertainty is a tenth).

use crate::plan::film::needs_irradiance;
use crate::plan::{CameraBody, CameraPlan, Plan, Route};
use crate::render::{identity_coverage, weather_layers};
use etendue_core::Bands;
use etendue_core::Integrator;
use etendue_optics::effects::{Effect, OperationCounts};
use etendue_optics::ghosts;
use etendue_optics::{DepthOfField, Lens};
use etendue_tracer::lights::Sun;
use glam::DVec2;

/// A path of the street scene (docs/evidence/performance.md).
pub(crate) const PATH_CPU_S: f64 = 2.2e-6;
/// A path of at most two bounces, of direct light alone, and without shadows: as fractions of a whole path, from street.toml with max_bounces 6 and 2 and the
/// integrators direct and flat (docs/plan.md).
pub(crate) const TWO_BOUNCES_CPU_S: f64 = 0.95 * PATH_CPU_S;
pub(crate) const DIRECT_PATH_CPU_S: f64 = 0.70 * PATH_CPU_S;
pub(crate) const FLAT_PATH_CPU_S: f64 = 0.57 * PATH_CPU_S;
/// Time of one additional branch, as a fraction of the path: 0.52 to 0.57 in the wet night, 0.69 in the Cornell box (docs/decisions/branching.md).
const BRANCH_FRACTION: f64 = 0.6;

/// A pixel with a tap of a kernel of few taps: a multiplication and two tests; too short to be measured on a film.
const TAP_S: f64 = 1e-9;
/// A value in a Fourier transform, per bit of the lengths of both sides. night-flare.toml with glare alone, compared with no effects.
const TRANSFORMED_S: f64 = 1.07e-9;
/// A point of a diffraction pattern distributed over the taps of a kernel, including its part of the kernel's computation. night-flare.toml with point spread
/// alone.
const SHARED_S: f64 = 38e-9;
/// A pattern of a wavefront: a transform of 1024 × 1024, its phases, its light. night-flare.toml with coma.
const PATTERN_S: f64 = 31e-3;
/// A surface hit by a ghost's ray, and a ghost's beam, of one source, pair and wavelength, accumulated on the sensor. scenes/lenses/ghosts.toml, camera bare,
/// and the street by day through the same lens, 2026-11-23.
const GHOST_SURFACE_S: f64 = 60e-9;
const GHOST_BEAM_S: f64 = 0.08e-3;
/// Number of sources of an image's ghosts: if a sun or lamps dominate, and for uniform light. Between 1 and 1024, depending on the image.
const DOMINATED_SOURCES: f64 = 270.0;
const UNIFORM_SOURCES: f64 = 1000.0;
/// A band of a stored pixel looked up for an image, with its distance. scenes/lenses/defocus.toml, camera sharp, from through-lens.
const RESAMPLED_S: f64 = 300e-9;
/// The outline of a pixel's blur, and a band of a row of it. defocus.toml, camera physical, focused at 6 m and at 1 m.
const OUTLINE_S: f64 = 2e-6;
const BLUR_BAND_S: f64 = 10e-9;
/// A band of a pixel blended. defocus.toml, camera fast.
const BLENDED_S: f64 = 100e-9;
/// A pixel's ground truth: a primary ray and its hit. night-flare.toml and sphere-on-plane.toml with and without it: less than the noise between runs.
const TRUTH_S: f64 = 0.3e-6;
/// Rays of ground truth per pixel for boxes: its own, and those of the objects whose boxes contain it, in a street.
const BOX_RAYS: f64 = 8.0;
/// A pixel of a capture from electrons to digital numbers with all noises, and one from there to the image: "A frame of two megapixels" there.
const SENSOR_S: f64 = 99e-9;
const PROCESSING_S: f64 = 73e-9;
/// A value of a cube written: "Spectral EXR" there.
const WRITTEN_S: f64 = 4.0 / 34.5e6;

/// CPU time of a path for a camera's integrator and bounces, s.
pub(crate) fn path_cpu_s(camera: &CameraPlan) -> f64 {
    match (camera.settings.paths.integrator, camera.settings.paths.max_bounces) {
        (Integrator::Flat, _) => FLAT_PATH_CPU_S,
        (Integrator::Direct, _) | (Integrator::Path, 1) => DIRECT_PATH_CPU_S,
        (Integrator::Path, 2) => TWO_BOUNCES_CPU_S,
        (Integrator::Path, _) => PATH_CPU_S,
    }
}

/// Time of all branches of a path except the first, as a fraction of the path.
pub(crate) fn branches_fraction(camera: &CameraPlan) -> f64 {
    f64::from(camera.settings.paths.branches - 1) * BRANCH_FRACTION
}

/// A part of the work on a finished film.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmWork {
    /// Name, as text.
    pub name: &'static str,
    /// CPU time, s.
    pub cpu_s: f64,
    /// Condition under which the figure holds, as text; empty if the plan determines it.
    pub holds_for: &'static str,
}

/// Work on the film of a camera; parts that it does not have take no time.
pub(crate) fn film_work(plan: &Plan, camera: &CameraPlan) -> Vec<FilmWork> {
    let work = |name, cpu_s| FilmWork { name, cpu_s, holds_for: "" };
    let (ghosts_s, holds_for) = ghosts(plan, camera);
    vec![
        work(Effect::PointSpread.name(), point_spread(camera)),
        work(Effect::Glare.name(), glare(camera)),
        FilmWork { name: Effect::Ghosts.name(), cpu_s: ghosts_s, holds_for },
        work("lens applied to the image", if applies_lens(plan, camera) { at_pupil(camera) } else { 0.0 }),
        work("ground truth", truth(camera)),
        work("spectral files", files(camera)),
        work("weather layers", weather(camera)),
        work("sensor", sensor(camera)),
        work("processing", processing(camera)),
    ]
}

/// Bands on which effects act.
fn bands(camera: &CameraPlan) -> Option<Bands> {
    camera.settings.bands
}

fn frame_cpu_s(camera: &CameraPlan, effect: Effect) -> f64 {
    let Some(bands) = bands(camera) else { return 0.0 };
    let with_variance = camera.settings.replicates > 1 && camera.settings.route == Route::Lens;
    let operations = camera.body.effects.operation_counts(&camera.body.raster, bands, with_variance);
    operations.into_iter().filter(|(which, _)| *which == effect).map(|(_, work)| seconds(work)).sum()
}

fn seconds(work: OperationCounts) -> f64 {
    work.taps * TAP_S + work.transformed * TRANSFORMED_S + work.shared * SHARED_S + work.patterns * PATTERN_S
}

/// Diffraction and wavefront error, or an image of a point's light.
fn point_spread(camera: &CameraPlan) -> f64 {
    frame_cpu_s(camera, Effect::PointSpread)
}

/// Veiling glare.
fn glare(camera: &CameraPlan) -> f64 {
    frame_cpu_s(camera, Effect::Glare)
}

/// Ghosts, and the condition that determines the number of their sources.
fn ghosts(plan: &Plan, camera: &CameraPlan) -> (f64, &'static str) {
    let body = &camera.body;
    let (Some(settings), Lens::Prescription(lens), Some(bands)) = (body.effects.ghosts(), &body.lens, bands(camera))
    else {
        return (0.0, "");
    };
    let sky = plan.sources.environment.is_some();
    let (sources, holds_for) = match plan.sources.suns.iter().any(|sun| is_seen(camera, sun)) {
        true => (DOMINATED_SOURCES, "for an image dominated by a sun; twice as long for uniform illumination"),
        false if sky => {
            (UNIFORM_SOURCES, "for uniform illumination; half as long for an image dominated by a few lights")
        }
        false => (DOMINATED_SOURCES, "for an image dominated by a few lights; twice as long for uniform illumination"),
    };
    let work = ghosts::operation_counts(lens, settings, [bands.low_nm(), bands.high_nm()], sources);
    (work.surface_hits * GHOST_SURFACE_S + work.splats * GHOST_BEAM_S, holds_for)
}

/// Returns true if a sun is within the film of a camera, occluded or not.
fn is_seen(camera: &CameraPlan, sun: &Sun) -> bool {
    let film = camera.body.film();
    let direction = camera.path.at(camera.timing.frame_start_s(0)).rotation.transpose() * sun.direction().as_dvec3();
    let at_px = camera.body.lens.project(direction).map(|mm| film.raster_px(mm));
    at_px.is_some_and(|px| px.cmpge(DVec2::ZERO).all() && px.x < film.width() as f64 && px.y < film.height() as f64)
}

/// Returns true if the lens is applied to the image: not if the film is on disk and no product needs it.
fn applies_lens(plan: &Plan, camera: &CameraPlan) -> bool {
    plan.scratch(camera).is_none() || needs_irradiance(camera)
}

/// Pupil route: resampling, and depth of field.
fn at_pupil(camera: &CameraPlan) -> f64 {
    let (Route::Pupil(_), Some(bands)) = (&camera.settings.route, bands(camera)) else { return 0.0 };
    let margin = camera.body.whole_margin_px(camera.body.blur_margin_px(&camera.depth_of_field));
    let wide = camera.body.raster.widened(margin);
    let numbers = pixels(wide.width(), wide.height()) * bands.count() as f64;
    let blur = match &camera.depth_of_field {
        DepthOfField::None => 0.0,
        DepthOfField::Fast(_) => numbers * BLENDED_S,
        DepthOfField::Physical => {
            let outline = pixels(wide.width(), wide.height()) * OUTLINE_S;
            outline + numbers * rows(&camera.body) * BLUR_BAND_S
        }
    };
    numbers * RESAMPLED_S + blur
}

/// Number of rows over which the light of a distant object is spread.
fn rows(body: &CameraBody) -> f64 {
    1.0 + body.lens.circle_of_confusion_mm(f64::INFINITY) / body.raster.pitch_mm().y
}

/// Ground truth, or distances at the pupil.
fn truth(camera: &CameraPlan) -> f64 {
    let products = &camera.products;
    let annotations = &products.annotations;
    let planes = products.ground_truth || products.depth_png_per_m.is_some() || products.rays;
    let is_wanted = [
        (planes, GroundTruthRays::Planes),
        (annotations.needs_neighbours(), GroundTruthRays::Neighbours),
        (annotations.disparity.is_some(), GroundTruthRays::Disparity),
        (annotations.boxes, GroundTruthRays::Boxes),
        (annotations.cryptomatte, GroundTruthRays::Coverage),
    ];
    is_wanted.into_iter().filter(|(is_wanted, _)| *is_wanted).map(|(_, what)| truth_cpu_s(camera, what)).sum()
}

/// Purpose of rays of the ground truth.
#[derive(Clone, Copy, Debug)]
pub(super) enum GroundTruthRays {
    /// The frame itself.
    Planes,
    /// The previous and next frames.
    Neighbours,
    /// Another camera.
    Disparity,
    /// Objects.
    Boxes,
    /// Surfaces hit by each pixel's samples.
    Coverage,
}

/// CPU time of a part of the ground truth, s.
pub(super) fn truth_cpu_s(camera: &CameraPlan, what: GroundTruthRays) -> f64 {
    // One ray of the frame itself, and one of each compared frame or camera; boxes: about one for every object that a pixel's ray passes.
    let rays = match what {
        GroundTruthRays::Planes => 1.0,
        GroundTruthRays::Neighbours => 3.0,
        GroundTruthRays::Disparity => 2.0,
        GroundTruthRays::Boxes => BOX_RAYS,
        GroundTruthRays::Coverage => f64::from(identity_coverage::spp(camera)),
    };
    pixels(camera.body.raster.width(), camera.body.raster.height()) * TRUTH_S * rays
}

/// Layers of weather: paths for the airlight and rays for both fractions.
fn weather(camera: &CameraPlan) -> f64 {
    let (width, height) = camera.film_size();
    let samples = f64::from(width) * f64::from(height) * f64::from(weather_layers::spp(camera));
    if camera.products.weather { samples * (PATH_CPU_S + 2.0 * TRUTH_S) } else { 0.0 }
}

/// Encoding of cubes of bands.
fn files(camera: &CameraPlan) -> f64 {
    let p = &camera.products;
    let cubes = [p.radiance, p.irradiance, p.ghosts].into_iter().filter(|is_wanted| *is_wanted).count() as f64;
    let cubes = if p.variance { 2.0 * cubes } else { cubes };
    cubes * cube_cpu_s(camera)
}

/// All captures of a frame, if electrons are computed.
fn sensor(camera: &CameraPlan) -> f64 {
    let products = &camera.products;
    let makes_frames = products.raw || products.picture || products.signal_breakdown;
    let Some(sensor) = camera.body.sensor.as_ref().filter(|_| makes_frames) else { return 0.0 };
    let captures = 1 + sensor.parameters().hdr.captures.len();
    image_pixels(camera) * captures as f64 * SENSOR_S
}

/// Processing from raw to image.
fn processing(camera: &CameraPlan) -> f64 {
    if camera.products.picture { image_pixels(camera) * PROCESSING_S } else { 0.0 }
}

/// CPU time of encoding a cube of bands, s.
pub(super) fn cube_cpu_s(camera: &CameraPlan) -> f64 {
    bands(camera).map_or(0.0, |bands| image_pixels(camera) * bands.count() as f64 * WRITTEN_S)
}

fn image_pixels(camera: &CameraPlan) -> f64 {
    pixels(camera.body.raster.width(), camera.body.raster.height())
}

fn pixels(width: usize, height: usize) -> f64 {
    width as f64 * height as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Choices, compile};
    use etendue_scene::asset::Assets;
    use etendue_scene::{Description, Overrides};
    use std::path::Path;

    const THIN: &str = "lens = { type = \"thin\", focal_length_mm = 6, f_number = 4.0, focus_distance_m = 5 }";
    const GAUSS: &str = "lens = { type = \"prescription\", published = \"double-gauss\", f_number = 4, focus_distance_m = \"infinity\" }";
    const PITCH: [&str; 2] = ["6.0", "300.0"];

    /// CPU time of the parts, s, of a camera that looks along +x.
    fn cost(lens: &str, camera: &str, render: &str, scene: &str) -> Vec<f64> {
        let pitch = PITCH[usize::from(lens == GAUSS)];
        let scene = if scene.is_empty() { "[scene]" } else { scene };
        let text = format!(
            "format = 1\n{scene}\n[[cameras]]\nname = \"front\"\nposition_m = [0, 0, 1]\nlook_at_m = [10, 0, 1]\n{lens}\n\
             sensor = {{ width_px = 120, height_px = 80, pixel_pitch_um = {pitch} }}\n{camera}\n[render]\nspp = 4\n\
             band_width_nm = 20\n{render}\n[output]\nirradiance = true\nground_truth = false\n"
        );
        let read = |_: &Path| Ok(text.clone());
        let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).expect("a job");
        let plan = compile(&job, &Assets::default(), &Choices::default());
        let plan =
            plan.unwrap_or_else(|errors| panic!("{}", errors.iter().map(|f| format!("{f}\n")).collect::<String>()));
        film_work(&plan, &plan.cameras[0]).into_iter().map(|work| work.cpu_s).collect()
    }

    #[test]
    fn what_a_camera_does_not_have_costs_nothing() {
        let costs = cost(THIN, "", "", "");
        assert_eq!(costs[..5], [0.0; 5]);
        assert!(costs[5] > 0.0, "a cube is written: {costs:?}");
    }

    #[test]
    fn spread_and_glare_are_by_patches_and_pictures() {
        let psf = |patches: &str| {
            cost(THIN, &format!("effects = {{ margin = 0.1, psf = {{ blades = 6, patches = {patches} }} }}"), "", "")
        };
        let (one, four) = (psf("[1, 1]"), psf("[2, 2]"));
        assert!(one[0] > 0.0 && one[1..5] == [0.0; 4], "{one:?}");
        // Four times the kernels; the film part to which each is applied differs.
        assert!((3.0..4.5).contains(&(four[0] / one[0])), "{} by {}", four[0], one[0]);
        let glare = |render: &str| {
            cost(
                THIN,
                "effects = { margin = 0.1, glare = { scatter = 0.02, core_um = 25, exponent = 2.5 } }",
                render,
                "",
            )[1]
        };
        let (means, both) = (glare("replicates = 1"), glare("replicates = 2"));
        // The kernel is computed once; variances are images too.
        assert!(means > 0.0 && (1.8..2.0).contains(&(both / means)), "{both} by {means}");
    }

    #[test]
    fn ghosts_are_by_wavelengths_and_sources() {
        let sky = |elevation: f64| {
            format!(
                "[scene.environment]\ntype = \"sky\"\nturbidity = 3\nsun_elevation_deg = {elevation}\nsun_azimuth_deg = 0\n"
            )
        };
        let ghosts =
            |render: &str, elevation: f64| cost(GAUSS, "effects = { ghosts = true }", render, &sky(elevation))[2];
        let (narrow, wide) = ("wavelength_range_nm = [400, 500]", "wavelength_range_nm = [400, 700]");
        // Tabulated at 2 and at 4 wavelengths; the first pass uses one.
        let ratio = ghosts(wide, 60.0) / ghosts(narrow, 60.0);
        assert!((1.85..2.0).contains(&ratio), "{ratio}");
        // Of beams alone 1000 to 270; the number of rays that tabulate them is unchanged.
        let ratio = ghosts(wide, 60.0) / ghosts(wide, 5.0);
        assert!((1.5..1000.0 / 270.0).contains(&ratio), "the sun in the picture: {ratio}");
        assert_eq!(cost(GAUSS, "effects = { ghosts = false }", wide, "")[2], 0.0);
    }

    #[test]
    fn depth_of_field_costs_at_the_pupil_alone() {
        let of = |depth: &str| {
            cost(THIN, &format!("render = {{ route = \"pupil\", depth_of_field = \"{depth}\" }}"), "", "")[3]
        };
        let (none, physical) = (of("none"), of("physical"));
        assert!(none > 0.0 && physical > none + 120.0 * 80.0 * OUTLINE_S, "{physical} over {none}");
    }
}
