//! How much memory films may take.

use etendue_io::ScratchFolder;
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::Plan;
use etendue_pipeline::plan::{CameraPlan, FilmLimit};
use std::path::PathBuf;
use std::sync::Arc;

/// How much memory the bands of a film may take, and where those are kept that take more. No result depends on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilmMemory {
    /// Most bytes of the means and variances of one film's bands in memory.
    pub limit_bytes: u64,
    /// The folder for the scratch files of larger ones; `None`: that of tiles of textures ([`TextureMemory::cache`](etendue_io::TextureMemory)).
    pub scratch: Option<PathBuf>,
}

impl Default for FilmMemory {
    /// 2048 MB.
    fn default() -> Self {
        Self { limit_bytes: 2_048_000_000, scratch: None }
    }
}

impl FilmMemory {
    /// What a plan is told, where tiles of textures are in `cache`.
    pub(crate) fn limit(&self, cache: Option<&PathBuf>) -> FilmLimit {
        let folder = self.scratch.as_ref().or(cache).map(PathBuf::as_path);
        FilmLimit { bytes: self.limit_bytes, store: Arc::new(ScratchFolder::new(folder)) }
    }
}

/// Checks that the folder for scratch files can be written.
pub(crate) fn check_folder(plan: &Plan) -> Result<(), Error> {
    let store = plan.cameras.iter().find_map(|camera| plan.scratch(camera));
    store.map_or(Ok(()), |store| {
        store.room(0).map(|_| ()).map_err(|words| Error::coded(ErrorCode::UnwritableOutput, words))
    })
}

/// Checks that the system has memory for the film of each camera.
pub(crate) fn check_films(plan: &Plan) -> Result<(), Error> {
    plan.cameras.iter().try_for_each(|camera| check_room(plan, camera))
}

/// Allocates the memory of a camera's film and frees it: a later allocation that fails would end the process.
fn check_room(plan: &Plan, camera: &CameraPlan) -> Result<(), Error> {
    let bytes = plan.film_bytes(camera).memory;
    Vec::<u8>::new().try_reserve_exact(bytes as usize).map_err(|_| {
        Error::run(format!(
            "camera {}: the system does not give the {:.0} MB of memory that its film takes; make room, render fewer pixels or bands, or keep more of it on \
             the disk with `film_memory_mb`",
            camera.name,
            bytes / 1e6
        ))
    })
}
