//! Renders a camera's light.

use crate::plan::pixel_density::PixelDensity;
use crate::plan::{CameraBody, CameraPlan, NumberedPass, Plan, Precipitation, Route, Settings};
use crate::render::exposure::{FilmExposure, FrameCapture};
use crate::render::film::Film;
use crate::render::light::{RaySource, RenderError, RenderJob, Sampling};
use crate::render::mosaic::Mosaic;
use crate::render::near_precipitation::{near, visible_region};
use crate::render::observer::Observer;
use crate::render::training::guide;
use crate::sizes::tile::Shard;
use etendue_core::PupilRay;
use etendue_core::maths::f64::atan2;
use etendue_optics::effects::SampleSpread;
use etendue_optics::{Front, Lens, PupilProjection};
use etendue_projection::Raster;
use etendue_tracer::accel::Simd;
use etendue_tracer::integrator::{PathSettings, PathTracer, SpectralPaths};
use etendue_tracer::lights::{LightCounts, Lights};
use etendue_tracer::media::Media;
use etendue_tracer::precipitation::{ChangeOver, VisibleRegion};
use etendue_tracer::render_space::RenderSpace;
use glam::{DVec2, DVec3};
use std::borrow::Cow;

/// Parameters of a render.
#[derive(Clone, Copy, Debug)]
pub struct LightRequest {
    /// Frame and capture; the first for a camera whose light does not depend on time.
    pub frame_capture: FrameCapture,
    /// Tiles to render.
    pub shard: Shard,
    /// Instruction set for the accelerator. It does not change the result.
    pub simd: Simd,
    /// Storage of the bands. It does not change the result.
    pub keeping: FilmStorage,
}

/// Storage of a film's bands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmStorage {
    /// In memory, or on disk if they exceed the plan's limit.
    Planned,
    /// In memory, whatever their size.
    Memory,
}

impl Default for LightRequest {
    fn default() -> Self {
        Self {
            frame_capture: FrameCapture::default(),
            shard: Shard::WHOLE,
            simd: Simd::Auto,
            keeping: FilmStorage::Planned,
        }
    }
}

/// Renders the light of one camera on the caller's thread pool: irradiance and electrons through the lens, or (on the pupil route) radiance, for which every
/// weight is 1.
///
/// # Errors
/// The observer cancels, or bands cannot be stored on disk.
pub fn light(
    plan: &Plan,
    camera: &CameraPlan,
    request: LightRequest,
    observer: &dyn Observer,
) -> Result<Film, RenderError> {
    let mut film = pass(plan, camera, request, camera.pass(0), None, observer)?;
    for number in 1..camera.pass_count() {
        film = pass(plan, camera, request, camera.pass(number), Some(&film), observer)?;
    }
    Ok(film)
}

/// Renders one pass of it and adds it to the light of the passes before.
///
/// # Errors
/// The observer cancels, or bands cannot be stored on disk.
pub fn pass(
    plan: &Plan,
    camera: &CameraPlan,
    request: LightRequest,
    pass: NumberedPass,
    before: Option<&Film>,
    observer: &dyn Observer,
) -> Result<Film, RenderError> {
    with_source(camera, request.frame_capture, LightJob { plan, camera, request, pass, before, observer })
}

/// A task on a camera's rays, independent of their source.
pub(super) trait SourceJob {
    /// Result of the task.
    type Output;

    /// Runs the task.
    fn run(self, source: &dyn RaySource) -> Self::Output;
}

/// Runs a task with the rays of a camera's image.
pub(super) fn with_source<J: SourceJob>(camera: &CameraPlan, frame_capture: FrameCapture, job: J) -> J::Output {
    match &camera.settings.route {
        Route::Lens => with_lens(camera, frame_capture, job),
        Route::Pupil(projection) => job.run(projection),
    }
}

