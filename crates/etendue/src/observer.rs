//! How a caller watches and stops what takes long.

/// What is counted while the caller waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Tiles of a camera's light.
    Tiles,
    /// Pictures that are read and searched.
    Pictures,
}

/// How far a task is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress<'a> {
    /// The task: a camera's name, or what is sought.
    pub heading: &'a str,
    /// What is counted.
    pub unit: Unit,
    /// How many are done.
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

/// What a task tells its caller, and asks of it. Called from worker threads.
pub trait Observer: Sync {
    /// The caller should know this.
    fn message(&self, _message: Message<'_>) {}

    /// The task got so far; at the end `done` is `total`.
    fn progress(&self, _progress: Progress<'_>) {}

    /// Whether the caller wants the task to stop.
    fn cancelled(&self) -> bool {
        false
    }
}

/// An observer that watches nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {}

/// The tiles of a camera's light, as the pipeline counts them.
pub(crate) struct Tiles<'a> {
    pub(crate) heading: &'a str,
    pub(crate) observer: &'a dyn Observer,
}

impl etendue_pipeline::Observer for Tiles<'_> {
    fn tiles(&self, done: usize, total: usize) {
        self.observer.progress(Progress { heading: self.heading, unit: Unit::Tiles, done, total });
    }

    fn cancelled(&self) -> bool {
        self.observer.cancelled()
    }
}
