//! Symmetries written out.

use std::path::Path;

use crate::{Error, ErrorCode};

/// A plane: its horizontal angle, degrees, and its intensities.
pub(super) type Plane = (f64, Vec<f64>);

/// How a lamp is told by a part of its planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symmetry {
    /// All planes are there.
    None,
    /// One plane stands for all.
    Round,
    /// Angle H stands for 360° − H: planes from 0° to 180°.
    AboutC0,
    /// Angle H stands for 180° − H: planes from 90° to 270°, or from 270° over 0° to 90°.
    AboutC90,
    /// Both: planes from 0° to 90°.
    Quadrants,
    /// Angle H stands for −H: planes from 0° on (types A and B).
    LeftRight,
}

/// Splits intensities into planes.
pub(super) fn planes(angles: &[f64], intensities: &[f64]) -> Vec<Plane> {
    let rows = intensities.len() / angles.len();
    angles.iter().copied().zip(intensities.chunks_exact(rows).map(<[f64]>::to_vec)).collect()
}

/// All planes of type C, 0° and 360° among them, by rising angle.
pub(super) fn full_turn(file: &Path, planes: Vec<Plane>, symmetry: Symmetry) -> Result<Vec<Plane>, Error> {
    if symmetry == Symmetry::Round {
        return planes
            .into_iter()
            .next()
            .map(|(_, plane)| vec![(0.0, plane.clone()), (360.0, plane)])
            .ok_or_else(|| Error::coded(ErrorCode::Empty, file, "holds no plane; expected one at least"));
    }
    let mut all = planes;
    if matches!(symmetry, Symmetry::AboutC90 | Symmetry::Quadrants) {
        mirror(&mut all, |angle| (540.0 - angle) % 360.0);
    }
    if matches!(symmetry, Symmetry::AboutC0 | Symmetry::Quadrants) {
        mirror(&mut all, |angle| 360.0 - angle);
    }
    sort(&mut all);
    close(&mut all);
    check_gaps(file, &all)?;
    Ok(all)
}

/// Planes of types A and B by rising angle.
pub(super) fn fan(planes: Vec<Plane>, symmetry: Symmetry) -> Vec<Plane> {
    let mut all = planes;
    if symmetry == Symmetry::LeftRight {
        mirror(&mut all, |angle| -angle);
    }
    sort(&mut all);
    all
}

fn mirror(planes: &mut Vec<Plane>, image: impl Fn(f64) -> f64) {
    let images: Vec<Plane> = planes.iter().map(|(angle, plane)| (image(*angle), plane.clone())).collect();
    planes.extend(images);
}

/// By rising angle, each once. −0° is 0°.
fn sort(planes: &mut Vec<Plane>) {
    planes.iter_mut().for_each(|(angle, _)| *angle += 0.0);
    planes.sort_by(|a, b| a.0.total_cmp(&b.0));
    planes.dedup_by(|a, b| a.0 == b.0);
}

/// Adds 0° and 360°: the same plane, or between the last and the first where neither is there.
fn close(planes: &mut Vec<Plane>) {
    let (Some(first), Some(last)) = (planes.first().cloned(), planes.last().cloned()) else { return };
    match (first.0 == 0.0, last.0 == 360.0) {
        (true, true) => {}
        (true, false) => planes.push((360.0, first.1)),
        (false, true) => planes.insert(0, (0.0, last.1)),
        (false, false) => {
            let share = (360.0 - last.0) / (first.0 + 360.0 - last.0);
            let seam: Vec<f64> = last.1.iter().zip(&first.1).map(|(a, b)| (1.0 - share) * a + share * b).collect();
            planes.insert(0, (0.0, seam.clone()));
            planes.push((360.0, seam));
        }
    }
}

/// Refuses a turn with a gap of more than half of it: what lies between was not measured.
fn check_gaps(file: &Path, planes: &[Plane]) -> Result<(), Error> {
    let gap = planes.windows(2).map(|pair| (pair[0].0, pair[1].0)).find(|(a, b)| b - a > 180.0);
    gap.map_or(Ok(()), |(a, b)| {
        Err(Error::new(
            file,
            format!("no plane was measured between {a}° and {b}°; expected planes all around, or a symmetry"),
        ))
    })
}
