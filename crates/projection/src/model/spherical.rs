//! Models by projections of a unit sphere: unified, extended unified, double sphere.
//!
//! The unified omnidirectional model: a unit sphere seen from a point ξ behind its centre, then a distortion.
//!
//! r = sin θ/(cos θ + ξ), then k₁, k₂, p₁, p₂ (Geyer & Daniilidis 2000; Mei & Rives 2007, `cv::omnidir`, Kalibr's omni-none
//! and omni-radtan). ξ = 0 is the pinhole, 1 the stereographic projection.
//!
//! The field ends, by the formula and without a fold of the calibration, at cos θ = −ξ for ξ ≤ 1 (at infinity) and at
//! cos θ = −1/ξ for ξ > 1 (at r = 1/√(ξ² − 1)). Mirrors are described by ξ and γ; γ is in the camera matrix.
//!
//! The extended unified model: an ellipsoid in place of the sphere.
//!
//! r = sin θ/(α √(β sin² θ + cos² θ) + (1 − α) cos θ), 0 ≤ α ≤ 1, β > 0 (Khomutenko, Garcia & Martinet 2016; Kalibr's
//! eucm-none, COLMAP's EUCM). β = 1 is the unified model with ξ = α/(1 − α) and a focal length of f/(1 − α).
//!
//! The field ends without a fold where cos θ = −w √(β sin² θ + cos² θ), w = α/(1 − α) or its inverse, whichever is smaller.
//!
//! The double sphere model: a unit sphere, a second one ξ behind it, then the unified projection by α.
//!
//! r = sin θ/(α d + (1 − α)(ξ + cos θ)), d = √(sin² θ + (ξ + cos θ)²), −1 < ξ < 1, 0 ≤ α ≤ 1
//! (Usenko, Demmel & Cremers 2018, eqs. 40–45; Kalibr's ds-none).
//!
//! The field ends without a fold where r is largest (α > ½) or infinite: at ξ + cos θ = −w d with w = α/(1 − α) or its inverse, whichever is smaller,
//! that is at cos θ = −ξ (1 − w²) − w √(1 − ξ² (1 − w²)). The paper's bound −w₂ (eq. 43) comes before it for ξ > 0, and after it for ξ < 0, where two
//! directions already share a point.

use etendue_core::maths::f64::{acos, atan2, sin_cos};

use super::ModelError;
use super::profile::{DistortedProfile, FieldEdge, Profile, Projection};
use crate::plane::{Distortion, DistortionTerms};
use crate::rectilinear::legal;

/// The unified model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unified(DistortedProfile<UnifiedSphere>);

impl Unified {
    /// Creates the camera from ξ ≥ 0 and distortion terms; Mei's are `numerator` k₁, k₂ and `tangential` p₁, p₂.
    ///
    /// # Errors
    /// If ξ is negative or a number is not finite.
    pub fn new(xi: f64, terms: DistortionTerms) -> Result<Self, ModelError> {
        legal("xi", xi, xi >= 0.0, "0 or a positive number")?;
        terms.check()?;
        let profile = UnifiedSphere { xi };
        Ok(Self(DistortedProfile { profile, distortion: Distortion::new(terms, profile.reach()) }))
    }

    /// ξ.
    #[must_use]
    pub fn xi(&self) -> f64 {
        self.0.profile.xi
    }

    #[must_use]
    pub fn distortion(&self) -> &Distortion {
        &self.0.distortion
    }

