//! The path tracer: spectral radiance along a ray.
//!
//! Unidirectional paths from the camera (Kajiya 1986). At each vertex a light is drawn and asked (next-event
//! estimation; at the first surface several where paths branch), then the surface draws where the path goes on; light found in both ways is weighed by its densities
//! (multiple importance sampling). Paths end at random by what is left of what they carried (Russian roulette), which
//! leaves the mean unchanged. Nothing is clamped.
//!
//! `max_bounces` is the greatest number of scattering events between a light and the camera: 0 shows only what
//! glows, 1 adds direct light, 2 light that was scattered twice. Beside the filtering of textures it is the only bias, and it is
//! darkness.
//!
//! All wavelengths of a path share its directions, drawn by densities common to them.

mod branching;
mod carried;
mod caustic;
mod cone;
mod direct;
mod effects;
mod guided;
mod level;
mod medium;
mod met_light;
mod mis;
mod path;
mod path_tracer;
mod radiance;
mod regularize;
mod roulette;
mod scatter_at_particle;
mod scatter_in_medium;
mod settings;
mod shadow;
mod shared;
mod surroundings;

#[cfg(test)]
mod tests;

pub use level::Level;
pub use mis::Strategies;
pub use path_tracer::PathTracer;
pub use radiance::SpectralPaths;
pub use settings::{LightSampling, PathSettings};
pub use surroundings::Surroundings;
