//! How a caller watches and stops a rendering.

use crate::render::film::Film;
use crate::sizes::tile::Tile;

/// What a rendering tells its caller, and asks of it. Called from worker threads.
pub trait Observer: Sync {
    /// All is set up, and the first sample follows.
    fn begins(&self) {}
    /// The pixels of `tile` of the film are complete, or hold one pass more. The film is locked: whoever wants more than a look copies the tile.
    fn tile(&self, _tile: Tile, _film: &Film) {}
    /// `done` of `total` tiles of a camera's light are finished.
    fn tiles(&self, done: usize, total: usize);
    /// Whether the caller wants the rendering to stop. Asked before every pixel, or block of pixels that share paths; of adaptive sampling before every
    /// tile.
    fn cancelled(&self) -> bool;
}

/// An observer that watches nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {
    fn tiles(&self, _done: usize, _total: usize) {}

    fn cancelled(&self) -> bool {
        false
    }
}
