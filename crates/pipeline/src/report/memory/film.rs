//! The memory of a film, and its scratch files.

use crate::plan::film::{needs_all_bands, needs_irradiance};
use crate::plan::{CameraPlan, Plan, Route};
use crate::sizes::film::{has_variance, scratch_bytes};
use crate::sizes::tile::Shard;

/// What the film of a camera takes, bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmBytes {
    /// In memory.
    pub memory: f64,
    /// In scratch files, the most at a time; 0 where the bands are in memory.
    pub disk: f64,
    /// For what bands on the disk are read into memory all at once, in words; these, and what is made of them, count as memory.
    pub all_bands_for: Option<&'static str>,
}

impl Plan {
    /// What the film of a camera takes.
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
        // A further pass has a file of its own beside the one before.
        let films = if camera.pass_count() > 1 { 2.0 } else { 1.0 };
        let (loaded, made) =
            if all_bands_for.is_some() { (cubes_in_memory(camera), 0.0) } else { (0.0, cubes_made(camera)) };
        FilmBytes {
            memory: layout.bytes_beside_cube(size.0, size.1) + loaded * means,
            disk: films * film + made * means,
            all_bands_for,
        }
    }
}

/// Cubes that are in memory at the same time where all bands are read: the film's (radiance and what passes the lens, at the pupil), what effects leave of it,
/// ghosts, and the variances of the film's.
fn cubes_in_memory(camera: &CameraPlan) -> f64 {
    let effects = &camera.body.effects;
    let of_film = if is_at_pupil(camera) { 3 } else { 1 };
    let means = of_film + usize::from(!effects.is_idle()) + usize::from(effects.ghosts().is_some());
    (means + 2 * usize::from(delivers_variance(camera))) as f64
}

/// Cubes that are made of a film band after band and kept on the disk: what passes the lens at the pupil, and what effects leave of it and of its variance.
fn cubes_made(camera: &CameraPlan) -> f64 {
    if !needs_irradiance(camera) {
        return 0.0;
    }
    let by_effects = if camera.body.effects.is_idle() { 0 } else { 1 + usize::from(delivers_variance(camera)) };
    (usize::from(is_at_pupil(camera)) + by_effects) as f64
}

fn is_at_pupil(camera: &CameraPlan) -> bool {
    matches!(camera.settings.route, Route::Pupil(_))
}

/// Whether the irradiance's variance is delivered, which is known through the lens alone.
fn delivers_variance(camera: &CameraPlan) -> bool {
    camera.products.irradiance && camera.products.variance && !is_at_pupil(camera)
}
