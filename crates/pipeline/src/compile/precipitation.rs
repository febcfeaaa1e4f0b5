//! Rain and snow: from records to the tracer's field.

use super::context::Context;
use crate::plan::Precipitation;
use etendue_scene::Place;
use etendue_scene::record::Precipitation as Record;
use etendue_scene::record::precipitation::{self, PrecipitationSettings};
use etendue_tracer::media::Medium;
use etendue_tracer::precipitation::{Crystals, PrecipitationField, SizeLaw, SizeLawError};
use glam::DVec3;

/// Precipitation, with its medium added to the others.
pub(super) fn precipitation(
    record: Option<&Record>,
    media: &mut Vec<Medium>,
    context: &mut Context<'_>,
) -> Option<Precipitation> {
    let (law, rescaled, fall, place) = match record? {
        Record::Rain(of) => (SizeLaw::rain(of.rate_mm_h.value), &of.rescaled, &of.fall, &of.rate_mm_h.place),
        Record::Snow(of) => {
            let crystals = of.crystals.as_ref().map_or(Crystals::default(), |crystals| self::crystals(crystals.value));
            (SizeLaw::snow(of.rate_mm_h.value, crystals), &of.rescaled, &of.fall, &of.rate_mm_h.place)
        }
    };
    let law = self::law(law, rescaled.as_ref().is_some_and(|rescaled| rescaled.value), place, context)?;
    let field = field(law, fall);
    media.push(context.accept(place, field.medium())?);
    Some(Precipitation {
        field,
        medium: media.len() - 1,
        clear_m: fall.clear_m.as_ref().map_or(0.0, |of| of.value),
        smallest_px: fall.smallest_px.as_ref().map_or(0.25, |of| of.value),
        max_drops: fall.most.as_ref().map_or(200_000, |of| of.value),
    })
}

fn law(
    law: Result<SizeLaw, SizeLawError>,
    rescaled: bool,
    place: &Place,
    context: &mut Context<'_>,
) -> Option<SizeLaw> {
    let law = context.accept(place, law)?;
    Some(if rescaled { law.rescaled() } else { law })
}

fn field(law: SizeLaw, fall: &PrecipitationSettings) -> PrecipitationField {
    let wind_mps = fall.wind_m_s.as_ref().map_or(DVec3::ZERO, |wind| DVec3::from_array(wind.value));
    let top_m = fall.top_m.as_ref().map_or(500.0, |top| top.value);
    PrecipitationField::new(law, wind_mps, top_m, fall.seed.as_ref().map_or(0, |seed| seed.value as u32))
}

fn crystals(record: precipitation::Crystals) -> Crystals {
    match record {
        precipitation::Crystals::Dendrites => Crystals::Dendrites,
        precipitation::Crystals::Aggregates => Crystals::Aggregates,
        precipitation::Crystals::Rimed => Crystals::Rimed,
        precipitation::Crystals::Graupel => Crystals::Graupel,
    }
}
