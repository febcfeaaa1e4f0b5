//! Bounds of a light or a cluster: position, strength, and cone of emission.

use core::f32::consts::{FRAC_PI_2, PI};

use etendue_core::maths;
use glam::Vec3;

/// Bounds of a light or of a cluster of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::lights) struct LightBounds {
    /// Minimum and maximum coordinates, render frame, m.
    pub(in crate::lights) low: Vec3,
    pub(in crate::lights) high: Vec3,
    /// Radius of a sphere about the middle of these that holds everything, m.
    pub(in crate::lights) radius: f32,
    /// Mean intensity along the axis, W·sr⁻¹·nm⁻¹.
    pub(in crate::lights) intensity: f64,
    /// Unit axis, and half angles (rad): the intensity is constant up to `theta_o` from the axis, and falls beyond it to zero at `theta_o` + `theta_e`.
    ///
    pub(in crate::lights) axis: Vec3,
    pub(in crate::lights) theta_o: f32,
    pub(in crate::lights) theta_e: f32,
    /// True if it is one lamp, with an opening or without.
    pub(in crate::lights) is_lamp: bool,
}

impl LightBounds {
    pub(super) fn centre(&self) -> Vec3 {
        self.low * 0.5 + self.high * 0.5
    }

    /// The cone of full intensity.
    fn cone(&self) -> AngularCone {
        AngularCone { axis: self.axis, half_angle_rad: self.theta_o }
    }

    /// Bounds of both.
    pub(super) fn union(&self, other: &Self) -> Self {
        let (low, high) = (self.low.min(other.low), self.high.max(other.high));
        let AngularCone { axis, half_angle_rad: theta_o } = self.cone().union(other.cone());
        Self {
            low,
            high,
            // Margin for the rounding of the middle.
            radius: (high * 0.5 - low * 0.5).length() * (1.0 + 1e-5),
            intensity: self.intensity + other.intensity,
            axis,
            theta_o,
            theta_e: self.theta_e.max(other.theta_e),
            is_lamp: false,
        }
    }

    /// The orientation measure M_Ω of Conty Estevez and Kulla: ∫ over the cone, weighted by the fall beyond θ_o.
    fn orientation(&self) -> f64 {
        let (o, w) = (f64::from(self.theta_o), f64::from((self.theta_o + self.theta_e).min(PI)));
        let (sin, cos) = maths::f64::sin_cos(o);
        let fall = 2.0 * w * sin - maths::f64::cos(o - 2.0 * w) - 2.0 * o * sin + cos;
        core::f64::consts::TAU * (1.0 - cos) + core::f64::consts::FRAC_PI_2 * fall
    }

    /// Cost of a cluster in a tree: intensity × squared radius × orientation. The radius replaces the area of the box in the paper, which
    /// is zero for lamps in a row.
    pub(super) fn cost(&self) -> f64 {
        self.intensity * f64::from(self.radius) * f64::from(self.radius) * self.orientation()
    }
}

/// Directions about a unit axis.
#[derive(Clone, Copy)]
struct AngularCone {
    axis: Vec3,
    half_angle_rad: f32,
}

impl AngularCone {
    /// The smallest cone about two.
    fn union(self, other: Self) -> Self {
        let (wide, narrow) = if self.half_angle_rad >= other.half_angle_rad { (self, other) } else { (other, self) };
        let between = angle(wide.axis, narrow.axis);
        if (between + narrow.half_angle_rad).min(PI) <= wide.half_angle_rad {
            return wide;
        }
        let half = 0.5 * (wide.half_angle_rad + between + narrow.half_angle_rad);
        let aside = (narrow.axis - wide.axis * wide.axis.dot(narrow.axis)).normalize_or_zero();
        // Opposite axes have no direction between them.
        if half >= PI || aside == Vec3::ZERO {
            return Self { half_angle_rad: PI, ..wide };
        }
        let (sin, cos) = maths::f32::sin_cos(half - wide.half_angle_rad);
        // Margin for rounding.
        Self { axis: (wide.axis * cos + aside * sin).normalize(), half_angle_rad: (half + 1e-5).min(PI) }
    }
}

/// Angle between unit vectors, rad.
fn angle(a: Vec3, b: Vec3) -> f32 {
    maths::f32::atan2(a.cross(b).length(), a.dot(b))
}

impl LightBounds {
    /// Bounds of a surface: diffuse emission from one side (`normal`) or all.
    pub(in crate::lights) fn from_surface(points: &[Vec3], intensity: f64, normal: Option<Vec3>) -> Self {
        let low = points.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let high = points.iter().copied().reduce(Vec3::max).unwrap_or_default();
        let (axis, theta_o, theta_e) = normal.map_or((Vec3::Z, PI, FRAC_PI_2), |n| (n, 0.0, FRAC_PI_2));
        let radius = (high * 0.5 - low * 0.5).length() * (1.0 + 1e-5);
        Self { low, high, radius, intensity, axis, theta_o, theta_e, is_lamp: false }
    }
}
