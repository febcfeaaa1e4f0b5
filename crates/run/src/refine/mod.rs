//! Light in passes: what is kept and refined after each, and how many there are where a time decides.
//!
//! - [`progress`] is what a progressive run does after a pass, on disk.
//! - [`state`] is what it keeps, from which an interrupted run resumes.
//! - [`timed`] renders for a given time.
//! - [`pace`] decides how large its next pass is.

mod pace;
pub(crate) mod progress;
pub(crate) mod state;
pub(crate) mod timed;

pub(crate) use progress::Progress;
