//! Changes of a job's keys, as `--set` takes them.

use crate::plan::CameraPlan;

/// The value that takes a key out.
pub(super) const REMOVED: &str = "null";

/// A change of a key of a camera: of `lens.distortion`, `render.caustics` …
pub(super) fn of_camera(camera: &CameraPlan, key: &str, value: &str) -> String {
    // A dot in a name would end it.
    let is_plain = !camera.name.contains(['.', '=']);
    let entry = if is_plain { camera.name.clone() } else { camera.index.to_string() };
    format!("cameras.{entry}.{key}={value}")
}

/// Takes a key of a camera out.
pub(super) fn without(camera: &CameraPlan, key: &str) -> String {
    of_camera(camera, key, REMOVED)
}
