//! Perspective with OpenCV's distortion: k₁ … k₆, p₁, p₂, s₁ … s₄, τx, τy.
//!
//! (X/Z, Y/Z) goes through the [`Distortion`] and the [`Tilt`]: `cv::projectPoints` of OpenCV 3 and later, with
//! distCoeffs in the order k₁ k₂ p₁ p₂ k₃ k₄ k₅ k₆ s₁ s₂ s₃ s₄ τx τy. All zero is the pinhole. COLMAP's SIMPLE_PINHOLE,
//! PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV and FULL_OPENCV are special cases, as is Kalibr's pinhole-radtan.
//!
//! dΩ/dA = cos³ θ/det J. Where nothing folds before, the field ends at 90°.

use etendue_core::maths::f64::atan;
use glam::{DVec2, DVec3};

use super::ModelError;
use super::profile::{Edge, Projection, Sight};
use crate::model_error::{finite_list, legal};
use crate::plane::{Distortion, DistortionTerms, Tilt};

/// A perspective camera with the distortion of OpenCV.
#[derive(Clone, Debug, PartialEq)]
pub struct Perspective {
    distortion: Distortion,
    tilt: Option<Box<Tilt>>,
}

impl Perspective {
    /// The camera of distortion terms and of a sensor tilt τx, τy (rad; zeros for none).
    ///
    /// # Errors
    /// Where a number is not finite or a tilt reaches a right angle.
    pub fn new(terms: DistortionTerms, tilt_rad: [f64; 2]) -> Result<Self, ModelError> {
        terms.check()?;
        finite_list("tau", 1, &tilt_rad)?;
        for (name, tau) in ["tau_x", "tau_y"].into_iter().zip(tilt_rad) {
            legal(name, tau, tau.abs() < 1.5, "an angle between -1.5 and 1.5 rad")?;
        }
        let tilt = (tilt_rad != [0.0; 2]).then(|| Box::new(Tilt::new(tilt_rad)));
        Ok(Self { distortion: Distortion::new(terms, FARTHEST), tilt })
    }

    /// No distortion: a pinhole.
    #[must_use]
    pub fn pinhole() -> Self {
        Self { distortion: Distortion::new(DistortionTerms::default(), FARTHEST), tilt: None }
    }

    /// The camera of OpenCV's distCoeffs: 0, 4, 5, 8, 12 or 14 numbers in its order.
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

    /// Its distortion.
    #[must_use]
    pub fn distortion(&self) -> &Distortion {
        &self.distortion
    }

    /// The tilt of its sensor, where there is one.
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

    /// dΩ/dA of an image point whose gnomonic point is known.
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
    fn edge(&self) -> Edge {
        self.distortion.fold().map_or(Edge::FRONT, |limit| Edge::fold(atan(limit)))
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

    fn sight(&self, point: DVec2) -> Option<Sight> {
        let ideal = self.ideal(point)?;
        Some(Sight { direction: ideal.extend(1.0).normalize(), sr_per_area: self.per_area(point, ideal)? })
    }
}

/// The tangent of the largest field angle: 0.06″ from 90°.
const FARTHEST: f64 = 1e8;
