//! Effects of weather on each pixel: separate layers of the light, which depth and identities ignore.
//!
//! - **Transmittance**: fraction of light at 587.56 nm, the wavelength of ground truth, that arrives unscattered from the first surface (or from
//!   infinity) through all media. Near drops and flakes are not included; they are in the cover. Together they transmit
//!   transmittance · (1 − cover).
//! - **Cover**: fraction of a pixel, its pupil and its exposure with a drop or flake before the first surface.
//! - **Airlight**: spectral radiance that media scattered into the pixel's rays before they hit a surface, a drop or a flake.
//!
//! They are means over as many samples as the light has, with its random addresses (wavelengths are sampled uniformly here; if the light's samples are
//! adaptive, there are 64): light minus airlight is, except for noise, the light from surfaces. They have the raster of the film, without the effects behind
//! the lens. Surfaces with opacity are present as in ground truth: where it is at least one half.

use crate::plan::{CameraPlan, NumberedPass, Plan, Settings};
use crate::render::camera_light::{SourceJob, lights, path_settings, region_and_change_over, render_job, with_source};
use crate::render::exposure::FilmExposure;
use crate::render::film::Film;
use crate::render::light::{RaySource, RenderJob, Sampling};
use crate::render::near_precipitation::near;
use crate::render::observer::NullObserver;
use crate::render::truth::is_there;
use crate::render::{FrameCapture, LightRequest};
use crate::sizes::film::FilmLayout;
use etendue_core::quantity::{Cover, Quantity, Radiance, Transmittance};
use etendue_core::{Bands, FieldRay, Plane, RadianceField, Spectral, SpectralCube, Wavelengths};
use etendue_optics::PRINCIPAL_NM;
use etendue_tracer::accel::Simd;
use etendue_tracer::integrator::{PathSettings, PathTracer};
use etendue_tracer::materials::MaterialTable;
use etendue_tracer::media::{ForwardPeak, Media, MediaRay, RandomCounter};
use etendue_tracer::precipitation::NearParticles;
use etendue_tracer::render_space::RenderSpace;

/// Effects of weather on the pixels of a film.
#[derive(Clone, Debug)]
pub struct WeatherLayers {
    /// Fraction of light transmitted by media.
    pub transmittance: Plane<Transmittance>,
    /// Fraction covered by near drops or flakes; `None` without precipitation.
    pub cover: Option<Plane<Cover>>,
    /// Light scattered in by media, in the bands of the light; in a single band if it has none.
    pub airlight: SpectralCube<Radiance>,
}

/// Layers of a camera's image; takes slightly longer than its light. Runs on the caller's pool.
#[must_use]
pub fn weather_layers(plan: &Plan, camera: &CameraPlan, frame_capture: FrameCapture, simd: Simd) -> WeatherLayers {
    with_source(
        camera,
        frame_capture,
        LayersJob { plan, camera, request: LightRequest { frame_capture, simd, ..LightRequest::default() } },
    )
}

struct LayersJob<'a> {
    plan: &'a Plan,
    camera: &'a CameraPlan,
    request: LightRequest,
}

