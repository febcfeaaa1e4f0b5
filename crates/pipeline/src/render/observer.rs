//! Interface through which a caller observes and cancels a render.

use crate::render::film::Film;
use crate::sizes::tile::Tile;

/// Receives the progress of a render, and can cancel it. Called from worker threads.
pub trait Observer: Sync {
    /// Setup is complete; the first sample follows.
    fn begins(&self) {}
    /// The pixels of `tile` of the film are complete, or contain one more pass. The film is locked: copy the tile for anything longer than a short look.
    fn tile(&self, _tile: Tile, _film: &Film) {}
    /// `done` of `total` tiles of a camera's light are finished.
    fn tiles(&self, done: usize, total: usize);
    /// Returns true to cancel the render. Called before every pixel, or block of pixels that share paths; with adaptive sampling before every tile.
    fn cancelled(&self) -> bool;
}

/// An observer that ignores progress and never cancels.
#[derive(Clone, Copy, Debug, Default)]
pub struct NullObserver;

impl Observer for NullObserver {
    fn tiles(&self, _done: usize, _total: usize) {}

    fn cancelled(&self) -> bool {
        false
    }
}
