//! Drops and flakes that a camera may see.

use crate::plan::Precipitation;
use crate::render::exposure::FilmExposure;
use crate::render::light::RaySource;
use etendue_core::TimeInterval;
use etendue_optics::PupilProjection;
use etendue_tracer::accel::Simd;
use etendue_tracer::media::Media;
use etendue_tracer::precipitation::{ChangeOver, NearParticles, ViewPlacement, VisibleRegion};
use glam::{DMat3, DVec2};

/// Points along a side of the film whose rays bound the view.
const SIDE: u32 = 13;

/// Margin for rays between these points, rad.
const MARGIN_RAD: f64 = 0.03;

/// Points of the pupil whose rays bound the view.
const PUPIL: [[f64; 2]; 5] = [[0.5, 0.5], [0.001, 0.001], [0.999, 0.001], [0.001, 0.999], [0.999, 0.999]];

/// Distance of alternative points inside the film's edges, px, for edges without a ray.
const EDGE_OFFSET_PX: f64 = 1e-6;

/// A central wavelength of the spectrum, nm.
const MIDDLE_NM: f64 = 550.0;

/// Region that a camera sees during an exposure of a film of a size in px, relative to the origin of its view.
pub(super) fn visible_region(
    source: &dyn RaySource,
    exposure: &FilmExposure<'_>,
    width: u32,
    height: u32,
) -> VisibleRegion {
    let moments = moments(exposure.interval());
    let (mut directions, mut margin_m) = (vec![], 0.0_f64);
    for [at, within] in grid(width, height) {
        for pupil in PUPIL {
            let ray = |at: DVec2| source.ray(at, DVec2::from_array(pupil), MIDDLE_NM);
            let Some(ray) = ray(at).or_else(|| ray(within)) else { continue };
            for moment_s in moments {
                let ray = exposure.to_render(&ray, moment_s);
                directions.push(ray.direction.as_dvec3());
                margin_m = margin_m.max(f64::from(ray.origin.length()));
            }
        }
    }
    VisibleRegion::around(&directions, MARGIN_RAD, margin_m)
}

/// Region that the static camera of a stored image sees, with its axes rotated to the world's.
pub(crate) fn region_of_projection(projection: &PupilProjection, rotation: DMat3) -> VisibleRegion {
    let (width, height) = (projection.width() as u32, projection.height() as u32);
    let direction = |[at, within]: [DVec2; 2]| projection.direction(at).or_else(|| projection.direction(within));
    let directions: Vec<_> = grid(width, height).filter_map(direction).map(|direction| rotation * direction).collect();
    VisibleRegion::around(&directions, MARGIN_RAD, 0.0)
}

/// Points over a film, including its edges, each with an alternative just inside the edges.
fn grid(width: u32, height: u32) -> impl Iterator<Item = [DVec2; 2]> {
    let size = DVec2::new(f64::from(width), f64::from(height));
    (0..SIDE * SIDE).map(move |i| {
        let at = size * DVec2::new(f64::from(i % SIDE), f64::from(i / SIDE)) / f64::from(SIDE - 1);
        [at, at.min(size - EDGE_OFFSET_PX)]
    })
}

fn moments(interval: TimeInterval) -> [f64; 5] {
    core::array::from_fn(|i| interval.start_s() + 0.25 * i as f64 * interval.length_s())
}

/// Drops and flakes of a view; `media` are its media.
pub(super) fn near<'a>(
    precipitation: &Precipitation,
    media: &Media<'a>,
    exposure: &FilmExposure<'_>,
    simd: Simd,
    region: &VisibleRegion,
    change_over: &ChangeOver,
) -> NearParticles<'a> {
    let view = ViewPlacement { origin_m: exposure.origin_m(), interval: exposure.interval(), simd };
    NearParticles::new(&precipitation.field, media.clone(), precipitation.medium, view, region, change_over)
}
