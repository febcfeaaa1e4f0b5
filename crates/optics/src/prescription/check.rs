//! Checks of a prescription, and the steps from the stated surfaces to a lens that is opened and focused.

use etendue_core::wavelength::{MAX_NM, MIN_NM};
use etendue_spectra::glass::Dispersion;
use glam::DVec3;

use super::paraxial::{self, AxialClipping, AxialOpening};
use super::surface::{Shape, Surface, SurfaceKind};
use super::trace::{self, ApertureTest, LensRay, RayLoss, RayLossReason, TravelDirection, walk};
use super::{Prescription, PrescriptionParameters, coating::Coating, focus, indices::IndexTable};
use crate::error::PrescriptionError;

/// Checks every surface by itself and counts the stops; returns the index of the stop, from 0.
pub(super) fn check_surfaces(surfaces: &[Surface]) -> Result<usize, PrescriptionError> {
    if surfaces.is_empty() {
        return Err(PrescriptionError::Empty);
    }
    surfaces.iter().enumerate().try_for_each(|(i, surface)| numbers(i + 1, surface))?;
    let stops: Vec<usize> = surfaces.iter().enumerate().filter(|(_, s)| s.stop).map(|(i, _)| i).collect();
    let [stop] = stops[..] else { return Err(PrescriptionError::Stops { count: stops.len() }) };
    Ok(stop)
}

/// Fills in the media behind mirrors: those of the spaces before them.
fn fill_mirror_media(surfaces: &mut [Surface]) {
    let mut before = Dispersion::AIR;
    for surface in surfaces {
        if surface.is_mirror() {
            surface.glass = before;
        }
        before = surface.glass;
    }
}

fn check_thin_lens_media(surfaces: &[Surface]) -> Result<(), PrescriptionError> {
    let mut before = Dispersion::AIR;
    for (i, surface) in surfaces.iter().enumerate() {
        let medium_before = core::mem::replace(&mut before, surface.glass);
        if let SurfaceKind::ThinLens { focal_length_mm } = surface.kind
            && medium_before != surface.glass
        {
            let expected = "a thin lens must lie between equal media";
            let (surface, name, value) = (i + 1, "focal_length_mm", focal_length_mm);
            return Err(PrescriptionError::Number { surface, name, value, expected });
        }
    }
    Ok(())
}

fn finite_number(surface: usize, name: &'static str, value: f64) -> Result<f64, PrescriptionError> {
    let expected = "it must be a finite number";
    if value.is_finite() { Ok(value) } else { Err(PrescriptionError::Number { surface, name, value, expected }) }
}

/// A wavelength within the range of the index tables.
fn reference(nm: f64) -> Result<f64, PrescriptionError> {
    if (MIN_NM..=MAX_NM).contains(&nm) { Ok(nm) } else { Err(PrescriptionError::Wavelength { nm }) }
}

fn numbers(surface: usize, s: &Surface) -> Result<(), PrescriptionError> {
    let error = |name, value, expected| Err(PrescriptionError::Number { surface, name, value, expected });
    if s.radius_mm == 0.0 || s.radius_mm.is_nan() {
        return error("radius_mm", s.radius_mm, "it must not be zero; infinity (or leaving it out) is a plane");
    }
    finite_number(surface, "conic", s.conic)?;
    s.asphere.iter().try_for_each(|a| finite_number(surface, "asphere", *a).map(|_| ()))?;
    if !(s.semi_aperture_mm > 0.0 && s.semi_aperture_mm.is_finite()) {
        return error("semi_aperture_mm", s.semi_aperture_mm, "it must be positive and finite");
    }
    if !(s.obscured_radius_mm >= 0.0 && s.obscured_radius_mm < s.semi_aperture_mm) {
        let expected = "it must not be negative, and smaller than semi_aperture_mm";
        return error("obscured_radius_mm", s.obscured_radius_mm, expected);
    }
    if let SurfaceKind::ThinLens { focal_length_mm } = s.kind
        && !(focal_length_mm.is_finite() && focal_length_mm != 0.0 && s.shape() == Shape::Plane)
    {
        return error("focal_length_mm", focal_length_mm, "it must be finite and not 0, and the surface plane");
    }
    if !(s.thickness_mm >= 0.0 && s.thickness_mm.is_finite()) {
        return error("thickness_mm", s.thickness_mm, "it must be finite and not negative");
    }
    match s.coating {
        Coating::Constant(value) if !(value > 0.0 && value <= 1.0) => {
            let name = if s.is_mirror() { "reflectance" } else { "transmittance" };
            error(name, value, "it must be above 0 and at most 1")
        }
        Coating::QuarterWave { design_nm } if s.is_mirror() => {
            error("quarter_wave_nm", design_nm, "the coating of a mirror is its reflectance, a number")
        }
        Coating::QuarterWave { design_nm } if !(design_nm > 0.0 && design_nm.is_finite()) => {
            error("design_wavelength_nm", design_nm, "it must be positive and finite")
        }
        _ => check_clear_aperture(surface, s),
    }
}

