//! The camera of `sensor.scale`: the same field of view with larger pixels, by one transformation of the record before it is compiled.
//!
//! One pixel replaces k × k of the described sensor and has the same technology: quantities proportional to the area grow by k², quantities of each read-out
//! are unchanged, and row times keep the duration of a frame. docs/sensor.md has the table of keys. Calibrations describe the full
//! sensor and are converted with [`full_raster`] and [`etendue_projection::Calibration::with_larger_pixels`].

mod sensor;

use super::context::{Context, ErrorCode};
use etendue_projection::{Raster, RasterError};
use etendue_scene::Placed;
use etendue_scene::record::processing::GruyerFilter;
use etendue_scene::record::sensor::Scale;
use etendue_scene::record::{Camera, Lens, Processing, lens};
use std::borrow::Cow;

/// Returns the number of pixels of the described sensor in a row and in a column of one pixel.
pub(super) fn divisor(sensor: &etendue_scene::record::Sensor) -> u64 {
    sensor.scale.as_ref().map_or(1, |scale| scale.value.divisor)
}

/// Returns the camera with the pixels of its scale; `None`, with the errors recorded, if sizes do not divide. Its sensor keeps the scale, with which
/// calibrations are converted later.
pub(super) fn scaled<'c>(camera: &'c Camera, context: &mut Context<'_>) -> Option<Cow<'c, Camera>> {
    let Some(scale) = camera.sensor.scale.as_ref().filter(|scale| scale.value.divisor > 1) else {
        return Some(Cow::Borrowed(camera));
    };
    check(camera, scale, context)?;
    let mut camera = camera.clone();
    let k = scale.value.divisor as f64;
    sensor::enlarge(&mut camera.sensor, k);
    if let Some(distortion) = distortion(&mut camera.lens)
        && distortion.radius_unit.value == lens::RadiusUnit::Pixels
    {
        distortion.k1.value *= k * k;
        distortion.k2.iter_mut().for_each(|k2| k2.value *= k * k * k * k);
    }
    camera.isp.iter_mut().for_each(|isp| shrink_processing(isp, k));
    Some(Cow::Owned(camera))
}

/// Converts positions and sizes in the image, px, to those of the smaller image; filters of neighbouring pixels are unchanged.
fn shrink_processing(isp: &mut Processing, k: f64) {
    let centre = isp.shading.iter_mut().filter_map(|shading| shading.centre_px.as_mut());
    centre.for_each(|centre| centre.value = centre.value.map(|px| px / k));
    isp.image_filters.iter_mut().for_each(|filter| shrink_filter(filter, k));
}

fn shrink_filter(filter: &mut GruyerFilter, k: f64) {
    match filter {
        GruyerFilter::Glow(glow) => glow.radius_px.value /= k,
        GruyerFilter::Drops(drops) => {
            for length in [&mut drops.min_radius_px, &mut drops.max_radius_px, &mut drops.blur_px] {
                length.value /= k;
            }
            drops.flow_px_per_frame.iter_mut().for_each(|flow| flow.value /= k);
        }
        GruyerFilter::ToneMap(_)
        | GruyerFilter::Colour(_)
        | GruyerFilter::PulseNoise(_)
        | GruyerFilter::GaussianNoise(_)
        | GruyerFilter::UniformNoise(_) => {}
    }
}

fn distortion(lens: &mut Lens) -> Option<&mut lens::Distortion> {
    match lens {
        Lens::Pinhole(r) => r.distortion.as_mut(),
        Lens::Thin(r) => r.distortion.as_mut(),
        Lens::Thick(r) => r.distortion.as_mut(),
        Lens::Calibrated(_) | Lens::Prescription(_) | Lens::RayTransfer(_) | Lens::Telecentric(_) => None,
    }
}

/// Returns the raster of the described sensor; `raster` has the larger pixels.
pub(super) fn full_raster(raster: &Raster, divisor: u64) -> Result<Raster, RasterError> {
    let k = divisor as f64;
    let (width, height) = (raster.width() * divisor as usize, raster.height() * divisor as usize);
    Raster::new(width, height, raster.pitch_mm() / k, raster.principal_px() * k)
}

/// Refuses sizes that are not a whole number of larger pixels: no border is cropped.
fn check(camera: &Camera, scale: &Placed<Scale>, context: &mut Context<'_>) -> Option<()> {
    let sensor = &camera.sensor;
    let k = scale.value.divisor;
    let (width, height) = (sensor.width_px.value, sensor.height_px.value);
    let mut divides = true;
    if !(width.is_multiple_of(k) && height.is_multiple_of(k)) {
        let problem = format!("{width} × {height} px are not a multiple of {k} × {k} pixels");
        context.error(ErrorCode::NotAMultiple, &scale.place, problem, remedy([width, height].iter()));
        divides = false;
    }
    let region = sensor.electronics.as_ref().and_then(|electronics| electronics.roi_px.as_ref());
    // A fraction of a pixel is refused where the key is read.
    if let Some(region) = region.filter(|region| region.value.iter().any(|side| side % k as f64 != 0.0)) {
        let [x, y, columns, rows] = region.value;
        let problem =
            format!("the region roi_px = [{x}, {y}, {columns}, {rows}] is not a multiple of {k} × {k} pixels");
        let sides = region.value.map(|side| side as u64);
        context.error(ErrorCode::NotAMultiple, &scale.place, problem, remedy([width, height].iter().chain(&sides)));
        divides = false;
    }
    divides.then_some(())
}

/// Lists the possible scales, at most six, the coarsest last.
fn remedy<'s>(sizes: impl Iterator<Item = &'s u64> + Clone) -> String {
    let divides = |k: &u64| sizes.clone().all(|size| size.is_multiple_of(*k));
    let largest = sizes.clone().filter(|size| **size > 0).min().copied().unwrap_or(1);
    let possible: Vec<String> = (2..=largest.min(64)).filter(divides).take(6).map(|k| format!("1/{k}")).collect();
    match possible.as_slice() {
        [] => "remove the scale, or give the sensor another size".to_owned(),
        possible => format!("give one of {}", possible.join(", ")),
    }
}
