//! The division model: a point at r sees (x, y, 1 + k r²).
//!
//! tan θ = r/(1 + k r²) (Fitzgibbon 2001; COLMAP's SIMPLE_DIVISION and DIVISION). With k < 0 (barrel) it passes 90° at
//! r = 1/√−k and goes to 180°; with k > 0 it folds at r = 1/√k.

use core::f64::consts::PI;

use etendue_core::maths::f64::{atan2, sin_cos};

use super::ModelError;
use super::profile::{Edge, Profile};
use crate::model_error::finite;

/// The division model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Division {
    k: f64,
}

impl Division {
    /// The camera of k.
    ///
    /// # Errors
    /// Where k is not finite.
    pub fn new(k: f64) -> Result<Self, ModelError> {
        finite([("k", k)])?;
        Ok(Self { k })
    }

    /// k.
    #[must_use]
    pub fn k(&self) -> f64 {
        self.k
    }
}

impl Profile for Division {
    fn edge(&self) -> Edge {
        match self.k {
            k if k > 0.0 => Edge::fold(atan2(1.0 / k.sqrt(), 2.0)),
            k if k < 0.0 => Edge::end(PI),
            _ => Edge::FRONT,
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
