//! A camera wherever it stands: lens, effects, sensor, processing.

use super::context::Context;
use super::effects::effects;
use super::front::front;
use super::lens::lens;
use super::processing::development;
use super::row_exposure::row_exposure;
use super::scale;
use super::sensor::{fill_factor, sensor};
use crate::plan::CameraBody;
use etendue_scene::record::Camera;

/// The camera's models; `None` with the faults noted.
pub(super) fn body(camera: &Camera, context: &mut Context<'_>) -> Option<CameraBody> {
    let before = context.faults.len();
    let camera = &*scale::scaled(camera, context)?;
    let lens = lens(camera, context);
    let scale = scale::divisor(&camera.sensor);
    // A lens with faults makes no camera: the sensor is looked at for its own faults.
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
    (context.faults.len() == before).then_some(body)
}
