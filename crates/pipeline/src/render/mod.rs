//! Rendering: from a plan to the light of a camera, tile by tile.
//!
//! # Contract
//! - [`light`](light()) renders one camera of a plan and returns a [`film::Film`]: spectral irradiance (W·m⁻²·nm⁻¹) or mean
//!   electrons per second through the lens, spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) on the pupil route, with the variance of the means.
//! - Bands of a film that is too large for memory are in a scratch file ([`tiled_cube`]).
//! - [`adaptive`] determines the number of samples of a pixel in noise-limited sampling.
//! - [`motion`] is the ground truth of motion: optical flow, scene flow, disparity.
//! - [`boxes`] are the boxes of objects, in the image and in space.
//! - [`truth`], [`rays`] and [`pupil_depth`] are point-sampled separately, along principal rays.
//! - [`identity_coverage`] is the coverage of each pixel by objects.
//! - [`weather_layers`] are the effects of media, drops and flakes on each pixel.
//! - Every pixel has one owner and its own random address: the result does not depend on threads, tiles or shards.
//! - Work runs on the caller's rayon pool, under the caller's [`observer::Observer`].

pub mod adaptive;
pub(crate) mod band_views;
pub mod boxes;
mod camera_light;
#[cfg(test)]
mod disk_tests;
#[cfg(test)]
mod displaced_tests;
pub mod exposure;
pub mod film;
pub mod frame_view;
pub mod gather;
pub mod identity_coverage;
pub mod light;
mod look_at;
pub mod mosaic;
pub mod motion;
mod near_precipitation;
pub mod noise_reached;
pub mod observer;
#[cfg(test)]
mod pass_tests;
pub mod pupil_depth;
pub mod rays;
mod surrounded;
#[cfg(test)]
mod test_job;
#[cfg(test)]
mod test_scenes;
pub mod tile_bands;
pub mod tiled_cube;
pub mod training;
pub mod truth;
mod wavelength_numbers;
pub mod weather_layers;

pub use camera_light::{FilmStorage, LightRequest, change_over, light, light_counts, pass};
pub use exposure::FrameCapture;
pub use light::RenderError;
pub(crate) use near_precipitation::region_of_projection;
pub(crate) use surrounded::surrounding_object;
