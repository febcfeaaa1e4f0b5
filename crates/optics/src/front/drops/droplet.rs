//! A drop by its place and size.

use glam::DVec2;

/// A drop on the glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Droplet {
    /// Its middle in the glass's frame, x to the right, y down, mm.
    pub centre_mm: DVec2,
    /// Radius of its base, mm.
    pub radius_mm: f64,
}
