//! From images to camera parameters, each with its uncertainty.
//!
//! Operates on images only, rendered or captured: this crate is independent of the tracer, the sensor model and file formats.
//! Positions are raster coordinates: pixel centres at +0.5, x to the right, y down, from the top left corner. All arithmetic is
//! `f64`, in the order of the pixels, with the functions of `etendue_core::maths`: bit-identical on all platforms.

pub mod calibrate;
pub mod chromatic;
pub mod colour;
pub mod contrast;
#[cfg(test)]
mod coverage;
pub mod depth;
pub mod distortion;
pub mod estimate;
pub mod fit;
pub mod flare;
pub mod flicker;
mod fourier;
pub mod linear;
pub mod noise;
pub mod oecf;
pub mod patch_statistics;
pub mod photon_transfer;
pub mod sfr;
pub mod shading;
pub mod target;
pub mod texture;

pub use estimate::Estimate;
pub use patch_statistics::{Image, Reading};
