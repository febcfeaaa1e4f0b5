//! What the tests of this folder share: a job written as text, compiled and rendered in memory, without any file.

mod job;
mod shot;

pub use job::Job;
pub use shot::{Samples, Shot};