fn check_clear_aperture(surface: usize, s: &Surface) -> Result<(), PrescriptionError> {
    let semi_aperture_mm = s.semi_aperture_mm;
    let ends = s.shape().sag(semi_aperture_mm).is_none();
    if ends { Err(PrescriptionError::Equator { surface, semi_aperture_mm }) } else { Ok(()) }
}

/// Heights at which neighbouring surfaces are compared.
const HEIGHTS: usize = 64;
/// Tolerance of a sag, mm: surfaces may touch.
const TOUCHING_MM: f64 = 1e-9;

/// Checks that neighbouring surfaces that refract or reflect do not cross within both their clear apertures. Other surfaces (a stop in air, a dummy) may
/// be anywhere.
pub(super) fn overlaps(surfaces: &[Surface]) -> Result<(), PrescriptionError> {
    let mut z_mm = 0.0;
    let mut before: Option<(usize, f64)> = None;
    let mut medium = Dispersion::AIR;
    for (i, surface) in surfaces.iter().enumerate() {
        let refracts = core::mem::replace(&mut medium, surface.glass) != surface.glass;
        if refracts || surface.is_mirror() {
            if let Some((first, first_mm)) = before {
                let pair = [&surfaces[first], surface];
                overlap(pair, z_mm - first_mm, first + 1, i + 1)?;
            }
            before = Some((i, z_mm));
        }
        z_mm += surface.thickness_mm;
    }
    Ok(())
}

fn overlap(pair: [&Surface; 2], gap_mm: f64, first: usize, second: usize) -> Result<(), PrescriptionError> {
    // The centre of a surface with a hole does not exist.
    let hole_mm = pair[0].obscured_radius_mm.max(pair[1].obscured_radius_mm);
    let minimum = pair[0].semi_aperture_mm.min(pair[1].semi_aperture_mm);
    for i in 0..=HEIGHTS {
        let height_mm = minimum * i as f64 / HEIGHTS as f64;
        let behind_mm = pair[0].sag_behind(height_mm).unwrap_or(0.0);
        let overlap_mm = behind_mm - pair[1].shape().sag(height_mm).unwrap_or(0.0) - gap_mm;
        if overlap_mm > TOUCHING_MM && height_mm >= hole_mm {
            return Err(PrescriptionError::Overlap { first, second, height_mm, overlap_mm });
        }
    }
    Ok(())
}

/// Fraction of the entrance pupil, from its centre, that must be open on the axis: published apertures are rounded.
const MIN_OPEN_FRACTION: f64 = 0.99;
/// The same if other clear apertures may clip: below it the difference is more than rounding.
const MIN_UNCLIPPED_FRACTION: f64 = 0.999;
const STEPS: usize = 32;
/// Bisections of a step, down to rounding.
const HALVINGS: usize = 50;

/// Checks that the bundle of the axial point in focus passes: without total reflection, and limited by the stop alone unless other clear apertures
/// may clip it.
fn axial_bundle(lens: &Prescription, other_rims: AxialClipping) -> Result<AxialOpening, PrescriptionError> {
    let open = if other_rims == AxialClipping::Clip { MIN_UNCLIPPED_FRACTION } else { MIN_OPEN_FRACTION };
    let stop_mm = lens.stop_mm();
    for step in 0..=STEPS {
        let fraction = open * step as f64 / STEPS as f64;
        let Some(lost) = loss_at(lens, fraction) else { continue };
        if lost.surface == lens.stop {
            return Ok(AxialOpening::STOP);
        }
        let (surface, height_mm) = (lost.surface + 1, fraction * stop_mm);
        return match lost.loss {
            RayLossReason::Clipped if other_rims == AxialClipping::Clip && step > 0 => {
                let passes = open * (step - 1) as f64 / STEPS as f64;
                Ok(AxialOpening {
                    radius_ratio: edge(lens, passes, fraction),
                    limit: Some(lost.surface),
                    ..AxialOpening::STOP
                })
            }
            RayLossReason::TotalReflection => Err(PrescriptionError::TotalReflection { surface, height_mm }),
            _ => Err(PrescriptionError::NotTheStop { surface, height_mm, stop_mm }),
        };
    }
    Ok(AxialOpening::STOP)
}

