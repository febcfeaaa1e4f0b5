//! Pilot runs: the light of some tiles with few samples, with one seed after the other.

use crate::Clock;
use crate::plan::PilotPlan;
use crate::work_timer::WorkTimer;
use etendue::{Error, Job, LightSampling, Observer, SampledPixel, Simd};

/// Planes of one configuration with one number of samples, and the time of each.
#[derive(Clone, Debug)]
pub(crate) struct Pilot {
    pub(crate) pixels: Vec<SampledPixel>,
    /// One plane per seed.
    pub(crate) planes: Vec<Vec<f32>>,
    /// CPU time of each plane, sum over all threads, s.
    pub(crate) processor_s: Vec<f64>,
    /// Wall-clock time of all planes, s.
    pub(crate) clock_s: f64,
}

/// Runs pilots.
pub(crate) struct Pilots<'a> {
    pub(crate) camera: &'a str,
    pub(crate) plan: PilotPlan,
    pub(crate) simd: Simd,
    pub(crate) clock: &'a dyn Clock,
    pub(crate) observer: &'a dyn Observer,
}

impl Pilots<'_> {
    /// Runs a pilot of `spp` samples per pixel in one replicate with each of `seeds` seeds. With equal seeds two configurations share the common part of
    /// their paths, so that their differences have little noise.
    pub(crate) fn run(&self, job: &Job, spp: u32, seeds: u32) -> Result<Pilot, Error> {
        let own = job.camera_plan(self.camera)?.settings.seed;
        let (mut pixels, mut planes, mut processor_s) = (Vec::new(), Vec::new(), Vec::new());
        let all = WorkTimer::start(self.clock);
        for k in 0..seeds {
            let (light, took_s) = self.timed(job, spp, 1, seed(own, k))?;
            pixels = light.pixels;
            processor_s.push(took_s);
            planes.push(light.signal);
        }
        Ok(Pilot { pixels, planes, processor_s, clock_s: all.clock_s() })
    }

    /// Renders the light of the study's tiles with the given samples and replicates; returns it with its CPU time, sum over all threads, s.
    pub(crate) fn timed(
        &self,
        job: &Job,
        spp: u32,
        replicates: u32,
        seed: u64,
    ) -> Result<(etendue::SampledLight, f64), Error> {
        let PilotPlan { tile_px, shard } = self.plan;
        let sampling = LightSampling { spp, replicates, seed, tile_px, shard };
        let timer = WorkTimer::start(self.clock);
        let light = job.sampled_light(self.camera, sampling, self.simd, self.observer)?;
        Ok((light, timer.processor_s()))
    }
}

/// A seed of a study, different from the job's own: the estimates are independent of the reported result.
pub(crate) fn seed(own: u64, k: u32) -> u64 {
    (own.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (0x5851_f42d_4c95_7f2d_u64.wrapping_mul(u64::from(k) + 1))) >> 1
}
