//! Media that light travels through: fog, haze, spray, smoke.
//!
//! A [`Medium`] fills a part of the world; [`Media`] are all those of a view. Rays query them for the next scattering point and for the
//! transmittance. The coefficients of overlapping media add. Media fill the space that objects leave free and pass through thin panes; solids of
//! glass or water displace them.
//!
//! Distances are sampled by delta tracking (Woodcock et al. 1965) of all wavelengths together, with the probabilities of Kutz et al. ("Spectral and
//! decomposition tracking", 2017). Transmittance is exact for uniform density, and otherwise estimated by ratio tracking (Novák et al. 2014).

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
pub use medium::{DensityVariation, ForwardPeak, Medium, MediumError};
pub use noise::Noise;
pub use phase::Phase;
pub use phase_table::SpectralTable;
pub use shape::{HollowPart, HollowRegion, MediumRegion};

pub(crate) use media::RaySpan;
#[cfg(test)]
pub(crate) use solid::cuboid;
pub use solid::{Solid, SolidError};
