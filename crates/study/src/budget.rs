//! Number of tiles that a study can sample in its time.

use crate::Clock;
use crate::pilot::{Pilots, seed};
use crate::plan::{PilotPlan, TILE_PX};
use crate::work_timer::WorkTimer;
use etendue::{Error, Job, Observer, Simd};

/// Tiles of the first measurement, and the minimum of any.
const MIN_TILES: u32 = 48;
/// Maximum number of pixels of a study: it stores several planes of each.
const MAX_PIXELS: u32 = 1 << 19;

/// Number of tiles that can be sampled with `samples` per pixel in `budget_s`, extrapolated from the time of a first measurement.
pub(crate) fn affordable_tiles(
    job: &Job,
    camera: &str,
    budget_s: f64,
    samples: f64,
    simd: Simd,
    clock: &dyn Clock,
    observer: &dyn Observer,
) -> Result<PilotPlan, Error> {
    let grid = job.tile_grid(camera, TILE_PX)?;
    let all = grid[0] * grid[1];
    let plan = PilotPlan::with_tiles(grid, MIN_TILES);
    let pilots = Pilots { camera, plan, simd, clock, observer };
    let own = job.camera_plan(camera)?.settings.seed;
    // Runs twice: the first run meets cold caches.
    pilots.timed(job, 2, 1, seed(own, 1000))?;
    let timer = WorkTimer::start(clock);
    let light = pilots.timed(job, 2, 1, seed(own, 1001))?.0;
    // Uses wall-clock time, because the budget is wall-clock time.
    let elapsed_s = timer.clock_s();
    let of_tile_s = elapsed_s / f64::from(all / plan.shard.count).max(1.0) / 2.0;
    let tile_px2 = (light.pixels.len() as u32 / (all / plan.shard.count).max(1)).max(1);
    let affordable = (budget_s / (samples * of_tile_s)).min(f64::from(all)) as u32;
    Ok(PilotPlan::with_tiles(grid, affordable.min(MAX_PIXELS / tile_px2).max(MIN_TILES.min(all))))
}
