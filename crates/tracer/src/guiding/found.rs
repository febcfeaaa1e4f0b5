//! What training paths found at one place.

use super::distribution::BINS;

/// What was found in the directions of one bin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// Sum of squares of radiance.
    pub(super) squares: f64,
    /// Paths.
    pub(super) paths: f64,
}

/// What was found at one place.
pub(super) type FoundByBin = [Found; BINS];
