//! Perspective models and distortions of them: OpenCV's, the division model, the radial polynomial, the FOV model.
//!
//! Perspective with OpenCV's distortion: k₁ … k₆, p₁, p₂, s₁ … s₄, τx, τy.
//!
//! (X/Z, Y/Z) goes through the [`Distortion`] and the [`Tilt`]: `cv::projectPoints` of OpenCV 3 and later, with
//! distCoeffs in the order k₁ k₂ p₁ p₂ k₃ k₄ k₅ k₆ s₁ s₂ s₃ s₄ τx τy. All zero is the pinhole. COLMAP's SIMPLE_PINHOLE,
//! PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV and FULL_OPENCV are special cases, as is Kalibr's pinhole-radtan.
//!
//! dΩ/dA = cos³ θ/det J. The field ends at 90° unless it folds before.
//!
//! The division model: a point at r sees (x, y, 1 + k r²).
//!
//! tan θ = r/(1 + k r²) (Fitzgibbon 2001; COLMAP's SIMPLE_DIVISION and DIVISION). With k < 0 (barrel) it passes 90° at
//! r = 1/√−k and goes to 180°; with k > 0 it folds at r = 1/√k.
//!
//! The radial polynomial r′ = r (1 + k₁ r² + k₂ r⁴) of [`RadialDistortion`], in either direction, after a perspective.
//!
//! Lengths are principal distances here, where [`RadialDistortion`] states mm: a unit of 1 makes r the tangent of the field angle.
//!
//! The FOV model: r = atan(2 tan θ tan(ω/2))/ω, 0 < ω < π, below 90°.
//!
//! Devernay & Faugeras 2001 (eqs. 13, 14); COLMAP's FOV, Kalibr's pinhole-fov.

use core::f64::consts::PI;

use etendue_core::maths::f64::{atan, atan2, sin_cos, tan};
use glam::{DVec2, DVec3};

use super::ModelError;
use super::profile::{DirectionAndSolidAngle, FieldEdge, Profile, Projection};
use crate::plane::{Distortion, DistortionTerms, Tilt};
use crate::radial::RadialDistortion;
use crate::rectilinear::{finite, finite_list, legal};

/// A perspective camera with the distortion of OpenCV.
#[derive(Clone, Debug, PartialEq)]
pub struct Perspective {
    distortion: Distortion,
    tilt: Option<Box<Tilt>>,
}

impl Perspective {
    /// Creates the camera from distortion terms and a sensor tilt τx, τy (rad; zeros for none).
    ///
    /// # Errors
    /// If a number is not finite or a tilt reaches a right angle.
    pub fn new(terms: DistortionTerms, tilt_rad: [f64; 2]) -> Result<Self, ModelError> {
        terms.check()?;
        finite_list("tau", 1, &tilt_rad)?;
        for (name, tau) in ["tau_x", "tau_y"].into_iter().zip(tilt_rad) {
            legal(name, tau, tau.abs() < 1.5, "an angle between -1.5 and 1.5 rad")?;
        }
        let tilt = (tilt_rad != [0.0; 2]).then(|| Box::new(Tilt::new(tilt_rad)));
        Ok(Self { distortion: Distortion::new(terms, MAX_TANGENT), tilt })
    }

    /// A pinhole without distortion.
    #[must_use]
    pub fn pinhole() -> Self {
        Self { distortion: Distortion::new(DistortionTerms::default(), MAX_TANGENT), tilt: None }
    }

    /// Creates the camera from OpenCV's distCoeffs: 0, 4, 5, 8, 12 or 14 numbers in its order.
    ///
    /// # Errors
    /// As [`Perspective::new`], and for any other count.
    pub fn from_opencv(coefficients: &[f64]) -> Result<Self, ModelError> {
        let count = coefficients.len();
        legal("number of distCoeffs", count as f64, [0, 4, 5, 8, 12, 14].contains(&count), "0, 4, 5, 8, 12 or 14")?;
        let mut c = [0.0; 14];
        c[..count].copy_from_slice(coefficients);
        let [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y] = c;
        let terms = DistortionTerms {
            numerator: [k1, k2, k3, 0.0],
            denominator: [k4, k5, k6],
            tangential: [p1, p2],
            prism: [s1, s2, s3, s4],
        };
        Self::new(terms, [tau_x, tau_y])
    }

    #[must_use]
    pub fn distortion(&self) -> &Distortion {
        &self.distortion
    }

    /// Tilt of the sensor, if any.
    #[must_use]
    pub fn tilt(&self) -> Option<&Tilt> {
        self.tilt.as_deref()
    }

    /// The gnomonic point of an image point.
    fn ideal(&self, point: DVec2) -> Option<DVec2> {
        let upright = match &self.tilt {
            Some(tilt) => tilt.upright(point)?,
            None => point,
        };
        self.distortion.ideal(upright)
    }

