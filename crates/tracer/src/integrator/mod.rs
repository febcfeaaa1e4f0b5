//! The path tracer: spectral radiance along a ray.
//!
//! Unidirectional paths from the camera (Kajiya 1986). At each vertex a light is sampled (next-event estimation; several lights at the first surface
//! if paths branch). Then the BSDF samples the direction in which the path continues. Light that both strategies find is weighted by their densities
//! (multiple importance sampling). Paths end at random by their remaining throughput (Russian roulette), which leaves the mean unchanged. Nothing is
//! clamped.
//!
//! `max_bounces` is the maximum number of scattering events between a light and the camera: 0 shows only emission, 1 adds direct light, 2 adds light
//! that was scattered twice. Together with the filtering of textures it is the only bias, and it darkens the image.
//!
//! All wavelengths of a path share its directions, which are sampled by densities common to them.
//!
//! | file | subject |
//! | --- | --- |
//! | `settings` | settings, and the weights of multiple importance sampling |
//! | `path_tracer` | view, materials, lights; effects that paths are compiled for |
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
