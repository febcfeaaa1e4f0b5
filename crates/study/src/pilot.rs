//! Pilot runs: the light of some tiles with few samples, by one seed after the other.

use crate::Clock;
use crate::plan::PilotPlan;
use crate::stint::Stint;
use etendue::{Error, Job, LightSampling, Observer, SampledPixel, Simd};

/// The planes of one way with one number of samples, and how long each took.
#[derive(Clone, Debug)]
pub(crate) struct Pilot {
    pub(crate) pixels: Vec<SampledPixel>,
    /// One of each seed.
    pub(crate) planes: Vec<Vec<f32>>,
    /// Processor time of each plane, all threads together, s.
    pub(crate) processor_s: Vec<f64>,
    /// All planes by the clock, s.
    pub(crate) clock_s: f64,
}

/// What runs pilots.
pub(crate) struct Pilots<'a> {
    pub(crate) camera: &'a str,
    pub(crate) plan: PilotPlan,
    pub(crate) simd: Simd,
    pub(crate) clock: &'a dyn Clock,
    pub(crate) observer: &'a dyn Observer,
}

impl Pilots<'_> {
    /// A pilot of `spp` samples a pixel in one replicate by each of `seeds` seeds. Equal seeds make equal paths as far as two ways have them in common, so that
    /// their differences are little noisy.
    pub(crate) fn run(&self, job: &Job, spp: u32, seeds: u32) -> Result<Pilot, Error> {
        let own = job.camera_plan(self.camera)?.settings.seed;
        let (mut pixels, mut planes, mut processor_s) = (Vec::new(), Vec::new(), Vec::new());
        let all = Stint::begin(self.clock);
        for k in 0..seeds {
            let (light, took_s) = self.timed(job, spp, 1, seed(own, k))?;
            pixels = light.pixels;
            processor_s.push(took_s);
            planes.push(light.signal);
        }
        Ok(Pilot { pixels, planes, processor_s, clock_s: all.clock_s() })
    }

    /// The light of the study's tiles with so many samples and replicates, and its processor time, all threads together, s.
    pub(crate) fn timed(
        &self,
        job: &Job,
        spp: u32,
        replicates: u32,
        seed: u64,
    ) -> Result<(etendue::SampledLight, f64), Error> {
        let PilotPlan { tile_px, shard } = self.plan;
        let sampling = LightSampling { spp, replicates, seed, tile_px, shard };
        let stint = Stint::begin(self.clock);
        let light = job.sampled_light(self.camera, sampling, self.simd, self.observer)?;
        Ok((light, stint.processor_s()))
    }
}

/// A seed of a study, not the job's own: what is foretold is no part of what is told.
pub(crate) fn seed(own: u64, k: u32) -> u64 {
    (own.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (0x5851_f42d_4c95_7f2d_u64.wrapping_mul(u64::from(k) + 1))) >> 1
}
