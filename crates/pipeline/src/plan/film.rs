//! Storage of film bands, and the parts of a film that its camera needs.

use crate::plan::{CameraBody, CameraPlan, Products, Route};
use etendue_core::storage::ScratchStore;
use etendue_optics::DepthOfField;
use std::sync::Arc;

/// Memory limit of the bands of a film, and the storage of films that exceed it. No result depends on it.
#[derive(Clone, Debug)]
pub struct FilmMemoryLimit {
    /// Maximum bytes of the means and variances of one film.
    pub bytes: u64,
    /// Storage of larger films.
    pub store: Arc<dyn ScratchStore>,
}

/// Purpose for which all bands of a camera's film must be in memory at once, as text; `None` if they need not be.
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

/// Returns true if a product depends on the irradiance.
pub(crate) fn needs_irradiance(camera: &CameraPlan) -> bool {
    let products = &camera.products;
    products.irradiance
        || products.ghosts
        || (!camera.settings.accumulates_electrons && needs_electrons(&camera.body, products))
}

/// Returns true if a product depends on electrons.
pub(crate) fn needs_electrons(body: &CameraBody, products: &Products) -> bool {
    let frames = products.raw || products.picture || products.signal_breakdown || products.video;
    body.sensor.is_some() && (products.electrons || frames)
}
