//! Models symmetric about the axis: an increasing function r(θ) from the field angle to the radius in the image plane, up to the edge of the field.
//!
//! dΩ/dA = sin θ dθ/(r dr), which is 1/(dr/dθ)² on the axis.

use core::f64::consts::{FRAC_PI_2, PI};

use etendue_core::maths::f64::{atan2, sin, sin_cos};
use glam::{DVec2, DVec3};

use crate::plane::{Affine, Distortion};

/// The edge of a model's field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldEdge {
    /// The exclusive limit of the field angle (from the axis), rad.
    pub angle_rad: f64,
    /// True if the image folds there: the fitted function turns back and is undefined beyond. Otherwise the formula or the calibration ends.
    pub folds: bool,
}

impl FieldEdge {
    /// The whole sphere except the point behind the camera.
    pub(crate) const SPHERE: Self = Self::end(PI);
    /// The hemisphere in front of the camera.
    pub(crate) const FRONT: Self = Self::end(FRAC_PI_2);

    pub(crate) const fn end(angle_rad: f64) -> Self {
        Self { angle_rad, folds: false }
    }

    pub(crate) const fn fold(angle_rad: f64) -> Self {
        Self { angle_rad, folds: true }
    }

    /// The nearer of both.
    pub(crate) fn nearer(self, other: Self) -> Self {
        if other.angle_rad < self.angle_rad { other } else { self }
    }
}

/// The interface of every model ([`Model`](super::Model) documents it).
pub(crate) trait Projection {
    fn edge(&self) -> FieldEdge;
    fn project(&self, direction: DVec3) -> Option<DVec2>;
    fn unproject(&self, point: DVec2) -> Option<DVec3>;
    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64>;

    /// Both results for an image point. Models with a numerical inverse solve it once.
    fn sight(&self, point: DVec2) -> Option<DirectionAndSolidAngle> {
        Some(DirectionAndSolidAngle {
            direction: self.unproject(point)?,
            sr_per_area: self.solid_angle_per_area(point)?,
        })
    }
}

/// Direction and solid angle of an image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionAndSolidAngle {
    /// Unit direction.
    pub direction: DVec3,
    /// dΩ/dA, sr per unit area of the image plane.
    pub sr_per_area: f64,
}

impl DirectionAndSolidAngle {
    /// The same through a map of the plane that multiplies areas by `ratio`.
    pub(crate) fn enlarged(self, ratio: f64) -> Self {
        Self { sr_per_area: self.sr_per_area / ratio, ..self }
    }
}

/// r(θ), increasing from r(0) = 0 to the edge.
pub(crate) trait Profile {
    fn edge(&self) -> FieldEdge;

    /// r of an angle before the edge.
    fn radius(&self, angle_rad: f64) -> f64;

    /// dr/dθ at an angle before the edge.
    fn slope(&self, angle_rad: f64) -> f64;

    /// θ of r > 0; `None`, or a value at the edge or beyond, if there is none.
    fn angle(&self, radius: f64) -> Option<f64>;

    /// The angle of a radius, before the edge.
    fn checked_radius(&self, radius: f64) -> Option<f64> {
        let angle = if radius > 0.0 { self.angle(radius)? } else { radius };
        (angle < Profile::edge(self).angle_rad).then_some(angle)
    }
}

impl<P: Profile> Projection for P {
    fn edge(&self) -> FieldEdge {
        Profile::edge(self)
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        let across = direction.truncate().length();
        let angle = field_angle(direction)?;
        if angle >= Profile::edge(self).angle_rad {
            return None;
        }
        let point = if across > 0.0 { direction.truncate() * (self.radius(angle) / across) } else { DVec2::ZERO };
        point.is_finite().then_some(point)
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        let radius = point.length();
        let (sin, cos) = sin_cos(self.checked_radius(radius)?);
        let azimuth = if radius > 0.0 { point / radius } else { DVec2::ZERO };
        Some((azimuth * sin).extend(cos))
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        let radius = point.length();
        let angle = self.checked_radius(radius)?;
        Some(per_area(radius, sin(angle), self.slope(angle)))
    }

    fn sight(&self, point: DVec2) -> Option<DirectionAndSolidAngle> {
        let radius = point.length();
        let angle = self.checked_radius(radius)?;
        let (sin, cos) = sin_cos(angle);
        let azimuth = if radius > 0.0 { point / radius } else { DVec2::ZERO };
        let sr_per_area = per_area(radius, sin, self.slope(angle));
        Some(DirectionAndSolidAngle { direction: (azimuth * sin).extend(cos), sr_per_area })
    }
}

/// sin θ/(r dr/dθ), or its limit on the axis.
fn per_area(radius: f64, sin: f64, slope: f64) -> f64 {
    if radius > 0.0 { sin / (radius * slope) } else { 1.0 / (slope * slope) }
}

/// The angle from the axis of a direction of any length, rad; `None` for an invalid direction.
pub(crate) fn field_angle(direction: DVec3) -> Option<f64> {
    let across = direction.truncate().length();
    let is_one = direction.is_finite() && (across > 0.0 || direction.z != 0.0);
    is_one.then(|| atan2(across, direction.z))
}

/// r(θ), then a distortion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DistortedProfile<P> {
    pub(super) profile: P,
    pub(super) distortion: Distortion,
}

impl<P: Profile> Projection for DistortedProfile<P> {
    fn edge(&self) -> FieldEdge {
        let fold = self.distortion.fold().and_then(|radius| self.profile.angle(radius));
        let edge = Profile::edge(&self.profile);
        fold.map_or(edge, |angle| edge.nearer(FieldEdge::fold(angle)))
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        self.distortion.distorted(self.profile.project(direction)?)
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        self.profile.unproject(self.distortion.ideal(point)?)
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        let ideal = self.distortion.ideal(point)?;
        Some(self.profile.solid_angle_per_area(ideal)? / self.distortion.area_ratio(ideal))
    }

    fn sight(&self, point: DVec2) -> Option<DirectionAndSolidAngle> {
        let ideal = self.distortion.ideal(point)?;
        Some(self.profile.sight(ideal)?.enlarged(self.distortion.area_ratio(ideal)))
    }
}

/// r(θ), then an affine map.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AffineProfile<P> {
    pub(super) profile: P,
    pub(super) affine: Affine,
}

impl<P: Profile> Projection for AffineProfile<P> {
    fn edge(&self) -> FieldEdge {
        Profile::edge(&self.profile)
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        Some(self.affine.there(self.profile.project(direction)?))
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        self.profile.unproject(self.affine.back(point))
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        Some(self.profile.solid_angle_per_area(self.affine.back(point))? / self.affine.area_ratio())
    }

    fn sight(&self, point: DVec2) -> Option<DirectionAndSolidAngle> {
        Some(self.profile.sight(self.affine.back(point))?.enlarged(self.affine.area_ratio()))
    }
}
