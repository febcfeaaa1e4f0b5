//! Where a line meets a mirror.

use glam::DVec3;

/// A point of a mirror's surface in its frame, and the normal of the reflecting side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::front) struct Touch {
    pub(super) point_mm: DVec3,
    /// The normal of the surface itself, which tells the sides apart.
    pub(super) facing: DVec3,
    /// The normal by which it reflects: of a mesh the smooth one.
    pub(super) normal: DVec3,
}
