//! Rotations as the programs write them.

use glam::{DMat3, DQuat};

/// w, x, y, z of a rotation, w not below 0.
pub(super) fn quaternion(rotation: &DMat3) -> [f64; 4] {
    let [x, y, z, w] = DQuat::from_mat3(rotation).to_array();
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    [w, x, y, z].map(|q| sign * q)
}
