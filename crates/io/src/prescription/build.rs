//! Common result of both file kinds: aperture and surfaces in the file's unit, converted to a prescription in mm.

use std::path::Path;

use etendue_core::wavelength::{MAX_NM, MIN_NM};
use etendue_scene::asset::{ASPHERE_TERMS, GlassAsset, LensFields, LensOpening, PrescriptionAsset, SurfaceAsset};

use super::raw_surface::{RawSurface, SurfaceForm};
use super::text::Words;
use super::unfold::{unfold, widen_obscuring_planes};
use crate::Error;

/// Aperture, and the line that states it.
#[derive(Clone, Copy)]
pub(super) struct StatedOpening {
    pub(super) stated: LensOpening,
    pub(super) line: usize,
}

/// No image in air is brighter than at f/0.5: the numerical aperture is 1 there.
const MIN_F_NUMBER: f64 = 0.5;

impl StatedOpening {
    /// Diameter of the entrance pupil: EPD, ENPD.
    pub(super) fn pupil(w: &Words<'_>) -> Result<Self, Error> {
        let diameter_mm = w.number(1)?;
        let known = diameter_mm > 0.0;
        known.then(|| Self::new(LensOpening::EntrancePupil { diameter_mm }, w)).ok_or_else(|| wrong(w, "above 0"))
    }

    /// f-number: FNO, FNUM.
    pub(super) fn f_number(w: &Words<'_>) -> Result<Self, Error> {
        let f_number = w.number(1)?;
        let known = f_number > MIN_F_NUMBER;
        known.then(|| Self::new(LensOpening::FNumber { f_number }, w)).ok_or_else(|| wrong(w, "above 0.5"))
    }

    /// Sine of the axial point's cone behind the lens, in air: NA.
    pub(super) fn image_cone(w: &Words<'_>) -> Result<Self, Error> {
        let sine = sine(w)?;
        Ok(Self::new(LensOpening::ImageCone { sine }, w))
    }

    /// Sine of the axial point's cone in front of the lens, in air: NAO, OBNA.
    pub(super) fn object_cone(w: &Words<'_>) -> Result<Self, Error> {
        let sine = sine(w)?;
        Ok(Self::new(LensOpening::ObjectCone { sine }, w))
    }

    /// The same by its half angle, degrees: OBNA with 1.
    pub(super) fn object_angle(w: &Words<'_>) -> Result<Self, Error> {
        let degrees = w.number(1)?;
        if degrees <= 0.0 || degrees >= 90.0 {
            return Err(wrong(w, "of degrees above 0 and below 90"));
        }
        let sine = etendue_core::maths::f64::sin_cos(degrees.to_radians()).0;
        Ok(Self::new(LensOpening::ObjectCone { sine }, w))
    }

    fn new(stated: LensOpening, w: &Words<'_>) -> Self {
        Self { stated, line: w.line }
    }

    /// f-number as CODE V defines it: that of the image, wherever the object is.
    pub(super) fn in_image_space(self) -> Self {
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
    w.error(format!("{} is {}; expected a number {expected}", w.word(0), w.word(1)))
}

/// Lens as read: object and image are surfaces too, lengths in the file's unit.
#[derive(Default)]
pub(super) struct RawLens {
    pub(super) title: String,
    /// Unit of the file, mm.
    pub(super) unit_mm: Option<f64>,
    pub(super) surfaces: Vec<RawSurface>,
    pub(super) opening: Option<StatedOpening>,
    pub(super) fields: Option<LensFields>,
    /// By field: fraction of the pupil vignetted at its upper and its lower end.
    pub(super) vignetting: [Vec<f64>; 2],
    pub(super) wavelengths_nm: Vec<f64>,
    pub(super) primary: Option<PrimaryWavelength>,
    /// True if the program computes the image position: the last distance is then not stated.
    pub(super) image_is_found: bool,
    pub(super) notes: Vec<String>,
}

/// Wavelength of a file's first-order data.
#[derive(Clone, Copy)]
pub(super) struct PrimaryWavelength {
    /// Index among the file's wavelengths, from 1.
    number: f64,
    line: usize,
}

impl PrimaryWavelength {
    /// PWAV, REF.
    pub(super) fn read(w: &Words<'_>) -> Result<Self, Error> {
        Ok(Self { number: w.number(1)?, line: w.line })
    }

