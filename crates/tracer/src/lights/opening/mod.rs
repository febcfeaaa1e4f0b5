//! The luminous opening of a lamp: a body about the lamp's position whose surface emits the lamp's intensity.
//!
//! # Contract
//! - The far field stays the lamp's. The radiance along ω is L(ω) = I(ω) / A(ω), the same at every point of the opening, with A
//!   the area of the opening as seen from that direction. Left out is the structure of the near field: single LEDs, filaments
//!   and reflectors within the opening.
//! - A flat opening emits from both sides, a body outwards, wherever the intensity is positive. No flux is lost, except by flat
//!   openings within a cosine of 10⁻³ towards their plane: there A(ω) is at least that fraction of the face, so that radiance is
//!   bounded. [`Opening::lost_fraction`] returns the loss. Lamps that lose more than a hundredth are refused.
//! - Rays hit a mesh of flat facets ([`Opening::mesh`]) or a sphere that its instance stretches. Light
//!   samples lie on the same surface, and A(ω) is that of the mesh, except for the side of round bodies: the silhouette of their
//!   48 sides has the circle's width in the mean over directions and differs from it by at most 1.5·10⁻³.

mod body;
mod facets;
mod mesh;

#[cfg(test)]
mod tests;

pub use body::{Opening, OpeningBody, OpeningError};

pub(super) use facets::{FacetSample, OpeningFacets};
