//! Which objects and which materials a pixel sees, and how much of it each covers.
//!
//! Ground truth has the identity at the pixel's centre. Here a pixel's samples go through the lens as those of its light do, at points of its photosensitive
//! area, of the pupil and of its row's exposure, so that edges, blur and motion have the shares that they have in the picture. The coverage of an identity is the
//! mean weight of the rays that meet it over that of all rays; what is left to 1 is the background. Surfaces that are cut out by their opacity are there where at
//! least half of them is; panes hide what is behind them; weather is not seen; what effects behind the lens spread stays where it came from.

use crate::plan::{CameraPlan, PassAt, Plan};
use crate::render::camera_light::{Request, SourceJob, render_job, with_lens};
use crate::render::exposure::{FilmExposure, Shot};
use crate::render::light::{RaySource, RenderJob, Sampling};
use crate::render::truth::is_there;
use crate::render::weather_layers;
use etendue_core::random::{PathStream, Pixel};
use etendue_core::{FieldRay, TimeInterval};
use etendue_optics::PRINCIPAL_NM;
use etendue_tracer::accel::Simd;
use etendue_tracer::render_space::Truth;
use rayon::prelude::*;

/// Samples a pixel, at most: shares are then known to some hundredths.
const MAX_SPP: u32 = 64;

/// An identity in a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// As in the ground truth; never 0.
    pub id: u32,
    /// The part of the pixel's light that comes from it, above 0 and at most 1.
    pub coverage: f32,
}

/// What the pixels of a picture see, row by row from the top left; of each pixel the largest shares first, equal ones by their ids.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentityCoverage {
    /// Columns of the picture.
    pub width: usize,
    /// Rows of the picture.
    pub height: usize,
    /// By instance.
    pub instances: Vec<Vec<Share>>,
    /// By material: places in the plan's list, from 1.
    pub materials: Vec<Vec<Share>>,
}

/// The coverage of a frame of a camera, by as many samples as its light has, 64 at most, or one of each replicate where these are more; on the caller's pool.
#[must_use]
pub fn identity_coverage(plan: &Plan, camera: &CameraPlan, frame: u32, simd: Simd) -> IdentityCoverage {
    let shot = Shot { frame, capture: 0 };
    with_lens(camera, shot, CoverageJob { plan, camera, request: Request { shot, simd, ..Request::default() } })
}

/// Samples a pixel.
pub(crate) fn spp(camera: &CameraPlan) -> u32 {
    let replicates = camera.settings.replicates;
    weather_layers::spp(camera).min((MAX_SPP / replicates * replicates).max(replicates))
}

/// Maximum memory per pixel while its coverage is computed and written, bytes: the header and four entries of two lists, the same again for writing, and the 24
/// numbers in the file.
pub(crate) const BYTES_OF_PIXEL: f64 =
    (4 * (size_of::<Vec<Share>>() + 4 * size_of::<Share>() + 2 * size_of::<usize>()) + 24 * size_of::<f32>()) as f64;

struct CoverageJob<'a> {
    plan: &'a Plan,
    camera: &'a CameraPlan,
    request: Request,
}

impl SourceJob for CoverageJob<'_> {
    type Output = IdentityCoverage;

    fn run(self, source: &dyn RaySource) -> IdentityCoverage {
        let Self { plan, camera, request } = self;
        let exposure = FilmExposure::of(camera, request.shot);
        let view = plan.world.render_space_with(exposure.origin_m(), exposure.interval(), request.simd);
        let job = render_job(camera, exposure, request, source, None);
        let sampling = Sampling { pass: PassAt::only(spp(camera)), ..job.sampling };
        let job = RenderJob { sampling, aperture_px: camera.body.aperture_px, ..job };
        let (width, height) = (camera.body.raster.width(), camera.body.raster.height());
        // The film of rays through the lens has a margin before the picture.
        let margin = camera.body.effects.margin_px();
        let pixel = |i: usize| Pixel { x: (i % width + margin[0]) as u32, y: (i / width + margin[1]) as u32 };
        let shares = |i: usize| {
            let (mut instances, mut materials) = (Tally::default(), Tally::default());
            job.each_ray(pixel(i), |ray, weight| {
                let (origin, direction) = (ray.ray.origin.as_dvec3(), ray.ray.direction.as_dvec3());
                let seen =
                    view.truth(origin, direction, ray.ray.time_s, |point| is_there(&view, &plan.material_table, point));
                instances.add(seen.as_ref().map_or(0, |truth: &Truth| truth.instance_id), weight);
                materials.add(seen.map_or(0, |truth| truth.material + 1), weight);
            });
            (instances.shares(), materials.shares())
        };
        let (instances, materials) = (0..width * height).into_par_iter().map(shares).unzip();
        IdentityCoverage { width, height, instances, materials }
    }
}

impl RenderJob<'_> {
    /// Hands over the rays of a pixel's samples with their weights, those that the lens stops left out.
    fn each_ray(&self, pixel: Pixel, mut take: impl FnMut(&FieldRay, f64)) {
        let Sampling { replicates, .. } = self.sampling;
        for replicate in 0..replicates {
            let first = PathStream::new(&self.address(pixel, replicate), 0);
            for sample in 0..self.sampling.spp() / replicates {
                let stream = first.with_sample(sample);
                let Some(ray) = self.pupil_ray(pixel, glam::DVec2::ZERO, &stream, PRINCIPAL_NM as f32) else {
                    continue;
                };
                // At the pupil all rows are exposed together, and there may be fewer of them than of the picture.
                let row = pixel.y.min(self.height - 1);
                let moment_s = self.exposure.moment_s(row, self.time_number(&stream));
                let lit = TimeInterval::default();
                take(&FieldRay { ray: self.exposure.to_render(&ray, moment_s), stream, lit }, ray.weight_sr);
            }
        }
    }
}

/// The weights of the identities that were met so far, in the order in which they were first.
#[derive(Default)]
struct Tally(Vec<(u32, f64)>);

impl Tally {
    fn add(&mut self, id: u32, weight: f64) {
        match self.0.iter_mut().find(|(known, _)| *known == id) {
            Some((_, sum)) => *sum += weight,
            None => self.0.push((id, weight)),
        }
    }

    /// Of all but the background.
    fn shares(self) -> Vec<Share> {
        let whole: f64 = self.0.iter().map(|(_, weight)| weight).sum();
        let met = self.0.into_iter().filter(|(id, weight)| *id > 0 && *weight > 0.0);
        let mut shares: Vec<_> = met.map(|(id, weight)| Share { id, coverage: (weight / whole) as f32 }).collect();
        shares.sort_by(|a, b| b.coverage.total_cmp(&a.coverage).then(a.id.cmp(&b.id)));
        shares
    }
}

#[cfg(test)]
mod tests;
