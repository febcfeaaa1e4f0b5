//! Expansion of symmetries, and check of a lamp's flux.
//!
//! The flux of a lamp is compared with the flux stated in its file.
//!
//! ∫ I dΩ over the grid is exact for the rendered intensities. An IES file rates the lamps, not the luminaire, so that less light is the luminaire's light
//! output ratio; EULUMDAT states that ratio. A difference beyond 2 % is noted in the report. A flux of more than 3 times the stated one, or for EULUMDAT less
//! than a third, means a wrong unit and is refused.

use std::path::Path;

use etendue_scene::asset::PhotometryAsset;

use crate::{Error, ErrorCode};

/// Plane: horizontal angle, degrees, and intensities.
pub(super) type Plane = (f64, Vec<f64>);

/// Symmetry by which a part of the planes describes a lamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symmetry {
    /// None: all planes are present.
    None,
    /// Rotational: one plane describes all.
    Round,
    /// Angle H equals 360° − H: planes from 0° to 180°.
    AboutC0,
    /// Angle H equals 180° − H: planes from 90° to 270°, or from 270° over 0° to 90°.
    AboutC90,
    /// Both: planes from 0° to 90°.
    Quadrants,
    /// Angle H equals −H: planes from 0° on (types A and B).
    LeftRight,
}

/// Splits intensities into planes.
pub(super) fn planes(angles: &[f64], intensities: &[f64]) -> Vec<Plane> {
    let rows = intensities.len() / angles.len();
    angles.iter().copied().zip(intensities.chunks_exact(rows).map(<[f64]>::to_vec)).collect()
}

/// All planes of type C, 0° and 360° included, by increasing angle.
pub(super) fn full_turn(file: &Path, planes: Vec<Plane>, symmetry: Symmetry) -> Result<Vec<Plane>, Error> {
    if symmetry == Symmetry::Round {
        return planes
            .into_iter()
            .next()
            .map(|(_, plane)| vec![(0.0, plane.clone()), (360.0, plane)])
            .ok_or_else(|| Error::coded(ErrorCode::Empty, file, "contains no plane; expected at least one"));
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

/// Planes of types A and B by increasing angle.
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

/// Sorts by increasing angle, each once. −0° is 0°.
fn sort(planes: &mut Vec<Plane>) {
    planes.iter_mut().for_each(|(angle, _)| *angle += 0.0);
    planes.sort_by(|a, b| a.0.total_cmp(&b.0));
    planes.dedup_by(|a, b| a.0 == b.0);
}

/// Adds 0° and 360°: the same plane, or interpolated between the last and the first if neither is present.
fn close(planes: &mut Vec<Plane>) {
    let (Some(first), Some(last)) = (planes.first().cloned(), planes.last().cloned()) else { return };
    match (first.0 == 0.0, last.0 == 360.0) {
        (true, true) => {}
        (true, false) => planes.push((360.0, first.1)),
        (false, true) => planes.insert(0, (0.0, last.1)),
        (false, false) => {
            let fraction = (360.0 - last.0) / (first.0 + 360.0 - last.0);
            let seam: Vec<f64> =
                last.1.iter().zip(&first.1).map(|(a, b)| (1.0 - fraction) * a + fraction * b).collect();
            planes.insert(0, (0.0, seam.clone()));
            planes.push((360.0, seam));
        }
    }
}

/// Refuses a turn with a gap of more than half of it: that part was not measured.
fn check_gaps(file: &Path, planes: &[Plane]) -> Result<(), Error> {
    let gap = planes.windows(2).map(|pair| (pair[0].0, pair[1].0)).find(|(a, b)| b - a > 180.0);
    gap.map_or(Ok(()), |(a, b)| {
        Err(Error::new(
            file,
            format!("no plane was measured between {a}° and {b}°; expected planes over the full turn, or a symmetry"),
        ))
    })
}

/// Relative difference beyond which a note is written: numbers in files have three or four digits, grids have steps of degrees.
const NOTE_THRESHOLD: f64 = 0.02;

/// Maximum ratio of computed to stated flux, or its inverse.
const MAX_FLUX_RATIO: f64 = 3.0;

/// Checks the flux, and reports a difference.
pub(super) fn check(file: &Path, asset: &mut PhotometryAsset) -> Result<(), Error> {
    let flux = asset.flux_lm();
    if flux.is_nan() || flux <= 0.0 {
        return Err(Error::new(file, "all intensities are 0; expected an intensity above 0"));
    }
    let Some(stated) = asset.stated_flux_lm() else { return Ok(()) };
    let ratio = flux / stated;
    if ratio > MAX_FLUX_RATIO || (asset.output_ratio.is_some() && ratio < 1.0 / MAX_FLUX_RATIO) {
        return Err(Error::new(file, implausible_flux(asset, flux, stated)));
    }
    if (ratio - 1.0).abs() > NOTE_THRESHOLD {
        asset.report.push(note(asset, flux, stated));
    }
    Ok(())
}

fn implausible_flux(asset: &PhotometryAsset, flux: f64, stated: f64) -> String {
    let (source, remedy) = match asset.output_ratio {
        Some(fraction) => (
            format!("lumens of the lamps × light output ratio ({fraction})"),
            "times more or less: correct the lumens, the conversion factor or the light output ratio (in per cent)",
        ),
        None => (
            "lumens of the lamps".to_owned(),
            "times more: correct the lumens or the multiplier; lumens of -1 denote absolute photometry of the luminaire",
        ),
    };
    format!(
        "the flux from the intensities is {flux:.4} lm, that from the {source} {stated:.4} lm; expected at most {MAX_FLUX_RATIO} {remedy}"
    )
}

fn note(asset: &PhotometryAsset, flux: f64, stated: f64) -> String {
    let ratio = flux / stated;
    let reason = match (asset.output_ratio, ratio < 1.0) {
        (Some(_), _) => {
            "the lumens of the lamps × the light output ratio: one of them is wrong, or directions are missing"
        }
        (None, true) => "the lumens of the lamps: the luminaire absorbs the rest, or directions are missing",
        (None, false) => {
            "the lumens of the lamps, but a luminaire cannot emit more than its lamps: check lumens and multiplier"
        }
    };
    format!(
        "the flux from the intensities is {flux:.1} lm, {ratio:.3} times the {stated:.1} lm from {reason}; the intensities are used"
    )
}
