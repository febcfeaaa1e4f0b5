//! Media that light travels through: fog, haze, spray, smoke.
//!
//! A [`Medium`] says what a part of the world is filled with; [`Media`] are all of a view, asked along rays: where a ray is next scattered,
//! and what share of light comes through. Where several lie in one another their coefficients add. They fill what objects leave free and
//! pass through thin panes; solids of glass or water displace them.
//!
//! Distances are drawn by delta tracking (Woodcock et al. 1965) of all wavelengths together, with the chances of Kutz et al. ("Spectral and
//! decomposition tracking", 2017); transmittance is exact where the density is even, and estimated by ratio tracking (Novák et al. 2014) where it is not.

mod collide;
#[allow(clippy::module_inception)]
mod media;
mod medium;
mod noise;
mod phase;
mod phase_table;
mod shape;
mod solid;

pub use collide::{Collision, FlightRandom};
pub use media::{Media, MediaRay, RandomCounter};
pub use medium::{ForwardPeak, Medium, MediumError, Unevenness};
pub use noise::Noise;
pub use phase::Phase;
pub use phase_table::SpectralTable;
pub use shape::{Hollow, HollowPart, Shape};

pub(crate) use media::RaySpan;
#[cfg(test)]
pub(crate) use solid::cuboid;
pub use solid::{Solid, SolidError};