    /// Wavelength, nm; `None` if the file states no wavelengths.
    fn nm(self, file: &Path, wavelengths_nm: &[f64]) -> Result<Option<f64>, Error> {
        let count = wavelengths_nm.len();
        let place = self.number as usize;
        if count == 0 {
            return Ok(None);
        }
        let selected = wavelengths_nm.get(place.wrapping_sub(1)).filter(|_| place as f64 == self.number);
        let nm = *selected.ok_or_else(|| {
            let what = format!(
                "the primary wavelength has number {}; expected 1 to {count}, the file's wavelengths",
                self.number
            );
            Error::at(file, self.line, what)
        })?;
        if (MIN_NM..=MAX_NM).contains(&nm) {
            return Ok(Some(nm));
        }
        let what = format!("the primary wavelength is {nm} nm; expected {MIN_NM} to {MAX_NM} nm");
        Err(Error::at(file, self.line, format!("{what}: select another wavelength of the file")))
    }
}

impl RawLens {
    /// Scales every length.
    pub(super) fn scale(&mut self, factor: f64) {
        for surface in &mut self.surfaces {
            surface.curvature /= factor;
            surface.asphere = surface.asphere.take().map(|terms| Box::new(scaled_asphere(*terms, factor)));
            surface.semi_aperture = surface.semi_aperture.map(|semi| semi * factor);
            surface.obscured_radius *= factor;
            surface.thickness *= factor;
            if let SurfaceForm::ThinLens(focal_length) = &mut surface.form {
                *focal_length *= factor;
            }
        }
        self.opening = self.opening.map(|opening| StatedOpening { stated: scaled(opening.stated, factor), ..opening });
        self.fields = self.fields.take().map(|fields| scaled_fields(fields, factor));
    }

