//! Shared support of the flow tests.

use etendue_core::{Plane, quantity::OpticalFlow};

/// Plane of vectors, `width` per row.
pub(crate) fn flow(width: usize, vectors: &[[f32; 2]]) -> Plane<OpticalFlow> {
    Plane::from_samples(width, vectors.len() / width, vectors.to_vec()).expect("full rows")
}
