//! Angles of a grid as they stand in a file: how many, in order, in range.

use std::ops::RangeInclusive;

use etendue_scene::asset::PhotometryAxes;

use super::fields::Fields;
use crate::Error;

/// The greatest count of angles of one kind: 0.01° over a full turn.
pub(super) const MOST: u32 = 36_001;

/// The legal vertical angles, degrees.
pub(super) fn vertical_range(axes: PhotometryAxes) -> RangeInclusive<f64> {
    match axes {
        PhotometryAxes::A => -90.0..=90.0,
        PhotometryAxes::B => -180.0..=180.0,
        PhotometryAxes::C => 0.0..=180.0,
    }
}

/// The legal horizontal angles, degrees.
pub(super) fn horizontal_range(axes: PhotometryAxes) -> RangeInclusive<f64> {
    match axes {
        PhotometryAxes::A => -180.0..=180.0,
        PhotometryAxes::B => -90.0..=90.0,
        PhotometryAxes::C => 0.0..=360.0,
    }
}

/// The next `count` angles: rising, each once, in `range`.
pub(super) fn read(
    fields: &mut Fields<'_>,
    count: u32,
    which: &str,
    range: &RangeInclusive<f64>,
) -> Result<Vec<f64>, Error> {
    fields.list(count as usize, &format!("{which} angle"), |before, angle| {
        let (low, high) = (range.start(), range.end());
        if !range.contains(&angle) {
            return Some(format!("found the {which} angle {angle}°; expected one from {low}° to {high}°"));
        }
        let last = *before.last()?;
        let number = before.len() + 1;
        (angle <= last).then(|| {
            format!(
                "{which} angle {number} of {count} is {angle}° and follows {last}°: sort them by rising angle, each once, \
                 or correct their count"
            )
        })
    })
}

/// What a grid leaves out: a sentence, where it does not end where grids of these axes do.
pub(super) fn dark_beyond(which: &str, grid: &[f64], firsts: &[f64], lasts: &[f64]) -> Option<String> {
    let (first, last) = (*grid.first()?, *grid.last()?);
    let whole = firsts.contains(&first) && lasts.contains(&last);
    (!whole).then(|| format!("{which} angles from {first}° to {last}° were measured; beyond them the lamp is dark"))
}

/// The same of vertical angles. Type C may stop at the horizon: many lamps give light to one side alone.
pub(super) fn dark_above_or_below(axes: PhotometryAxes, vertical: &[f64]) -> Option<String> {
    match axes {
        PhotometryAxes::C => dark_beyond("vertical", vertical, &[0.0, 90.0], &[90.0, 180.0]),
        PhotometryAxes::A => dark_beyond("vertical", vertical, &[-90.0], &[90.0]),
        PhotometryAxes::B => dark_beyond("vertical", vertical, &[-90.0, -180.0], &[90.0, 180.0]),
    }
}
