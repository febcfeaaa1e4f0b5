//! Geometry of cameras from images in closed form.

mod calibration;
mod cameras;
mod detection;
mod distortion;
mod frontal;
mod intervals;
mod opencv;
mod paint;
