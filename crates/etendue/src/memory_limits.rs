//! The memory that a machine has for a run, against what the run needs.

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

/// How much memory a run may take, of each limit that is known the bytes that are still free. No result depends on it. Libraries do not look at the
/// machine: who calls them says what is free.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MemoryLimits {
    /// Limits that are not listed are not known, and refuse nothing.
    pub free_bytes: Vec<(MemoryLimit, u64)>,
}

impl MemoryLimits {
    /// The limit that leaves least.
    #[must_use]
    pub fn tightest(&self) -> Option<(MemoryLimit, u64)> {
        self.free_bytes.iter().copied().min_by_key(|(_, bytes)| *bytes)
    }

    /// Refuses a run that needs more memory than is free, before its first sample. `held_moments`: films of all cameras are held together, of so many
    /// moments each.
    pub(crate) fn check(&self, plan: &Plan, held_moments: Option<usize>) -> Result<(), Error> {
        let Some((limit, free)) = self.tightest() else { return Ok(()) };
        let memory = RunMemory::new(plan, rayon::current_num_threads());
        let memory = match held_moments {
            Some(moments) => memory.holding_films(plan, moments),
            None => memory,
        };
        // What is free is known from before the job was read, so that the scene counts and the program does not.
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
            camera.map_or_else(|| "make room".to_owned(), remedies),
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

/// The keys that lower what a camera takes.
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
        "less is needed with {}; --film-memory and --texture-memory keep more of films and textures on the disk; or give the run more memory",
        keys.join(", ")
    )
}
