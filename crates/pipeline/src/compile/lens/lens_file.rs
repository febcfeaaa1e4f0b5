//! Statements of a lens file in addition to the surfaces: its aperture, its object, its image.
//!
//! The file applies where the description states nothing. Values that the description changes, and values that the file leaves open, are noted.

use super::super::context::Context;
use crate::compile::stated::focus_m;
use etendue_optics::prescription::{Focus, Surface, SurfaceKind};
use etendue_optics::{PRINCIPAL_NM, Prescription, PrescriptionError, PrescriptionParameters};
use etendue_scene::asset::{GlassAsset, LensOpening, PrescriptionAsset, SurfaceAsset};
use etendue_scene::record::lens::prescription as record;
use etendue_spectra::glass::{Dispersion, GlassError};

/// Opening of the stop, relative to its own, for the computation of first-order quantities: no other surface then clips.
const PARAXIAL_OPENING: f64 = 1e-4;
const MM_PER_M: f64 = 1e3;

/// Aperture, object and image of a file, in terms of a [`PrescriptionParameters`].
#[derive(Clone, Debug)]
pub(super) struct FileAperture {
    /// Stop for the file's own aperture, mm; `None` if that is the stop's size.
    pub(super) stop_mm: Option<f64>,
    /// Distance of the object from the entrance pupil, m.
    pub(super) distance_m: f64,
    /// Distance of the file's image behind its paraxial image, mm; `None` if the file leaves it open.
    pub(super) defocus_mm: Option<f64>,
}

impl FileAperture {
    /// Computes them from the file's numbers and first-order quantities of its surfaces.
    ///
    /// # Errors
    /// The surfaces do not form a lens.
    pub(super) fn new(asset: &PrescriptionAsset, surfaces: &[Surface]) -> Result<Self, PrescriptionError> {
        let narrow = |focus: Focus| paraxial_lens(surfaces, focus, 0.0, reference_nm(asset));
        let distant = narrow(Focus::Sensor { distance_m: f64::INFINITY })
            .or_else(|_| narrow(Focus::Fixed { back_focus_mm: asset.back_focus_mm }))?;
        let p = distant.paraxial();
        let distance_m = (asset.object_distance_mm + p.entrance_pupil_position_mm) / MM_PER_M;
        let distance_m = if distance_m > 0.0 { distance_m } else { f64::INFINITY };
        let near = if distance_m.is_finite() { narrow(Focus::Sensor { distance_m })? } else { distant.clone() };
        let image_mm = near.sensor_position_mm() - near.last_vertex_mm();
        let has_focus = asset.back_focus_mm > 0.0;
        // An aperture at the pupil corresponds to one at the stop by the pupil's magnification.
        let stop_per_pupil = distant.stop_mm() / p.entrance_radius_mm;
        let pupil_mm = match asset.opening {
            None => None,
            Some(LensOpening::EntrancePupil { diameter_mm }) => Some(0.5 * diameter_mm),
            Some(LensOpening::FNumber { f_number }) => Some(0.5 * p.focal_length_mm.abs() / f_number),
            Some(LensOpening::ObjectCone { sine }) => Some(radius_from_cone(sine, distance_m)?),
            Some(LensOpening::ImageCone { sine }) if distance_m.is_infinite() => Some(p.focal_length_mm.abs() * sine),
            // By the sine condition, which lenses for wide cones are designed to fulfil.
            Some(LensOpening::ImageCone { sine }) => Some(radius_from_cone(near.magnification() * sine, distance_m)?),
        };
        Ok(Self {
            stop_mm: pupil_mm.map(|radius_mm| radius_mm * stop_per_pupil),
            distance_m,
            defocus_mm: if has_focus { Some(asset.back_focus_mm - image_mm) } else { None },
        })
    }
}

/// Radius of the entrance pupil for a cone of light from a distance, mm.
fn radius_from_cone(sine: f64, distance_m: f64) -> Result<f64, PrescriptionError> {
    if sine < 1.0 && distance_m.is_finite() {
        Ok(sine / (1.0 - sine * sine).sqrt() * distance_m * MM_PER_M)
    } else {
        Err(PrescriptionError::Cone { sine, distance_m })
    }
}

/// Wavelength of a file's first-order statements, nm.
pub(super) fn reference_nm(asset: &PrescriptionAsset) -> f64 {
    asset.primary_nm.unwrap_or(PRINCIPAL_NM)
}

/// The lens with its stop nearly closed and nothing obscured, and its sensor close to the paraxial image.
pub(super) fn paraxial_lens(
    surfaces: &[Surface],
    focus: Focus,
    defocus_mm: f64,
    reference_nm: f64,
) -> Result<Prescription, PrescriptionError> {
    let close = |s: &Surface| {
        let part = if s.stop { PARAXIAL_OPENING } else { 1.0 };
        Surface { semi_aperture_mm: part * s.semi_aperture_mm, obscured_radius_mm: 0.0, ..*s }
    };
    let surfaces = surfaces.iter().map(close).collect();
    Prescription::new(PrescriptionParameters {
        defocus_mm,
        reference_nm,
        ..PrescriptionParameters::new(surfaces, focus)
    })
}

