//! Polynomial fisheye: r = θ (1 + k₁ θ² + k₂ θ⁴ + k₃ θ⁶ + …).
//!
//! Kannala & Brandt 2006 (eq. 6, symmetrical part); with four coefficients `cv::fisheye` and Kalibr's pinhole-equi, with one
//! and two COLMAP's SIMPLE_RADIAL_FISHEYE and RADIAL_FISHEYE, with none the equidistant fisheye. θ counts from the optical
//! axis and goes to 180°, where `cv::fisheye` itself stops at 90°; beyond the first angle at which dr/dθ vanishes there is
//! nothing. The asymmetrical terms of the paper are left out, as in all those programs.

use super::ModelError;
use super::profile::{Edge, Profile};
use crate::model_error::finite_list;
use crate::root::{first_sign_change, increasing};

/// Coefficients of the longest polynomial.
const LONGEST: usize = 6;

/// The polynomial fisheye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KannalaBrandt {
    coefficients: [f64; LONGEST],
    edge: Edge,
}

impl KannalaBrandt {
    /// The fisheye with these coefficients, k₁ first.
    ///
    /// # Errors
    /// Where one is not finite.
    pub fn new(k: [f64; 4]) -> Result<Self, ModelError> {
        Self::long([k[0], k[1], k[2], k[3], 0.0, 0.0])
    }

    /// The fisheye with six coefficients.
    ///
    /// # Errors
    /// Where one is not finite.
    pub fn long(coefficients: [f64; LONGEST]) -> Result<Self, ModelError> {
        finite_list("k", 1, &coefficients)?;
        let mut slope = [1.0; LONGEST + 1];
        for (i, k) in coefficients.iter().enumerate() {
            slope[i + 1] = (2 * i + 3) as f64 * k;
        }
        let sphere = Edge::SPHERE;
        let fold = first_sign_change(&slope, sphere.angle_rad * sphere.angle_rad);
        let edge = fold.map_or(sphere, |square| sphere.nearer(Edge::fold(square.sqrt())));
        Ok(Self { coefficients, edge })
    }

    /// k₁ … k₆.
    #[must_use]
    pub fn coefficients(&self) -> [f64; LONGEST] {
        self.coefficients
    }

    /// r and dr/dθ.
    fn value(&self, angle: f64) -> [f64; 2] {
        let s = angle * angle;
        let (mut value, mut slope) = (0.0, 0.0);
        for (i, k) in self.coefficients.iter().enumerate().rev() {
            value = (value + k) * s;
            slope = (slope + (2 * i + 3) as f64 * k) * s;
        }
        [angle * (1.0 + value), 1.0 + slope]
    }
}

impl Profile for KannalaBrandt {
    fn edge(&self) -> Edge {
        self.edge
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        self.value(angle_rad)[0]
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        self.value(angle_rad)[1]
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        increasing(radius, [0.0, self.edge.angle_rad], radius, |angle| self.value(angle))
    }
}
