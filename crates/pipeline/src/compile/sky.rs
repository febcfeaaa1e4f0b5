//! Clear sky and sun by the model of Hosek and Wilkie.

use super::context::{Context, ErrorCode};
use crate::plan::SkyFacts;
use etendue_core::maths::f64::{sin, sin_cos};
use etendue_scene::record::environment::{Sky, SunMoment};
use etendue_scene::{Place, Placed};
use etendue_spectra::sky::{SkyModel, sun};
use etendue_spectra::{Spectrum, observer};
use etendue_tracer::lights::sun_position::{CalendarDate, ClockTime, UtcTime, sun_position};
use etendue_tracer::lights::{SUN_ANGULAR_DIAMETER_DEG, SkyEnvironment, Sun};
use glam::DVec3;

/// Default reflectance of the ground: grass and soil reflect about a fifth of the light.
const GROUND_ALBEDO: f64 = 0.2;

/// A sky, its sun if requested and above the horizon, and the plan's facts of them.
pub(super) struct CompiledSky {
    pub(super) environment: SkyEnvironment,
    pub(super) sun: Option<Sun>,
    pub(super) facts: SkyFacts,
}

/// Direction of the sun in the world, rad: elevation, and azimuth from +x towards +y.
struct SunDirection {
    elevation_rad: f64,
    azimuth_rad: f64,
}

/// Sky of a record; `None` with the errors recorded.
pub(super) fn sky(record: &Sky, context: &mut Context<'_>) -> Option<CompiledSky> {
    let place = record.sun_place();
    let sunward = sunward(record, context)?;
    let albedo = record.ground_albedo.as_ref().map_or(GROUND_ALBEDO, |a| a.value);
    let model = context.accept(place, SkyModel::new(record.turbidity.value, albedo, sunward.elevation_rad))?;
    let is_requested = record.sun.as_ref().is_none_or(|s| s.value);
    let beam = match is_requested && sunward.elevation_rad >= 0.0 {
        true => Some(normal_irradiance(&record.turbidity, sunward.elevation_rad, place, context)?),
        false => None,
    };
    let on_ground = match &beam {
        Some(beam) => beam.scaled(sin(sunward.elevation_rad)),
        None => Spectrum::constant(0.0),
    };
    let Some(environment) = SkyEnvironment::new(&model, sunward.azimuth_rad, albedo, &on_ground) else {
        context.error(
            ErrorCode::OutOfRange,
            place,
            "the sky is black at this elevation of the sun",
            "remove the sky, or raise the sun",
        );
        return None;
    };
    let facts = SkyFacts {
        turbidity: record.turbidity.value,
        sun_elevation_deg: sunward.elevation_rad.to_degrees(),
        sun_azimuth_deg: sunward.azimuth_rad.to_degrees(),
        sky_lx: observer::luminance(environment.irradiance()),
        sun_lx: observer::luminance(&on_ground),
    };
    let sun = match beam {
        Some(beam) => {
            let sun = Sun::from_irradiance(sunward.direction(), SUN_ANGULAR_DIAMETER_DEG, &beam);
            Some(context.accept(place, sun)?.with_limb())
        }
        None => None,
    };
    Some(CompiledSky { environment, sun, facts })
}

/// Spectral irradiance by the sun through air of a given turbidity, on a plane perpendicular to the beam.
pub(super) fn normal_irradiance(
    turbidity: &Placed<f64>,
    elevation_rad: f64,
    place: &Place,
    context: &mut Context<'_>,
) -> Option<Spectrum> {
    context.accept(place, sun::normal_irradiance(turbidity.value, elevation_rad))
}

fn sunward(record: &Sky, context: &mut Context<'_>) -> Option<SunDirection> {
    match (&record.angles, &record.moment) {
        (Some(angles), _) => Some(SunDirection {
            elevation_rad: angles.sun_elevation_deg.value.to_radians(),
            azimuth_rad: angles.sun_azimuth_deg.value.to_radians(),
        }),
        (None, Some(moment)) => direction_at(moment, context),
        // A sky in a loaded description states one of them.
        (None, None) => None,
    }
}

fn direction_at(moment: &SunMoment, context: &mut Context<'_>) -> Option<SunDirection> {
    let (day, seconds) = (moment.date.value, moment.time_utc.seconds);
    let date = CalendarDate { year: day.year as i32, month: day.month, day: day.day };
    let time = ClockTime { hour: seconds / 3600, minute: seconds / 60 % 60, second: f64::from(seconds % 60) };
    let utc = context.accept(&moment.date.place, UtcTime::new(date, time))?;
    let position = sun_position(utc, moment.latitude_deg.value, moment.longitude_deg.value);
    let position = context.accept(&moment.latitude_deg.place, position)?;
    // North rotates anticlockwise as seen from above, the sun's azimuth clockwise from it.
    let north_rad = moment.north_azimuth_deg.as_ref().map_or(0.0, |n| n.value.to_radians());
    let turn = core::f64::consts::TAU;
    let azimuth_rad = (north_rad - position.azimuth_rad).rem_euclid(turn);
    Some(SunDirection { elevation_rad: position.elevation_rad, azimuth_rad })
}

impl SunDirection {
    fn direction(&self) -> DVec3 {
        direction(self.elevation_rad, self.azimuth_rad)
    }
}

/// Unit vector of an elevation and an azimuth.
pub(super) fn direction(elevation_rad: f64, azimuth_rad: f64) -> DVec3 {
    let ((sin_e, cos_e), (sin_a, cos_a)) = (sin_cos(elevation_rad), sin_cos(azimuth_rad));
    DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e)
}
