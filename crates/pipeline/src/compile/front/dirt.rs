//! Dirt on the front glass.

use super::super::context::Context;
use etendue_optics::front::{Dirt, DirtParameters, FrontError, Mask, Stand};
use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_scene::record::front::dirt as record;
use glam::{DVec2, DVec3};

pub(super) fn dirt(r: &record::Dirt, context: &mut Context<'_>) -> Option<Dirt> {
    let Some(image) = context.assets.images.get(&r.mask.value) else {
        let problem = format!("the picture {} was not loaded", r.mask.value.display());
        context.fault(&r.mask.place, problem, "give a readable file");
        return None;
    };
    let mask = context.accept(&r.mask.place, mask(image))?;
    let [x, y] = r.offset_mm.as_ref().map_or([0.0; 2], |o| o.value);
    let tilt = r.tilt_deg.as_ref().map_or(0.0, |t| t.value);
    let stand = Stand::turned(DVec3::new(x, y, r.distance_mm.value), [tilt, 0.0, 0.0]);
    let size_mm = DVec2::from_array(r.size_mm.value);
    context.accept(&r.place, Dirt::new(DirtParameters { stand, size_mm, mask }))
}

fn mask(image: &ImageAsset) -> Result<Mask, FrontError> {
    let byte = |v: u8| f32::from(v) / 255.0;
    let mean = |p: [f32; 3]| (p[0] + p[1] + p[2]) / 3.0;
    let texels = match &image.pixels {
        ImagePixels::Gray8(p) => p.iter().map(|v| byte(*v)).collect(),
        ImagePixels::Gray16(p) => p.iter().map(|v| f32::from(*v) / 65_535.0).collect(),
        ImagePixels::Rgb8(p) => p.iter().map(|p| mean(p.map(byte))).collect(),
        ImagePixels::Rgba8(p) => p.iter().map(|[r, g, b, _]| mean([*r, *g, *b].map(byte))).collect(),
        ImagePixels::Rgb32F(p) => p.iter().map(|p| mean(*p)).collect(),
        ImagePixels::Rgba32F(p) => p.iter().map(|[r, g, b, _]| mean([*r, *g, *b])).collect(),
    };
    Mask::new(image.width as usize, image.height as usize, texels)
}
