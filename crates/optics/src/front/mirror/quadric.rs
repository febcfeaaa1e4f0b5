//! Convex quadrics about the axis: sphere, paraboloid, hyperboloid, cone.
//!
//! r² + m z² − 2 R z = 0 with R the radius of curvature at the vertex and m = 1 + k, k the conic constant (sphere 0, paraboloid
//! −1, hyperboloid −e²); a cone of half-angle α is R = 0, m = −tan² α. The sheet that opens to +z is where R − m z > 0; its
//! outer normal is along (x, y, m z − R). The foci of a hyperboloid are on the axis at R/(1 + e) within the sheet and at
//! −R/(e − 1) outside: a ray towards the one is reflected as if it came from the other.

use core::f64::consts::PI;

use etendue_core::maths::f64::tan;
use glam::DVec3;

use super::super::MemberRay;
use super::MirrorHit;
use crate::error::front::{FrontError, positive};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuadricKind {
    /// A conic of a vertex radius (mm) and a conic constant: 0 a sphere, −1 a paraboloid, below −1 a hyperboloid.
    Conic {
        /// Radius of curvature at the vertex, mm.
        radius_mm: f64,
        /// Conic constant.
        conic: f64,
    },
    /// A cone with its apex at the vertex.
    Cone {
        /// Angle between axis and surface, degrees.
        half_angle_deg: f64,
    },
}

/// A quadric between its hole and its outer edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    radius_mm: f64,
    shape: f64,
    rim_mm: f64,
    hole_mm: f64,
}

impl Quadric {
    /// Creates a mirror from `hole_mm` (0 for none) to `rim_mm` from its axis.
    ///
    /// # Errors
    /// If a number is outside its range, the surface does not reach its outer edge, or the hole reaches it.
    pub fn new(kind: QuadricKind, rim_mm: f64, hole_mm: f64) -> Result<Self, FrontError> {
        let (radius_mm, shape) = match kind {
            QuadricKind::Conic { radius_mm, conic } => {
                let range = "a finite number";
                let conic = if conic.is_finite() { Ok(conic) } else { Err(number("conic", conic, range)) }?;
                (positive("radius_mm", radius_mm)?, 1.0 + conic)
            }
            QuadricKind::Cone { half_angle_deg: angle } => {
                let range = "above 0 and below 90";
                let tangent = if angle > 0.0 && angle < 90.0 { tan(angle * PI / 180.0) } else { f64::NAN };
                if !tangent.is_finite() {
                    return Err(number("half_angle_deg", angle, range));
                }
                (0.0, -tangent * tangent)
            }
        };
        let rim_mm = positive("rim_radius_mm", rim_mm)?;
        if shape > 0.0 && rim_mm > radius_mm / shape.sqrt() {
            return Err(FrontError::RimTooLarge { rim_mm, reach_mm: radius_mm / shape.sqrt() });
        }
        if !(hole_mm.is_finite() && hole_mm >= 0.0) {
            return Err(number("hole_radius_mm", hole_mm, "finite and 0 or more"));
        }
        if hole_mm >= rim_mm {
            return Err(FrontError::NoSurface { hole_mm, rim_mm });
        }
        Ok(Self { radius_mm, shape, rim_mm, hole_mm })
    }

    /// Distance of the pupil outside the vertex for a single viewpoint, mm; `None` for all except hyperboloids.
    #[must_use]
    pub fn outer_focus_mm(&self) -> Option<f64> {
        (self.radius_mm > 0.0 && self.shape < 0.0).then(|| self.radius_mm / ((1.0 - self.shape).sqrt() - 1.0))
    }

    /// Name in words.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self.shape {
            _ if self.radius_mm == 0.0 => "cone",
            1.0 => "sphere",
            0.0 => "paraboloid",
            shape if shape < 0.0 => "hyperboloid",
            _ => "ellipsoid",
        }
    }

    /// Radius of the outer edge, mm.
    #[must_use]
    pub fn rim_mm(&self) -> f64 {
        self.rim_mm
    }

    /// True if a point of the mirror's frame lies within the sheet.
    pub(super) fn holds(&self, p: DVec3) -> bool {
        let value = p.x * p.x + p.y * p.y + self.shape * p.z * p.z - 2.0 * self.radius_mm * p.z;
        value < 0.0 && self.radius_mm - self.shape * p.z > 0.0
    }

    /// The first hit of a ray given in the mirror's frame.
    pub(super) fn intersect(&self, line: &MemberRay) -> Option<MirrorHit> {
        let d = line.direction;
        // From the ray's point nearest to the vertex, so that far pupils lose no digits.
        let direction = -line.point_mm.dot(d);
        let o = line.point_mm + d * direction;
        let (m, r) = (self.shape, self.radius_mm);
        let a = d.x * d.x + d.y * d.y + m * d.z * d.z;
        let b = o.x * d.x + o.y * d.y + m * o.z * d.z - r * d.z;
        let c = o.x * o.x + o.y * o.y + m * o.z * o.z - 2.0 * r * o.z;
        let square = b * b - a * c;
        if square < 0.0 {
            return None;
        }
        let q = -(b + square.sqrt().copysign(b));
        let (s, t) = (q / a, c / q);
        let ahead = |t: &f64| t.is_finite() && direction + t > 0.0;
        [s.min(t), s.max(t)].into_iter().filter(ahead).find_map(|t| self.at(o + d * t))
    }

    /// The surface at a point of the quadric, if it lies on the mirror.
    fn at(&self, p: DVec3) -> Option<MirrorHit> {
        let r2 = p.x * p.x + p.y * p.y;
        let within = r2 <= self.rim_mm * self.rim_mm && r2 >= self.hole_mm * self.hole_mm;
        let sheet = self.radius_mm - self.shape * p.z;
        if !within || sheet <= 0.0 {
            return None;
        }
        let normal = DVec3::new(p.x, p.y, -sheet).normalize();
        Some(MirrorHit { point_mm: p, facing: normal, normal })
    }
}

fn number(name: &'static str, value: f64, range: &'static str) -> FrontError {
    FrontError::Number { name, value, range }
}
