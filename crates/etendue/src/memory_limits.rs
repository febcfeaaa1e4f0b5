//! Comparison of the memory that is free for a run with the memory that the run needs.

use crate::error::Error;
use etendue_pipeline::Plan;
use etendue_pipeline::plan::{CameraPlan, RunMemory};

/// What limits the memory of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryLimit {
    /// The address space of the process (`ulimit -v`).
    Process,
    /// The control group of the process (a container, a service, a job of a cluster).
    ControlGroup,
    /// The memory of the machine.
    Machine,
}

/// The memory that a run may take: the free bytes of each known limit. No result depends on it. The library does not query the machine: the caller
/// states what is free.
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

    /// Refuses a run that needs more memory than is free, before its first sample. `held_moments`: the films of all cameras are in memory together,
    /// with this number of moments each.
    pub(crate) fn check(&self, plan: &Plan, held_moments: Option<usize>) -> Result<(), Error> {
        let Some((limit, free)) = self.tightest() else { return Ok(()) };
        let memory = RunMemory::new(plan, rayon::current_num_threads());
        let memory = match held_moments {
            Some(moments) => memory.holding_films(plan, moments),
            None => memory,
        };
        // The free memory was measured before the job was read: the scene counts and the program does not.
        if memory.beyond_program() <= free as f64 {
            return Ok(());
        }
        let camera = memory.largest().and_then(|(name, _)| plan.camera(name));
        Err(Error::input(format!(
            "the run needs {:.0} MB of memory beside the program, and {:.0} MB are free {} ({}); {}",
            memory.beyond_program() / 1e6,
            free as f64 / 1e6,
            limit.words(),
            memory.parts(),
            camera.map_or_else(|| "free memory or give the run more".to_owned(), remedies),
        )))
    }
}

impl MemoryLimit {
    fn words(self) -> &'static str {
        match self {
            Self::Process => "within the address space of the process (ulimit -v)",
            Self::ControlGroup => "within the memory of its control group",
            Self::Machine => "on this machine",
        }
    }
}

/// Returns the keys that reduce the memory of a camera.
fn remedies(camera: &CameraPlan) -> String {
    let name = &camera.name;
    let products = &camera.products;
    let spectra = products.radiance || products.irradiance;
    let asked = [
        (products.ground_truth, "output.ground_truth = false"),
        (products.radiance, "output.radiance = false"),
        (products.irradiance, "output.irradiance = false"),
        (products.undistorted.is_some(), "no output.undistorted"),
        (products.signal_breakdown, "output.signal_breakdown = false"),
    ];
    let asked = asked.into_iter().filter(|(is_asked, _)| *is_asked).map(|(_, key)| key.to_owned());
    let size = format!("smaller width_px and height_px of [sensor] of camera {name}");
    let bands = spectra.then(|| "a larger render.band_width_nm".to_owned());
    let keys: Vec<String> = [size].into_iter().chain(bands).chain(asked).collect();
    format!(
        "reduce it with {}; keep more of films and textures on the disk with --film-memory and --texture-memory; or give the run more memory",
        keys.join(", ")
    )
}