/// Runs a task with the rays through a camera's lens and the elements before it, whatever its light's route.
pub(super) fn with_lens<J: SourceJob>(camera: &CameraPlan, frame_capture: FrameCapture, job: J) -> J::Output {
    match &camera.body.front {
        None => job.run(&LensSource::new(camera)),
        Some(front) => {
            let front = &front_at(front, camera, frame_capture);
            job.run(&FrontSource { lens: LensSource::new(camera), front })
        }
    }
}

struct LightJob<'a> {
    plan: &'a Plan,
    camera: &'a CameraPlan,
    request: LightRequest,
    pass: NumberedPass,
    before: Option<&'a Film>,
    observer: &'a dyn Observer,
}

impl SourceJob for LightJob<'_> {
    type Output = Result<Film, RenderError>;

    fn run(self, source: &dyn RaySource) -> Self::Output {
        render_film(&self, source)
    }
}

/// Number of lights that a camera's paths sample.
#[must_use]
pub fn light_counts(plan: &Plan, camera: &CameraPlan) -> LightCounts {
    let exposure = FilmExposure::new(camera, FrameCapture::default());
    let view = plan.world.render_space_for_few(exposure.origin_m(), exposure.interval());
    lights(plan, camera, &view).light_counts()
}

pub(super) fn lights(plan: &Plan, camera: &CameraPlan, view: &RenderSpace<'_>) -> Lights {
    Lights::new(view, &plan.material_table, plan.sources.clone(), camera.settings.range)
        .expect("a compiled plan names only materials that it has")
}

fn render_film(job: &LightJob<'_>, source: &dyn RaySource) -> Result<Film, RenderError> {
    let LightJob { plan, camera, request, pass, before, observer } = *job;
    let rows = FilmExposure::new(camera, request.frame_capture);
    let view = plan.world.render_space_with(rows.origin_m(), rows.interval(), request.simd);
    let lights = lights(plan, camera, &view);
    let media = Media::new(&plan.media, rows.origin_m(), rows.interval());
    let near = region_and_change_over(plan, camera, &rows, source).map(|(precipitation, region, change_over)| {
        near(precipitation, &media, &rows, request.simd, &region, &change_over)
    });
    let tracer = PathTracer::new(&view, &plan.material_table, &lights, path_settings(camera, pass))
        .with_media(&media)
        .with_near(near.as_ref());
    let settings = &camera.settings;
    let density = pixel_density(plan, camera);
    let mosaic = camera.summing_sensor().map(|sensor| Mosaic::new(sensor, &density).beyond(margin_px(camera)));
    let job = render_job(camera, rows, request, source, mosaic.as_ref());
    let scratch = if request.keeping == FilmStorage::Memory { None } else { plan.scratch(camera) };
    let sample_spread = sample_spread(camera);
    let sample_spread = sample_spread.as_ref();
    let job = RenderJob { sampling: Sampling { pass, ..job.sampling }, sample_spread, scratch, ..job };
    match settings.wavelengths {
        1 => gather_light::<1>(&job, tracer, camera, before, observer),
        8 => gather_light::<8>(&job, tracer, camera, before, observer),
        _ => gather_light::<4>(&job, tracer, camera, before, observer),
    }
}

/// Renders the light of a job, with path guiding if the settings request it.
fn gather_light<const N: usize>(
    job: &RenderJob<'_>,
    tracer: PathTracer<'_>,
    camera: &CameraPlan,
    before: Option<&Film>,
    observer: &dyn Observer,
) -> Result<Film, RenderError>
where
    for<'t> PathTracer<'t>: SpectralPaths<N>,
{
    let asks = camera.settings.guiding;
    let guide = asks.then(|| guide::<N>(job, &tracer, camera, observer)).transpose()?;
    job.gather::<N>(&tracer.with_guide(guide.as_ref()), before, observer)
}

/// Spread of a camera's samples on its film.
fn sample_spread(camera: &CameraPlan) -> Option<SampleSpread> {
    let CameraPlan { body, settings, .. } = camera;
    let through_lens = settings.route == Route::Lens;
    through_lens.then(|| body.effects.sample_spread(&body.raster, settings.range)).flatten()
}

