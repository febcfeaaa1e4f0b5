//! Compiles weather over stored radiance from its record.

use super::context::Context;
use super::{medium, precipitation, spectrum};
use crate::plan::{Airlight, PrecipitationExposure, Weather};
use etendue_core::{Epoch, Motion};
use etendue_scene::DescriptionError;
use etendue_scene::asset::Assets;
use etendue_scene::record::weather::{self as record, Fog};
use etendue_spectra::Spectrum;
use etendue_tracer::media::{Medium, Phase};

/// Default elevation up to which the sky is averaged, degrees.
const SKY_DEG: f64 = 10.0;

/// Weather to apply to stored radiance.
///
/// # Errors
/// All contradictions, with their places.
pub fn compile_weather(weather: &record::Weather, assets: &Assets) -> Result<Weather, Vec<DescriptionError>> {
    let mut context = Context::new(assets, Epoch::default());
    let airlight = airlight(&weather.airlight, &mut context);
    let mut media: Vec<_> = weather.fog.iter().filter_map(|fog| self::fog(fog, &mut context)).collect();
    let falls = precipitation::precipitation(weather.precipitation.as_ref(), &mut media, &mut context);
    let falling = falls.zip(weather.exposure_s.as_ref());
    let falling = falling.map(|(precipitation, of)| PrecipitationExposure { precipitation, exposure_s: of.value });
    let errors = context.into_errors();
    airlight.filter(|_| errors.is_empty()).map(|airlight| Weather { airlight, media, falling }).ok_or(errors)
}

fn airlight(record: &record::Airlight, context: &mut Context<'_>) -> Option<Airlight> {
    match record {
        record::Airlight::Uniform(emission) => spectrum::emitted(emission, context).map(Airlight::Uniform),
        record::Airlight::Sky(sky) => {
            let elevation_deg = sky.elevation_deg.as_ref().map_or(SKY_DEG, |elevation| elevation.value);
            Some(Airlight::Sky { elevation_rad: elevation_deg.to_radians() })
        }
    }
}

/// Only the extinction of fog is used: albedo and phase function are arbitrary.
fn fog(record: &Fog, context: &mut Context<'_>) -> Option<Medium> {
    let extinction = medium::extinction(&record.extinction, context)?;
    let to_world = Motion::constant(record.transform.to_world());
    let shape = medium::shape(record.shape.as_ref(), context)?;
    let medium = Medium::new(extinction, Spectrum::constant(1.0), Phase::Isotropic, shape, to_world);
    let fog = context.accept(&record.place, medium)?;
    Some(medium::with_unevenness(fog, record.unevenness.as_ref()))
}
