//! An observer that also shows light in a viewer.

use super::Display;
use etendue::{ImageTile, Message, Observer, Progress};

/// Passes everything to another observer, and light also to a viewer if there is one.
pub struct DisplayObserver<'a> {
    observer: &'a dyn Observer,
    display: Option<Display>,
}

impl<'a> DisplayObserver<'a> {
    /// Adds a viewer to `observer`.
    pub fn new(observer: &'a dyn Observer, display: Option<Display>) -> Self {
        Self { observer, display }
    }

    /// Waits for a limited time until the viewer has received everything.
    pub fn finish(self) {
        self.display.into_iter().for_each(Display::finish);
    }
}

impl Observer for DisplayObserver<'_> {
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
