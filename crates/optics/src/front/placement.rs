//! Placement of a member of the front, rays to it and from it, and its wavelength-dependent quantities.

use core::f64::consts::PI;

use etendue_core::{maths::f64::sin_cos, ray::PupilRay};
use etendue_spectra::Spectrum;
use glam::{DMat3, DVec3};

use crate::pupil::MM;

/// A local frame within the camera frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Its origin in the camera frame, mm.
    pub origin_mm: DVec3,
    /// Rotation from the local frame to the camera frame.
    pub rotation: DMat3,
}

impl Placement {
    /// A rotated frame: initially parallel to the camera frame, it is rotated right-handed about the camera's x, then its y, then its z axis,
    /// degrees.
    #[must_use]
    pub fn with_rotation_deg(origin_mm: DVec3, degrees: [f64; 3]) -> Self {
        let [(sx, cx), (sy, cy), (sz, cz)] = degrees.map(|d| sin_cos(d * PI / 180.0));
        let x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
        let y = DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
        let z = DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
        Self { origin_mm, rotation: z * y * x }
    }

    pub(super) fn inward(&self, line: MemberRay) -> MemberRay {
        let back = self.rotation.transpose();
        MemberRay { point_mm: back * (line.point_mm - self.origin_mm), direction: back * line.direction }
    }

    pub(super) fn outward(&self, line: MemberRay) -> MemberRay {
        MemberRay {
            point_mm: self.rotation * line.point_mm + self.origin_mm,
            direction: self.rotation * line.direction,
        }
    }
}

/// A ray in a member's frame, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MemberRay {
    pub(crate) point_mm: DVec3,
    pub(crate) direction: DVec3,
}

/// Result of a ray's interaction with a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RayOutcome {
    /// The ray misses the member.
    Missed,
    /// The ray ends: no light comes along it.
    Absorbed,
    /// The ray continues here, with this factor on its weight.
    Transmitted(MemberRay, f64),
}

pub(super) fn line(ray: &PupilRay) -> MemberRay {
    MemberRay { point_mm: ray.origin_m / MM, direction: ray.direction }
}

pub(super) fn outgoing(line: MemberRay, weight_sr: f64) -> PupilRay {
    PupilRay { origin_m: line.point_mm * MM, direction: line.direction, weight_sr }
}

/// A ray that leaves the front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontRay {
    /// The ray from the last surface it met, camera frame.
    pub ray: PupilRay,
    /// Offset from a distance along `ray` to the ground-truth distance, m: see [`FrontRay::truth_origin_m`].
    pub path_m: f64,
    /// The point where it met a mirror, camera frame, m.
    pub mirror_m: Option<DVec3>,
}

impl FrontRay {
    /// A ray with nothing in front of the lens.
    #[must_use]
    pub fn without_front(ray: PupilRay) -> Self {
        Self { ray, path_m: 0.0, mirror_m: None }
    }

    /// Origin of the ray in the ray table: the mirror point; else the point from which distances count.
    #[must_use]
    pub fn truth_origin_m(&self) -> DVec3 {
        self.mirror_m.unwrap_or(self.ray.origin_m - self.ray.direction * self.path_m)
    }
}

/// A quantity that is exactly constant over wavelength, or tabulated.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// The same at all wavelengths.
    Constant(f64),
    /// Tabulated.
    Table(Box<Spectrum>),
}

impl Curve {
    /// Its value at a wavelength, nm.
    #[inline]
    #[must_use]
    pub fn at(&self, nm: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(spectrum) => f64::from(spectrum.at(nm as f32)),
        }
    }

    /// True if it depends on the wavelength.
    #[must_use]
    pub fn varies(&self) -> bool {
        matches!(self, Self::Table(spectrum) if spectrum.min_value() != spectrum.max_value())
    }

    /// Smallest and largest value.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        match self {
            Self::Constant(value) => (*value, *value),
            Self::Table(spectrum) => (f64::from(spectrum.min_value()), f64::from(spectrum.max_value())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_positive_turn_about_x_leans_the_upper_edge_towards_the_camera() {
        let placement = Placement::with_rotation_deg(DVec3::new(0.0, 0.0, 500.0), [30.0, 0.0, 0.0]);
        let upper = placement.outward(MemberRay { point_mm: DVec3::new(0.0, -100.0, 0.0), direction: DVec3::Z });
        // y is down: the upper edge lies at 500 − 100 sin 30° and its normal points up.
        assert!((upper.point_mm.z - 450.0).abs() < 1e-12 && (upper.direction.y + 0.5).abs() < 1e-15);
        let back = placement.inward(upper);
        assert!((back.point_mm - DVec3::new(0.0, -100.0, 0.0)).length() < 1e-12);
    }

    #[test]
    fn a_positive_turn_about_y_looks_to_the_right() {
        let placement = Placement::with_rotation_deg(DVec3::ZERO, [0.0, 20.0, 0.0]);
        assert!((placement.rotation * DVec3::Z).x > 0.3);
        assert!((placement.rotation.determinant() - 1.0).abs() < 1e-15);
    }
}
