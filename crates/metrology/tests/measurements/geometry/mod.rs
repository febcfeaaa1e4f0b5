//! The geometry of cameras from pictures in closed form.

mod calibration;
mod cameras;
mod detection;
mod distortion;
mod frontal;
mod intervals;
mod opencv;
mod paint;
