//! Rays of members, in mm, and what a member makes of one.

use crate::pupil::MM;
use etendue_core::ray::PupilRay;
use glam::DVec3;

/// A ray of a member, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) point_mm: DVec3,
    pub(crate) direction: DVec3,
}

/// What a member makes of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fate {
    /// It does not meet the member.
    Past,
    /// It ends: no light comes this way.
    Lost,
    /// It goes on here, with this factor on its weight.
    On(Line, f64),
}

pub(super) fn line(ray: &PupilRay) -> Line {
    Line { point_mm: ray.origin_m / MM, direction: ray.direction }
}

pub(super) fn outgoing(line: Line, weight_sr: f64) -> PupilRay {
    PupilRay { origin_m: line.point_mm * MM, direction: line.direction, weight_sr }
}