    /// Converts at least an object, one surface and an image to a prescription.
    pub(super) fn finish(mut self, file: &Path) -> Result<PrescriptionAsset, Error> {
        let unit = self.unit_mm.unwrap_or(1.0);
        unfold(file, &mut self.surfaces)?;
        let [object, surfaces @ .., image] = &self.surfaces[..] else {
            return Err(Error::new(
                file,
                "the file has fewer than three surfaces; expected object, surfaces and image",
            ));
        };
        if image.curvature != 0.0 {
            let note =
                format!("line {}: the image surface is curved; the sensor is a plane through its vertex", image.line);
            self.notes.push(note);
        }
        let (before_mm, mut surfaces) = effective_surfaces(surfaces, unit);
        widen_obscuring_planes(&mut surfaces, self.opening.map(|opening| scaled(opening.stated, unit)));
        let object_distance_mm = object.thickness * unit + before_mm;
        self.opening.map_or(Ok(()), |opening| near_enough(file, opening, object_distance_mm))?;
        let primary_nm = match (self.primary, &self.wavelengths_nm[..]) {
            (Some(primary), list) => primary.nm(file, list)?,
            (None, [only]) if (MIN_NM..=MAX_NM).contains(only) => Some(*only),
            (None, _) => None,
        };
        let shift_mm = image.thickness * unit;
        self.notes.extend(without_image_mask(&mut surfaces));
        let stated_mm = surfaces.last().map_or(0.0, |surface| surface.thickness_mm + shift_mm);
        let is_focused = self.image_is_found || !stated_mm.is_finite() || stated_mm == 0.0;
        match surfaces.iter().filter(|s| s.stop).count() {
            _ if surfaces.is_empty() => Err(Error::new(file, "no surface refracts; expected a lens")),
            1 => Ok(PrescriptionAsset {
                title: self.title,
                surfaces,
                object_distance_mm,
                back_focus_mm: if is_focused { 0.0 } else { stated_mm },
                defocus_mm: if is_focused && shift_mm.is_finite() { shift_mm } else { 0.0 },
                opening: self.opening.map(|opening| scaled(opening.stated, unit)),
                opening_line: self.opening.map_or(0, |opening| opening.line),
                fields: self.fields.map(|fields| scaled_fields(fields, unit)),
                vignetting: self.vignetting,
                primary_nm,
                wavelengths_nm: self.wavelengths_nm,
                notes: self.notes,
                hash: [0; 32],
            }),
            stop_count => {
                Err(Error::new(file, format!("{stop_count} surfaces are aperture stops; expected one (STOP or STO)")))
            }
        }
    }
}

/// Refuses a cone of light from an object at infinity.
fn near_enough(file: &Path, opening: StatedOpening, object_distance_mm: f64) -> Result<(), Error> {
    let near = object_distance_mm.is_finite() && object_distance_mm > 0.0;
    match opening.stated {
        LensOpening::ObjectCone { .. } if !near => Err(Error::at(
            file,
            opening.line,
            "the aperture is a cone of light from the object (NAO, OBNA), but no object is at a finite distance in front of the lens; give the \
             diameter of the entrance pupil (EPD, ENPD)",
        )),
        _ => Ok(()),
    }
}

/// Removes a mask in the image plane, with a note: no plane may coincide with the sensor.
fn without_image_mask(surfaces: &mut Vec<SurfaceAsset>) -> Option<String> {
    let [.., before, last] = &surfaces[..] else { return None };
    let bends = last.glass != before.glass || last.mirror || last.thin_lens_mm.is_some();
    let mask = !bends && !last.stop && last.thickness_mm == 0.0;
    let last = if mask { surfaces.pop()? } else { return None };
    Some(format!("line {}: an aperture in the image plane is not modelled; it would limit the field", last.line))
}

/// Surfaces in mm without those that have no effect, and the distance from the first of all to the first of them. A non-refracting surface stays if it is the
/// stop or has a clear aperture or an obscuration: a baffle, a field stop.
fn effective_surfaces(surfaces: &[RawSurface], unit: f64) -> (f64, Vec<SurfaceAsset>) {
    let (mut before_mm, mut list) = (0.0, Vec::<SurfaceAsset>::new());
    let mut before = GlassAsset::Air;
    for surface in surfaces {
        let idle = surface.is_idle(&before);
        before = surface.glass.clone();
        match list.last_mut() {
            Some(last) if idle => last.thickness_mm += surface.thickness * unit,
            None if idle => before_mm += surface.thickness * unit,
            _ => list.push(in_mm(surface, unit)),
        }
    }
    (before_mm, list)
}

fn in_mm(s: &RawSurface, unit: f64) -> SurfaceAsset {
    SurfaceAsset {
        mirror: s.mirror,
        thin_lens_mm: match s.form {
            SurfaceForm::ThinLens(focal_length) => Some(focal_length * unit),
            SurfaceForm::Standard | SurfaceForm::Even | SurfaceForm::Odd | SurfaceForm::CoordinateBreak => None,
        },
        obscured_radius_mm: s.obscured_radius * unit,
        radius_mm: if s.curvature == 0.0 { f64::INFINITY } else { unit / s.curvature },
        conic: s.conic,
        asphere: s.asphere.as_deref().map_or([0.0; ASPHERE_TERMS], |terms| scaled_asphere(*terms, unit)),
        semi_aperture_mm: s.semi_aperture.map(|a| a * unit),
        clips_light: s.is_clear_aperture && s.semi_aperture.is_some(),
        thickness_mm: s.thickness * unit,
        glass: s.glass.clone(),
        stop: s.stop,
        line: s.line,
    }
}

/// Coefficients of r², r⁴ … of a surface enlarged by a factor: αᵢ has the unit of length to the power 1 − 2i.
fn scaled_asphere(terms: [f64; ASPHERE_TERMS], factor: f64) -> [f64; ASPHERE_TERMS] {
    let mut power = 1.0;
    terms.map(|a| {
        power *= factor * factor;
        a * factor / power
    })
}

fn scaled(opening: LensOpening, unit: f64) -> LensOpening {
    match opening {
        LensOpening::EntrancePupil { diameter_mm } => LensOpening::EntrancePupil { diameter_mm: diameter_mm * unit },
        same @ (LensOpening::FNumber { .. } | LensOpening::ObjectCone { .. } | LensOpening::ImageCone { .. }) => same,
    }
}

fn scaled_fields(fields: LensFields, unit: f64) -> LensFields {
    let scale = |heights: Vec<f64>| heights.into_iter().map(|h| h * unit).collect();
    match fields {
        LensFields::ObjectMm(heights) => LensFields::ObjectMm(scale(heights)),
        LensFields::ImageMm(heights) => LensFields::ImageMm(scale(heights)),
        same @ LensFields::AnglesDeg(_) => same,
    }
}