impl SourceJob for LayersJob<'_> {
    type Output = WeatherLayers;

    fn run(self, source: &dyn RaySource) -> WeatherLayers {
        let Self { plan, camera, request } = self;
        let rows = FilmExposure::new(camera, request.frame_capture);
        let view = plan.world.render_space_with(rows.origin_m(), rows.interval(), request.simd);
        let media = Media::new(&plan.media, rows.origin_m(), rows.interval());
        let near = region_and_change_over(plan, camera, &rows, source).map(|(precipitation, region, change_over)| {
            near(precipitation, &media, &rows, request.simd, &region, &change_over)
        });
        let field_of = |of| FractionField {
            view: &view,
            material_table: &plan.material_table,
            media: &media,
            near: near.as_ref(),
            fraction: of,
        };
        let uniform = FilmLayout { bands: Some(single_band(camera)), accumulates_electrons: false, watched: false };
        let job = |layout| {
            let job = render_job(camera, rows.clone(), request, source, None);
            RenderJob {
                layout,
                tolerance: None,
                sampling: Sampling { pass: NumberedPass::only(spp(camera)), ..job.sampling },
                ..job
            }
        };
        let fractions_of = |of| {
            let film = job(uniform).gather::<1>(&field_of(of), None, &NullObserver).expect("nobody cancels");
            radiance(&film).planes()[0].samples().to_vec()
        };
        let lights = lights(plan, camera, &view);
        let settings =
            PathSettings { only_airlight: true, ..path_settings(camera, NumberedPass::only(camera.settings.spp)) };
        let tracer =
            PathTracer::new(&view, &plan.material_table, &lights, settings).with_media(&media).with_near(near.as_ref());
        let bands = camera.settings.bands.unwrap_or_else(|| single_band(camera));
        let job = job(FilmLayout { bands: Some(bands), accumulates_electrons: false, watched: false });
        let airlight = match camera.settings.wavelengths {
            1 => job.gather::<1>(&tracer, None, &NullObserver),
            8 => job.gather::<8>(&tracer, None, &NullObserver),
            _ => job.gather::<4>(&tracer, None, &NullObserver),
        };
        WeatherLayers {
            transmittance: plane(camera, fractions_of(WeatherFraction::Transmittance)),
            cover: near.is_some().then(|| plane(camera, fractions_of(WeatherFraction::Cover))),
            airlight: radiance(&airlight.expect("nobody cancels")),
        }
    }
}

/// Samples per pixel: those of the light; if these are adaptive, 64, or as many as are common to all pixels.
pub(crate) fn spp(camera: &CameraPlan) -> u32 {
    let Settings { spp, replicates, adaptive, .. } = camera.settings;
    adaptive.map_or(spp, |adaptive| adaptive.min_spp.max(64).next_multiple_of(replicates))
}

/// The wavelength range of a camera's light as a single band.
fn single_band(camera: &CameraPlan) -> Bands {
    let range = camera.settings.range;
    Bands::new(range.low_nm, range.width_nm(), 1).expect("a compiled plan has a range")
}

fn radiance(film: &Film) -> SpectralCube<Radiance> {
    film.radiance().expect("a film with bands").mean
}

fn plane<Q: Quantity<Sample = f32>>(camera: &CameraPlan, samples: Vec<f32>) -> Plane<Q> {
    let (width, height) = camera.film_size();
    Plane::from_samples(width as usize, height as usize, samples).expect("one sample a pixel")
}

/// Fraction to evaluate.
#[derive(Clone, Copy)]
enum WeatherFraction {
    Transmittance,
    Cover,
}

/// Fractions in place of radiance, so that they are averaged in the same way.
struct FractionField<'a> {
    view: &'a RenderSpace<'a>,
    material_table: &'a MaterialTable,
    media: &'a Media<'a>,
    near: Option<&'a NearParticles<'a>>,
    fraction: WeatherFraction,
}

impl RadianceField<1> for FractionField<'_> {
    fn radiance(&self, field_ray: &FieldRay, _wavelengths: &Wavelengths<1>) -> Spectral<1> {
        let mut ray = field_ray.ray;
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let hit =
            self.view.truth(origin, direction, ray.time_s, |point| is_there(self.view, self.material_table, point));
        ray.t_max = hit.map_or(f32::INFINITY, |truth| truth.distance_m as f32);
        let near = self.near.filter(|near| near.looks_along(ray.direction));
        match self.fraction {
            WeatherFraction::Cover => {
                let is_hit = near.is_some_and(|near| near.closest(&ray, ray.t_max).is_some());
                Spectral::splat(if is_hit { 1.0 } else { 0.0 })
            }
            WeatherFraction::Transmittance => {
                let media = near.map_or(self.media, NearParticles::media);
                let at = Wavelengths { nm: [PRINCIPAL_NM as f32], pdf: [1.0] };
                let random = RandomCounter { stream: &field_ray.stream, counter: 0 };
                media.transmittance(MediaRay { ray: &ray, peak: ForwardPeak::Exact }, random, &at)
            }
        }
    }
}

#[cfg(test)]
mod tests;
