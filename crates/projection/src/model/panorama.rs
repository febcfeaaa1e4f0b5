//! Panoramas about the camera's y axis (which points down).
//!
//! | panorama | x | y | dΩ/dA |
//! | --- | --- | --- | --- |
//! | cylindrical | azimuth λ = atan2(X, Z) | Y/√(X² + Z²) = tan φ | (1 + y²)^(−3/2) |
//! | equirectangular | azimuth λ | elevation φ below the horizon | cos φ |
//!
//! λ runs from −π to π, rad, and is 0 ahead; φ from −π/2 to π/2 and is positive downwards, as y is. The cylinder leaves out
//! the poles. A picture of the whole sphere has fx = width/2π and fy = height/π (COLMAP's EQUIRECTANGULAR).

use core::f64::consts::{FRAC_PI_2, PI};

use etendue_core::maths::f64::{atan2, cos, sin_cos};
use glam::{DVec2, DVec3};

use super::profile::{Edge, Projection, field_angle};

/// A panorama.
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
    fn edge(&self) -> Edge {
        Edge::SPHERE
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
