//! Point spread functions at field positions, from files: a table by distance from the axis and by wavelength.
//!
//! x and y of a file are those of its lens program, of the physical image seen against the light: y upwards. The samples' own axes have y downwards
//! ([`etendue_optics::effects::spread_table`]).

use super::context::{Context, ErrorCode};
use etendue_core::maths::f64::{sin_cos, tan};
use etendue_optics::Lens;
use etendue_optics::effects::{FieldSpread, SpreadTable, SpreadTableParameters, WavelengthTable};
use etendue_projection::Raster;
use etendue_scene::Placed;
use etendue_scene::asset::{FieldPoint, PointSpreadAsset};
use glam::{DVec2, DVec3};
use std::path::PathBuf;

/// Minimum fraction of a point's light whose loss is reported.
const MIN_LOST_FRACTION: f64 = 0.002;
/// Maximum extent of the image relative to the farthest function without a note.
const MAX_RELATIVE_EXTENT: f64 = 1.02;

/// A file with its content.
struct PointSpreadFile<'a> {
    file: &'a Placed<PathBuf>,
    asset: &'a PointSpreadAsset,
    spread: FieldSpread,
}

/// Functions of files over an image.
pub(super) fn table(
    files: &[Placed<PathBuf>],
    patches: Option<[usize; 2]>,
    lens: &Lens,
    image_raster: &Raster,
    context: &mut Context<'_>,
) -> Option<SpreadTable> {
    let listed: Vec<Option<PointSpreadFile<'_>>> =
        files.iter().map(|file| read_file(file, lens, image_raster, context)).collect();
    let listed = listed.into_iter().collect::<Option<Vec<_>>>()?;
    let wavelengths = wavelengths(&listed, context)?;
    let table = SpreadTable::new(SpreadTableParameters { wavelengths, patches }, image_raster);
    let table = context.accept(&files[0].place, table)?;
    note_extent(&table, image_raster, context);
    Some(table)
}

/// Content of a file, on the sensor, with notes on the conversion.
fn read_file<'a, 'c: 'a>(
    file: &'a Placed<PathBuf>,
    lens: &Lens,
    image_raster: &Raster,
    context: &mut Context<'c>,
) -> Option<PointSpreadFile<'a>> {
    let assets = context.assets;
    let Some(asset) = assets.point_spreads.get(&file.value) else {
        context.error(
            ErrorCode::UnreadableFile,
            &file.place,
            "the point spread was not loaded",
            "give a readable file",
        );
        return None;
    };
    asset.notes.iter().for_each(|note| context.note_on(file.value.display(), note));
    let Some(place_mm) = place_mm(asset, lens) else {
        let problem = format!("the lens forms no image at the field {} of the file", field(asset.field));
        context.error(
            ErrorCode::UnsuitableFile,
            &file.place,
            problem,
            "give files within the lens's field, or files that state their coordinates on the sensor",
        );
        return None;
    };
    let spread = FieldSpread {
        place_mm,
        pitch_um: asset.spacing_um,
        width: asset.width,
        light: asset.light.clone(),
        point: asset.point,
    };
    context.accept(&file.place, spread.check(image_raster))?;
    Some(PointSpreadFile { file, asset, spread })
}

/// Position of the point on the sensor, in the samples' axes.
fn place_mm(asset: &PointSpreadAsset, lens: &Lens) -> Option<DVec2> {
    let stated_position = |[x, y]: [f64; 2]| DVec2::new(x, -y);
    match (asset.place_mm, asset.field) {
        (Some(place), _) | (None, FieldPoint::Millimetres(place)) => Some(stated_position(place)),
        (None, FieldPoint::Degrees(degrees)) => {
            let towards = direction_from_angles(degrees)?;
            let radius_mm = lens.project(towards)?.length();
            Some(
                stated_position([towards.x, towards.y])
                    .try_normalize()
                    .map_or(DVec2::ZERO, |outwards| outwards * radius_mm),
            )
        }
    }
}

/// Direction with the field angles of x and y, which combine by their tangents; for a single one by the angle.
fn direction_from_angles(degrees: [f64; 2]) -> Option<DVec3> {
    let [x, y] = degrees.map(f64::to_radians);
    if x == 0.0 || y == 0.0 {
        let [(across, ahead), (up, above)] = [x, y].map(sin_cos);
        return Some(DVec3::new(across, up, ahead * above));
    }
    let ahead = x.abs().max(y.abs()) < core::f64::consts::FRAC_PI_2;
    ahead.then(|| DVec3::new(tan(x), tan(y), 1.0))
}

