//! What the tests of this folder share: a job written as text, compiled and rendered in memory, without any file.

mod job;
mod probe;
mod quad;
mod shot;

pub use job::Job;
pub use probe::{FLAT, ONE_BAND, eye, flat_per_lux};
pub use quad::quad;
pub use shot::{Samples, Shot};
