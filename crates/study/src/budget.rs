//! How many tiles a study may look at in its time.

use crate::Clock;
use crate::pilot::{Pilots, seed};
use crate::plan::{PilotPlan, TILE_PX};
use crate::stint::Stint;
use etendue::{Error, Job, Observer, Simd};

/// Tiles of the first look, and the fewest of any.
const FEWEST_TILES: u32 = 48;
/// Pixels that a study holds at most: of each it keeps some planes.
const MOST_PIXELS: u32 = 1 << 19;

/// As many tiles as may be sampled `samples` times a pixel in `budget_s`, by the time that a first look takes.
pub(crate) fn within(
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
    let plan = PilotPlan::of_tiles(grid, FEWEST_TILES);
    let look = Pilots { camera, plan, simd, clock, observer };
    let own = job.camera_plan(camera)?.settings.seed;
    // Twice: the first one finds cold caches.
    look.timed(job, 2, 1, seed(own, 1000))?;
    let stint = Stint::begin(clock);
    let light = look.timed(job, 2, 1, seed(own, 1001))?.0;
    // By the clock: that is what the study may take.
    let took_s = stint.clock_s();
    let of_tile_s = took_s / f64::from(all / plan.shard.count).max(1.0) / 2.0;
    let tile_px2 = (light.pixels.len() as u32 / (all / plan.shard.count).max(1)).max(1);
    let affordable = (budget_s / (samples * of_tile_s)).min(f64::from(all)) as u32;
    Ok(PilotPlan::of_tiles(grid, affordable.min(MOST_PIXELS / tile_px2).max(FEWEST_TILES.min(all))))
}