    pub(super) fn projection(&self) -> &dyn Projection {
        &self.0
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct UnifiedSphere {
    xi: f64,
}

impl UnifiedSphere {
    /// The upper bound of the radius.
    fn reach(self) -> f64 {
        if self.xi > 1.0 { 1.0 / (self.xi * self.xi - 1.0).sqrt() } else { 1e8 }
    }
}

impl Profile for UnifiedSphere {
    fn edge(&self) -> FieldEdge {
        FieldEdge::end(acos(-self.xi.min(1.0 / self.xi)))
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        sin / (cos + self.xi)
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let (_, cos) = sin_cos(angle_rad);
        (1.0 + self.xi * cos) / ((cos + self.xi) * (cos + self.xi))
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let s = radius * radius;
        let under = 1.0 + (1.0 - self.xi * self.xi) * s;
        let scale = (self.xi + under.sqrt()) / (1.0 + s);
        (under >= 0.0).then(|| atan2(scale * radius, scale - self.xi))
    }
}

/// The extended unified model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedUnified {
    alpha: f64,
    beta: f64,
}

impl ExtendedUnified {
    /// Creates the camera from α and β.
    ///
    /// # Errors
    /// If α is not in [0, 1] or β not positive.
    pub fn new(alpha: f64, beta: f64) -> Result<Self, ModelError> {
        legal("alpha", alpha, (0.0..=1.0).contains(&alpha), "a number from 0 to 1")?;
        legal("beta", beta, beta > 0.0, "a positive number")?;
        Ok(Self { alpha, beta })
    }

    /// α.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// β.
    #[must_use]
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// √(β sin² θ + cos² θ).
    fn distance(&self, sin: f64, cos: f64) -> f64 {
        (self.beta * sin * sin + cos * cos).sqrt()
    }
}

impl Profile for ExtendedUnified {
    fn edge(&self) -> FieldEdge {
        let w = self.alpha.min(1.0 - self.alpha) / self.alpha.max(1.0 - self.alpha);
        FieldEdge::end(atan2((1.0 - w * w).sqrt(), -w * self.beta.sqrt()))
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        sin / (self.alpha * self.distance(sin, cos) + (1.0 - self.alpha) * cos)
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        let distance = self.distance(sin, cos);
        let below = self.alpha * distance + (1.0 - self.alpha) * cos;
        ((1.0 - self.alpha) + self.alpha * cos / distance) / (below * below)
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let s = self.beta * radius * radius;
        let under = 1.0 - (2.0 * self.alpha - 1.0) * s;
        let forward = (1.0 - self.alpha * self.alpha * s) / (self.alpha * under.sqrt() + (1.0 - self.alpha));
        (under >= 0.0).then(|| atan2(radius, forward))
    }
}

/// The double sphere model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleSphere {
    xi: f64,
    alpha: f64,
}

impl DoubleSphere {
    /// Creates the camera from ξ and α.
    ///
    /// # Errors
    /// If ξ is not between −1 and 1 or α not in [0, 1].
    pub fn new(xi: f64, alpha: f64) -> Result<Self, ModelError> {
        legal("xi", xi, xi.abs() < 1.0, "a number between -1 and 1")?;
        legal("alpha", alpha, (0.0..=1.0).contains(&alpha), "a number from 0 to 1")?;
        Ok(Self { xi, alpha })
    }

    /// ξ.
    #[must_use]
    pub fn xi(&self) -> f64 {
        self.xi
    }

    /// α.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// ξ + cos θ, d and the denominator.
    fn parts(&self, sin: f64, cos: f64) -> [f64; 3] {
        let forward = self.xi + cos;
        let d = (sin * sin + forward * forward).sqrt();
        [forward, d, self.alpha * d + (1.0 - self.alpha) * forward]
    }
}

impl Profile for DoubleSphere {
    fn edge(&self) -> FieldEdge {
        let w = self.alpha.min(1.0 - self.alpha) / self.alpha.max(1.0 - self.alpha);
        let rest = 1.0 - w * w;
        let cos = -self.xi * rest - w * (1.0 - self.xi * self.xi * rest).sqrt();
        FieldEdge::end(acos(cos.clamp(-1.0, 1.0)))
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        sin / self.parts(sin, cos)[2]
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        let [_, d, below] = self.parts(sin, cos);
        let second = (cos * d * d + self.xi * sin * sin) / d;
        (self.alpha * second + (1.0 - self.alpha) * (1.0 + self.xi * cos)) / (below * below)
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let (s, a) = (radius * radius, self.alpha);
        let under = 1.0 - (2.0 * a - 1.0) * s;
        let forward = (1.0 - a * a * s) / (a * under.sqrt() + (1.0 - a));
        let root = (forward * forward + (1.0 - self.xi * self.xi) * s).sqrt();
        let scale = (forward * self.xi + root) / (forward * forward + s);
        (under >= 0.0).then(|| atan2(scale * radius, scale * forward - self.xi))
    }
}
