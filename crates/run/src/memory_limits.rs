//! Memory limits of a run: free memory as the caller states it, the share of films, and the comparison with the memory that a run needs.

use etendue_io::ScratchFolder;
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::Plan;
use etendue_pipeline::plan::{CameraPlan, FilmMemoryLimit};
use etendue_pipeline::report::RunMemory;
use std::path::PathBuf;
use std::sync::Arc;

/// A limit on the memory of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryLimit {
    /// The address space of the process (`ulimit -v`).
    Process,
    /// The control group of the process (a container, a service, a job of a cluster).
    ControlGroup,
    /// The memory of the machine.
    Machine,
    /// A number stated by the user.
    Stated,
}

/// Free memory for a run, as bytes of each known limit. No result depends on it. The library does not query the machine: the caller states the free memory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MemoryLimits {
    /// Limits that are not listed are unknown and not applied.
    pub free_bytes: Vec<(MemoryLimit, u64)>,
}

impl MemoryLimits {
    /// Returns the limit with the fewest free bytes.
    #[must_use]
    pub fn tightest(&self) -> Option<(MemoryLimit, u64)> {
        self.free_bytes.iter().copied().min_by_key(|(_, bytes)| *bytes)
    }
}

impl MemoryLimit {
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Process => "within the address space of the process (ulimit -v)",
            Self::ControlGroup => "within the memory limit of its control group",
            Self::Machine => "on this machine",
            Self::Stated => "by `memory_mb`",
        }
    }
}

/// Memory limit of the bands of a film, and the place of films that exceed it. No result depends on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilmMemory {
    /// Maximum bytes, in memory, of the means and variances of one film's bands.
    pub limit_bytes: u64,
    /// Folder for the scratch files of larger films; `None`: that of texture tiles ([`TextureMemory::cache`](etendue_io::TextureMemory)).
    pub scratch: Option<PathBuf>,
}

impl Default for FilmMemory {
    /// 2048 MB.
    fn default() -> Self {
        Self { limit_bytes: 2_048_000_000, scratch: None }
    }
}

impl FilmMemory {
    /// The limit as the plan receives it, with texture tiles in `cache`.
    pub(crate) fn limit(&self, cache: Option<&PathBuf>) -> FilmMemoryLimit {
        let folder = self.scratch.as_ref().or(cache).map(PathBuf::as_path);
        FilmMemoryLimit { bytes: self.limit_bytes, store: Arc::new(ScratchFolder::new(folder)) }
    }
}

/// Refuses, before the first sample, a run that needs more memory than is free, and films that cannot be stored.
pub(crate) fn check(plan: &Plan, memory: &RunMemory, limits: &MemoryLimits) -> Result<(), Error> {
    check_folder(plan)?;
    let Some((limit, free)) = limits.tightest() else { return check_films(plan) };
    // The free memory was measured before the job was read: the scene counts and the program does not.
    if memory.beyond_program() <= free as f64 {
        return Ok(());
    }
    let camera = memory.largest_camera().and_then(|(name, _)| plan.camera(name));
    Err(Error::coded(
        ErrorCode::NotEnoughMemory,
        format!(
            "the run needs {:.0} MB of memory in addition to the program, but {:.0} MB are free {} ({}); {}",
            memory.beyond_program() / 1e6,
            free as f64 / 1e6,
            limit.words(),
            memory.parts(),
            camera.map_or_else(|| "free memory or give the run more".to_owned(), remedies),
        ),
    ))
}

/// Returns the keys that reduce the memory of a camera.
fn remedies(camera: &CameraPlan) -> String {
    let name = &camera.name;
    let products = &camera.products;
    let spectra = products.needs_radiance() || products.irradiance;
    let products_of_film = [
        (products.ground_truth, "output.ground_truth = false"),
        (products.radiance, "output.radiance = false"),
        (products.irradiance, "output.irradiance = false"),
        (products.undistorted.is_some(), "no output.undistorted"),
        (products.signal_breakdown, "output.signal_breakdown = false"),
    ];
    let product_keys =
        products_of_film.into_iter().filter(|(is_requested, _)| *is_requested).map(|(_, key)| key.to_owned());
    let size = format!("smaller width_px and height_px of [sensor] of camera {name}");
    let bands = spectra.then(|| "a larger render.band_width_nm".to_owned());
    let keys: Vec<String> = [size].into_iter().chain(bands).chain(product_keys).collect();
    format!(
        "reduce it with {}; store more of films and textures on disk with `film_memory_mb` and `texture_memory_mb`; \
         use fewer `threads`; or give the run more memory (`memory_mb` 0 omits this check)",
        keys.join(", ")
    )
}

/// Checks that the folder for scratch files can be written.
fn check_folder(plan: &Plan) -> Result<(), Error> {
    let store = plan.cameras.iter().find_map(|camera| plan.scratch(camera));
    store.map_or(Ok(()), |store| {
        store.room(0).map(|_| ()).map_err(|words| Error::coded(ErrorCode::UnwritableOutput, words))
    })
}

/// Checks that the system has memory for the film of each camera.
fn check_films(plan: &Plan) -> Result<(), Error> {
    plan.cameras.iter().try_for_each(|camera| check_room(plan, camera))
}

/// Allocates the memory of a camera's film and frees it: a later allocation that fails would end the process.
fn check_room(plan: &Plan, camera: &CameraPlan) -> Result<(), Error> {
    let bytes = plan.film_bytes(camera).memory;
    Vec::<u8>::new().try_reserve_exact(bytes as usize).map_err(|_| {
        Error::run(format!(
            "camera {}: the system cannot provide the {:.0} MB of memory that its film needs; free memory, render \
             fewer pixels or bands, or store more of it on disk with `film_memory_mb`",
            camera.name,
            bytes / 1e6
        ))
    })
}
