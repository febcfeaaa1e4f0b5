//! Cameras: from the light on a film to irradiance, electrons, digital numbers and pictures.
//!
//! # Contract
//! - [`photograph`] conducts the stages: the effects behind the lens, exposure, the sensor's frames, their development.
//! - [`stored`], [`defocus`] and `rectified` put a lens before stored radiance, or another camera in a camera's place.
//! - `disk_light` does for films on the disk what [`photograph`] does for those in memory.
//! - [`flat`] and [`light_meter`] are closed forms for even light: nothing is traced.
//! - [`datasheet`] makes a camera file of an EMVA 1288 data sheet.

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