/// Wavelength sampling of a camera's pixels.
fn pixel_density<'a>(plan: &'a Plan, camera: &CameraPlan) -> PixelDensity<'a> {
    let Settings { wavelength_sampling: sampling, range, bands, .. } = camera.settings;
    PixelDensity { sampling, sources: &plan.source_spectra, range, keeps_bands: bands.is_some() }
}

/// Distances up to which drops or flakes are modelled individually for the first image of a camera; `None` without precipitation.
#[must_use]
pub fn change_over(plan: &Plan, camera: &CameraPlan) -> Option<ChangeOver> {
    let rows = FilmExposure::new(camera, FrameCapture::default());
    let of = match &camera.settings.route {
        Route::Pupil(projection) => region_and_change_over(plan, camera, &rows, projection),
        Route::Lens => match &camera.body.front {
            None => region_and_change_over(plan, camera, &rows, &LensSource::new(camera)),
            Some(front) => {
                region_and_change_over(plan, camera, &rows, &FrontSource { lens: LensSource::new(camera), front })
            }
        },
    };
    of.map(|(.., change_over)| change_over)
}

/// Columns and rows of a camera's film before its image.
fn margin_px(camera: &CameraPlan) -> [usize; 2] {
    match camera.settings.route {
        Route::Lens => camera.body.effects.margin_px(),
        Route::Pupil(_) => [0, 0],
    }
}

pub(super) fn region_and_change_over<'a>(
    plan: &'a Plan,
    camera: &CameraPlan,
    rows: &FilmExposure<'_>,
    source: &dyn RaySource,
) -> Option<(&'a Precipitation, VisibleRegion, ChangeOver)> {
    let precipitation = plan.precipitation.as_ref()?;
    let (width, height) = camera.film_size();
    let region = visible_region(source, rows, width, height);
    let resolution = precipitation.resolution(pitch_tan(camera), rows.interval().length_s());
    let change_over = ChangeOver::new(precipitation.field.classes(), &resolution, &region);
    Some((precipitation, region, change_over))
}

pub(super) fn render_job<'a>(
    camera: &CameraPlan,
    exposure: FilmExposure<'a>,
    request: LightRequest,
    source: &'a dyn RaySource,
    mosaic: Option<&'a Mosaic>,
) -> RenderJob<'a> {
    let settings = &camera.settings;
    let (width, height) = camera.film_size();
    RenderJob {
        source,
        exposure,
        width,
        height,
        aperture_px: if settings.route == Route::Lens { camera.body.aperture_px } else { 1.0 },
        layout: camera.film_layout(),
        mosaic,
        sampling: Sampling {
            pass: NumberedPass::only(settings.spp),
            replicates: settings.replicates,
            seed: settings.seed,
            camera: camera.light.index,
            frame_capture: request.frame_capture,
            low_nm: settings.range.low_nm as f32,
            high_nm: settings.range.high_nm as f32,
            spread: camera.spectrum_spread(),
        },
        tolerance: camera.tolerance(),
        blocks: settings.blocks,
        tile_px: settings.tile_px,
        shard: request.shard,
        sample_spread: None,
        scratch: None,
    }
}

/// Angle of a pixel at the centre of the image, rad, given by its tangent.
fn pitch_tan(camera: &CameraPlan) -> f64 {
    match &camera.settings.route {
        Route::Lens => front_pitch(&camera.body)
            .unwrap_or_else(|| camera.body.raster.pitch_mm().x / camera.body.lens.principal_distance_mm()),
        Route::Pupil(projection) => projection.pitch_tan(),
    }
}

