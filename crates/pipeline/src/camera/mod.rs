//! Cameras: from the light on a film to irradiance, electrons, digital numbers and images.
//!
//! # Contract
//! - [`photograph`] runs the stages: effects behind the lens, exposure, the sensor's frames, their processing.
//! - [`stored`], [`defocus`] and `rectified` apply a lens to stored radiance, or replace a camera by another.
//! - `disk_light` does the same for films on disk as [`photograph`] for those in memory.
//! - [`flat`] and [`light_meter`] are closed forms for uniform light: nothing is traced.
//! - [`datasheet`] makes a camera file from an EMVA 1288 data sheet.

mod behind_lens;
pub mod datasheet;
pub mod defocus;
mod disk_light;
mod effects;
pub mod flat;
mod light;
pub mod light_meter;
pub mod photograph;
mod plane_cube;
mod rectified;
pub mod sampling;
pub mod stored;
pub mod weather;
