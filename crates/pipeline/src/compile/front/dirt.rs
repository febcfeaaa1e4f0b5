//! Dirt on the front glass.

use super::super::context::Context;
use super::super::picture::grey;
use etendue_optics::front::{Dirt, DirtParameters, Mask, Placement};
use etendue_scene::record::front::dirt as record;
use glam::{DVec2, DVec3};

pub(super) fn dirt(r: &record::Dirt, context: &mut Context<'_>) -> Option<Dirt> {
    let (width, texels) = grey(&r.mask, context)?;
    let mask = context.accept(&r.mask.place, Mask::new(width, texels.len() / width.max(1), texels))?;
    let [x, y] = r.offset_mm.as_ref().map_or([0.0; 2], |o| o.value);
    let tilt = r.tilt_deg.as_ref().map_or(0.0, |t| t.value);
    let placement = Placement::turned(DVec3::new(x, y, r.distance_mm.value), [tilt, 0.0, 0.0]);
    let size_mm = DVec2::from_array(r.size_mm.value);
    context.accept(&r.place, Dirt::new(DirtParameters { placement, size_mm, mask }))
}
