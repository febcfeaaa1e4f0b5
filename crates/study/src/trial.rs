//! Test of a recommendation on tiles that the study has not sampled. Among many configurations with scattered times the fastest is partly the luckiest; a
//! time measured after the choice is free of this bias. Tiles differ in cost. Another configuration, which was not chosen for its time, is therefore timed on
//! the same tiles in turn. The reported time is the ratio of both, times the pilots' result for the other configuration.

use crate::error::Estimate;
use crate::front::{Recommendation, RecommendationTest};
use crate::measured::ConfigurationMeasurement;
use crate::pilot::{Pilots, seed};
use crate::pixels::SampledPixels;
use crate::plan::PilotPlan;
use etendue::{Error, Job};
use etendue_stats::Moments;

/// Maximum fraction of the study's time for the test of one recommendation.
const BUDGET_FRACTION: f64 = 0.1;
/// Minimum number of tiles of a test.
const MIN_TILES: u32 = 16;
/// Minimum number of replicates that gives a variance, and maximum number.
const REPLICATES: [u32; 2] = [2, 16];
/// First seed of tests.
const FIRST_SEED: u32 = 2000;

/// Context of tests.
pub(crate) struct TrialContext<'a> {
    /// Approximate duration of the study, s.
    pub(crate) budget_s: f64,
    /// The studied job.
    pub(crate) job: &'a Job,
    pub(crate) pilots: &'a Pilots<'a>,
}

/// Extent of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TestExtent {
    plan: PilotPlan,
    tiles: u32,
    /// Samples of each replicate.
    samples: u32,
    replicates: u32,
}

impl TestExtent {
    /// Part of a recommendation of `spp` samples that can be rendered when only the fraction `affordable` is: reduces tiles first, then samples. `None` for
    /// images of too few tiles.
    fn within(
        affordable: f64,
        spp: u32,
        replicates: u32,
        pilot_plan: PilotPlan,
        [columns, rows]: [u32; 2],
    ) -> Option<Self> {
        let all = columns * rows;
        let plan = pilot_plan.other_tiles(columns, (1.0 / affordable).ceil() as u32, all / MIN_TILES);
        let tiles = all / plan.shard.count;
        let own = f64::from(spp / replicates);
        let planes = replicates.clamp(REPLICATES[0], REPLICATES[1]);
        let max_samples = affordable * f64::from(plan.shard.count) * f64::from(spp);
        let samples = (max_samples / f64::from(planes)).min(own).max(1.0) as u32;
        let replicates = (max_samples / f64::from(samples)).clamp(f64::from(REPLICATES[0]), f64::from(planes)) as u32;
        (all >= MIN_TILES).then_some(Self { plan, tiles, samples, replicates })
    }
}

