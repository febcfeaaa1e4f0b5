//! A camera defined by the directions of its pixels.

use super::super::context::{Context, ErrorCode};
use super::super::scale::{divisor, full_raster};
use super::projection;
use crate::compile::stated::{focus_m, transmittance};
use etendue_optics::{CalibratedParameters, Falloff, FalloffArgument, Lens, OpticsError, PupilOrientation};
use etendue_projection::{Calibration, Raster};
use etendue_scene::Place;
use etendue_scene::asset::{LensNumbers, LensQuantity};
use etendue_scene::record::Sensor;
use etendue_scene::record::lens::calibrated::{
    CalibratedLens, IlluminationSource, PixelDirections, Pupil, RelativeIllumination,
};
use etendue_scene::record::lens::projection::CalibrationFile;

/// Lens, and the raster around the calibration's principal point.
pub(super) fn lens(
    record: &CalibratedLens,
    sensor: &Sensor,
    raster: &Raster,
    context: &mut Context<'_>,
) -> Option<(Lens, Raster)> {
    let full = context.accept(&record.place, full_raster(raster, divisor(sensor)))?;
    let (place, calibration) = match &record.view {
        PixelDirections::Projection(projection) => {
            (&record.place, projection::calibration(projection, &record.place, &full, context)?)
        }
        PixelDirections::Calibration(file) => {
            let calibration = imported(file, &full, context)?;
            context.accept(&sensor.place, check_size(&calibration, &full))?;
            (&file.file.place, calibration)
        }
    };
    one_principal_point(record, sensor, context)?;
    let calibration = calibration.with_larger_pixels(divisor(sensor) as usize);
    let calibration = match &record.greatest_angle_deg {
        None => calibration,
        Some(angle) => context.accept(&angle.place, calibration.with_max_angle(angle.value.to_radians()))?,
    };
    let matrix = calibration.matrix();
    let principal = glam::DVec2::new(matrix.cx, matrix.cy);
    let raster = context.accept(place, Raster::new(raster.width(), raster.height(), raster.pitch_mm(), principal))?;
    warn_of_principal_point(record, &raster, context);
    let falloff = match &record.relative_illumination {
        Some(table) => Some(falloff(table, context)?),
        None => None,
    };
    let lens = Lens::calibrated(parameters(record, calibration, &raster, falloff));
    let lens = context.accept(place, lens)?;
    let checked = lens.check(&raster);
    let at = match (&checked, &record.relative_illumination) {
        (Err(OpticsError::FalloffEnds { .. }), Some(table)) => &table.place,
        (Err(OpticsError::CalibratedSize { .. }), _) => &sensor.place,
        _ => place,
    };
    context.accept(at, checked)?;
    Some((lens, raster))
}

fn parameters(
    record: &CalibratedLens,
    calibration: Calibration,
    raster: &Raster,
    relative_illumination: Option<Falloff>,
) -> CalibratedParameters {
    CalibratedParameters {
        calibration,
        pixel_pitch_mm: raster.pitch_mm().x,
        f_number: record.f_number.value,
        transmittance: transmittance(record.transmittance.as_ref()),
        focus_distance_m: record.focus_distance_m.as_ref().map(focus_m),
        pupil: record.pupil.as_ref().map(|pupil| match pupil.value {
            Pupil::Flat => PupilOrientation::Flat,
            Pupil::Turning => PupilOrientation::Oriented,
        }),
        relative_illumination,
    }
}

/// The table, or that of its file, with notes on the conversion.
fn falloff(table: &RelativeIllumination, context: &mut Context<'_>) -> Option<Falloff> {
    let (place, result) = match &table.source {
        IlluminationSource::Radii(radii) => {
            let points = radii.iter().zip(table.ratio.iter().flatten());
            (&table.place, Falloff::new(points.map(|(radius, ratio)| (radius.value, ratio.value)).collect()))
        }
        IlluminationSource::File(file) => {
            let key = (file.value.clone(), LensQuantity::RelativeIllumination);
            let assets = context.assets;
            let asset = assets.lens_tables.get(&key)?;
            asset.notes.iter().for_each(|note| context.note_on(file.value.display(), note));
            let by_angle = asset.numbers == LensNumbers::IlluminationByAngle;
            let by = if by_angle { FalloffArgument::Angle } else { FalloffArgument::Radius };
            (&file.place, Falloff::over(by, asset.points.clone()))
        }
    };
    context.accept(place, result)
}

/// Camera of a calibration file, with notes on the parts of the file that are ignored. A file without an image size takes that of the raster.
fn imported(file: &CalibrationFile, full: &Raster, context: &mut Context<'_>) -> Option<Calibration> {
    let assets = context.assets;
    let Some(asset) = assets.calibrations.get(&(file.file.value.clone(), file.camera_in_file())) else {
        context.error(
            ErrorCode::UnreadableFile,
            &file.file.place,
            "the calibration was not loaded",
            "give a readable file",
        );
        return None;
    };
    for note in &asset.report {
        context.note_on(file.file.value.display(), note);
    }
    if asset.states_size {
        return Some(asset.calibration.clone());
    }
    let (width, height) = (full.width(), full.height());
    let note = format!("the file states no image size; that of the sensor, {width} × {height} px, is assumed");
    context.note_on(file.file.value.display(), note);
    context.accept(&file.file.place, asset.calibration.clone().with_size([width, height]))
}

/// Refuses a calibration of another image size; the sensor's and the file's sizes are reported as stated.
fn check_size(calibration: &Calibration, full: &Raster) -> Result<(), OpticsError> {
    let [width, height] = calibration.size_px();
    let (got_width, got_height) = (full.width(), full.height());
    match [got_width, got_height] == [width, height] {
        true => Ok(()),
        false => Err(OpticsError::CalibratedSize { got_width, got_height, width, height }),
    }
}

/// Distance of a principal point from the centre of the image, as a fraction of its width or height, above which the calibration is assumed to be for another
/// image size.
const FAR_FRACTION: f64 = 0.25;

/// Warns of a principal point outside the image, or far from its centre, as with a calibration of another resolution.
fn warn_of_principal_point(record: &CalibratedLens, raster: &Raster, context: &mut Context<'_>) {
    let size = glam::DVec2::new(raster.width() as f64, raster.height() as f64);
    let principal = raster.principal_px();
    let off = ((principal - 0.5 * size) / size).abs().max_element();
    if off <= FAR_FRACTION {
        return;
    }
    let place = if off > 0.5 { "outside the image" } else { "far from the centre of the image" };
    let text = format!(
        "the principal point ({:.1}, {:.1}) px is {place} of {} × {} px; check whether the calibration is for another \
         image size",
        principal.x, principal.y, size.x, size.y
    );
    match &record.view {
        PixelDirections::Projection(_) => context.warn_on(&record.place, text),
        PixelDirections::Calibration(file) => context.warn_on(file.file.value.display(), text),
    }
}

/// Refuses a second principal point: a calibration has its own.
fn one_principal_point(record: &CalibratedLens, sensor: &Sensor, context: &mut Context<'_>) -> Option<()> {
    let Some(principal_point) = &sensor.principal_point_px else { return Some(()) };
    let by: Option<&Place> = match &record.view {
        PixelDirections::Projection(projection) => projection::stated_centre(projection),
        PixelDirections::Calibration(file) => Some(&file.place),
    };
    let Some(by) = by else { return Some(()) };
    let problem = format!("the principal point is stated here and by the lens ({by})");
    context.error(ErrorCode::Contradiction, &principal_point.place, problem, "remove one of them");
    None
}
