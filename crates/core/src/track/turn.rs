//! Rotations between two keys.

use glam::{DQuat, DVec3};

use crate::maths;

/// A rotation over a parameter u from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Turn {
    /// About one axis at constant rate (slerp, Shoemake 1985): start · exp(u · vector).
    Even {
        /// Rotation at u = 0.
        start: DQuat,
        /// Axis times angle, rad, in the turning frame.
        vector: DVec3,
    },
    /// A cubic Hermite curve on the sphere of unit quaternions (Kim, Kim, Shin 1995, "A general construction scheme for unit
    /// quaternion curves with simple high order derivatives", SIGGRAPH, section 5.2): start · Π exp(βᵢ(u) · vectorᵢ) with the
    /// cumulative Bernstein polynomials β₁ = 1 − (1 − u)³, β₂ = 3u² − 2u³, β₃ = u³.
    Smooth {
        /// Rotation at u = 0.
        start: DQuat,
        /// Axes times angles, rad.
        vectors: [DVec3; 3],
    },
    /// About y by an angle that is a cubic polynomial of u, of any size.
    Rolling {
        /// Coefficients of 1, u, u² and u³, rad.
        angle: [f64; 4],
    },
}

impl Turn {
    /// Returns the rotation from `start` to `end` along the shorter arc at constant rate.
    pub(super) fn even(start: DQuat, end: DQuat) -> Self {
        Self::Even { start, vector: vector_between(start, end) }
    }

    /// Returns the rotation from `start` to `end` with the angular velocities `leaves` and `arrives`, rad per unit of u in the turning frame.
    pub(super) fn smooth(start: DQuat, end: DQuat, leaves: DVec3, arrives: DVec3) -> Self {
        let rotation = vector_between(start, end);
        if leaves == rotation && arrives == rotation {
            return Self::Even { start, vector: rotation };
        }
        let (first, last) = (leaves / 3.0, arrives / 3.0);
        let rest = exp(-first) * start.conjugate() * end * exp(-last);
        Self::Smooth { start, vectors: [first, log(rest), last] }
    }

    pub(super) fn at(&self, u: f64) -> DQuat {
        match self {
            Self::Even { start, vector } => *start * exp(*vector * u),
            Self::Smooth { start, vectors: [a, b, c] } => {
                let rest = 1.0 - u;
                let weights = [1.0 - rest * rest * rest, u * u * (3.0 - 2.0 * u), u * u * u];
                *start * exp(*a * weights[0]) * exp(*b * weights[1]) * exp(*c * weights[2])
            }
            Self::Rolling { angle: [a, b, c, d] } => rolled(a + (b + (c + d * u) * u) * u),
        }
    }

    /// The angular velocity, rad per unit of u, in the turning frame. With R = R₀ A₁ A₂ A₃ the part of Aᵢ is rotated back by those after it.
    pub(super) fn velocity(&self, u: f64) -> DVec3 {
        match self {
            Self::Even { vector, .. } => *vector,
            Self::Smooth { vectors: [a, b, c], .. } => {
                let rest = 1.0 - u;
                let rates = [3.0 * rest * rest, 6.0 * u * rest, 3.0 * u * u];
                let back = [exp(*b * (-u * u * (3.0 - 2.0 * u))), exp(*c * (-u * u * u))];
                back[1] * (back[0] * (*a * rates[0]) + *b * rates[1]) + *c * rates[2]
            }
            Self::Rolling { angle } => DVec3::Y * slope(angle, u),
        }
    }

    /// Returns true if it is constant.
    pub(super) fn is_constant(&self) -> bool {
        match self {
            Self::Even { vector, .. } => *vector == DVec3::ZERO,
            Self::Smooth { vectors, .. } => *vectors == [DVec3::ZERO; 3],
            Self::Rolling { angle } => angle[1..] == [0.0; 3],
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        match self {
            Self::Even { start, vector } => start.is_finite() && vector.is_finite(),
            Self::Smooth { start, vectors } => start.is_finite() && vectors.iter().all(|v| v.is_finite()),
            Self::Rolling { angle } => angle.iter().all(|a| a.is_finite()),
        }
    }

    /// Returns bounds, within [u0, u1], of |Ṙ y| and |R̈ y| for vectors y of length 1.
    ///
    /// With R = R₀ A₁ A₂ A₃, Aᵢ = exp(βᵢ (ωᵢ×)): Ȧᵢ = β̇ᵢ Aᵢ (ωᵢ×) has the norm aᵢ = |β̇ᵢ| |ωᵢ|, and Äᵢ one of at most aᵢ² + |β̈ᵢ| |ωᵢ|. The product rule gives
    /// |Ṙ| ≤ Σ aᵢ and |R̈| ≤ (Σ aᵢ)² + Σ |β̈ᵢ| |ωᵢ|.
    pub(super) fn max_rates(&self, u0: f64, u1: f64) -> (f64, f64) {
        match self {
            Self::Even { vector, .. } => (vector.length(), vector.length_squared()),
            Self::Smooth { vectors, .. } => {
                let middle = if u0 > 0.5 { u0 } else { u1.min(0.5) };
                let first = [3.0 * (1.0 - u0) * (1.0 - u0), 6.0 * middle * (1.0 - middle), 3.0 * u1 * u1];
                let second = [6.0 * (1.0 - u0), (6.0 - 12.0 * u0).abs().max((6.0 - 12.0 * u1).abs()), 6.0 * u1];
                let angles = vectors.map(DVec3::length);
                let sum = |weights: [f64; 3]| weights.iter().zip(angles).map(|(w, angle)| w * angle).sum::<f64>();
                let rate = sum(first);
                (rate, rate * rate + sum(second))
            }
            Self::Rolling { angle } => {
                let curve = |u: f64| (2.0 * angle[2] + 6.0 * angle[3] * u).abs();
                let second = curve(u0).max(curve(u1));
                // No place is farther than half the length from an end.
                let rate = slope(angle, u0).abs().max(slope(angle, u1).abs()) + second * (0.5 * (u1 - u0));
                (rate, rate * rate + second)
            }
        }
    }
}

/// The derivative of a cubic polynomial.
fn slope([_, b, c, d]: &[f64; 4], u: f64) -> f64 {
    b + (2.0 * c + 3.0 * d * u) * u
}

/// The rotation about y by an angle, rad.
pub(super) fn rolled(angle: f64) -> DQuat {
    let (sin, cos) = maths::f64::sin_cos(0.5 * angle);
    DQuat::from_xyzw(0.0, sin, 0.0, cos)
}

/// Axis times angle, rad, of the shorter rotation from one rotation to another, in the frame of the first.
pub(super) fn vector_between(start: DQuat, end: DQuat) -> DVec3 {
    if start == end { DVec3::ZERO } else { log(start.conjugate() * end) }
}

/// The rotation by an angle |v|, rad, about an axis v.
fn exp(v: DVec3) -> DQuat {
    let half = v * 0.5;
    let angle = half.length();
    if angle == 0.0 {
        return DQuat::IDENTITY;
    }
    let (sin, cos) = maths::f64::sin_cos(angle);
    DQuat::from_vec4((half * (sin / angle)).extend(cos))
}

/// Axis times angle, rad, at most π, of a rotation.
fn log(q: DQuat) -> DVec3 {
    let v = DVec3::new(q.x, q.y, q.z);
    let sine = v.length();
    if sine == 0.0 {
        return DVec3::ZERO;
    }
    let angle = 2.0 * maths::f64::atan2(sine, q.w.abs());
    v * (if q.w < 0.0 { -angle } else { angle } / sine)
}
