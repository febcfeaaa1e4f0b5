//! The geometry of cameras from pictures in closed form.

mod calibration;
mod cameras;
#[path = "../../src/coverage.rs"]
mod coverage;
mod detection;
mod distortion;
#[path = "../intervals/draws.rs"]
mod draws;
mod frontal;
mod intervals;
mod opencv;
mod paint;

use etendue_metrology::Estimate;
