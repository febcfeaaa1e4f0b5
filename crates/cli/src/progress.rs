//! Progress on a terminal, and stopping at Ctrl-C by the operating system's own way.

use etendue_pipeline::Observer;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar of tiles on stderr; drawn only where stderr is a terminal.
pub struct TileBar(ProgressBar);

impl TileBar {
    /// A bar with a heading, not yet drawn.
    pub fn new(heading: &str) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{prefix} {wide_bar} {pos}/{len} tiles, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_prefix(heading.to_owned());
        Self(bar)
    }

    /// Takes the bar off the terminal.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

/// A bar of pictures read, on stderr; drawn only where stderr is a terminal.
pub struct PictureBar(ProgressBar);

impl PictureBar {
    /// A bar of so many pictures.
    pub fn new(heading: &str, count: usize) -> Self {
        let bar = ProgressBar::with_draw_target(Some(count as u64), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{prefix} {wide_bar} {pos}/{len} pictures, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_prefix(heading.to_owned());
        Self(bar)
    }

    /// One more picture is read.
    pub fn step(&self) {
        self.0.inc(1);
    }

    /// Takes the bar off the terminal.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

impl Observer for TileBar {
    fn tiles(&self, done: usize, total: usize) {
        self.0.set_length(total as u64);
        self.0.set_position(done as u64);
    }

    fn cancelled(&self) -> bool {
        false
    }
}
