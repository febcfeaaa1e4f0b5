//! What a run that fails, is cancelled or panics leaves in its folder: told to the caller on the way out.

use crate::film_names::holds_state;
use etendue_core::observer::{Message, Observer};
use etendue_io::OutputFolder;
use std::cell::Cell;
use std::path::PathBuf;

/// Tells what was kept when it is dropped before all is; panics on their way through are no exception.
pub(crate) struct Kept<'a> {
    root: PathBuf,
    observer: &'a dyn Observer,
    /// Frames of cameras that have their files.
    frames: Cell<usize>,
    is_all: Cell<bool>,
}

impl<'a> Kept<'a> {
    /// Of a run that writes into a folder from now on.
    pub(crate) fn of_run(folder: &OutputFolder, observer: &'a dyn Observer) -> Self {
        Self { root: folder.path().to_path_buf(), observer, frames: Cell::new(0), is_all: Cell::new(false) }
    }

    /// A frame of a camera has its files.
    pub(crate) fn frame(&self) {
        self.frames.set(self.frames.get() + 1);
    }

    /// All has been written.
    pub(crate) fn all(&self) {
        self.is_all.set(true);
    }

    fn told(&self) -> String {
        let frames = match self.frames.get() {
            0 => None,
            1 => Some("1 frame that is whole".to_owned()),
            n => Some(format!("{n} frames that are whole")),
        };
        let light = holds_state(&self.root).then(|| "the light of the last whole pass".to_owned());
        let kept: Vec<String> = frames.into_iter().chain(light).collect();
        let folder = self.root.display();
        match kept.is_empty() {
            true => format!("{folder}: nothing of this run was kept"),
            false => format!(
                "{folder}: kept {}; with `resume` in the place of `overwrite` a run goes on",
                kept.join(" and ")
            ),
        }
    }
}

impl Drop for Kept<'_> {
    fn drop(&mut self) {
        if !self.is_all.get() {
            self.observer.message(Message::Note(&self.told()));
        }
    }
}
