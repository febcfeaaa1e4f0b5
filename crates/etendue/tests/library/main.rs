//! Tests of the library through its public functions.

mod annotations;
mod dropped_effects;
mod errors;
mod examples;
mod far_times;
mod flicker;
mod progress;
mod rig;
mod scale;
