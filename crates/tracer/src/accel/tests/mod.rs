//! Tests of the accelerator against closed forms and brute force.

mod agreement;
mod deforming;
mod degenerate;
mod motion;
mod needles;
pub(crate) mod shapes;
mod ties;
mod watertight;
