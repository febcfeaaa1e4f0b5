//! Clear semi-apertures that a lens file does not state: as large as the light of its field points needs.

use super::lens_file::surface_from_file;
use super::lens_file::{FileAperture, paraxial_lens, reference_nm};
use etendue_optics::prescription::clear_apertures::{FieldBundle, FieldPoint, clear_apertures_mm, provisional_mm};
use etendue_optics::prescription::{Focus, Surface};
use etendue_optics::{Prescription, PrescriptionError};
use etendue_scene::asset::{LensFields, PrescriptionAsset};
use etendue_spectra::glass::{GlassError, LINE_D_NM};

const MM_PER_M: f64 = 1e3;

/// Semi-apertures of all surfaces, and a note on them.
pub(super) struct ClearApertures {
    pub(super) semi_apertures_mm: Vec<f64>,
    pub(super) note: String,
}

/// Semi-apertures from chief and marginal rays, for surfaces without a stated one.
///
/// # Errors
/// They cannot be found: the reason, to follow "the file gives none, and".
pub(super) fn find(asset: &PrescriptionAsset) -> Result<ClearApertures, String> {
    let fields = asset.fields.as_ref().ok_or("no fields (YAN, YOB, YIM) from which they could be computed")?;
    let own_mm = asset.surfaces.iter().find(|s| s.stop).and_then(|s| s.semi_aperture_mm);
    let lens = provisional_lens(asset).map_err(|error| with_line(asset, &error))?;
    let stop_mm =
        lens.file_aperture.stop_mm.or(own_mm).ok_or("no aperture (EPD, FNO, NA) from which they could be computed")?;
    let bundles = bundles(asset, fields, lens.file_aperture.distance_m)?;
    let wavelengths_nm = if asset.wavelengths_nm.is_empty() { vec![LINE_D_NM] } else { asset.wavelengths_nm.clone() };
    let needed = clear_apertures_mm(&lens.prescription, stop_mm, &bundles, &wavelengths_nm).map_err(lost_bundle)?;
    let semi_apertures_mm: Vec<f64> =
        asset.surfaces.iter().zip(needed).map(|(s, needed_mm)| s.semi_aperture_mm.unwrap_or(needed_mm)).collect();
    let note = note(asset, &semi_apertures_mm);
    Ok(ClearApertures { semi_apertures_mm, note })
}

fn note(asset: &PrescriptionAsset, semi_apertures_mm: &[f64]) -> String {
    let without =
        asset.surfaces.iter().zip(semi_apertures_mm).enumerate().filter(|(_, (s, _))| s.semi_aperture_mm.is_none());
    let list: Vec<String> = without.map(|(i, (_, semi_mm))| format!("{}: {semi_mm:.3} mm", i + 1)).collect();
    let vignetted =
        if asset.vignetting.iter().flatten().any(|v| *v != 0.0) { " and its vignetting factors" } else { "" };
    format!(
        "it states no semi-aperture for some surfaces; computed from the chief and marginal rays of its \
         fields{vignetted}: {}",
        list.join(", ")
    )
}

/// An error of the surfaces, or of the aperture with the line of the file that states it.
fn with_line(asset: &PrescriptionAsset, error: &LensFileError) -> String {
    match error {
        LensFileError::Lens(cone @ PrescriptionError::Cone { .. }) => format!("{cone} (line {})", asset.opening_line),
        LensFileError::Lens(other) => other.to_string(),
        LensFileError::Glass(other) => other.to_string(),
    }
}

fn lost_bundle(bundle: usize) -> String {
    match bundle {
        0 => "they cannot be computed: its marginal ray on the axis does not pass the lens".to_owned(),
        i => format!("they cannot be computed: the chief or a marginal ray of its field {i} does not pass the lens"),
    }
}

/// The lens before its clear apertures are known.
struct ProvisionalLens {
    file_aperture: FileAperture,
    prescription: Prescription,
}

/// Reasons for which there is none.
enum LensFileError {
    Lens(PrescriptionError),
    Glass(GlassError),
}

impl From<PrescriptionError> for LensFileError {
    fn from(error: PrescriptionError) -> Self {
        Self::Lens(error)
    }
}

fn provisional_lens(asset: &PrescriptionAsset) -> Result<ProvisionalLens, LensFileError> {
    let surfaces = asset.surfaces.iter().map(|s| surface_from_file(s, 1.0)).collect::<Result<Vec<_>, _>>();
    let surfaces = surfaces.map_err(LensFileError::Glass)?;
    let semi_aperture_mm = provisional_mm(&surfaces);
    let surfaces: Vec<Surface> = surfaces.into_iter().map(|s| Surface { semi_aperture_mm, ..s }).collect();
    let file_aperture = FileAperture::new(asset, &surfaces)?;
    let focus = Focus::Sensor { distance_m: file_aperture.distance_m };
    let defocus_mm = file_aperture.defocus_mm.unwrap_or(asset.defocus_mm);
    let prescription = paraxial_lens(&surfaces, focus, defocus_mm, reference_nm(asset))?;
    Ok(ProvisionalLens { file_aperture, prescription })
}

/// Ray bundles of the axis and of the file's fields.
fn bundles(asset: &PrescriptionAsset, fields: &LensFields, distance_m: f64) -> Result<Vec<FieldBundle>, String> {
    let near = distance_m.is_finite();
    let distance_mm = asset.object_distance_mm;
    let object = |height_mm: f64| FieldPoint::Object { height_mm, distance_mm };
    let points: Vec<FieldPoint> = match fields {
        // The point of the near object in that direction from the entrance pupil: light that travels upwards comes from below.
        LensFields::AnglesDeg(list) if near => {
            list.iter().map(|deg| object(-tangent(*deg) * distance_m * MM_PER_M)).collect()
        }
        LensFields::AnglesDeg(list) => list.iter().map(|deg| FieldPoint::Angle(deg.to_radians())).collect(),
        LensFields::ObjectMm(list) if near => list.iter().map(|height_mm| object(*height_mm)).collect(),
        LensFields::ObjectMm(_) => return Err("its fields are heights of an object at infinity".to_owned()),
        LensFields::ImageMm(list) => list.iter().map(|height_mm| FieldPoint::Image(*height_mm)).collect(),
    };
    let open = |end: usize, i: usize| 1.0 - asset.vignetting[end].get(i).copied().unwrap_or(0.0);
    let axis = FieldBundle { point: if near { object(0.0) } else { FieldPoint::Angle(0.0) }, reach: [1.0; 2] };
    let fields =
        points.into_iter().enumerate().map(|(i, point)| FieldBundle { point, reach: [open(0, i), open(1, i)] });
    Ok(core::iter::once(axis).chain(fields).collect())
}

fn tangent(deg: f64) -> f64 {
    let (sine, cosine) = etendue_core::maths::f64::sin_cos(deg.to_radians());
    sine / cosine
}
