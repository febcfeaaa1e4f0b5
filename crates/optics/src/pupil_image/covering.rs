//! The geometry that contains all directions of a sensor image at sufficient resolution.
//!
//! - Up to [`MAX_RECTILINEAR_RAD`] from the axis: one rectilinear view, none of whose pixels is wider than a pixel of the sensor image anywhere. A
//!   lens without distortion or lateral colour has the sensor image's own pixels.
//! - Beyond that: six views, none of whose pixels is wider than the longer side of a pixel of the sensor image anywhere. (Near the pole of an
//!   equirectangular panorama the width of pixels tends to zero, but not their height.)
//!
//! The extreme directions lie on the sensor image's border, which is sampled pixel by pixel; on the edge of the image circle, which is found to a
//! step of the survey, and that step is added; or on a face's edge.

use etendue_core::WavelengthRange;
use etendue_projection::Raster;
use glam::DVec2;

use super::cube::{BORDER_PX, Cube, Window};
use super::projection::{MAX_RECTILINEAR_RAD, PupilProjection};
use super::{survey::Survey, view::Face};
use crate::{error::OpticsError, lens::Lens};

/// Rounding tolerance of a position in pixels.
const ROUNDING_PX: f64 = 1e-6;

impl PupilProjection {
    /// The geometry that contains every direction of a sensor image with `margin_px` more columns and rows on all sides, at the wavelengths of a
    /// range (nm).
    ///
    /// # Errors
    /// If the lens has no single viewpoint or cannot form the sensor image.
    pub fn covering(
        lens: &Lens,
        raster: &Raster,
        margin_px: [usize; 2],
        range: WavelengthRange,
    ) -> Result<Self, OpticsError> {
        serves(lens)?;
        lens.check(raster)?;
        let raster = raster.widened(margin_px);
        let survey = Survey::new(lens, &raster, range);
        if survey.samples.is_empty() {
            return Err(OpticsError::SeesNothing);
        }
        if survey.widest_rad() <= MAX_RECTILINEAR_RAD { one_view(lens, &raster, &survey) } else { six_views(&survey) }
    }
}

/// Refuses lenses without a single viewpoint, or whose viewpoints are not known accurately.
pub(super) fn serves(lens: &Lens) -> Result<(), OpticsError> {
    match lens {
        Lens::Telecentric(_) | Lens::RayTransfer(_) => Err(OpticsError::NoPupilRoute { kind: lens.kind() }),
        _ => Ok(()),
    }
}

/// True if the sensor image is rectilinear itself.
fn is_rectilinear(lens: &Lens) -> bool {
    let paraxial = matches!(lens, Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_));
    paraxial && lens.distortion().is_none() && !lens.spreads_colours()
}

fn one_view(lens: &Lens, raster: &Raster, survey: &Survey) -> Result<PupilProjection, OpticsError> {
    let plain = is_rectilinear(lens);
    let central = raster.pitch_mm().min_element() / lens.principal_distance_mm();
    let sides = || survey.samples.iter().filter_map(|sample| sample.sides_tan(Face::Front)).flatten();
    let pitch_tan = if plain { central } else { sides().fold(central, f64::min) };
    let [low, high] = bounds(survey, Face::Front, f64::INFINITY).ok_or(OpticsError::SeesNothing)?;
    let margin = if plain { 0.0 } else { 1.0 };
    // The lattice keeps the fraction of the principal point, so that pixels coincide without distortion.
    let fraction = raster.principal_px() - raster.principal_px().floor();
    let before = (-low / pitch_tan - fraction - ROUNDING_PX).ceil() + margin;
    let principal_px = before + fraction;
    let size = (principal_px + high / pitch_tan - ROUNDING_PX).ceil() + margin;
    PupilProjection::rectilinear(size.x as usize, size.y as usize, pitch_tan, principal_px)
}

fn six_views(survey: &Survey) -> Result<PupilProjection, OpticsError> {
    let longer = |sample: &super::survey::SurveySample| {
        let [a, b] = sample.sides_tan(Face::towards(sample.direction))?;
        Some(a.max(b))
    };
    let finest = survey.samples.iter().filter_map(longer).fold(1.0, f64::min);
    let face_px = 2 * (1.0 / finest - ROUNDING_PX).ceil() as usize;
    Cube::new(face_px, Face::ALL.map(|face| window(survey, face, face_px))).map(PupilProjection::Cube)
}

/// The stored window of a face.
fn window(survey: &Survey, face: Face, face_px: usize) -> Option<Window> {
    let half = 0.5 * face_px as f64;
    let [low, high] = bounds(survey, face, 1.0)?.map(|tangent| tangent * half + half);
    // A sensor image that crosses the face's edge was sampled beyond it; one that ends before needs a pixel for rounding.
    let first = |t: f64| if t < 1.0 { -BORDER_PX } else { t.floor() as i64 - 1 };
    let last = face_px as f64 - 1.0;
    let end = |t: f64| if t > last { face_px as i64 + BORDER_PX } else { t.ceil() as i64 + 1 };
    let [left, top] = [first(low.x), first(low.y)];
    let [right, bottom] = [end(high.x), end(high.y)];
    (left < right && top < bottom).then(|| Window {
        left,
        top,
        width: (right - left) as usize,
        height: (bottom - top) as usize,
    })
}

/// The rectangle of tangents of a face seen by the sensor image, among those within `reach` of the axis and a step of the survey about them; `None`
/// if it sees none of the face.
fn bounds(survey: &Survey, face: Face, reach: f64) -> Option<[DVec2; 2]> {
    let step = survey.step_px as f64;
    let mut bounds: Option<[DVec2; 2]> = None;
    for sample in &survey.samples {
        let Some(tangent) = face.tangent(sample.direction) else { continue };
        let side = sample.sides_tan(face).map_or(0.0, |[a, b]| a.max(b));
        // Sides grow without limit towards a right angle from the face's axis.
        if tangent.abs().max_element() > reach + (step * side).min(1.0) {
            continue;
        }
        let about = DVec2::splat(if survey.dark { step * side } else { 0.0 });
        let [low, high] = bounds.unwrap_or([tangent, tangent]);
        bounds = Some([low.min(tangent - about), high.max(tangent + about)]);
    }
    bounds
}
