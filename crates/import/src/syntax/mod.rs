//! Syntax of other programs' files: directives, elements and prims, each with its place.

pub mod mitsuba;
pub mod pbrt;
#[cfg(feature = "usd")]
pub mod usd;
