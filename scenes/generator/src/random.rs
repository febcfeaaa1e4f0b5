//! Addressed random numbers of the generator: Philox words under a scene's own key.

use core::convert::Infallible;
use etendue_core::random::{philox4x32, unit_f64};
use rand::TryRng;

/// A running stream of words, the same on every machine. rand's distributions draw from it.
#[derive(Clone, Debug)]
pub struct RandomStream {
    key: u32,
    count: u32,
}

impl RandomStream {
    /// The stream of one key.
    #[must_use]
    pub fn new(key: u32) -> Self {
        Self { key, count: 0 }
    }
}

impl TryRng for RandomStream {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        self.try_next_u64().map(|word| (word >> 32) as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        self.count += 1;
        Ok(word([self.count, 0, 0], self.key))
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        rand::rand_core::utils::fill_bytes_via_next_word(bytes, || self.try_next_u64())
    }
}

/// A number in [0, 1) that belongs to three whole numbers and a key.
#[must_use]
pub fn hash(at: [u32; 3], key: u32) -> f64 {
    unit_f64(word(at, key))
}

fn word(at: [u32; 3], key: u32) -> u64 {
    let words = philox4x32([at[0], at[1], at[2], 0], [key, 0x5ce_ae5]);
    u64::from(words[0]) | u64::from(words[1]) << 32
}

/// Smooth value noise in [0, 1) on a square lattice of `period` cells that repeats.
#[must_use]
pub fn noise(x: f64, y: f64, period: [u32; 2], key: u32) -> f64 {
    let (cell_x, cell_y) = (x.floor(), y.floor());
    let (tx, ty) = (fade(x - cell_x), fade(y - cell_y));
    let at = |dx: f64, dy: f64| hash([wrap(cell_x + dx, period[0]), wrap(cell_y + dy, period[1]), 7], key);
    let low = at(0.0, 0.0) * (1.0 - tx) + at(1.0, 0.0) * tx;
    let high = at(0.0, 1.0) * (1.0 - tx) + at(1.0, 1.0) * tx;
    low * (1.0 - ty) + high * ty
}

fn wrap(cell: f64, period: u32) -> u32 {
    (cell as i64).rem_euclid(i64::from(period)) as u32
}

/// 3 t² − 2 t³.
#[must_use]
pub fn fade(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// 0 below `low`, 1 above `high`, smooth between.
#[must_use]
pub fn step(low: f64, high: f64, x: f64) -> f64 {
    fade(((x - low) / (high - low)).clamp(0.0, 1.0))
}
