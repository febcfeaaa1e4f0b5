//! Which films keep their bands in memory, and which on the disk.

use crate::camera::disk_light::needs_all_bands;
use crate::plan::{CameraPlan, Plan};
use crate::render::film::Film;
use crate::render::layout;
use crate::render::light::has_variance;
use crate::render::tile::Shard;
use crate::render::tiled_cube::TiledCube;
use etendue_core::scratch::ScratchStore;
use std::sync::Arc;

/// How much memory the bands of a film may take, and where those are kept that take more. No result depends on it.
#[derive(Clone, Debug)]
pub struct FilmLimit {
    /// Most bytes of the means and variances of one film.
    pub bytes: u64,
    /// Where larger ones are kept.
    pub store: Arc<dyn ScratchStore>,
}

/// What the film of a camera takes, bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmBytes {
    /// In memory.
    pub memory: f64,
    /// In a scratch file; 0 where the bands are in memory.
    pub disk: f64,
    /// For what bands on the disk are read into memory all at once, in words; these, and what is made of them, count as memory.
    pub all_bands_for: Option<&'static str>,
}

impl Plan {
    /// Where the bands of a camera's film are kept that do not fit into memory; `None` where they do, and where no limit is set.
    #[must_use]
    pub fn scratch(&self, camera: &CameraPlan) -> Option<&Arc<dyn ScratchStore>> {
        let limit = self.film_limit.as_ref()?;
        let (width, height) = camera.film_size();
        let bytes = Film::cube_bytes(width as usize, height as usize, &layout(camera));
        (bytes > limit.bytes as f64).then_some(&limit.store)
    }

    /// What the film of a camera takes.
    #[must_use]
    pub fn film_bytes(&self, camera: &CameraPlan) -> FilmBytes {
        let ((width, height), layout) = (camera.film_size(), layout(camera));
        let size = (width as usize, height as usize);
        let (Some(_), Some(bands)) = (self.scratch(camera), layout.bands) else {
            return FilmBytes { memory: Film::bytes(size.0, size.1, &layout), disk: 0.0, all_bands_for: None };
        };
        let pixels = f64::from(width) * f64::from(height);
        let all_bands_for = needs_all_bands(camera);
        // Their means, and the irradiance that is made of them.
        let loaded = if all_bands_for.is_some() { 2.0 * TiledCube::bytes(pixels, bands, false) } else { 0.0 };
        FilmBytes {
            memory: Film::bytes_beside_cube(size.0, size.1, &layout) + loaded,
            disk: TiledCube::bytes(pixels, bands, has_variance(camera.settings.replicates, Shard::WHOLE)),
            all_bands_for,
        }
    }
}
