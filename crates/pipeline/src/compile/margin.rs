//! What is missing beyond the picture, where effects and blur take light from.

use super::context::Context;
use crate::plan::CameraBody;
use etendue_optics::DepthOfField;

/// Light from beyond the picture that the lens does not give.
pub(super) fn remark(body: &CameraBody, context: &mut Context<'_>) {
    if let (Ok(()), Err(error)) = (body.lens.check(&body.raster), body.lens.check(&body.film())) {
        context.warn(format!("beyond the picture, where the effects take light from, some is missing: {error}"));
    }
}

/// Blur that is wider than what is kept around the picture.
pub(super) fn remark_reach(camera: &str, depth_of_field: &DepthOfField, body: &CameraBody, context: &mut Context<'_>) {
    if let Some([reach, kept]) = body.short_blur_margin_px(depth_of_field) {
        let text = format!(
            "camera \"{camera}\": things at 1 m and beyond blur over radii of up to {reach} px, and {kept} px are kept around the picture: what lies farther out counts as the \
             mean of what is kept, so that even light is right and a lone lamp out of focus may be far too bright; route = \"lens\" has no such limit"
        );
        context.warn(text);
    }
}
