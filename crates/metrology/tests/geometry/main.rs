//! The geometry of cameras from pictures in closed form.

mod calibration;
mod cameras;
mod detection;
mod distortion;
mod opencv;
mod paint;
