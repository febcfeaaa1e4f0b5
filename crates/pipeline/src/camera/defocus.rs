//! Depth of field for stored radiance: the required margin, and the work on several threads.

use crate::camera::stored::{PinholeImages, StoredRadianceImage};
use crate::plan::CameraBody;
use etendue_core::quantity::Radiance;
use etendue_core::{Bands, SpectralCube};
use etendue_optics::defocus::{self, PhysicalDefocus};
use etendue_optics::{DepthOfField, OpticsError, PupilProjection, Resampling};
use rayon::prelude::*;

/// Margin in a stored image, up to the required one.
///
/// # Errors
/// It does not contain the image itself.
pub fn available_margin_px(
    stored: &PupilProjection,
    body: &CameraBody,
    bands: Bands,
    depth_of_field: &DepthOfField,
) -> Result<usize, OpticsError> {
    let holds = |margin: usize| {
        let margin = body.whole_margin_px(margin);
        Resampling::new(*stored, &body.lens, &body.raster, margin, bands).map(|_| ())
    };
    let needed = body.blur_margin_px(depth_of_field);
    if holds(needed).is_ok() {
        return Ok(needed);
    }
    holds(0)?;
    let (mut available, mut missing) = (0, needed);
    while missing - available > 1 {
        let middle = usize::midpoint(available, missing);
        if holds(middle).is_ok() {
            available = middle;
        } else {
            missing = middle;
        }
    }
    Ok(available)
}

/// Radiance seen by the pixels of a camera's film, blurred as requested: each pixel is the mean over its pupil. Without distances there is no blur.
///
/// # Errors
/// The stored image does not contain the camera's image, or its radiance is not finite.
pub fn pupil_mean_radiance(
    stored: &StoredRadianceImage<'_>,
    body: &CameraBody,
    depth_of_field: &DepthOfField,
) -> Result<SpectralCube<Radiance>, OpticsError> {
    let method = if stored.distance.is_some() { *depth_of_field } else { DepthOfField::None };
    let margin = available_margin_px(stored.projection, body, stored.radiance.bands(), &method)?;
    let PinholeImages { radiance, distance } = stored.resample(body, body.whole_margin_px(margin))?;
    let (Some(distance), true) = (distance, method != DepthOfField::None) else { return Ok(radiance) };
    let film = body.film();
    let view = defocus::PinholeView::new(&body.lens, &film, margin, &radiance, &distance)?;
    Ok(match method {
        DepthOfField::Physical => physical(view),
        other => other.apply(&view),
    })
}

/// Strips are independent of each other, so that threads do not change the result.
fn physical(view: defocus::PinholeView<'_>) -> SpectralCube<Radiance> {
    let prepared = PhysicalDefocus::new(view);
    let strips: Vec<_> = prepared.strips().collect();
    let strips: Vec<_> = strips.into_par_iter().map(|rows| prepared.rows(rows)).collect();
    prepared.join(&strips)
}
