//! An observer that shows light in a viewer as well.

use super::Display;
use etendue::{ImageTile, Message, Observer, Progress};

/// Hands all on to another observer, and light to a viewer where there is one.
pub struct Displaying<'a> {
    observer: &'a dyn Observer,
    display: Option<Display>,
}

impl<'a> Displaying<'a> {
    /// The same as `observer`, with a viewer.
    pub fn new(observer: &'a dyn Observer, display: Option<Display>) -> Self {
        Self { observer, display }
    }

    /// Waits a while until the viewer has all.
    pub fn finish(self) {
        self.display.into_iter().for_each(Display::finish);
    }
}

impl Observer for Displaying<'_> {
    fn message(&self, message: Message<'_>) {
        self.observer.message(message);
    }

    fn progress(&self, progress: Progress<'_>) {
        self.observer.progress(progress);
    }

    fn wants_tiles(&self) -> bool {
        self.display.is_some()
    }

    fn tile(&self, tile: &ImageTile<'_>) {
        self.display.iter().for_each(|display| display.tile(tile));
    }

    fn now_s(&self) -> Option<f64> {
        self.observer.now_s()
    }

    fn cancelled(&self) -> bool {
        self.observer.cancelled()
    }
}
