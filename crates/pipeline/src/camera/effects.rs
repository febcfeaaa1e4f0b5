//! Irradiance effects of a camera on a whole film, bands in parallel.

use crate::plan::CameraBody;
use etendue_core::quantity::{Irradiance, Quantity, Variance};
use etendue_core::{Bands, Plane, SpectralCube, WavelengthRange};
use etendue_optics::effects::{FilmPart, PreparedEffects};
use etendue_optics::{Lens, ghosts};
use rayon::prelude::*;

/// Result of effects on a film: an image.
pub(crate) struct EffectsOutput {
    pub(crate) irradiance: SpectralCube<Irradiance>,
    /// Variance without that of ghosts, which is far below the image's own.
    pub(crate) variance: Option<SpectralCube<Variance>>,
    /// Ghosts, as part of the irradiance, if the camera has them.
    pub(crate) ghosts: Option<SpectralCube<Irradiance>>,
}

/// Irradiance of the image and its variance, from those of the film; unchanged if the camera has no effects. `part` of the point spread is not yet in the
/// film. Runs on the caller's pool.
pub(crate) fn behind(
    body: &CameraBody,
    part: FilmPart,
    film: SpectralCube<Irradiance>,
    variance: Option<SpectralCube<Variance>>,
) -> EffectsOutput {
    if body.effects.is_idle() {
        return EffectsOutput { irradiance: film, variance, ghosts: None };
    }
    let ghosts = ghosts(body, &film);
    let bands = film.bands();
    let prepared = body.effects.prepared(&body.raster, bands.range(), part);
    let of_band = |band: usize| {
        let variance = variance.as_ref().map(|cube| &cube.planes()[band]);
        apply_to_band(&prepared, bands, band, &film.planes()[band], variance)
    };
    let (means, variances): (Vec<_>, Vec<_>) = (0..film.planes().len()).into_par_iter().map(of_band).unzip();
    let mut irradiance = SpectralCube::from_planes(bands, means).expect("planes of one picture");
    if let Some(ghosts) = &ghosts {
        irradiance.planes_mut().iter_mut().zip(ghosts.planes()).for_each(|(sum, plane)| add(sum, plane));
    }
    let variances: Option<Vec<_>> = variances.into_iter().collect();
    EffectsOutput {
        irradiance,
        variance: variances.and_then(|planes| SpectralCube::from_planes(bands, planes)),
        ghosts,
    }
}

/// Ghosts of the image, from the film's light.
fn ghosts(body: &CameraBody, film: &SpectralCube<Irradiance>) -> Option<SpectralCube<Irradiance>> {
    let (Some(settings), Lens::Prescription(lens)) = (body.effects.ghosts(), &body.lens) else { return None };
    let layer =
        ghosts::layer(film, lens, &body.film(), settings).expect("the film has the size that its effects ask for");
    Some(picture(body, layer))
}

fn add(sum: &mut Plane<Irradiance>, plane: &Plane<Irradiance>) {
    sum.samples_mut().iter_mut().zip(plane.samples()).for_each(|(sum, value)| *sum += value);
}

/// Result of effects on a band and its variance.
pub(crate) fn apply_to_band(
    prepared: &PreparedEffects,
    bands: Bands,
    band: usize,
    film: &Plane<Irradiance>,
    variance: Option<&Plane<Variance>>,
) -> (Plane<Irradiance>, Option<Plane<Variance>>) {
    let low_nm = bands.low_nm() + band as f64 * bands.width_nm();
    prepared.apply(WavelengthRange::new(low_nm, low_nm + bands.width_nm()), film, variance)
}

/// Image of a film, without its margin.
pub(crate) fn picture<Q: Quantity>(body: &CameraBody, film: SpectralCube<Q>) -> SpectralCube<Q> {
    if body.effects.margin_px() == [0, 0] {
        return film;
    }
    let planes = film.planes().iter().map(|plane| crop_to_image(body, plane)).collect();
    SpectralCube::from_planes(film.bands(), planes).expect("planes of one picture")
}

/// Image part of a plane of a film.
pub(crate) fn crop_to_image<Q: Quantity>(body: &CameraBody, film: &Plane<Q>) -> Plane<Q> {
    let [x, y] = body.effects.margin_px();
    film.part(x, y, body.raster.width(), body.raster.height())
}
