//! A flat disc pupil: its points, its rays, and its light at a sensor point.
//!
//! Spectral irradiance at a sensor point is E = τ ∫ L cos θ cos θ′ / d² dA over the exit pupil. Pupil and sensor are parallel planes a distance z
//! apart, so both cosines are z/d and the integrand is L z²/d⁴.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use etendue_core::{maths::f64::sin_cos, ray::PupilRay};
use glam::{DVec2, DVec3};

/// Metres per millimetre.
pub(crate) const MM: f64 = 1e-3;

/// From the unit square to the unit disc, area-preserving and continuous (Shirley and Chiu 1997).
pub(crate) fn concentric_disc(u: DVec2) -> DVec2 {
    concentric(u).0
}

/// The same, with the point's angle from the x axis without its sign, in [0, π].
#[inline]
pub(crate) fn concentric(u: DVec2) -> (DVec2, f64) {
    let p = u * 2.0 - DVec2::ONE;
    if p == DVec2::ZERO {
        return (DVec2::ZERO, 0.0);
    }
    let (r, angle) =
        if p.x.abs() > p.y.abs() { (p.x, FRAC_PI_4 * (p.y / p.x)) } else { (p.y, FRAC_PI_2 - FRAC_PI_4 * (p.x / p.y)) };
    let (s, c) = sin_cos(angle);
    (DVec2::new(r * c, r * s), if r < 0.0 { PI - angle.abs() } else { angle.abs() })
}

/// A disc pupil as seen from a sensor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PupilView {
    /// Distance between the planes of sensor and pupil, mm.
    pub(crate) distance_mm: f64,
    /// Radius of the pupil, mm.
    pub(crate) radius_mm: f64,
}

impl PupilView {
    /// ∫ z²/d⁴ dA in sr with the integrand's value at the pupil point `pupil_mm` used for the whole pupil. `sensor_mm` is in the erect image: the
    /// point itself lies at its negative.
    pub(crate) fn weight_sr(&self, sensor_mm: DVec2, pupil_mm: DVec2) -> f64 {
        let (z2, area) = (self.distance_mm * self.distance_mm, PI * self.radius_mm * self.radius_mm);
        let d2 = z2 + (pupil_mm + sensor_mm).length_squared();
        area * (z2 / (d2 * d2))
    }

    /// ∫ z²/d⁴ dA over the whole disc, sr: π times the form factor of a disc seen from a parallel plane (Foote 1915), with T the tangent of the field
    /// angle and a the pupil's radius, both in units of the distance: ½ (1 − B/S), B = 1 + T² − a², S² = B² + 4a². For B > 0 it is written as 2a²/(S
    /// (S + B)), which keeps all digits for small pupils.
    pub(crate) fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        let a = self.radius_mm / self.distance_mm;
        let t2 = sensor_mm.length_squared() / (self.distance_mm * self.distance_mm);
        let b = 1.0 + t2 - a * a;
        let s = (b * b + 4.0 * a * a).sqrt();
        PI * if b > 0.0 { 2.0 * a * a / (s * (s + b)) } else { 0.5 * (s - b) / s }
    }
}

/// A pencil of rays in object space: all pass through the plane in focus at the image of one sensor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pencil {
    /// Tangents of the chief ray's direction.
    pub(crate) tangent: DVec2,
    /// Inverse of the distance of the plane in focus from the entrance pupil, 1/mm; 0 at infinity.
    pub(crate) inverse_focus_per_mm: f64,
}

impl Pencil {
    /// The ray through a point of the entrance pupil.
    pub(crate) fn ray(&self, entrance_mm: DVec2, weight_sr: f64) -> PupilRay {
        let slope = self.tangent - entrance_mm * self.inverse_focus_per_mm;
        PupilRay {
            origin_m: DVec3::new(entrance_mm.x * MM, entrance_mm.y * MM, 0.0),
            direction: slope.extend(1.0).normalize(),
            weight_sr,
        }
    }
}