    /// dΩ/dA of an image point with a known gnomonic point.
    fn per_area(&self, point: DVec2, ideal: DVec2) -> Option<f64> {
        let square = 1.0 + ideal.length_squared();
        let tilt = match &self.tilt {
            Some(tilt) => tilt.area_ratio(tilt.upright(point)?),
            None => 1.0,
        };
        Some(1.0 / (square * square.sqrt() * self.distortion.area_ratio(ideal) * tilt))
    }
}

impl Projection for Perspective {
    fn edge(&self) -> FieldEdge {
        self.distortion.fold().map_or(FieldEdge::FRONT, |limit| FieldEdge::fold(atan(limit)))
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        if direction.z <= 0.0 {
            return None;
        }
        let distorted = self.distortion.distorted(direction.truncate() / direction.z)?;
        match &self.tilt {
            Some(tilt) => tilt.tilted(distorted),
            None => Some(distorted),
        }
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        Some(self.ideal(point)?.extend(1.0).normalize())
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        self.per_area(point, self.ideal(point)?)
    }

    fn sight(&self, point: DVec2) -> Option<DirectionAndSolidAngle> {
        let ideal = self.ideal(point)?;
        Some(DirectionAndSolidAngle {
            direction: ideal.extend(1.0).normalize(),
            sr_per_area: self.per_area(point, ideal)?,
        })
    }
}

/// The tangent of the largest field angle: 0.06″ from 90°.
const MAX_TANGENT: f64 = 1e8;

/// The division model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Division {
    k: f64,
}

impl Division {
    /// Creates the camera of k.
    ///
    /// # Errors
    /// If k is not finite.
    pub fn new(k: f64) -> Result<Self, ModelError> {
        finite([("k", k)])?;
        Ok(Self { k })
    }

    #[must_use]
    pub fn k(&self) -> f64 {
        self.k
    }
}

impl Profile for Division {
    fn edge(&self) -> FieldEdge {
        match self.k {
            k if k > 0.0 => FieldEdge::fold(atan2(1.0 / k.sqrt(), 2.0)),
            k if k < 0.0 => FieldEdge::end(PI),
            _ => FieldEdge::FRONT,
        }
    }

    /// The smaller root of k sin θ r² − cos θ r + sin θ = 0, without cancellation.
    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        let root = (cos * cos - 4.0 * self.k * sin * sin).max(0.0).sqrt();
        if cos > 0.0 { 2.0 * sin / (cos + root) } else { (cos - root) / (2.0 * self.k * sin) }
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let s = self.radius(angle_rad) * self.radius(angle_rad);
        let forward = 1.0 + self.k * s;
        (s + forward * forward) / (1.0 - self.k * s)
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let s = radius * radius;
        (self.k * s < 1.0).then(|| atan2(radius, 1.0 + self.k * s))
    }
}

impl Projection for RadialDistortion {
    fn edge(&self) -> FieldEdge {
        let fold = self.fold_ideal_mm();
        if fold.is_finite() { FieldEdge::fold(atan(fold)) } else { FieldEdge::FRONT }
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        let in_front = direction.z > 0.0;
        in_front.then(|| self.observed(direction.truncate() / direction.z))?.filter(|p| p.is_finite())
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        Some(self.ideal(point)?.extend(1.0).normalize())
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        per_area(self, point, self.ideal(point)?)
    }

    fn sight(&self, point: DVec2) -> Option<DirectionAndSolidAngle> {
        let ideal = self.ideal(point)?;
        Some(DirectionAndSolidAngle {
            direction: ideal.extend(1.0).normalize(),
            sr_per_area: per_area(self, point, ideal)?,
        })
    }
}

/// dΩ/dA of an image point with a known gnomonic point.
fn per_area(distortion: &RadialDistortion, point: DVec2, ideal: DVec2) -> Option<f64> {
    let square = 1.0 + ideal.length_squared();
    Some(distortion.ideal_area_per_observed(point.length())? / (square * square.sqrt()))
}

/// The FOV model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOfView {
    omega: f64,
    /// 2 tan(ω/2).
    stretch: f64,
}

impl FieldOfView {
    /// Creates the camera of ω, rad.
    ///
    /// # Errors
    /// If ω is not between 0 and π.
    pub fn new(omega_rad: f64) -> Result<Self, ModelError> {
        let inside = omega_rad > 0.0 && omega_rad < core::f64::consts::PI;
        legal("omega", omega_rad, inside, "an angle between 0 and 3.14159 rad")?;
        Ok(Self { omega: omega_rad, stretch: 2.0 * tan(0.5 * omega_rad) })
    }

    /// ω, rad.
    #[must_use]
    pub fn omega_rad(&self) -> f64 {
        self.omega
    }
}

impl Profile for FieldOfView {
    fn edge(&self) -> FieldEdge {
        FieldEdge::FRONT
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        atan2(self.stretch * sin, cos) / self.omega
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        let across = self.stretch * sin;
        self.stretch / (self.omega * (cos * cos + across * across))
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let turned = radius * self.omega;
        let (sin, cos) = sin_cos(turned);
        (turned < FieldEdge::FRONT.angle_rad).then(|| atan2(sin, self.stretch * cos))
    }
}
