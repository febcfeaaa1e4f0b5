//! Zemax's "Relative Illumination".

use etendue_scene::asset::{LensNumbers, LensTableAsset};

use super::listing::{FieldUnit, Listing, ListingTable, wavelength_nm};
use crate::Error;

pub(super) fn read(listing: &Listing<'_>) -> Result<LensTableAsset, Error> {
    if !["relative illumination", "rel. ill"].iter().any(|words| listing.header_contains(words)) {
        return Err(listing.error(0, "not an export of relative illumination: its header does not mention it"));
    }
    let [table] = &listing.tables[..] else {
        let second = listing.tables[1].rows[0].line;
        return Err(
            listing.error(second, "contains a second table; export one wavelength and one direction from the axis")
        );
    };
    let numbers = match listing.unit_of(table)? {
        FieldUnit::Degrees => LensNumbers::IlluminationByAngle,
        FieldUnit::Millimetres => LensNumbers::IlluminationByRadius,
    };
    let mut points = points(listing, table)?;
    let on_axis = points[0].1;
    points.iter_mut().for_each(|point| point.1 /= on_axis);
    let wavelength_nm = wavelength_nm(&listing.head);
    let mut notes = vec![match wavelength_nm {
        Some(nm) => format!("relative illumination computed for {nm} nm, used for all wavelengths"),
        None => "relative illumination used for all wavelengths".to_owned(),
    }];
    if on_axis != 1.0 {
        notes.push(format!("normalised by its value on the axis, {on_axis}"));
    }
    if table.rows[0].numbers.len() > 2 {
        notes.push("the effective f-numbers are not used".to_owned());
    }
    Ok(LensTableAsset { numbers, points, notes, hash: [0; 32] })
}

/// Absolute field, and ratio.
fn points(listing: &Listing<'_>, table: &ListingTable<'_>) -> Result<Vec<(f64, f64)>, Error> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for (field, row) in listing.rows_from_axis(table)? {
        let ratio = row.numbers[1];
        let wrong = match ratio {
            _ if ratio < 0.0 => Some(format!("the relative illumination is {ratio}; expected 0 or more")),
            _ if ratio == 0.0 && points.is_empty() => Some(
                "the relative illumination on the axis is 0; expected more, as the other values are normalised by it"
                    .to_owned(),
            ),
            _ => None,
        };
        if let Some(wrong) = wrong {
            return Err(listing.error(row.line, wrong));
        }
        points.push((field, ratio));
    }
    Ok(points)
}
