//! Ideal projections about an axis, and panoramas.
//!
//! Ideal projections about an axis, in focal lengths.
//!
//! | projection | r(θ) | field | solid angle per area, with its value on the axis as 1 |
//! | --- | --- | --- | --- |
//! | equidistant | θ | to 180° | sin θ/θ |
//! | equisolid | 2 sin(θ/2) | to 180° | 1 |
//! | stereographic | 2 tan(θ/2) | to 180°, at infinity | cos⁴(θ/2) |
//! | orthographic | sin θ | to 90° | 1/cos θ |
//! | rectilinear | tan θ | to 90°, at infinity | cos³ θ |
//!
//! (Miyamoto 1964; Ray, Applied Photographic Optics, 2002.) Fields are half of the full angle.
//!
//! Panoramas about the camera's y axis (which points down).
//!
//! | panorama | x | y | dΩ/dA |
//! | --- | --- | --- | --- |
//! | cylindrical | azimuth λ = atan2(X, Z) | Y/√(X² + Z²) = tan φ | (1 + y²)^(−3/2) |
//! | equirectangular | azimuth λ | elevation φ below the horizon | cos φ |
//!
//! λ runs from −π to π, rad, and is 0 ahead; φ from −π/2 to π/2 and is positive downwards, as y is. The cylinder leaves out
//! the poles. An image of the whole sphere has fx = width/2π and fy = height/π (COLMAP's EQUIRECTANGULAR).

use core::f64::consts::{FRAC_PI_2, PI};

use etendue_core::maths::f64::{asin, atan, atan2, cos, sin, sin_cos, tan};
use glam::{DVec2, DVec3};

use super::profile::{FieldEdge, Profile, Projection, field_angle};

/// An ideal projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ideal {
    /// Equal angles, equal lengths.
    Equidistant,
    /// Equal solid angles, equal areas.
    Equisolid,
    /// Small circles stay circles.
    Stereographic,
    /// The hemisphere seen from afar.
    Orthographic,
    /// Straight lines stay straight.
    Rectilinear,
}

impl Profile for Ideal {
    fn edge(&self) -> FieldEdge {
        match self {
            Self::Equidistant | Self::Equisolid | Self::Stereographic => FieldEdge::SPHERE,
            Self::Orthographic | Self::Rectilinear => FieldEdge::FRONT,
        }
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        match self {
            Self::Equidistant => angle_rad,
            Self::Equisolid => 2.0 * sin(0.5 * angle_rad),
            Self::Stereographic => 2.0 * tan(0.5 * angle_rad),
            Self::Orthographic => sin(angle_rad),
            Self::Rectilinear => tan(angle_rad),
        }
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let half = cos(0.5 * angle_rad);
        let cosine = cos(angle_rad);
        match self {
            Self::Equidistant => 1.0,
            Self::Equisolid => half,
            Self::Stereographic => 1.0 / (half * half),
            Self::Orthographic => cosine,
            Self::Rectilinear => 1.0 / (cosine * cosine),
        }
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        match self {
            Self::Equidistant => Some(radius),
            Self::Equisolid => (radius < 2.0).then(|| 2.0 * asin(0.5 * radius)),
            Self::Stereographic => Some(2.0 * atan(0.5 * radius)),
            Self::Orthographic => (radius < 1.0).then(|| asin(radius)),
            Self::Rectilinear => Some(atan(radius)),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Panorama {
    /// On a cylinder.
    Cylindrical,
    /// Longitude and latitude.
    Equirectangular,
}

impl Panorama {
    fn covers(self, point: DVec2) -> bool {
        let tall = match self {
            Self::Cylindrical => point.y.is_finite(),
            Self::Equirectangular => point.y.abs() <= FRAC_PI_2,
        };
        tall && point.x.abs() <= PI
    }
}

impl Projection for Panorama {
    fn edge(&self) -> FieldEdge {
        FieldEdge::SPHERE
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        field_angle(direction)?;
        let level = DVec2::new(direction.x, direction.z).length();
        let y = match self {
            Self::Cylindrical => direction.y / level,
            Self::Equirectangular => atan2(direction.y, level),
        };
        y.is_finite().then(|| DVec2::new(atan2(direction.x, direction.z), y))
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        if !self.covers(point) {
            return None;
        }
        let (sin, cos) = sin_cos(point.x);
        let (down, level) = match self {
            Self::Cylindrical => (point.y / (1.0 + point.y * point.y).sqrt(), 1.0 / (1.0 + point.y * point.y).sqrt()),
            Self::Equirectangular => sin_cos(point.y),
        };
        Some(DVec3::new(level * sin, down, level * cos))
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        let square = 1.0 + point.y * point.y;
        self.covers(point).then(|| match self {
            Self::Cylindrical => 1.0 / (square * square.sqrt()),
            Self::Equirectangular => cos(point.y),
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::super::Projection;
    use super::*;

    #[test]
    fn the_solid_angle_falls_as_the_table_says() {
        let expected: [fn(f64) -> f64; 5] = [
            |a| sin(a) / a,
            |_| 1.0,
            |a| cos(0.5 * a) * cos(0.5 * a) * cos(0.5 * a) * cos(0.5 * a),
            |a| 1.0 / cos(a),
            |a| cos(a) * cos(a) * cos(a),
        ];
        let all = [Ideal::Equidistant, Ideal::Equisolid, Ideal::Stereographic, Ideal::Orthographic, Ideal::Rectilinear];
        for (ideal, expected) in all.into_iter().zip(expected) {
            for i in 1..15 {
                let angle = 0.1 * f64::from(i);
                let point = DVec2::new(0.6, -0.8) * ideal.radius(angle);
                let actual = ideal.solid_angle_per_area(point).expect("seen");
                // A dozen roundings; near 90° the orthographic angle loses accuracy as its cosine (0.17 at 1.4 rad) becomes small.
                assert!((actual / expected(angle) - 1.0).abs() < 1e-13, "{ideal:?} at {angle}");
            }
            assert_eq!(ideal.solid_angle_per_area(DVec2::ZERO), Some(1.0));
        }
    }
}
