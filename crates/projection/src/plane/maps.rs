//! Maps of the image plane: an affine map, and the tilt of the sensor.
//!
//! The affine map of catadioptric and f-theta calibrations scales and shears a plane point.
//!
//! x′ = x + e y, y′ = d x + c y with x to the right and y down: Scaramuzza's stretch matrix [c d; e 1], whose first coordinate runs down the rows
//! (Scaramuzza, Martinelli & Siegwart 2006, eq. 6).
//!
//! The tilt of the sensor plane about the image's x and y axes (Scheimpflug).
//!
//! A point is mapped by the homography P R_y(τy) R_x(τx), with P the projection back on the plane along its normal: OpenCV's
//! `computeTiltProjectionMatrix` (Louhichi, Fournel, Lavest & Ben Aissia 2007).

use etendue_core::maths::f64::sin_cos;
use glam::{DMat2, DMat3, DVec2};

use crate::rectilinear::ModelError;

/// The stretch c, d, e; 1, 0, 0 for none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Scale of the rows.
    pub c: f64,
    /// Downward shift per step to the right.
    pub d: f64,
    /// Rightward shift per step downwards.
    pub e: f64,
}

impl Default for Affine {
    fn default() -> Self {
        Self { c: 1.0, d: 0.0, e: 0.0 }
    }
}

impl Affine {
    /// Refuses a map that mirrors or flattens the plane.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        let determinant = self.area_ratio();
        if determinant > 0.0 && determinant.is_finite() {
            return Ok(());
        }
        Err(ModelError::value("affine determinant c − d e", determinant, "a positive number"))
    }

    pub(crate) fn there(&self, p: DVec2) -> DVec2 {
        self.matrix() * p
    }

    pub(crate) fn back(&self, p: DVec2) -> DVec2 {
        self.matrix().inverse() * p
    }

    pub(crate) fn area_ratio(&self) -> f64 {
        self.c - self.d * self.e
    }

    fn matrix(&self) -> DMat2 {
        DMat2::from_cols_array(&[1.0, self.d, self.e, self.c])
    }
}

/// The homography of a tilt, and its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    angles_rad: [f64; 2],
    there: DMat3,
    back: DMat3,
}

impl Tilt {
    /// A sensor tilted by τx and τy, each less than a right angle.
    pub(crate) fn new(angles_rad: [f64; 2]) -> Self {
        let ((sx, cx), (sy, cy)) = (sin_cos(angles_rad[0]), sin_cos(angles_rad[1]));
        let about_x = rows([[1.0, 0.0, 0.0], [0.0, cx, sx], [0.0, -sx, cx]]);
        let about_y = rows([[cy, 0.0, -sy], [0.0, 1.0, 0.0], [sy, 0.0, cy]]);
        let turn = about_y * about_x;
        let normal = turn.z_axis;
        let onto = rows([[normal.z, 0.0, -normal.x], [0.0, normal.z, -normal.y], [0.0, 0.0, 1.0]]);
        let there = onto * turn;
        Self { angles_rad, there, back: there.inverse() }
    }

    /// τx and τy, rad.
    #[must_use]
    pub fn angles_rad(&self) -> [f64; 2] {
        self.angles_rad
    }

    /// The point on the tilted sensor; `None` beyond the horizon of the tilt.
    pub(crate) fn tilted(&self, p: DVec2) -> Option<DVec2> {
        mapped(&self.there, p)
    }

    /// The point before the tilt.
    pub(crate) fn upright(&self, p: DVec2) -> Option<DVec2> {
        mapped(&self.back, p)
    }

    /// Tilted area per upright area at an upright point: det H/w³.
    pub(crate) fn area_ratio(&self, p: DVec2) -> f64 {
        let w = (self.there * p.extend(1.0)).z;
        self.there.determinant() / (w * w * w)
    }
}

fn mapped(matrix: &DMat3, p: DVec2) -> Option<DVec2> {
    let q = *matrix * p.extend(1.0);
    (q.z > 0.0).then(|| q.truncate() / q.z)
}

fn rows(rows: [[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&rows).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_tilt_is_no_change_and_a_tilt_keeps_the_axis() {
        let p = DVec2::new(0.3, -0.2);
        assert_eq!(Tilt::new([0.0; 2]).tilted(p), Some(p));
        let tilt = Tilt::new([0.1, -0.25]);
        assert!(tilt.tilted(DVec2::ZERO).expect("in front").length() < 1e-16);
        let back = tilt.tilted(p).and_then(|q| tilt.upright(q)).expect("in front");
        assert!((back - p).length() < 1e-15);
    }

    #[test]
    fn a_tilt_about_x_alone_is_the_known_perspectivity() {
        // Points map to x′ = x cos τ/(cos τ − y sin τ), y′ = y/(cos τ − y sin τ): the plane rotated about x.
        let (tau, p) = (0.2, DVec2::new(0.3, -0.4));
        let (sin, cos) = sin_cos(tau);
        let q = Tilt::new([tau, 0.0]).tilted(p).expect("in front");
        let w = cos - p.y * sin;
        assert!((q - DVec2::new(p.x * cos, p.y) / w).length() < 1e-15, "{q}");
    }

    #[test]
    fn the_area_ratio_is_the_determinant() {
        let (tilt, p, h) = (Tilt::new([0.1, -0.25]), DVec2::new(0.3, -0.2), 1e-6);
        let at = |q: DVec2| tilt.tilted(q).expect("in front");
        let slope = |step: DVec2| (at(p + step) - at(p - step)) / (2.0 * h);
        let expected = slope(DVec2::X * h).perp_dot(slope(DVec2::Y * h));
        // Central differences: ε/h.
        assert!((tilt.area_ratio(p) - expected).abs() < 1e-9);
    }
}