/// The loss of the ray at a fraction of the entrance pupil's radius, at the reference wavelength; `None` if it passes. Obscurations are ignored.
fn loss_at(lens: &Prescription, fraction: f64) -> Option<RayLoss> {
    tested_loss(lens, fraction, ApertureTest::RimsOnly)
}

fn tested_loss(lens: &Prescription, fraction: f64, mut test: ApertureTest) -> Option<RayLoss> {
    let ray = axial_ray(lens, fraction * lens.paraxial.entrance_radius_mm);
    walk(&lens.elements, 0, TravelDirection::ToSensor, &lens.media(lens.reference_nm), ray, &mut test).err()
}

/// Radius of the obscured part of the bundle on the axis, over the bundle's, which is `radius_ratio` of the entrance pupil's.
fn obscured_ratio(lens: &Prescription, radius_ratio: f64) -> Result<f64, PrescriptionError> {
    if !lens.is_obscured() {
        return Ok(0.0);
    }
    let obscured = |ratio: f64| tested_loss(lens, ratio * radius_ratio, ApertureTest::ObscurationsOnly);
    let at = |step: usize| step as f64 / STEPS as f64;
    let Some((step, lost)) = (0..=STEPS).rev().find_map(|step| Some((step, obscured(at(step))?))) else {
        return Ok(0.0);
    };
    if step == STEPS {
        return Err(PrescriptionError::Blocked { surface: lost.surface + 1 });
    }
    Ok(bisect(at(step), at(step + 1), |ratio| obscured(ratio).is_some()))
}

/// The largest passing fraction, between one that passes and one that does not.
fn edge(lens: &Prescription, passes: f64, lost: f64) -> f64 {
    bisect(passes, lost, |fraction| loss_at(lens, fraction).is_none())
}

/// The last place where a condition holds, between one where it does and one where it does not.
fn bisect(mut holds: f64, mut fails: f64, condition: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (holds + fails);
        if condition(middle) {
            holds = middle;
        } else {
            fails = middle;
        }
    }
    holds
}

/// The ray from the axial point in focus through a height of the entrance pupil.
fn axial_ray(lens: &Prescription, height_mm: f64) -> LensRay {
    let pupil = DVec3::new(height_mm, 0.0, lens.paraxial.entrance_pupil_position_mm);
    let slope = height_mm / (lens.focus_distance_m * 1e3);
    LensRay { point: pupil, direction: DVec3::new(slope, 0.0, 1.0).normalize() }
}

impl Prescription {
    /// Creates a checked and focused lens.
    ///
    /// # Errors
    /// If the surfaces do not form a lens, or it cannot be focused as requested.
    pub fn new(parameters: PrescriptionParameters) -> Result<Self, PrescriptionError> {
        let PrescriptionParameters {
            mut surfaces,
            f_number,
            focus,
            defocus_mm,
            reference_nm,
            axial_clipping: other_rims,
        } = parameters;
        let stop = check_surfaces(&surfaces)?;
        fill_mirror_media(&mut surfaces);
        check_thin_lens_media(&surfaces)?;
        let (list, places) = trace::media(&surfaces)?;
        let table = IndexTable::new(&list);
        let media = table.at(reference(reference_nm)?);
        focus::open(&mut surfaces, stop, f_number, &places, &media)?;
        let focused = focus::focused(&mut surfaces, stop, focus, &places, &media)?;
        overlaps(&surfaces)?;
        let elements = trace::elements(&surfaces, &places);
        let paraxial = paraxial::paraxial(&elements, stop, surfaces[stop].semi_aperture_mm, &media);
        let last_mm = elements.last().map_or(0.0, |e| e.z_mm);
        let sensor_position_mm = last_mm + focused.image_mm + finite_number(surfaces.len(), "defocus_mm", defocus_mm)?;
        let mut lens = Self {
            sensor_position_mm,
            focus_distance_m: focused.distance_m,
            magnification: focused.magnification,
            principal_distance_mm: focus::principal_distance_mm(
                &elements,
                &paraxial,
                sensor_position_mm - last_mm,
                &media,
            ),
            surfaces,
            elements,
            table,
            stop,
            reference_nm,
            paraxial,
            axial_opening: AxialOpening::STOP,
        };
        lens.axial_opening = axial_bundle(&lens, other_rims)?;
        lens.axial_opening.obscured_ratio = obscured_ratio(&lens, lens.axial_opening.radius_ratio)?;
        lens.paraxial = paraxial.clipped(lens.axial_opening.radius_ratio);
        Ok(lens)
    }
}
