//! The point that asks for light.

use glam::Vec3;

/// A point that light is drawn for. Its normal lets lights be passed over that cannot reach it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSampleContext {
    /// Where it is, render frame, m.
    pub position: Vec3,
    /// The unit normal that light must come from the side of: the shading normal on the side of the viewer. Zero where
    /// light counts from every side.
    pub normal: Vec3,
}
