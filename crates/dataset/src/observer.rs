//! Observer that passes the progress of one sample on to the observer of the whole set.

use etendue::{ImageTile, Message, Observer, Progress};

/// Work of one sample as a part of all.
pub(crate) struct SampleObserver<'a> {
    pub(crate) all: &'a dyn Observer,
    /// Number of finished samples, and total.
    pub(crate) done: usize,
    pub(crate) total: usize,
    /// Number of the sample.
    pub(crate) sample: u32,
    /// True if notes are passed on: they are the same for most samples. Warnings always are, with the sample's number.
    pub(crate) tells: bool,
}

impl Observer for SampleObserver<'_> {
    fn message(&self, message: Message<'_>) {
        match message {
            Message::Note(_) if self.tells => self.all.message(message),
            Message::Note(_) => {}
            Message::Warning(warning) => {
                self.all.message(Message::Warning(&format!("sample {}: {warning}", self.sample)));
            }
        }
    }

    fn progress(&self, progress: Progress<'_>) {
        let heading = format!("sample {}, {}", self.sample, progress.heading);
        let done = self.done * progress.total + progress.done;
        self.all.progress(Progress { heading: &heading, done, total: self.total * progress.total, ..progress });
    }

    fn wants_tiles(&self) -> bool {
        self.all.wants_tiles()
    }

    fn tile(&self, tile: &ImageTile<'_>) {
        self.all.tile(tile);
    }

    fn now_s(&self) -> Option<f64> {
        self.all.now_s()
    }

    fn cancelled(&self) -> bool {
        self.all.cancelled()
    }
}
