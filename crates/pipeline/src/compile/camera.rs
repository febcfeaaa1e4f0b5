//! A camera without its pose (lens, effects, sensor, processing), with its errors, notes and warnings.

use super::context::{Context, ErrorCode};
use super::effects::effects;
use super::front::front;
use super::lens::lens;
use super::processing::development;
use super::row_exposure::row_exposure;
use super::scale;
use super::sensor::{fill_factor, sensor};
use crate::plan::{CameraBody, CameraPlan, PictureFormat};
use etendue_optics::DepthOfField;
use etendue_scene::record::{Camera, Output};

/// Models of the camera; `None` with the errors recorded.
pub(super) fn body(camera: &Camera, context: &mut Context<'_>) -> Option<CameraBody> {
    let before = context.errors.len();
    let camera = &*scale::scaled(camera, context)?;
    let lens = lens(camera, context);
    let scale = scale::divisor(&camera.sensor);
    // An invalid lens makes no camera: the sensor is checked for its own errors.
    let exit_pupil_mm = lens.as_ref().map_or(f64::INFINITY, |(lens, _)| lens.exit_pupil_distance_mm());
    let sensor = sensor(&camera.sensor, exit_pupil_mm, context);
    let development = match (&camera.isp, &sensor, &lens) {
        (Some(processing), Some(sensor), Some((_, raster))) => development(processing, sensor, raster, scale, context),
        _ => None,
    };
    let aperture_px = fill_factor(&camera.sensor).sqrt();
    let place = camera.sensor.place.clone();
    let (lens, raster) = lens?;
    let effects = effects(camera.effects.as_ref(), &lens, &raster, context)?;
    let front = camera.external_optics.as_ref().and_then(|record| front(record, &lens, &raster, context));
    let exposure = row_exposure(&camera.sensor, sensor.as_ref(), &raster, context);
    let body = CameraBody { place, raster, lens, front, effects, aperture_px, exposure, sensor, development, scale };
    (context.errors.len() == before).then_some(body)
}

/// Warns of light from outside the image that the lens does not transmit.
pub(super) fn warn_of_margin(body: &CameraBody, context: &mut Context<'_>) {
    if let (Ok(()), Err(error)) = (body.lens.check(&body.raster), body.lens.check(&body.film())) {
        context
            .warn(format!("part of the light from outside the image, which the lens effects use, is missing: {error}"));
    }
}

/// Warns of blur that is wider than the margin around the image.
pub(super) fn warn_of_blur(camera: &str, depth_of_field: &DepthOfField, body: &CameraBody, context: &mut Context<'_>) {
    if let Some([reach, sharp_reach]) = body.short_blur_margin_px(depth_of_field) {
        let text = format!(
            "camera \"{camera}\": objects at 1 m and beyond have blur radii of up to {reach} px, but only {sharp_reach} px \
             are stored around the image; light from farther out is replaced by the mean of the stored light, so a \
             single light out of focus may be far too bright (uniform illumination is correct); route = \"lens\" has \
             no such limit"
        );
        context.warn(text);
    }
}

/// Minimum rounding that is reported, m.
const MIN_REPORTED_M: f64 = 1e-3;

/// Reports the rounding of positions of cameras far from the world's origin.
pub(super) fn note_rounded_positions(cameras: &[CameraPlan], context: &mut Context<'_>) {
    for camera in cameras.iter().filter(|c| c.products.ground_truth && !c.products.camera_space_position) {
        let farthest = camera.path.at(camera.timing.frame_start_s(0)).position_m.abs().max_element();
        let rounding = f64::from(f32::EPSILON) * 0.5 * farthest;
        if rounding > MIN_REPORTED_M {
            context.note_on(format!("camera \"{}\"", camera.name), format!(
                "positions of the ground truth are 32-bit floats, which {farthest:.0} m from the world's origin are \
                 rounded by up to {rounding:.1e} m; depth, distance and normals are not affected; request \
                 \"camera_space_position\" and add the side-car's pose"
            ));
        }
    }
}

/// Refuses a video of images that are not written, have other bits or are lossy, or have no stated frame rate.
pub(super) fn check_video(output: &Output, camera: &CameraPlan, context: &mut Context<'_>) {
    let Some(key) = &output.video else { return };
    let mut refuse = |absent_reason: String, remedy: &str| {
        let problem = format!("\"video\" is requested, but {absent_reason}");
        context.error(ErrorCode::UnavailableOutput, &key.place, problem, format!("{remedy}, or remove the key"));
    };
    if camera.body.development.is_none() {
        return refuse("the camera has no [isp], which produces images".to_owned(), "add it");
    }
    if !camera.products.picture {
        return refuse("\"picture\", from which it is encoded, is not".to_owned(), "request \"picture\"");
    }
    match camera.body.picture_format() {
        PictureFormat::Png { bits: 8 } => {}
        PictureFormat::Png { bits } => {
            refuse(format!("the images have {bits} bits, and a video has 8"), "write images of 8 bits");
        }
        PictureFormat::Jpeg { .. } => {
            refuse("the images are JPEG, which is lossy".to_owned(), "write the images as PNG");
        }
    }
    if camera.timing.period_s.is_none() {
        refuse("no frame rate is stated".to_owned(), "add [sequence] with \"frame_rate_hz\" to the job");
    }
}
