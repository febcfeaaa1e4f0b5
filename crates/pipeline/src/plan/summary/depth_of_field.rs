//! What becomes of defocus at the pupil, in words.

use crate::camera::defocus::margin_px;
use crate::plan::CameraPlan;
use etendue_optics::DepthOfField;

/// What becomes of defocus at the pupil.
pub(super) fn depth_of_field(camera: &CameraPlan) -> String {
    match &camera.depth_of_field {
        DepthOfField::None => format!("defocus is left out ({})", blur(camera)),
        DepthOfField::Physical => {
            let margin = margin_px(&camera.depth_of_field, &camera.body);
            format!(
                "defocus by the pupil's outline, spread in the order of depth ({}; {margin} px around the picture); what lies \
                 behind edges is guessed from beside them",
                blur(camera)
            )
        }
        DepthOfField::Fast(blend) => {
            let p = blend.parameters();
            format!(
                "a look of defocus: sharp from {} to {} m, blended with a copy blurred by {} px, wholly before {} m and beyond \
                 {} m (the lens's own blur: {})",
                p.sharp_near_m,
                p.sharp_far_m,
                p.blur_px,
                p.blurred_near_m,
                p.blurred_far_m,
                blur(camera)
            )
        }
    }
}

/// The blur of the lens.
pub(super) fn blur(camera: &CameraPlan) -> String {
    let pixels = |depth_m: f64| camera.body.lens.circle_of_confusion_mm(depth_m) / camera.body.raster.pitch_mm().x;
    format!("{:.2} px across at 1 m, {:.2} px at infinity", pixels(1.0), pixels(f64::INFINITY))
}
