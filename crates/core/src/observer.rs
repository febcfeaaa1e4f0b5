//! How a caller watches and stops what takes long.

/// What is counted while the caller waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Tiles of a camera's light.
    Tiles,
    /// Pictures that are read and searched.
    Pictures,
    /// Ways to render that a study looks at.
    Pilots,
}

/// A frame among those of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FramePlace {
    /// The frame's number.
    pub number: u32,
    /// Its place in the run, from 1.
    pub place: u32,
    /// Frames of the run, those included that an earlier run has left.
    pub count: u32,
}

/// How far a task is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress<'a> {
    /// What is worked on: a camera's name, or what is sought.
    pub heading: &'a str,
    /// The frame that is worked on, where each has a light of its own.
    pub frame: Option<FramePlace>,
    /// What is counted.
    pub unit: Unit,
    /// How many are done, of all cameras and frames of the task.
    pub done: usize,
    /// Of how many.
    pub total: usize,
}

/// What the caller should know and is no error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Message<'a> {
    /// Something was decided for the user.
    Note(&'a str),
    /// The result is not, or may not be, what the user expects.
    Warning(&'a str),
}

/// A finished part of an image that is being made, to look at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageTile<'a> {
    /// The image's name: the camera's, with the frame where each has a light of its own.
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

/// What a task tells its caller, and asks of it. Called from worker threads.
pub trait Observer: Sync {
    /// The caller should know this.
    fn message(&self, _message: Message<'_>) {}

    /// The task got so far; at the end `done` is `total`.
    fn progress(&self, _progress: Progress<'_>) {}

    /// Whether the caller wants to look at light while it is gathered.
    fn wants_tiles(&self) -> bool {
        false
    }

    /// A tile of an image has been finished or refined, where the caller wants them. The task waits: whoever takes long does so elsewhere.
    fn tile(&self, _tile: &ImageTile<'_>) {}

    /// The caller's clock, s, from a moment of its choice on; `None`: it has none, and nothing is done by time.
    fn now_s(&self) -> Option<f64> {
        None
    }

    /// Whether the caller wants the task to stop.
    fn cancelled(&self) -> bool {
        false
    }
}

/// An observer that watches nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {}
