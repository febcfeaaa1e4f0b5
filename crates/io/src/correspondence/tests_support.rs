//! What tests of flow share.

use etendue_core::{Plane, quantity::OpticalFlow};

/// A plane of vectors, `width` a row.
pub(crate) fn flow(width: usize, vectors: &[[f32; 2]]) -> Plane<OpticalFlow> {
    Plane::from_samples(width, vectors.len() / width, vectors.to_vec()).expect("full rows")
}
