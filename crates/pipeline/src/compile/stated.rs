//! Numbers of optional keys, and those that all kinds of lenses state in the same way.

use etendue_scene::Placed;
use etendue_scene::record::lens as description;

pub(super) fn transmittance(value: Option<&Placed<f64>>) -> f64 {
    value.map_or(1.0, |t| t.value)
}

pub(super) fn focus_m(focus: &description::FocusDistance) -> f64 {
    match focus {
        description::FocusDistance::Metres(m) => m.value,
        description::FocusDistance::Infinity => f64::INFINITY,
    }
}

/// Number of a key, or the default if it is absent.
pub(super) fn value_or(key: Option<&Placed<f64>>, default: f64) -> f64 {
    key.map_or(default, |k| k.value)
}
