//! A spot: 1 within an inner field angle, 0 beyond an outer one, smooth between.
//!
//! With c the cosine of the angle from +x, c_i and c_o those of the half angles, t = (c − c_o)/(c_i − c_o): value = 1 for t ≥ 1, 0 for t ≤ 0, t² (3 −
//! 2 t) between. Its integral is exactly 2π ((1 − c_i) + (c_i − c_o)/2). Equal angles give a sharp edge. Cosines are stored as 1 − c, so that narrow
//! spots keep their digits.

use core::f64::consts::{PI, TAU};

use etendue_core::maths;
use glam::Vec3;

use super::spread::{self, DirectionalExtent, ProfileNode};

/// A spot's field.
#[derive(Clone, Debug, PartialEq)]
pub struct Cone {
    /// 1 − c_i and 1 − c_o.
    inner: f32,
    outer: f32,
    spread: DirectionalExtent,
}

/// Error of a spot.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ConeError {
    /// The angles are out of order or of range.
    #[error(
        "the cone's half angles are {inner_rad} (inner) and {outer_rad} rad (outer); expected 0 ≤ inner ≤ outer ≤ π and outer > \
         0"
    )]
    Angles {
        /// The inner half angle, rad.
        inner_rad: f64,
        /// The outer half angle, rad.
        outer_rad: f64,
    },
}

impl Cone {
    /// A spot of full value up to the half angle `inner_rad` and zero beyond `outer_rad`.
    ///
    /// # Errors
    /// If not 0 ≤ inner ≤ outer ≤ π, or the outer angle is zero.
    pub fn new(inner_rad: f64, outer_rad: f64) -> Result<Self, ConeError> {
        let legal = 0.0 <= inner_rad && inner_rad <= outer_rad && outer_rad <= PI && outer_rad > 0.0;
        let outer = one_minus_cos(outer_rad);
        if !legal || (outer as f32) < f32::MIN_POSITIVE {
            return Err(ConeError::Angles { inner_rad, outer_rad });
        }
        let inner = one_minus_cos(inner_rad);
        let spread = DirectionalExtent {
            flux_sr: TAU * (inner + 0.5 * (outer - inner)),
            peak: 1.0,
            axis: Vec3::X,
            core_rad: (0.5 * (inner_rad + outer_rad)) as f32,
            reach_rad: outer_rad as f32,
        };
        Ok(Self { inner: inner as f32, outer: outer as f32, spread })
    }

    pub(super) fn value(&self, direction: Vec3) -> f32 {
        let aside2 = direction.y * direction.y + direction.z * direction.z;
        let from_axis = 0.5 * ((1.0 - direction.x) * (1.0 - direction.x) + aside2);
        if from_axis <= self.inner {
            return 1.0;
        }
        let t = (self.outer - from_axis) / (self.outer - self.inner);
        if t > 0.0 { t * t * (3.0 - 2.0 * t) } else { 0.0 }
    }

    pub(super) fn spread(&self) -> &DirectionalExtent {
        &self.spread
    }

    pub(super) fn nodes(&self) -> Vec<ProfileNode> {
        spread::cap(f64::from(self.outer), |direction| self.value(direction))
    }
}

fn one_minus_cos(angle_rad: f64) -> f64 {
    let sin = maths::f64::sin(0.5 * angle_rad);
    2.0 * sin * sin
}
