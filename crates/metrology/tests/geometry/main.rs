//! The geometry of cameras from pictures in closed form.

mod cameras;
mod detection;
mod paint;
