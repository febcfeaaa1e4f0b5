//! Tests of the library through its public functions.

mod annotations;
mod dropped_effects;
mod examples;
mod far_times;
mod faults;
mod flicker;
mod panics;
mod progress;
mod rig;
mod scale;