/// Functions by wavelength and by distance from the axis, if every wavelength has the same fields.
fn wavelengths(listed: &[PointSpreadFile<'_>], context: &mut Context<'_>) -> Option<Vec<WavelengthTable>> {
    let first = &listed[0];
    let is_broad = |one: &PointSpreadFile<'_>| one.asset.wavelengths_nm[0] != one.asset.wavelengths_nm[1];
    let other = |one: &&PointSpreadFile<'_>| one.asset.wavelengths_nm != first.asset.wavelengths_nm;
    if let Some(other) = listed.iter().find(other).filter(|_| listed.iter().any(is_broad)) {
        let nm = |one: &PointSpreadFile<'_>| {
            format!("{} to {} nm", one.asset.wavelengths_nm[0], one.asset.wavelengths_nm[1])
        };
        let problem = format!("{} is for {}, but {} for {}", name(other), nm(other), name(first), nm(first));
        context.error(
            ErrorCode::UnsuitableFile,
            &other.file.place,
            problem,
            "give files of one wavelength each, or polychromatic files of the same range",
        );
        return None;
    }
    let mut nm: Vec<f64> = listed.iter().map(|one| one.asset.wavelengths_nm[0]).collect();
    nm.sort_by(f64::total_cmp);
    nm.dedup();
    let broad = is_broad(first);
    let of = |nm: &f64| {
        let mut fields: Vec<&PointSpreadFile<'_>> =
            listed.iter().filter(|one| one.asset.wavelengths_nm[0] == *nm).collect();
        fields.sort_by(|a, b| a.spread.place_mm.length().total_cmp(&b.spread.place_mm.length()));
        (*nm, fields)
    };
    let grid: Vec<(f64, Vec<&PointSpreadFile<'_>>)> = nm.iter().map(of).collect();
    check_twice(&grid, context)?;
    check_complete(listed, &grid, context)?;
    let wavelength = |(nm, fields): (f64, Vec<&PointSpreadFile<'_>>)| WavelengthTable {
        nm: (!broad).then_some(nm),
        fields: fields.into_iter().map(|one| one.spread.clone()).collect(),
    };
    Some(grid.into_iter().map(wavelength).collect())
}

/// Checks that no two files have the same distance and wavelength.
fn check_twice(grid: &[(f64, Vec<&PointSpreadFile<'_>>)], context: &mut Context<'_>) -> Option<()> {
    let mut pairs = grid.iter().flat_map(|(_, fields)| fields.windows(2));
    let same_place = pairs.find(|pair| {
        let [near, distant] = [pair[0], pair[1]].map(|one| one.spread.place_mm.length());
        distant - near <= 1e-6 * distant.max(1.0)
    });
    let Some(pair) = same_place else { return Some(()) };
    let problem =
        format!("{} has the same distance from the axis and the same wavelength as {}", name(pair[1]), name(pair[0]));
    context.error(
        ErrorCode::Duplicate,
        &pair[1].file.place,
        problem,
        "remove one of them; the point spread is rotated with the position in the image",
    );
    None
}

/// Checks that every wavelength has all fields.
fn check_complete(
    listed: &[PointSpreadFile<'_>],
    grid: &[(f64, Vec<&PointSpreadFile<'_>>)],
    context: &mut Context<'_>,
) -> Option<()> {
    let has = |fields: &[&PointSpreadFile<'_>], field_point: FieldPoint| {
        fields.iter().any(|one| one.asset.field == field_point)
    };
    for one in listed {
        if let Some((nm, _)) = grid.iter().find(|(_, fields)| !has(fields, one.asset.field)) {
            let problem = format!("no file is for {nm} nm at the field {} of {}", field(one.asset.field), name(one));
            context.error(
                ErrorCode::UnsuitableFile,
                &one.file.place,
                problem,
                "give a file for every field at every wavelength",
            );
            return None;
        }
    }
    Some(())
}

fn note_extent(table: &SpreadTable, image_raster: &Raster, context: &mut Context<'_>) {
    let (corner_mm, radii) = (image_raster.max_radius_mm(), table.radii_mm());
    let last_mm = radii[radii.len() - 1];
    if corner_mm > MAX_RELATIVE_EXTENT * last_mm && last_mm > 0.0 {
        context.note(format!(
            "point spreads are given up to {last_mm:.4} mm from the axis and constant beyond; the corner of the image \
             is at {corner_mm:.4} mm"
        ));
    }
    if radii[0] > 0.0 {
        context.note(format!(
            "no point spread is given for the axis: the one at {:.4} mm is used further inside, rotated with the \
             position; give a file for the axis",
            radii[0]
        ));
    }
    if !table.keeps_shapes() {
        let [across, down] = table.patches();
        context.note(format!(
            "point spreads change too fast for {across} × {down} patches: between them, centroids are off by more than \
             1 % of the width or second moments by more than 0.5 %; increase \"patches\""
        ));
    }
    let error = table.light_error();
    if error > MIN_LOST_FRACTION {
        context.note(format!(
            "point spreads conserve the light of a point only to {:.1} %: their centroids shift over the field",
            100.0 * error
        ));
    }
}

fn name(one: &PointSpreadFile<'_>) -> String {
    one.file.value.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn field(field: FieldPoint) -> String {
    match field {
        FieldPoint::Degrees([x, y]) => format!("({x}°, {y}°)"),
        FieldPoint::Millimetres([x, y]) => format!("({x}, {y}) mm"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// tan of 20° and 40° from the tables of Abramowitz and Stegun, 4.3.
    #[test]
    fn fields_of_two_angles_go_by_their_tangents() {
        let near = |actual: Option<DVec3>, expected: DVec3| {
            assert!(actual.is_some_and(|actual| (actual - expected).length() < 1e-9), "{actual:?}");
        };
        near(direction_from_angles([20.0, 40.0]), DVec3::new(0.363_970_234_266, 0.839_099_631_177, 1.0));
        near(direction_from_angles([0.0, -30.0]), DVec3::new(0.0, -0.5, 0.866_025_403_784));
        near(direction_from_angles([120.0, 0.0]), DVec3::new(0.866_025_403_784, 0.0, -0.5));
        assert_eq!((direction_from_angles([0.0, 0.0]), direction_from_angles([91.0, 10.0])), (Some(DVec3::Z), None));
    }
}
