//! Cameras: from the light on a film to irradiance, electrons, digital numbers and pictures.
//!
//! # Contract
//! - [`photograph`] conducts the stages: the effects behind the lens, exposure, the sensor's frames, their development.
//! - [`stored`], [`defocus`] and [`rectified`] put a lens before stored radiance, or another camera in a camera's place.
//! - [`flat`] and [`light_meter`] are closed forms for even light: nothing is traced.
//! - [`datasheet`] makes a camera file of an EMVA 1288 data sheet; [`raw_colour`] states what a raw reader has to know.

pub mod datasheet;
pub mod defocus;
mod effects;
pub mod flat;
pub mod light_meter;
pub mod photograph;
pub mod raw_colour;
pub mod rectified;
pub mod sampling;
pub mod stored;
pub mod weather;
