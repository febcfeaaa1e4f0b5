//! The camera of `sensor.scale`: the same field of view with larger pixels, one transformation of the record before anything is made of it.
//!
//! One pixel stands in the place of k × k of the described sensor, made by the same technology: what a pixel has by its area grows by k², what it has by each
//! reading stays, and times of rows are such that a frame takes as long. docs/sensor.md has the table of keys. Calibrations are of the full
//! sensor until [`full_raster`] and [`etendue_projection::Calibration::with_larger_pixels`] have made them.

mod neighbours;
mod processing;
mod sensor;

use super::context::Context;
use etendue_projection::{Raster, RasterError};
use etendue_scene::Placed;
use etendue_scene::record::sensor::Scale;
use etendue_scene::record::{Camera, Lens, lens};
use std::borrow::Cow;

/// How many pixels of the described sensor one pixel has in a row and in a column.
pub(super) fn divisor(sensor: &etendue_scene::record::Sensor) -> u64 {
    sensor.scale.as_ref().map_or(1, |scale| scale.value.divisor)
}

/// The camera with its pixels as large as its scale says; `None` with the faults noted where sizes do not divide. Its sensor keeps the scale, by which
/// calibrations are scaled later.
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
    camera.isp.iter_mut().for_each(|isp| processing::shrink(isp, k));
    Some(Cow::Owned(camera))
}

fn distortion(lens: &mut Lens) -> Option<&mut lens::Distortion> {
    match lens {
        Lens::Pinhole(r) => r.distortion.as_mut(),
        Lens::Thin(r) => r.distortion.as_mut(),
        Lens::Thick(r) => r.distortion.as_mut(),
        Lens::Calibrated(_) | Lens::Prescription(_) | Lens::RayTransfer(_) | Lens::Telecentric(_) => None,
    }
}

/// The raster of the described sensor, of which `raster` has the larger pixels.
pub(super) fn full_raster(raster: &Raster, divisor: u64) -> Result<Raster, RasterError> {
    let k = divisor as f64;
    let (width, height) = (raster.width() * divisor as usize, raster.height() * divisor as usize);
    Raster::new(width, height, raster.pitch_mm() / k, raster.principal_px() * k)
}

/// Refuses sizes that are no whole number of larger pixels: no border is cut.
fn check(camera: &Camera, scale: &Placed<Scale>, context: &mut Context<'_>) -> Option<()> {
    let sensor = &camera.sensor;
    let k = scale.value.divisor;
    let (width, height) = (sensor.width_px.value, sensor.height_px.value);
    let mut divides = true;
    if !(width.is_multiple_of(k) && height.is_multiple_of(k)) {
        let problem = format!("{k} × {k} pixels do not fill a picture of {width} × {height} px evenly");
        context.fault(&scale.place, problem, remedy([width, height].iter()));
        divides = false;
    }
    let region = sensor.electronics.as_ref().and_then(|electronics| electronics.roi_px.as_ref());
    // A part of a pixel is refused where the key is read.
    if let Some(region) = region.filter(|region| region.value.iter().any(|side| side % k as f64 != 0.0)) {
        let [x, y, columns, rows] = region.value;
        let problem = format!("{k} × {k} pixels do not fill the region roi_px = [{x}, {y}, {columns}, {rows}] evenly");
        let sides = region.value.map(|side| side as u64);
        context.fault(&scale.place, problem, remedy([width, height].iter().chain(&sides)));
        divides = false;
    }
    divides.then_some(())
}

/// The scales that are possible, the coarsest last, at most six of them.
fn remedy<'s>(sizes: impl Iterator<Item = &'s u64> + Clone) -> String {
    let divides = |k: &u64| sizes.clone().all(|size| size.is_multiple_of(*k));
    let largest = sizes.clone().filter(|size| **size > 0).min().copied().unwrap_or(1);
    let possible: Vec<String> = (2..=largest.min(64)).filter(divides).take(6).map(|k| format!("1/{k}")).collect();
    match possible.as_slice() {
        [] => "leave it out, or give the sensor another size".to_owned(),
        possible => format!("give one of {}", possible.join(", ")),
    }
}
