//! Lights: emitters, and light sampling from a point.
//!
//! # Contract
//! - [`Lights`] are those of one view: emissive triangles and spheres of its instances in the render frame, lamps, suns,
//!   and an environment. They are collected once and never change.
//! - [`Lights::sample`] samples a light and a direction towards it. Its `pdf` is by solid angle and includes the choice of
//!   the light. Exactly the same density is returned for light hit by chance, for multiple importance sampling:
//!   [`Lights::light_pdf`] for surfaces, [`Lights::distant`] for light at infinity.
//! - Every light except a uniform environment is sampled with a positive probability. A uniform environment is not sampled:
//!   no direction of it is better than the one that the surface prefers; its density is 0.
//! - Densities belong to a [`LightSampleContext`], the receiving point.
//! - Radiance is spectral, W·m⁻²·sr⁻¹·nm⁻¹.
//! - The caller states the time interval over which changing strengths are averaged, within the view's interval. A light that is
//!   dark throughout the view's interval is never sampled; other lights count in light selection with their level over it
//!   ([`crate::materials::selection_level`]).

mod collect;
mod environment;
mod gloss;
pub mod head_lamp;
mod lamp;
mod lamp_along_ray;
mod light;
mod light_sample;
mod light_sampler;
mod moving;
mod near;
mod opening;
mod opening_light;
mod patches;
mod power;
mod profile;
mod scene_lights;
mod sky;
mod sphere;
mod sun;
pub mod sun_position;
mod surface;
mod tree;
mod triangle;

use light::Light;
use surface::{ROUNDING, SurfaceEmission, SurfaceSample, solid_angle_pdf};

pub use crate::MAX_LIGHT_VALUE;
pub use collect::LightError;
pub use environment::{Environment, EnvironmentError, ImageEnvironment};
pub use gloss::ReceiverGloss;
pub use lamp::{Lamp, LampError};
pub use light_sample::{DistantLight, LightHit, LightSample, LightSampleContext};
pub use opening::{Opening, OpeningBody, OpeningError};
pub use power::spectral_fluxes;
pub use profile::{
    Cone, ConeError, MaskImage, MaskImageError, MaskedProfile, PhotometricAxes, PhotometricGrid, PhotometricGridError,
    Profile,
};
pub use scene_lights::{LightCounts, Lights, Sources};
pub use sky::SkyEnvironment;
pub use sun::{SUN_ANGULAR_DIAMETER_DEG, Sun, SunError};

pub(crate) use lamp_along_ray::RaySegment;
