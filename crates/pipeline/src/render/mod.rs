//! Rendering: from a plan to the light of a camera, tile by tile.
//!
//! # Contract
//! - [`light`](light()) renders one camera of a plan and answers with a [`film::Film`]: spectral irradiance (W·m⁻²·nm⁻¹) or mean
//!   electrons a second through the lens, spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) on the route at the pupil, with the variance of the means.
//! - Bands of a film that is too large for memory are in a scratch file ([`tiled_cube`]).
//! - [`adaptive`] decides how many samples a pixel gets, where noise does.
//! - [`motion`] is the ground truth of what moves: optical flow, scene flow, disparity.
//! - [`boxes`] are those of objects, in the picture and in space.
//! - [`truth`], [`rays`] and [`pupil_depth`] are point-sampled beside it, along principal rays.
//! - [`identity_coverage`] is which objects a pixel sees, and how much of it each covers.
//! - [`weather_layers`] are what media, drops and flakes do to each pixel.
//! - Every pixel has one owner and its own random address: the result depends on neither threads, nor tiles, nor shards.
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
mod heroes;
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
pub mod weather_layers;

pub use camera_light::{FilmKeeping, Request, change_over, light, light_counts, pass};
pub use exposure::Shot;
pub use light::GatherError;
pub(crate) use near_precipitation::region_of_projection;
pub(crate) use surrounded::surrounding_object;
