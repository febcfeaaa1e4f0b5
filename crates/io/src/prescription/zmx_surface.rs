//! Lines of one surface in a Zemax file.

use super::raw_surface::{RawSurface, SurfaceForm};
use super::text::Words;
use crate::{Error, ErrorCode};

/// Reads a line of the surface with this number.
pub(super) fn property(surface: &mut RawSurface, number: usize, w: &Words<'_>) -> Result<(), Error> {
    match w.word(0) {
        "TYPE" => surface.form = form(number, w)?,
        "CURV" => surface.curvature = w.number(1)?,
        "CONI" => surface.conic = w.number(1)?,
        "PARM" => parameter(surface, number, w)?,
        "DISZ" => surface.thickness = if w.word(1) == "INFINITY" { f64::INFINITY } else { w.number(1)? },
        // A clear aperture overrides the diameter for drawing.
        "CLAP" => {
            surface.obscured_radius = w.number(1)?;
            (surface.semi_aperture, surface.is_clear_aperture) = (Some(w.number(2)?), true);
        }
        "OBSC" if w.number(1)? == 0.0 => surface.obscured_radius = w.number(2)?,
        "OBSC" => {
            return Err(w
                .error("an obscuration in the form of a ring is not supported; expected a disc, of the minimum radius 0 (OBSC 0 5)")
                .with_code(ErrorCode::UnsupportedFile));
        }
        // A floating aperture clips at the diameter.
        "FLAP" => surface.is_clear_aperture = true,
        "DIAM" if surface.semi_aperture.is_none() => surface.semi_aperture = Some(w.number(1)?).filter(|d| *d > 0.0),
        "STOP" => surface.stop = true,
        "OBDC" if w.numbers(1)?.iter().all(|shift| *shift == 0.0) => {}
        aperture @ ("SQAP" | "ELAP" | "SQOB" | "ELOB" | "UDAD" | "OBDC") => {
            return Err(w
                .error(format!("apertures of type {aperture} are not supported; only round, centred apertures are"))
                .with_code(ErrorCode::UnsupportedFile));
        }
        _ => {}
    }
    Ok(())
}

fn form(number: usize, w: &Words<'_>) -> Result<SurfaceForm, Error> {
    match w.word(1) {
        "STANDARD" => Ok(SurfaceForm::Standard),
        "EVENASPH" => Ok(SurfaceForm::Even),
        "ODDASPHE" => Ok(SurfaceForm::Odd),
        "COORDBRK" => Ok(SurfaceForm::CoordinateBreak),
        "PARAXIAL" => Ok(SurfaceForm::ThinLens(f64::INFINITY)),
        kind => Err(w
            .error(format!(
                "surface {number} is of type {kind}, which is not supported; only STANDARD, EVENASPH, ODDASPHE without odd terms, PARAXIAL and \
                 COORDBRK of zeros are"
            ))
            .with_code(ErrorCode::UnsupportedFile)),
    }
}

/// Number of parameters of an asphere that are coefficients.
const TERMS: f64 = 8.0;
/// Number of parameters of a coordinate break that move or tilt; the sixth is their order.
const SHIFTS_AND_TILTS: f64 = 5.0;

fn parameter(surface: &mut RawSurface, number: usize, w: &Words<'_>) -> Result<(), Error> {
    let (place, value) = (w.number(1)?, w.number(2)?);
    let refused = |what: String| Err(w.error(what).with_code(ErrorCode::UnsupportedFile));
    let is_term = (1.0..=TERMS).contains(&place) && place.fract() == 0.0;
    match surface.form {
        // A STANDARD surface has no parameters.
        SurfaceForm::Standard => {}
        SurfaceForm::Even if is_term => surface.set_coefficient(place as usize - 1, value),
        SurfaceForm::Odd if is_term && place % 2.0 == 0.0 => surface.set_coefficient(place as usize / 2 - 1, value),
        SurfaceForm::Odd if is_term && value != 0.0 => {
            return refused(format!(
                "surface {number} of type ODDASPHE has {value} as its coefficient of r^{place}; only even powers are supported"
            ));
        }
        SurfaceForm::Even | SurfaceForm::Odd if value != 0.0 && !is_term => {
            return Err(w.error(format!("PARM {place}; expected 1 to 8, the coefficients")));
        }
        SurfaceForm::CoordinateBreak if value != 0.0 && (1.0..=SHIFTS_AND_TILTS).contains(&place) => {
            return refused(format!(
                "surface {number} of type COORDBRK shifts or tilts by {value} (PARM {place}); only centred surfaces are supported"
            ));
        }
        SurfaceForm::ThinLens(_) if place == 1.0 && value != 0.0 => surface.form = SurfaceForm::ThinLens(value),
        SurfaceForm::Even | SurfaceForm::Odd | SurfaceForm::CoordinateBreak | SurfaceForm::ThinLens(_) => {}
    }
    Ok(())
}
