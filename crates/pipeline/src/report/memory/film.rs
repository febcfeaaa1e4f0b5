//! The memory of a film, and its scratch files.

use crate::plan::film::{needs_all_bands, needs_irradiance};
use crate::plan::{CameraPlan, Plan, Route};
use crate::sizes::film::{has_variance, scratch_bytes};
use crate::sizes::tile::Shard;

/// Bytes of the film of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmBytes {
    /// In memory.
    pub memory: f64,
    /// In scratch files, maximum at any time; 0 if the bands are in memory.
    pub disk: f64,
    /// Purpose for which bands on disk are read into memory all at once, as text; these, and the results computed from them, count as memory.
    pub all_bands_for: Option<&'static str>,
}

impl Plan {
    /// Bytes of the film of a camera.
    #[must_use]
    pub fn film_bytes(&self, camera: &CameraPlan) -> FilmBytes {
        let ((width, height), layout) = (camera.film_size(), camera.film_layout());
        let size = (width as usize, height as usize);
        let (Some(_), Some(bands)) = (self.scratch(camera), layout.bands) else {
            return FilmBytes { memory: layout.bytes(size.0, size.1), disk: 0.0, all_bands_for: None };
        };
        let pixels = f64::from(width) * f64::from(height);
        let all_bands_for = needs_all_bands(camera);
        let means = scratch_bytes(pixels, bands, false);
        let film = scratch_bytes(pixels, bands, has_variance(camera.settings.replicates, Shard::WHOLE));
        // A further pass has its own file in addition to that of the pass before.
        let films = if camera.pass_count() > 1 { 2.0 } else { 1.0 };
        let (loaded, created) =
            if all_bands_for.is_some() { (cubes_in_memory(camera), 0.0) } else { (0.0, computed_cube_bytes(camera)) };
        FilmBytes {
            memory: layout.bytes_without_cube(size.0, size.1) + loaded * means,
            disk: films * film + created * means,
            all_bands_for,
        }
    }
}

/// Cubes in memory at the same time if all bands are read: the film's (radiance and the light that passes the lens, at the pupil), the result of effects,
/// ghosts, and the variances of the film.
fn cubes_in_memory(camera: &CameraPlan) -> f64 {
    let effects = &camera.body.effects;
    let of_film = if is_at_pupil(camera) { 3 } else { 1 };
    let means = of_film + usize::from(!effects.is_idle()) + usize::from(effects.ghosts().is_some());
    (means + 2 * usize::from(delivers_variance(camera))) as f64
}

/// Cubes computed from a film band after band and stored on disk: the light that passes the lens at the pupil, and the result of effects on it and on its
/// variance.
fn computed_cube_bytes(camera: &CameraPlan) -> f64 {
    if !needs_irradiance(camera) {
        return 0.0;
    }
    let by_effects = if camera.body.effects.is_idle() { 0 } else { 1 + usize::from(delivers_variance(camera)) };
    (usize::from(is_at_pupil(camera)) + by_effects) as f64
}

fn is_at_pupil(camera: &CameraPlan) -> bool {
    matches!(camera.settings.route, Route::Pupil(_))
}

/// Returns true if the irradiance's variance is delivered, which is known only on the lens route.
fn delivers_variance(camera: &CameraPlan) -> bool {
    camera.products.irradiance && camera.products.variance && !is_at_pupil(camera)
}
