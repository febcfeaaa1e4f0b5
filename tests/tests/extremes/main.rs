//! The ends of every range: what a user expects there, why, and the figure that is found.
//!
//! Each area is a test that fails where a row does not hold, and writes or compares its part of docs/extremes.md:
//! `ETENDUE_BLESS=1 cargo test -p etendue-tests --test extremes` (`just extremes`) writes the page. Figures are those of one seed, so that they are the same
//! everywhere.

mod camera;
mod geometry;
mod inverses;
mod light;
mod numerics;
mod page;
