//! Where the bands of films are stored, and what of a film its camera needs.

use crate::plan::{CameraBody, CameraPlan, Products, Route};
use etendue_core::storage::ScratchStore;
use etendue_optics::DepthOfField;
use std::sync::Arc;

/// How much memory the bands of a film may take, and where those are kept that take more. No result depends on it.
#[derive(Clone, Debug)]
pub struct FilmLimit {
    /// Most bytes of the means and variances of one film.
    pub bytes: u64,
    /// Where larger ones are kept.
    pub store: Arc<dyn ScratchStore>,
}

/// For what the bands of a camera's film are needed in memory all at once, in words; `None` where they are not.
#[must_use]
pub(crate) fn needs_all_bands(camera: &CameraPlan) -> Option<&'static str> {
    let is_at_pupil = matches!(camera.settings.route, Route::Pupil(_));
    let makes = needs_irradiance(camera);
    let by_depth = is_at_pupil && camera.depth_of_field != DepthOfField::None;
    match (makes, camera.body.effects.ghosts().is_some(), by_depth) {
        (true, true, _) => Some("ghosts"),
        (true, false, true) => Some("depth of field"),
        _ => None,
    }
}

/// Whether something that is delivered is made of the irradiance.
pub(crate) fn needs_irradiance(camera: &CameraPlan) -> bool {
    let products = &camera.products;
    products.irradiance || products.ghosts || (!camera.settings.folded && needs_electrons(&camera.body, products))
}

/// Whether something that is delivered is made of electrons.
pub(crate) fn needs_electrons(body: &CameraBody, products: &Products) -> bool {
    let frames = products.raw || products.picture || products.signal_breakdown || products.video;
    body.sensor.is_some() && (products.electrons || frames)
}
