//! Brute-force and conservation oracles for tests.
//!
//! | module | content |
//! | --- | --- |
//! | [`judge`] | comparison of an estimated image with a closed form |
//! | [`form_factor`] | irradiance from spheres and polygons, and behind a round, optionally clipped, pupil; integrals by direct sums |
//! | [`page`] | docs/evidence/extremes.md: its content and checks |
//! | [`skip`] | count of tests whose files are missing |
//!
//! Nothing here shares code with the tested crates, except the vocabulary and the elementary functions of `core`.

pub mod form_factor;
pub mod judge;
pub mod page;
pub mod skip;
