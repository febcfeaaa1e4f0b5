//! `[effects]`: from the record to the effects.

use super::context::Context;
use etendue_optics::{Effects, EffectsParameters, Glare, GlareParameters};
use etendue_projection::Raster;
use etendue_scene::record::{self, effects as description};

/// The effects behind a picture; none where the record is silent.
pub(super) fn effects(
    record: Option<&record::Effects>,
    picture: &Raster,
    context: &mut Context<'_>,
) -> Option<Effects> {
    let Some(record) = record else { return Some(Effects::default()) };
    let glare = match &record.glare {
        Some(record) => Some(context.accept(&record.place, glare(record))?),
        None => None,
    };
    let parameters = EffectsParameters { glare, margin: record.margin.as_ref().map(|m| m.value) };
    let place = record.margin.as_ref().map_or(&record.place, |m| &m.place);
    context.accept(place, Effects::new(parameters, picture))
}

fn glare(record: &description::Glare) -> Result<Glare, etendue_optics::EffectsError> {
    Glare::new(GlareParameters {
        scatter: record.scatter.value,
        core_um: record.core_um.value,
        exponent: record.exponent.value,
        reach_mm: record.reach_mm.as_ref().map(|r| r.value),
    })
}
