//! Selection of a study's tiles, for a given time.

use etendue::{Error, Job, ShardSpec};
use etendue_core::maths::greatest_common_divisor;

/// Side of the study's tiles, px, unless larger blocks of pixels share paths.
pub(crate) const TILE_PX: u32 = 16;

/// The selected tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PilotPlan {
    pub(crate) tile_px: u32,
    pub(crate) shard: ShardSpec,
}

impl PilotPlan {
    /// Selects about `tiles` tiles, spread over the frame.
    pub(crate) fn with_tiles([columns, rows]: [u32; 2], tiles: u32) -> Self {
        let count = spread(columns * rows / tiles.max(1), columns);
        Self { tile_px: TILE_PX, shard: ShardSpec { index: count / 2, count } }
    }
}

impl PilotPlan {
    /// Tiles that this plan does not contain, about one in `fewer` and at least one in `fewest`; the same tiles if it contains all.
    pub(crate) fn other_tiles(&self, columns: u32, fewer: u32, min_tiles: u32) -> Self {
        let count = self.shard.count;
        let factor = f64::from(fewer) / f64::from(count);
        // Deviation of a number of tiles from the target, as a factor.
        let off = |times: u32| (f64::from(times) / factor).max(factor / f64::from(times));
        let apart = (1..=(min_tiles / count).max(1)).filter(|times| greatest_common_divisor(*times, columns) == 1);
        let times = apart.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(1);
        let shard = ShardSpec { index: (self.shard.index + 1) % count, count: count * times };
        Self { shard, ..*self }
    }
}

/// Number of shards near `count` whose tiles do not align in columns: it has no divisor in common with the number of columns.
fn spread(count: u32, columns: u32) -> u32 {
    let apart = |a: u32, b: u32| greatest_common_divisor(a, b) == 1;
    (1..=count.max(1)).rev().find(|n| apart(*n, columns)).unwrap_or(1)
}

/// Fraction of a frame in `pixels` of its pixels.
pub(crate) fn pixel_fraction(job: &Job, camera: &str, pixels: usize) -> Result<f64, Error> {
    let [width, height] = job.film_px(camera)?;
    Ok(pixels as f64 / (f64::from(width) * f64::from(height)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_spread_over_columns_and_rows() {
        let plan = PilotPlan::with_tiles([80, 50], 100);
        let ShardSpec { index, count } = plan.shard;
        let tiles: Vec<u32> = (0..4000).filter(|tile| tile % count == index).collect();
        assert!((90..=130).contains(&tiles.len()), "{}", tiles.len());
        // No column or row has much more than its proportion.
        for column in 0..80 {
            assert!(tiles.iter().filter(|tile| *tile % 80 == column).count() <= 3, "{column}");
        }
        let other = plan.other_tiles(80, 3 * count, 1000);
        assert!(other.shard.count == 3 * count && other.shard.index % count != index, "{other:?}");
        assert!(tiles.iter().all(|tile| tile % other.shard.count != other.shard.index));
        // 120 columns share divisors with 2, 3, 4, 5 and 6.
        let wide = PilotPlan::with_tiles([120, 68], 48);
        let times = |fewer: u32, min_tiles: u32| wide.other_tiles(120, fewer, min_tiles).shard.count / wide.shard.count;
        assert_eq!([times(250, 510), times(600, 510), times(900, 2000), times(1, 510)], [1, 1, 7, 1]);
        assert_eq!(PilotPlan::with_tiles([4, 3], 48).shard.count, 1, "a small frame is looked at as a whole");
    }
}
