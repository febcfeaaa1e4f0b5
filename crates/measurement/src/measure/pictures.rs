//! Counting the pictures that a measurement reads.

use etendue_core::observer::{Observer, Progress, Unit};
use std::sync::atomic::{AtomicUsize, Ordering};

/// So many pictures, read by several threads.
pub(crate) struct Pictures<'a> {
    pub(crate) heading: &'a str,
    pub(crate) done: AtomicUsize,
    pub(crate) total: usize,
    pub(crate) observer: &'a dyn Observer,
}

impl Pictures<'_> {
    /// One more is read.
    pub(crate) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.observer.progress(Progress {
            heading: self.heading,
            frame: None,
            unit: Unit::Pictures,
            done,
            total: self.total,
        });
    }
}
