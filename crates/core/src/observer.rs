//! Observer: lets a caller watch and stop long tasks.

/// Unit in which progress is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgressUnit {
    /// Tiles of a camera's render.
    Tiles,
    /// Images that are read and searched.
    Images,
    /// Render configurations that a study tests.
    Pilots,
}

/// Place of a frame in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FramePlace {
    /// Frame number.
    pub number: u32,
    /// Position in the run, from 1.
    pub place: u32,
    /// Frames of the run, including those left by an earlier run.
    pub count: u32,
}

/// Progress of a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress<'a> {
    /// Subject of the work: a camera's name, or what is searched for.
    pub heading: &'a str,
    /// Frame in progress, if each frame is rendered separately.
    pub frame: Option<FramePlace>,
    /// Unit of the count.
    pub unit: ProgressUnit,
    /// Number done, over all cameras and frames of the task.
    pub done: usize,
    /// Total number.
    pub total: usize,
}

/// Information for the caller that is no error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Message<'a> {
    /// A choice was made for the user.
    Note(&'a str),
    /// The result differs, or may differ, from what the user expects.
    Warning(&'a str),
}

/// Finished part of an image that is being rendered, for display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageTile<'a> {
    /// Image name: the camera's, with the frame if each frame is rendered separately.
    pub image: &'a str,
    /// Columns and rows of the image.
    pub size_px: [u32; 2],
    /// First column and row of the tile.
    pub first_px: [u32; 2],
    /// Columns and rows of the tile.
    pub tile_px: [u32; 2],
    /// `R`, `G`, `B`: radiance in linear sRGB, (1, 1, 1) at 1 cd/m²; or `Y`: mean electrons of the exposure.
    pub channels: &'static [&'static str],
    /// The values of each channel, row by row, one channel after the other.
    pub values: &'a [f32],
}

/// Reports of a task to its caller, and requests of the caller. Called from worker threads.
pub trait Observer: Sync {
    /// Receives a note or a warning.
    fn message(&self, _message: Message<'_>) {}

    /// Receives the progress; at the end `done` is `total`.
    fn progress(&self, _progress: Progress<'_>) {}

    /// Returns true if the caller displays the image while it is rendered.
    fn wants_tiles(&self) -> bool {
        false
    }

    /// Receives a finished or refined tile of an image, if the caller wants tiles. The task waits, so slow work belongs on another thread.
    fn tile(&self, _tile: &ImageTile<'_>) {}

    /// Caller's clock, s, from an arbitrary origin; `None`: there is no clock, and nothing depends on time.
    fn now_s(&self) -> Option<f64> {
        None
    }

    /// Returns true if the task shall stop.
    fn cancelled(&self) -> bool {
        false
    }
}

/// An observer that watches nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct NullObserver;

impl Observer for NullObserver {}