/// Notes differences from a file, and values that it leaves open.
pub(super) fn note_differences(
    record: &record::Prescription,
    asset: &PrescriptionAsset,
    own_stop_mm: f64,
    file_aperture: &FileAperture,
    lens: &Prescription,
    context: &mut Context<'_>,
) {
    let record::SurfaceListSource::File(file) = &record.source else { return };
    let mut record_note = |text: String| context.note(format!("{}: {text}", file.value.display()));
    asset.notes.iter().for_each(|note| record_note(note.clone()));
    if let Some(stop_mm) = file_aperture.stop_mm.filter(|_| record.f_number.is_none())
        && (stop_mm / own_stop_mm - 1.0).abs() > 1e-3
    {
        let clipping =
            asset.surfaces.iter().find(|surface| surface.stop && surface.clips_light && stop_mm > own_stop_mm);
        record_note(clipping.map_or_else(
            || format!("its aperture opens the stop to {stop_mm:.4} mm, not to the {own_stop_mm:.4} mm of the stop's surface"),
            |stop| {
                let line = stop.line;
                format!("the aperture of the stop's surface (line {line}) limits the stop to {own_stop_mm:.4} mm; the \
                         lens would open it to {stop_mm:.4} mm")
            },
        ));
    }
    if let Some(i) = lens.axial_limit() {
        let (n, line) = (lens.paraxial().f_number(), asset.surfaces[i].line);
        record_note(format!(
            "surface {} (line {line}), not the stop, limits the bundle on the axis: f/{n:.3}, where the stop alone would give f/{:.3}",
            i + 1,
            n * lens.axial_radius_ratio()
        ));
    }
    if asset.surfaces.iter().any(|s| s.mirror) && asset.surfaces.iter().all(|s| s.obscured_radius_mm == 0.0) {
        record_note(
            "it states no central obscuration: its mirrors and the sensor take no light from the beam before them"
                .to_owned(),
        );
    }
    if let Some(n) = record.f_number.as_ref().filter(|_| asset.opening.is_some()) {
        record_note(format!("f/{} of the description replaces the file's aperture", n.value));
    }
    note_sensor_position(record, asset, file_aperture, lens, &mut record_note);
}

/// Notes the position of the sensor if it is not at the paraxial image or not where the file places it.
fn note_sensor_position(
    record: &record::Prescription,
    asset: &PrescriptionAsset,
    file_aperture: &FileAperture,
    lens: &Prescription,
    note: &mut impl FnMut(String),
) {
    let at_mm = lens.sensor_position_mm() - lens.last_vertex_mm();
    let file_mm = asset.back_focus_mm;
    let other_focus = record.focus_distance_m.as_ref().is_some_and(|focus| {
        let requested_per_m = 1.0 / focus_m(focus);
        (requested_per_m - 1.0 / file_aperture.distance_m).abs() > 1e-9
    });
    match (file_aperture.defocus_mm, &record.defocus_mm) {
        (None, None) => note(format!(
            "it states no image distance: the sensor is {at_mm:.4} mm behind the last vertex, at the paraxial image"
        )),
        (None, Some(_)) => {}
        (Some(_), Some(_)) => note(format!(
            "\"defocus_mm\" places the sensor {at_mm:.4} mm behind the last vertex; the file's image is at \
             {file_mm:.4} mm"
        )),
        (Some(own), None) if other_focus => note(format!(
            "the focus differs from the file's: the sensor is {at_mm:.4} mm behind the last vertex, {own:+.4} mm from \
             the paraxial image as in the file; the file's image is at {file_mm:.4} mm"
        )),
        (Some(own), None) if own.abs() > 1e-6 => note(format!(
            "the sensor is {at_mm:.4} mm behind the last vertex, as the file states: {own:+.4} mm from the paraxial \
             image"
        )),
        _ => {}
    }
}

/// A surface of a file.
///
/// # Errors
/// Its glass is invalid.
pub(super) fn surface_from_file(surface: &SurfaceAsset, semi_aperture_mm: f64) -> Result<Surface, GlassError> {
    let glass = match &surface.glass {
        GlassAsset::Air => Dispersion::AIR,
        GlassAsset::Named(glass) => glass.dispersion,
        GlassAsset::Index(n) => Dispersion::Constant { n: *n }.checked()?,
        GlassAsset::Abbe { index, abbe } => Dispersion::from_abbe(*index, *abbe)?,
    };
    let kind = match surface.thin_lens_mm {
        Some(focal_length_mm) => SurfaceKind::ThinLens { focal_length_mm },
        None if surface.mirror => SurfaceKind::Mirror,
        None => SurfaceKind::Refracting,
    };
    Ok(Surface {
        kind,
        obscured_radius_mm: surface.obscured_radius_mm,
        conic: surface.conic,
        asphere: surface.asphere,
        stop: surface.stop,
        ..Surface::sphere(surface.radius_mm, surface.thickness_mm, glass, semi_aperture_mm)
    })
}
