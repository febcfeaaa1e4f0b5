//! Which drops and flakes a camera may see.

use crate::plan::Precipitation;
use crate::render::exposure::FilmExposure;
use crate::render::light::RaySource;
use etendue_core::TimeInterval;
use etendue_tracer::accel::Simd;
use etendue_tracer::media::Media;
use etendue_tracer::precipitation::{ChangeOver, Near, SeenRegion};
use glam::{DVec2, DVec3};

/// Points along a side of the film whose rays are looked at.
const SIDE: u32 = 13;

/// Room for what lies between these, rad.
const ROOM_RAD: f64 = 0.03;

/// Points of the pupil whose rays are looked at.
const PUPIL: [[f64; 2]; 5] = [[0.5, 0.5], [0.001, 0.001], [0.999, 0.001], [0.001, 0.999], [0.999, 0.999]];

/// A wavelength in the middle of the spectrum, nm.
const MIDDLE_NM: f64 = 550.0;

/// What a camera sees during an exposure of a film of a size in px, about the origin of its view.
pub(super) fn seen_region<S: RaySource>(
    source: &S,
    exposure: &FilmExposure<'_>,
    (width, height): (u32, u32),
) -> SeenRegion {
    let size = DVec2::new(f64::from(width), f64::from(height));
    let moments = moments(exposure.interval());
    let (mut directions, mut margin_m) = (vec![], 0.0_f64);
    for i in 0..SIDE * SIDE {
        let at = size * DVec2::new(f64::from(i % SIDE), f64::from(i / SIDE)) / f64::from(SIDE - 1);
        for pupil in PUPIL {
            let Some(ray) = source.ray(at, DVec2::from_array(pupil), MIDDLE_NM) else { continue };
            for moment_s in moments {
                let ray = exposure.to_render(&ray, moment_s);
                directions.push(ray.direction.as_dvec3());
                margin_m = margin_m.max(f64::from(ray.origin.length()));
            }
        }
    }
    SeenRegion::around(&directions, ROOM_RAD, margin_m)
}

fn moments(interval: TimeInterval) -> [f64; 5] {
    core::array::from_fn(|i| interval.start_s() + 0.25 * i as f64 * interval.length_s())
}

/// The drops and flakes of a view, `media` being its media.
pub(super) fn near<'a>(
    precipitation: &Precipitation,
    media: &Media<'a>,
    (exposure, simd): (&FilmExposure<'_>, Simd),
    region: &SeenRegion,
    change_over: &ChangeOver,
) -> Near<'a> {
    let view = (exposure.origin_m() as DVec3, exposure.interval(), simd);
    Near::new(&precipitation.field, (media.clone(), precipitation.medium), view, region, change_over)
}
