//! Coverage of each pixel by objects and by materials.
//!
//! Ground truth has the identity at the pixel's centre. Here a pixel's samples pass through the lens like those of its light, at points of its photosensitive
//! area, of the pupil and of its row's exposure, so that edges, blur and motion have the same coverage as in the image. The coverage of an identity is the
//! mean weight of the rays that hit it over that of all rays; the remainder to 1 is the background. Surfaces with opacity are present where it is at least
//! one half; panes hide what is behind them; weather is ignored; light spread by effects behind the lens is counted at its origin.

use crate::plan::{CameraPlan, NumberedPass, Plan};
use crate::render::camera_light::{LightRequest, SourceJob, render_job, with_lens};
use crate::render::exposure::{FilmExposure, FrameCapture};
use crate::render::light::{RaySource, RenderJob, Sampling};
use crate::render::truth::is_there;
use crate::render::weather_layers;
use etendue_core::random::{PathStream, Pixel};
use etendue_core::{FieldRay, TimeInterval};
use etendue_optics::PRINCIPAL_NM;
use etendue_tracer::accel::Simd;
use etendue_tracer::render_space::Truth;
use rayon::prelude::*;

/// Maximum samples per pixel: the uncertainty of fractions is then a few hundredths.
const MAX_SPP: u32 = 64;

/// An identity in a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentityFraction {
    /// Id as in the ground truth; never 0.
    pub id: u32,
    /// Fraction of the pixel's light from it, above 0 and at most 1.
    pub coverage: f32,
}

/// Coverage of the pixels of an image, row by row from the top left; for each pixel in order of decreasing coverage, equal ones by id.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentityCoverage {
    /// Columns of the image.
    pub width: usize,
    /// Rows of the image.
    pub height: usize,
    /// By instance.
    pub instances: Vec<Vec<IdentityFraction>>,
    /// By material: positions in the plan's list, from 1.
    pub materials: Vec<Vec<IdentityFraction>>,
}

/// Coverage of a frame of a camera, with as many samples as its light has, at most 64, or one of each replicate if these are more. Runs on the caller's pool.
#[must_use]
pub fn identity_coverage(plan: &Plan, camera: &CameraPlan, frame: u32, simd: Simd) -> IdentityCoverage {
    let frame_capture = FrameCapture { frame, capture: 0 };
    with_lens(
        camera,
        frame_capture,
        CoverageJob { plan, camera, request: LightRequest { frame_capture, simd, ..LightRequest::default() } },
    )
}

/// Samples per pixel.
pub(crate) fn spp(camera: &CameraPlan) -> u32 {
    let replicates = camera.settings.replicates;
    weather_layers::spp(camera).min((MAX_SPP / replicates * replicates).max(replicates))
}

/// Maximum memory per pixel while its coverage is computed and written, bytes: the header and four entries of two lists, the same again for writing, and the 24
/// numbers in the file.
pub(crate) const BYTES_OF_PIXEL: f64 = (4
    * (size_of::<Vec<IdentityFraction>>() + 4 * size_of::<IdentityFraction>() + 2 * size_of::<usize>())
    + 24 * size_of::<f32>()) as f64;

struct CoverageJob<'a> {
    plan: &'a Plan,
    camera: &'a CameraPlan,
    request: LightRequest,
}

impl SourceJob for CoverageJob<'_> {
    type Output = IdentityCoverage;

    fn run(self, source: &dyn RaySource) -> IdentityCoverage {
        let Self { plan, camera, request } = self;
        let exposure = FilmExposure::new(camera, request.frame_capture);
        let view = plan.world.render_space_with(exposure.origin_m(), exposure.interval(), request.simd);
        let job = render_job(camera, exposure, request, source, None);
        let sampling = Sampling { pass: NumberedPass::only(spp(camera)), ..job.sampling };
        let job = RenderJob { sampling, aperture_px: camera.body.aperture_px, ..job };
        let (width, height) = (camera.body.raster.width(), camera.body.raster.height());
        // The film of rays through the lens has a margin before the image.
        let margin = camera.body.effects.margin_px();
        let pixel = |i: usize| Pixel { x: (i % width + margin[0]) as u32, y: (i / width + margin[1]) as u32 };
        let fractions_of = |i: usize| {
            let (mut instances, mut materials) = (Tally::default(), Tally::default());
            job.each_ray(pixel(i), |ray, weight| {
                let (origin, direction) = (ray.ray.origin.as_dvec3(), ray.ray.direction.as_dvec3());
                let hit =
                    view.truth(origin, direction, ray.ray.time_s, |point| is_there(&view, &plan.material_table, point));
                instances.add(hit.as_ref().map_or(0, |truth: &Truth| truth.instance_id), weight);
                materials.add(hit.map_or(0, |truth| truth.material + 1), weight);
            });
            (instances.into_fractions(), materials.into_fractions())
        };
        let (instances, materials) = (0..width * height).into_par_iter().map(fractions_of).unzip();
        IdentityCoverage { width, height, instances, materials }
    }
}

impl RenderJob<'_> {
    /// Passes the rays of a pixel's samples with their weights to `take`; rays blocked by the lens are omitted.
    fn each_ray(&self, pixel: Pixel, mut take: impl FnMut(&FieldRay, f64)) {
        let Sampling { replicates, .. } = self.sampling;
        for replicate in 0..replicates {
            let first = PathStream::new(&self.address(pixel, replicate), 0);
            for sample in 0..self.sampling.spp() / replicates {
                let stream = first.with_sample(sample);
                let Some(ray) = self.pupil_ray(pixel, glam::DVec2::ZERO, &stream, PRINCIPAL_NM as f32) else {
                    continue;
                };
                // At the pupil all rows are exposed together, and there may be fewer of them than rows of the image.
                let row = pixel.y.min(self.height - 1);
                let moment_s = self.exposure.sample_time_s(row, self.time_number(&stream));
                let light_interval = TimeInterval::default();
                take(&FieldRay { ray: self.exposure.to_render(&ray, moment_s), stream, light_interval }, ray.weight_sr);
            }
        }
    }
}

/// Weights of the identities hit so far, in order of first occurrence.
#[derive(Default)]
struct Tally(Vec<(u32, f64)>);

impl Tally {
    fn add(&mut self, id: u32, weight: f64) {
        match self.0.iter_mut().find(|(known, _)| *known == id) {
            Some((_, sum)) => *sum += weight,
            None => self.0.push((id, weight)),
        }
    }

    /// Coverage of all identities except the background.
    fn into_fractions(self) -> Vec<IdentityFraction> {
        let total: f64 = self.0.iter().map(|(_, weight)| weight).sum();
        let identities = self.0.into_iter().filter(|(id, weight)| *id > 0 && *weight > 0.0);
        let mut fractions: Vec<_> =
            identities.map(|(id, weight)| IdentityFraction { id, coverage: (weight / total) as f32 }).collect();
        fractions.sort_by(|a, b| b.coverage.total_cmp(&a.coverage).then(a.id.cmp(&b.id)));
        fractions
    }
}

#[cfg(test)]
mod tests;
