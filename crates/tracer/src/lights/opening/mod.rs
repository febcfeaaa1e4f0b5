//! The luminous opening of a lamp: a body about the lamp's place whose surface shines as the lamp's intensity says.
//!
//! # Contract
//! - The far field stays the lamp's: leaving along ω, radiance is L(ω) = I(ω) / A(ω), the same at every point of the opening, with A
//!   the area of the opening as seen from that direction. What is left out is the near field's own structure: single LEDs, filaments
//!   and reflectors within the opening.
//! - A flat opening shines to both sides, a body outwards, as far as the intensity has light there. So no flux is lost, but of flat
//!   openings within a cosine of 10⁻³ towards their plane, where A(ω) is not taken for less than that share of the face. Radiance is so
//!   bounded; [`Opening::lost_share`] tells what is lost, and lamps that lose more than a hundredth are refused.
//! - The surface that rays meet is a mesh of flat facets ([`Opening::mesh`]) or a sphere that its instance stretches. What light
//!   sampling draws lies on that very surface, and A(ω) is that of the mesh but for the side of round bodies: the silhouette of their
//!   48 sides has the circle's width in the mean over directions and differs from it by at most 1.5·10⁻³.

mod body;
mod facets;
mod mesh;

#[cfg(test)]
mod tests;

pub use body::{Opening, OpeningBody, OpeningError};

pub(super) use facets::{FacetSample, Facets};
