//! `[front]`: what stands in front of the lens.

mod curve;
mod dirt;
mod drops;
mod mirror;
mod windscreen;

use curve::curve;

use super::context::Context;
use etendue_optics::Lens;
use etendue_optics::front::{Front, FrontError, Optic};
use etendue_projection::Raster;
use etendue_scene::record::{self};

/// The front of a camera, checked against what the camera sees; `None` with the faults noted.
pub(super) fn front(record: &record::Front, lens: &Lens, raster: &Raster, context: &mut Context<'_>) -> Option<Front> {
    let dirt = match &record.dirt {
        Some(record) => Some(dirt::dirt(record, context)?),
        None => None,
    };
    let (optic, place) = match (&record.windscreen, &record.mirror) {
        (Some(glass), _) => (Some(Optic::Windscreen(Box::new(windscreen::windscreen(glass, context)?))), &glass.place),
        (None, Some(mirror)) => (Some(Optic::Mirror(Box::new(mirror::mirror(mirror, context)?))), &mirror.place),
        (None, None) => (None, &record.place),
    };
    let front = Front::new(dirt, optic)?;
    let checked = front.check(lens, raster);
    let drops = record.windscreen.as_ref().and_then(|glass| glass.drops.as_ref());
    let place = match (&checked, drops) {
        (Err(FrontError::DropsNotSeen), Some(drops)) => &drops.place,
        _ => place,
    };
    context.accept(place, checked)?;
    Some(front)
}
