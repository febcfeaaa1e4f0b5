//! Converts a projection's numbers to a calibration.

use super::super::context::{Context, ErrorCode};
use super::projection_models::{Scaling, model, scale};
use etendue_core::maths::f64::tan;
use etendue_projection::{Calibration, CameraMatrix, Model, Raster};
use etendue_scene::asset::{LensNumbers, LensQuantity, UndistortedProjection};
use etendue_scene::record::lens::projection::{Centre, Matrix, Projection, Scale, Table, TableSource};
use etendue_scene::{Place, Placed};
use glam::{DVec2, DVec3};

/// Calibration of a projection for an image.
pub(super) fn calibration(
    record: &Projection,
    place: &Place,
    raster: &Raster,
    context: &mut Context<'_>,
) -> Option<Calibration> {
    let points = match record {
        Projection::Table(table) => points(table, context)?,
        _ => Vec::new(),
    };
    let model = context.accept(place, model(record, &points))?;
    let matrix = match scale(record) {
        Scaling::Matrix(matrix) => camera_matrix(matrix, &model, raster, context)?,
        Scaling::Pixels(centre) => in_units(centre, DVec2::ONE, raster),
        Scaling::Millimetres(centre) => in_units(centre, raster.pitch_mm(), raster),
    };
    context.accept(place, Calibration::new(model, matrix, [raster.width(), raster.height()]))
}

/// Place where the projection states its principal point, if it does.
pub(super) fn stated_centre(record: &Projection) -> Option<&Place> {
    let centre = match scale(record) {
        Scaling::Matrix(matrix) => &matrix.centre,
        Scaling::Pixels(centre) | Scaling::Millimetres(centre) => centre,
    };
    centre.cx_px.as_ref().or(centre.cy_px.as_ref()).map(|c| &c.place)
}

fn centre(record: &Centre, raster: &Raster) -> DVec2 {
    let default = raster.principal_px();
    let or = |v: &Option<Placed<f64>>, default: f64| v.as_ref().map_or(default, |v| v.value);
    DVec2::new(or(&record.cx_px, default.x), or(&record.cy_px, default.y))
}

/// Camera matrix of a plane in units in which a pixel has the size `pixel`.
fn in_units(record: &Centre, pixel: DVec2, raster: &Raster) -> CameraMatrix {
    let at = centre(record, raster);
    CameraMatrix { fx: 1.0 / pixel.x, fy: 1.0 / pixel.y, skew: 0.0, cx: at.x, cy: at.y }
}

fn camera_matrix(record: &Matrix, model: &Model, raster: &Raster, context: &mut Context<'_>) -> Option<CameraMatrix> {
    let at = centre(&record.centre, raster);
    let fx = match &record.scale {
        Scale::Columns(fx) => fx.value,
        Scale::Millimetres(mm) => mm.value / raster.pitch_mm().x,
        Scale::FieldOfView(angle) => focal_length_from_field(angle, model, raster, context)?,
    };
    if let (Some(fy), false) = (&record.fy_px, matches!(record.scale, Scale::Columns(_))) {
        context.error(ErrorCode::NoEffect, &fy.place, "\"fy_px\" has no effect without \"fx_px\"", "remove it");
        return None;
    }
    let fy = record.fy_px.as_ref().map_or(fx, |fy| fy.value);
    let skew = record.skew_px.as_ref().map_or(0.0, |skew| skew.value);
    Some(CameraMatrix { fx, fy, skew, cx: at.x, cy: at.y })
}

/// Maximum radius of the edge of the field, in units of the camera matrix: it excludes an angle whose image is at infinity.
const MAX_RADIUS: f64 = 1e4;

/// fx of an image with a horizontal field angle.
fn focal_length_from_field(
    angle: &Placed<f64>,
    model: &Model,
    raster: &Raster,
    context: &mut Context<'_>,
) -> Option<f64> {
    // A full turn ends behind the camera, where no direction has an image: 1e-12 of it is excluded.
    let half = 0.5 * angle.value.to_radians() * (1.0 - 1e-12);
    let (sin, cos) = etendue_core::maths::f64::sin_cos(half);
    let reach = model.project(DVec3::new(sin, 0.0, cos)).map(|point| point.x);
    let reach = reach.filter(|x| *x > 0.0 && *x < MAX_RADIUS);
    if reach.is_none() {
        let edge = 2.0 * model.edge().angle_rad.to_degrees();
        let problem = format!("the projection does not reach {}°", angle.value);
        context.error(
            ErrorCode::OutOfRange,
            &angle.place,
            problem,
            format!("give less than {edge:.3}°, near which its image is infinite"),
        );
    }
    Some(0.5 * raster.width() as f64 / reach?)
}

/// Field angle, rad, and radius, mm, without the axis; with notes on the conversion of a file.
pub(super) fn points(table: &Table, context: &mut Context<'_>) -> Option<Vec<(f64, f64)>> {
    let file = match &table.source {
        TableSource::Angles(angles) => {
            let points = angles.iter().zip(table.radius_mm.iter().flatten());
            return Some(points.map(|(angle, radius)| (angle.value.to_radians(), radius.value)).collect());
        }
        TableSource::File(file) => file,
    };
    let assets = context.assets;
    let asset = assets.lens_tables.get(&(file.value.clone(), LensQuantity::Distortion))?;
    asset.notes.iter().for_each(|note| context.note_on(file.value.display(), note));
    let LensNumbers::Distortion { reference, focal_length_mm: own } = asset.numbers else { return None };
    let stated = table.focal_length_mm.as_ref().map(|mm| mm.value);
    let Some(f) = stated.or(own) else {
        let problem = "the file does not state the focal length of its distortion";
        context.error(ErrorCode::MissingKey, &file.place, problem, "add \"focal_length_mm\"");
        return None;
    };
    let ideal = |angle: f64| match reference {
        UndistortedProjection::Tangent => f * tan(angle),
        UndistortedProjection::Angle => f * angle,
    };
    let beyond = asset.points.iter().filter(|(field, _)| *field > 0.0);
    Some(beyond.map(|(field, ratio)| (field.to_radians(), ratio * ideal(field.to_radians()))).collect())
}
