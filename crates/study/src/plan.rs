//! Which tiles a study looks at, so that it takes the time that it may take.

use crate::Clock;
use crate::pilot::{Pilots, seed};
use etendue::{Error, Job, Observer, ShardSpec, Simd};

/// Side of the study's tiles, px, where no pixels share more.
const TILE_PX: u32 = 16;
/// Tiles of the first look, and the fewest of any.
const FEWEST_TILES: u32 = 48;
/// Pixels that a study holds at most: of each it keeps some planes.
const MOST_PIXELS: u32 = 1 << 19;

/// Which tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PilotPlan {
    pub(crate) tile_px: u32,
    pub(crate) shard: ShardSpec,
}

impl PilotPlan {
    /// About so many tiles, spread over the frame.
    fn of_tiles([columns, rows]: [u32; 2], tiles: u32) -> Self {
        let count = spread(columns * rows / tiles.max(1), columns);
        Self { tile_px: TILE_PX, shard: ShardSpec { index: count / 2, count } }
    }

    /// As many tiles as may be sampled `samples` times a pixel in `budget_s`, by the time that a first look takes.
    pub(crate) fn within(
        job: &Job,
        camera: &str,
        (budget_s, samples): (f64, f64),
        simd: Simd,
        (clock, observer): (&dyn Clock, &dyn Observer),
    ) -> Result<Self, Error> {
        let grid = job.tile_grid(camera, TILE_PX)?;
        let all = grid[0] * grid[1];
        let plan = Self::of_tiles(grid, FEWEST_TILES);
        let look = Pilots { camera, plan, simd, clock, observer };
        let own = job.render_settings(camera)?.seed;
        // Twice: the first one finds cold caches.
        look.timed(job, (2, 1), seed(own, 1000))?;
        let (light, took_s) = look.timed(job, (2, 1), seed(own, 1001))?;
        let of_tile_s = took_s / f64::from(all / plan.shard.count).max(1.0) / 2.0;
        let tile_px2 = (light.pixels.len() as u32 / (all / plan.shard.count).max(1)).max(1);
        let affordable = (budget_s / (samples * of_tile_s)).min(f64::from(all)) as u32;
        Ok(Self::of_tiles(grid, affordable.min(MOST_PIXELS / tile_px2).max(FEWEST_TILES.min(all))))
    }

    /// The part of all tiles that it takes, about.
    pub(crate) fn share(&self) -> f64 {
        1.0 / f64::from(self.shard.count)
    }
}

/// A number of shards, about `count`, whose tiles stand on no columns: one that has no divisor in common with their number.
fn spread(count: u32, columns: u32) -> u32 {
    let apart = |a: u32, b: u32| greatest_common_divisor(a, b) == 1;
    (1..=count.max(1)).rev().find(|n| apart(*n, columns)).unwrap_or(1)
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_spread_over_columns_and_rows() {
        let plan = PilotPlan::of_tiles([80, 50], 100);
        let ShardSpec { index, count } = plan.shard;
        let tiles: Vec<u32> = (0..4000).filter(|tile| tile % count == index).collect();
        assert!((90..=130).contains(&tiles.len()), "{}", tiles.len());
        // No column or row has much more than its part.
        for column in 0..80 {
            assert!(tiles.iter().filter(|tile| *tile % 80 == column).count() <= 3, "{column}");
        }
        assert_eq!(PilotPlan::of_tiles([4, 3], 48).shard.count, 1, "a small frame is looked at as a whole");
    }
}