impl TrialContext<'_> {
    /// Tests a recommendation next to another configuration, and corrects its time by the result.
    pub(crate) fn run(
        &self,
        recommendation: &mut Recommendation,
        measured: &ConfigurationMeasurement,
        control: &ConfigurationMeasurement,
        rest_s: f64,
    ) -> Result<(), Error> {
        let Some(trial) = self.run_pair(recommendation, measured, control)? else { return Ok(()) };
        let samples_s = measured.sample_s.value * f64::from(recommendation.point.spp);
        let fixed = Estimate { value: measured.load_s + measured.frame_s + rest_s, uncertainty: 0.0 };
        recommendation.point.seconds = trial.seconds.times(samples_s).plus(fixed);
        recommendation.confirmation = Some(trial);
        Ok(())
    }

    fn run_pair(
        &self,
        recommendation: &Recommendation,
        measured: &ConfigurationMeasurement,
        control: &ConfigurationMeasurement,
    ) -> Result<Option<RecommendationTest>, Error> {
        let point = &recommendation.point;
        let Pilots { camera, simd, clock, observer, plan } = *self.pilots;
        let whole_s = (measured.sample_s.value + control.sample_s.value) * f64::from(point.spp);
        let grid = self.job.tile_grid(camera, plan.tile_px)?;
        let affordable = BUDGET_FRACTION * self.budget_s / whole_s;
        let Some(extent) = TestExtent::within(affordable, point.spp, point.replicates, plan, grid) else {
            return Ok(None);
        };
        let pilots = Pilots { camera, plan: extent.plan, simd, clock, observer };
        let [job, other] =
            [measured, control].map(|measurement| measurement.configuration.request(self.job.request(), camera).open());
        let (job, other) = (job?, other?);
        let own = job.camera_plan(camera)?.settings.seed;
        let (mut planes, mut pixels) = (Vec::new(), Vec::new());
        let (mut own_s, mut other_s) = (Moments::default(), Moments::default());
        for k in 0..extent.replicates {
            let seed = seed(own, FIRST_SEED + k);
            other_s.push(pilots.timed(&other, extent.samples, 1, seed)?.1);
            let (light, took_s) = pilots.timed(&job, extent.samples, 1, seed)?;
            planes.push(light.signal);
            pixels = light.pixels;
            own_s.push(took_s);
        }
        let ratio = samples_time(&own_s, measured).over(samples_time(&other_s, control));
        let pixels = SampledPixels::new(&pixels, &planes, self.job.temporal_noise(camera)?.as_ref());
        Ok(Some(RecommendationTest {
            tiles: extent.tiles,
            unseen: extent.plan.shard.count > 1,
            samples: extent.samples,
            seconds: ratio.product(control.sample_s).times(1.0 / measured.sample_s.value),
            noise: noise(&pixels, &planes, measured, extent.samples),
        }))
    }
}

/// Time of a test's samples, s, without the time of a frame outside its samples.
fn samples_time(took_s: &Moments, measured: &ConfigurationMeasurement) -> Estimate {
    let uncertainty = took_s.variance_of_mean().unwrap_or(f64::NAN).sqrt();
    Estimate { value: (took_s.mean() - measured.frame_s).max(0.05 * took_s.mean()), uncertainty }
}

/// Noise of the planes over the estimate for `samples` samples, in the deciding metric; `None` without an estimate.
fn noise(
    pixels: &SampledPixels,
    planes: &[Vec<f32>],
    measured: &ConfigurationMeasurement,
    samples: u32,
) -> Option<Estimate> {
    let (variances, laws) = (pixels.variance(planes), &measured.variance);
    let (variance, law) = match (variances.sensor, laws.sensor) {
        (Some(variance), Some(law)) => (variance, law),
        _ => (variances.relative, laws.relative),
    };
    let estimated = law.at(f64::from(samples)).value;
    (estimated > 0.0).then(|| variance.times(1.0 / estimated).root())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: [u32; 2] = [80, 50];

    fn extent(affordable: f64) -> TestExtent {
        let pilot_plan = PilotPlan::with_tiles(GRID, 100);
        TestExtent::within(affordable, 64, 4, pilot_plan, GRID).expect("enough tiles")
    }

    #[test]
    fn what_is_affordable_is_tried_on_fewer_tiles_and_then_with_fewer_samples() {
        let (much, less, little) = (extent(1.0), extent(0.008), extent(1e-4));
        assert!(much.samples == 16 && much.replicates == 4 && much.tiles >= 80, "{much:?}");
        assert!((8..=16).contains(&less.samples) && less.replicates == 4 && (16..40).contains(&less.tiles), "{less:?}");
        // A ten-thousandth of 64 samples of 4000 tiles is 26 tile-samples: 1 sample of the fewest tiles, twice.
        assert!(little.samples == 1 && little.replicates == 2 && (16..=40).contains(&little.tiles), "{little:?}");
    }

    #[test]
    fn one_replicate_is_tried_twice() {
        let pilot_plan = PilotPlan::with_tiles(GRID, 100);
        let extent = TestExtent::within(1.0, 64, 1, pilot_plan, GRID).expect("enough tiles");
        assert!(extent.samples == 64 && extent.replicates == 2, "{extent:?}");
        assert_eq!(TestExtent::within(1.0, 64, 4, PilotPlan::with_tiles([2, 2], 48), [2, 2]), None, "too few tiles");
    }
}
