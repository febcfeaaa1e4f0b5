//! Keys that may be left out.

use etendue_scene::Placed;

/// A key's number, or what stands for its absence.
pub(super) fn or(key: Option<&Placed<f64>>, default: f64) -> f64 {
    key.map_or(default, |k| k.value)
}
