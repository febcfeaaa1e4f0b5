//! Spherical triangles: what a flat triangle fills of the directions about a point.
//!
//! The solid angle Ω is that of Van Oosterom & Strackee 1983, tan(Ω/2) = |a·(b×c)| / (1 + a·b + b·c + c·a) for the unit
//! directions a, b, c of the corners. Directions are drawn uniformly after Arvo 1995 ("Stratified sampling of spherical
//! triangles"), in f64: the triangles may be needles, or fill nearly half of all directions.

use etendue_core::maths::f64::{atan2, sin_cos};
use glam::{DVec2, DVec3};

/// A triangle as seen from a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalTriangle {
    /// Unit directions of the corners.
    corners: [DVec3; 3],
    /// a·(b×c), 0 or more.
    volume: f64,
    solid_angle_sr: f64,
}

impl SphericalTriangle {
    /// Of corners relative to the point; no number where the point lies at one of them.
    pub(super) fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let lengths = corners.map(DVec3::length);
        // By the edges: of the corners' own product few digits are left where the triangle is small or far.
        let volume = a.dot((b - a).cross(c - a)).abs() / (lengths[0] * lengths[1] * lengths[2]);
        let corners = [a / lengths[0], b / lengths[1], c / lengths[2]];
        let [a, b, c] = corners;
        let solid_angle_sr = 2.0 * atan2(volume, 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        Self { corners, volume, solid_angle_sr }
    }

    pub(super) fn solid_angle_sr(&self) -> f64 {
        self.solid_angle_sr
    }

    /// A unit direction, uniformly by solid angle; no number where the triangle has no area.
    pub(super) fn sample(&self, u: DVec2) -> DVec3 {
        let [a, b, c] = self.corners;
        let cos_side = a.dot(b);
        // The angle at a, between the planes of its sides.
        let (ab, ac) = (a.cross(b), a.cross(c));
        let per_sides = 1.0 / (ab.length() * ac.length());
        let (sin_a, cos_a) = (self.volume * per_sides, ab.dot(ac) * per_sides);
        // The corner c' on the side ac that cuts off the share u.x of the solid angle.
        let (sin, cos) = sin_cos(u.x * self.solid_angle_sr);
        let (s, t) = (sin * cos_a - cos * sin_a, cos * cos_a + sin * sin_a);
        let (p, q) = (t - cos_a, s + sin_a * cos_side);
        let cos_cut = ((q * t - p * s) * cos_a - q) / ((q * s + p * t) * sin_a);
        let cut = towards(a, c, cos_cut.clamp(a.dot(c), 1.0));
        let cos_along = 1.0 - u.y * (1.0 - cut.dot(b));
        towards(b, cut, cos_along)
    }
}

/// The unit direction at an angle of this cosine from `from` on the way to `to`.
fn towards(from: DVec3, to: DVec3, cos: f64) -> DVec3 {
    let aside = (to - from * from.dot(to)).normalize_or_zero();
    from * cos + aside * (1.0 - cos * cos).max(0.0).sqrt()
}
