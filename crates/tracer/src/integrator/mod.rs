//! The path tracer: spectral radiance along a ray.
//!
//! Unidirectional paths from the camera (Kajiya 1986). At each vertex a light is sampled (next-event
//! estimation; at the first surface several where paths branch), then the BSDF samples where the path continues; light found in both ways is weighted by
//! its densities (multiple importance sampling). Paths end at random by what is left of their throughput (Russian roulette), which
//! leaves the mean unchanged. Nothing is clamped.
//!
//! `max_bounces` is the greatest number of scattering events between a light and the camera: 0 shows only what
//! emits, 1 adds direct light, 2 light that was scattered twice. Beside the filtering of textures it is the only bias, and it is
//! darkness.
//!
//! All wavelengths of a path share its directions, drawn by densities common to them.
//!
//! | file | subject |
//! | --- | --- |
//! | `settings` | settings, and the weights of multiple importance sampling |
//! | `path_tracer` | view, materials, lights; which effects paths are compiled for |
//! | `radiance` | entry points: a ray, a group of rays, the training of a guide |
//! | `path` | the algorithm, from the camera to Russian roulette |
//! | `surface` | the surface at a vertex: textures, frame, BSDF, densities |
//! | `direct_light` | sampled lights and shadow rays |
//! | `participating_media` | scattering in media, at drops and at flakes |
//! | `path_state` | footprint, scattering history, roulette, medium of a path |
//! | `path_reuse` | paths of neighbouring pixels that share their tails |

mod direct_light;
mod participating_media;
mod path;
mod path_reuse;
mod path_state;
mod path_tracer;
mod radiance;
mod settings;
mod surface;

#[cfg(test)]
mod tests;

pub use path_tracer::{PathTracer, Surroundings};
pub use radiance::SpectralPaths;
pub use settings::{PathSettings, Strategies};
