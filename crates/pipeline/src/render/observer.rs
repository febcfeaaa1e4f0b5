//! How a caller watches and stops a rendering.

/// What a rendering tells its caller, and asks of it. Called from worker threads.
pub trait Observer: Sync {
    /// `done` of `total` tiles of a camera's light are finished.
    fn tiles(&self, done: usize, total: usize);
    /// Whether the caller wants the rendering to stop. Asked before every tile.
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
