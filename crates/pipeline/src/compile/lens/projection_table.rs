//! The points of a projection by a table.

use super::super::context::Context;
use etendue_core::maths::f64::tan;
use etendue_scene::asset::{LensNumbers, LensQuantity, Undistorted};
use etendue_scene::record::lens::projection::{Table, TableSource};

/// Field angle, rad, and radius, mm, without the axis; of a file with what was made of it remarked.
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
    asset.notes.iter().for_each(|note| context.remark_on(file.value.display(), note));
    let LensNumbers::Distortion { beside, focal_length_mm: own } = asset.numbers else { return None };
    let stated = table.focal_length_mm.as_ref().map(|mm| mm.value);
    let Some(f) = stated.or(own) else {
        let problem = "does not say for which focal length its distortion is stated";
        context.fault(&file.place, problem, "add \"focal_length_mm\"");
        return None;
    };
    let ideal = |angle: f64| match beside {
        Undistorted::Tangent => f * tan(angle),
        Undistorted::Angle => f * angle,
    };
    let beyond = asset.points.iter().filter(|(field, _)| *field > 0.0);
    Some(beyond.map(|(field, ratio)| (field.to_radians(), ratio * ideal(field.to_radians()))).collect())
}
