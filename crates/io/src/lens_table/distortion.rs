//! Zemax's "Field Curvature/Distortion".
//!
//! Distortion is (real height − reference height)/reference height; the reference is f tan θ, or f θ if the header mentions F-Theta. f is stated above the
//! table or in the header ("Distortion focal length"), or follows from the reference heights. Of several wavelengths the table nearest to 550 nm is read.

use etendue_core::maths::f64::tan;
use etendue_scene::asset::{LensNumbers, LensTableAsset, UndistortedProjection};

use super::listing::{FieldUnit, Listing, ListingTable, wavelength_nm};
use crate::Error;

/// Wavelength of the selected table, near the peak sensitivity of the eye and of most sensors.
const GREEN_NM: f64 = 550.0;
/// Columns of a complete row: field, two focus shifts, real and reference height, distortion.
const ROW_COLUMNS: usize = 6;
/// Largest field angle at which f tan θ is treated as finite.
const MAX_TANGENT_DEG: f64 = 89.0;

pub(super) fn read(listing: &Listing<'_>) -> Result<LensTableAsset, Error> {
    if !listing.header_contains("distortion") {
        return Err(listing.error(0, "not a distortion export: its header does not mention distortion"));
    }
    if listing.unit_of(&listing.tables[0])? != FieldUnit::Degrees {
        let problem = "the fields are not angles; export with fields in degrees";
        return Err(listing.error(listing.tables[0].rows[0].line, problem));
    }
    let undistorted = if ["f-theta", "f*theta", "f theta"].iter().any(|words| listing.header_contains(words)) {
        UndistortedProjection::Angle
    } else {
        UndistortedProjection::Tangent
    };
    let distance =
        |table: &ListingTable<'_>| wavelength_nm(&table.above).map_or(f64::INFINITY, |nm| (nm - GREEN_NM).abs());
    let table = listing.tables.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let table = table.expect("a listing has a table");
    let points = points(listing, table, undistorted)?;
    let focal_length_mm =
        listing.stated(table, "focal length").or_else(|| focal_length_from_heights(table, undistorted));
    let mut notes = vec![match wavelength_nm(&table.above).or_else(|| wavelength_nm(&listing.head)) {
        Some(nm) => format!("distortion computed for {nm} nm, used for all wavelengths"),
        None => "distortion used for all wavelengths".to_owned(),
    }];
    if listing.tables.len() > 1 {
        notes.push(format!("the tables of {} other wavelengths are not used", listing.tables.len() - 1));
    }
    if table.rows[0].numbers.len() >= ROW_COLUMNS {
        notes.push("the field curvature is not used".to_owned());
    }
    let numbers = LensNumbers::Distortion { reference: undistorted, focal_length_mm };
    Ok(LensTableAsset { numbers, points, notes, hash: [0; 32] })
}

/// Absolute field, degrees, and real over reference height; first the axis, without distortion.
fn points(
    listing: &Listing<'_>,
    table: &ListingTable<'_>,
    kind: UndistortedProjection,
) -> Result<Vec<(f64, f64)>, Error> {
    const PERCENT: f64 = 0.01;
    let mut points: Vec<(f64, f64)> = Vec::new();
    let widest = if kind == UndistortedProjection::Tangent { MAX_TANGENT_DEG } else { 180.0 };
    for (field, row) in listing.rows_from_axis(table)? {
        let percent = row.numbers[row.numbers.len() - 1];
        let wrong = match percent {
            _ if field > widest => Some(format!("the field angle {field}° exceeds {widest}°")),
            _ if percent <= -100.0 => Some(format!("the distortion is {percent} %; expected more than −100 %")),
            _ => None,
        };
        if let Some(wrong) = wrong {
            return Err(listing.error(row.line, wrong));
        }
        points.push((field, 1.0 + PERCENT * percent));
    }
    if points.len() < 3 {
        return Err(listing.error(table.rows[0].line, "has fewer than two fields off the axis; expected at least two"));
    }
    Ok(points)
}

/// Focal length from the last reference height.
fn focal_length_from_heights(table: &ListingTable<'_>, kind: UndistortedProjection) -> Option<f64> {
    let numbers = &table.rows.last()?.numbers;
    let height = *numbers.get(ROW_COLUMNS - 2).filter(|_| numbers.len() >= ROW_COLUMNS)?;
    let angle = numbers[0].to_radians();
    let f = height / if kind == UndistortedProjection::Tangent { tan(angle) } else { angle };
    Some(f.abs()).filter(|f| f.is_finite() && *f > 0.0)
}
