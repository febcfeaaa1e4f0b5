//! The ends of every range: what a user expects there, why, and the figure that is found.
//!
//! Each area is a test that fails where a row does not hold, and writes or compares its part of docs/evidence/extremes.md:
//! `just extremes` writes the page, to which the tests of the program (`crates/cli/tests/binary/extremes.rs`) add what only the binary can show. Figures are those of one seed, so that they are the same
//! everywhere.

mod camera;
mod facets;
mod fog;
mod geometry;
mod instances;
mod inverses;
mod light;
mod numerics;
mod spreads;
