//! How a compiled job finds a camera's light.

use crate::integrator::Integrator;
use crate::job::Job;
use etendue_io::failure::Error;
use etendue_tracer::integrator::Level;

/// How a camera's light is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderSettings {
    /// Samples a pixel; the most that a pixel gets where noise decides.
    pub spp: u32,
    /// Independent replicates.
    pub replicates: u32,
    /// How much of the light's ways is followed.
    pub integrator: Integrator,
    /// Greatest number of scattering events; 1 where no paths are traced.
    pub max_bounces: u32,
    /// Whether caustics of lamps are followed.
    pub caustics: bool,
    /// Whether lobes are widened that come after wider ones.
    pub regularize: bool,
    /// Whether matt surfaces draw directions by what paths before the picture have found.
    pub guiding: bool,
    /// How many paths go on, and lights are drawn, at the first surface of a sample.
    pub branches: u32,
    /// What lights are drawn by: "gloss" or "irradiance".
    pub light_sampling: &'static str,
    /// Side of the squares of pixels that share the tails of their paths; 1 where none do.
    pub path_reuse_px: u32,
    /// Wavelengths a path.
    pub wavelengths: u32,
    /// Whether each ray through the lens, or its weight, depends on its wavelength, so that a path carries one.
    pub disperses: bool,
    /// Whether noise decides how many samples a pixel gets.
    pub is_adaptive: bool,
    /// The seed of all random numbers.
    pub seed: u64,
}

impl Job {
    /// How a camera's light is found, with what its job leaves open.
    ///
    /// # Errors
    /// Where the job has no such camera.
    pub fn render_settings(&self, camera: &str) -> Result<RenderSettings, Error> {
        let camera = self.camera_plan(camera)?;
        let s = &camera.settings;
        let integrator = match s.level {
            Level::Flat => Integrator::Flat,
            Level::Direct => Integrator::Direct,
            Level::Path => Integrator::Path,
        };
        let through_lens = s.route == etendue_pipeline::plan::Route::Lens;
        Ok(RenderSettings {
            spp: s.spp,
            replicates: s.replicates,
            integrator,
            max_bounces: s.max_bounces,
            caustics: s.caustics,
            regularize: s.regularize,
            guiding: s.guiding,
            branches: s.branches,
            light_sampling: s.light_sampling.word(),
            path_reuse_px: s.blocks.side_px(),
            wavelengths: s.wavelengths,
            disperses: through_lens && camera.body.disperses(),
            is_adaptive: s.adaptive.is_some(),
            seed: s.seed,
        })
    }
}
