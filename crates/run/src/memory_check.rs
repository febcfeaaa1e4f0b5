//! Comparison of the memory that a run needs with the memory that is free.

use crate::film_memory;
use crate::job::Job;
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::report::RunMemory;
use std::ops::Range;

impl Job {
    /// Refuses films that cannot be stored, and a run of these frames that needs more memory than is free, before the first sample.
    pub(crate) fn check_memory(&self, frames: &Range<u32>) -> Result<(), Error> {
        let memory = RunMemory::new(self.plan(), rayon::current_num_threads());
        // A run of a stated time holds the films of all cameras and frames.
        self.compare_memory(&match self.request().time_s {
            Some(_) => memory.holding_films(self.plan(), frames.len()),
            None => memory,
        })
    }

    /// [`Self::check_memory`] for a shard, which gathers films and writes nothing else.
    pub(crate) fn check_shard_memory(&self) -> Result<(), Error> {
        self.compare_memory(&RunMemory::new(self.plan(), rayon::current_num_threads()).films_only())
    }

    fn compare_memory(&self, memory: &RunMemory) -> Result<(), Error> {
        film_memory::check_folder(self.plan())?;
        let Some((limit, free)) = self.request().memory.tightest() else {
            return film_memory::check_films(self.plan());
        };
        // The free memory was measured before the job was read: the scene counts and the program does not.
        if memory.beyond_program() <= free as f64 {
            return Ok(());
        }
        let camera = memory.largest().and_then(|(name, _)| self.plan().camera(name));
        Err(Error::coded(
            ErrorCode::NotEnoughMemory,
            format!(
                "the run needs {:.0} MB of memory beside the program, and {:.0} MB are free {} ({}); {}",
                memory.beyond_program() / 1e6,
                free as f64 / 1e6,
                limit.words(),
                memory.parts(),
                camera.map_or_else(|| "free memory or give the run more".to_owned(), remedies),
            ),
        ))
    }
}

/// Returns the keys that reduce the memory of a camera.
fn remedies(camera: &CameraPlan) -> String {
    let name = &camera.name;
    let products = &camera.products;
    let spectra = products.radiance || products.irradiance;
    let products_made = [
        (products.ground_truth, "output.ground_truth = false"),
        (products.radiance, "output.radiance = false"),
        (products.irradiance, "output.irradiance = false"),
        (products.undistorted.is_some(), "no output.undistorted"),
        (products.signal_breakdown, "output.signal_breakdown = false"),
    ];
    let product_keys = products_made.into_iter().filter(|(is_made, _)| *is_made).map(|(_, key)| key.to_owned());
    let size = format!("smaller width_px and height_px of [sensor] of camera {name}");
    let bands = spectra.then(|| "a larger render.band_width_nm".to_owned());
    let keys: Vec<String> = [size].into_iter().chain(bands).chain(product_keys).collect();
    format!(
        "reduce it with {}; keep more of films and textures on the disk with `film_memory_mb` and `texture_memory_mb`; run fewer `threads`; or give the run more memory (`memory_mb` 0 omits this check)",
        keys.join(", ")
    )
}
