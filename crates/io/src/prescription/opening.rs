//! How far a lens opens, as both kinds of file state it, checked where it is stated.

use etendue_scene::asset::LensOpening;

use super::text::Words;
use crate::Error;

/// An opening, and the line that states it.
#[derive(Clone, Copy)]
pub(super) struct Opening {
    pub(super) stated: LensOpening,
    pub(super) line: usize,
}

/// No image in air is brighter than that of f/0.5: the numerical aperture is 1 there.
const FASTEST: f64 = 0.5;

impl Opening {
    /// Diameter of the entrance pupil: EPD, ENPD.
    pub(super) fn pupil(w: &Words<'_>) -> Result<Self, Error> {
        let diameter_mm = w.number(1)?;
        let known = diameter_mm > 0.0;
        known.then(|| Self::of(LensOpening::EntrancePupil { diameter_mm }, w)).ok_or_else(|| wrong(w, "above 0"))
    }

    /// f-number: FNO, FNUM.
    pub(super) fn f_number(w: &Words<'_>) -> Result<Self, Error> {
        let f_number = w.number(1)?;
        let known = f_number > FASTEST;
        known.then(|| Self::of(LensOpening::FNumber { f_number }, w)).ok_or_else(|| wrong(w, "above 0.5"))
    }

    /// Sine of the axial point's cone behind the lens, in air: NA.
    pub(super) fn image_cone(w: &Words<'_>) -> Result<Self, Error> {
        let sine = sine(w)?;
        Ok(Self::of(LensOpening::ImageCone { sine }, w))
    }

    /// Sine of the axial point's cone in front of the lens, in air: NAO, OBNA.
    pub(super) fn object_cone(w: &Words<'_>) -> Result<Self, Error> {
        let sine = sine(w)?;
        Ok(Self::of(LensOpening::ObjectCone { sine }, w))
    }

    /// The same by its half angle, degrees: OBNA with 1.
    pub(super) fn object_angle(w: &Words<'_>) -> Result<Self, Error> {
        let degrees = w.number(1)?;
        if degrees <= 0.0 || degrees >= 90.0 {
            return Err(wrong(w, "of degrees above 0 and below 90"));
        }
        let sine = etendue_core::maths::f64::sin_cos(degrees.to_radians()).0;
        Ok(Self::of(LensOpening::ObjectCone { sine }, w))
    }

    fn of(stated: LensOpening, w: &Words<'_>) -> Self {
        Self { stated, line: w.line }
    }

    /// An f-number as CODE V means it: that of the image, wherever the object stands.
    pub(super) fn of_image(self) -> Self {
        match self.stated {
            LensOpening::FNumber { f_number } => {
                Self { stated: LensOpening::ImageCone { sine: 0.5 / f_number }, ..self }
            }
            _ => self,
        }
    }
}

fn sine(w: &Words<'_>) -> Result<f64, Error> {
    let sine = w.number(1)?;
    if sine > 0.0 && sine < 1.0 { Ok(sine) } else { Err(wrong(w, "above 0 and below 1, the sine of an angle in air")) }
}

fn wrong(w: &Words<'_>, expected: &str) -> Error {
    w.fault(format!("{} is {}; expected a number {expected}", w.word(0), w.word(1)))
}