pub(super) fn path_settings(camera: &CameraPlan, pass: NumberedPass) -> PathSettings {
    let Settings { replicates, adaptive, .. } = camera.settings;
    let spp = pass.pass.samples;
    // The samples of all passes so far cover the pixel together.
    let covering = pass.before_spp + spp;
    // With noise-limited sampling, runs of samples have the length common to all pixels.
    let samples = adaptive.map_or(spp, |limit| limit.min_spp) / replicates;
    PathSettings {
        samples,
        cone_spread_rad: pitch_tan(camera) as f32 * sample_width(covering / replicates),
        ..camera.settings.paths
    }
}

/// Angle between the views of neighbouring pixels in a mirror, which widens the field: the median over the image.
fn front_pitch(body: &CameraBody) -> Option<f64> {
    const SIDE: u32 = 24;
    body.front.as_ref()?;
    let size = DVec2::new(body.raster.width() as f64, body.raster.height() as f64);
    let ray_direction =
        |at: DVec2| body.truth_ray(at).filter(|(ray, _)| ray.mirror_m.is_some()).map(|(ray, _)| ray.ray.direction);
    let angle = |i: u32| {
        let at = size * (DVec2::new(f64::from(i % SIDE), f64::from(i / SIDE)) + 0.5) / f64::from(SIDE);
        let (a, b) = (ray_direction(at)?, ray_direction(at + DVec2::X)?);
        Some(atan2(a.cross(b).length(), a.dot(b)))
    };
    let mut angles: Vec<f64> = (0..SIDE * SIDE).filter_map(angle).collect();
    angles.sort_by(f64::total_cmp);
    angles.get(angles.len() / 2).copied()
}

/// Width of a sample as a fraction of a pixel's width: the samples together cover the pixel once, so that textures are not averaged over the pixel twice. At
/// least an eighth, to reduce texture reads.
fn sample_width(samples: u32) -> f32 {
    (1.0 / (samples.max(1) as f32).sqrt()).max(0.125)
}

/// Rays through a lens.
struct LensSource {
    lens: Lens,
    raster: Raster,
}

impl LensSource {
    fn new(camera: &CameraPlan) -> Self {
        Self { lens: camera.body.lens.clone(), raster: camera.body.film() }
    }
}

impl RaySource for LensSource {
    fn ray(&self, raster_px: DVec2, pupil: DVec2, wavelength_nm: f64) -> Option<PupilRay> {
        self.lens.ray(self.raster.sensor_mm(raster_px), pupil, wavelength_nm)
    }
}

/// The elements before a camera at the middle of an exposure, the same for all rows. Drops slide by the gravity of the camera's orientation when they start.
fn front_at<'a>(front: &'a Front, camera: &CameraPlan, frame_capture: FrameCapture) -> Cow<'a, Front> {
    let Some(drop_motion) = front.course() else { return Cow::Borrowed(front) };
    let pose = camera.path.at(drop_motion.start_s);
    let middle_s = FilmExposure::new(camera, frame_capture).interval().middle_s();
    Cow::Owned(front.at(middle_s, pose.rotation.transpose() * DVec3::NEG_Z))
}

/// Rays through a lens and the elements before it.
struct FrontSource<'a> {
    lens: LensSource,
    front: &'a Front,
}

impl RaySource for FrontSource<'_> {
    fn ray(&self, raster_px: DVec2, pupil: DVec2, wavelength_nm: f64) -> Option<PupilRay> {
        let LensSource { lens, raster } = &self.lens;
        self.front.ray(lens, raster.sensor_mm(raster_px), pupil, wavelength_nm).map(|front| front.ray)
    }
}

/// Rays from the centre of the entrance pupil, with weight 1, so that irradiance equals radiance. Pixels between the views of a cube have none.
impl RaySource for PupilProjection {
    fn ray(&self, raster_px: DVec2, _pupil: DVec2, _wavelength_nm: f64) -> Option<PupilRay> {
        let direction = self.direction(raster_px)?;
        Some(PupilRay { origin_m: DVec3::ZERO, direction, weight_sr: 1.0 })
    }
}
