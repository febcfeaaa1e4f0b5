//! What a bsdf says of a pair of directions, and of a direction that it draws.

use etendue_core::Spectral;
use glam::Vec3;

/// What a bsdf says of a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfValue<const N: usize> {
    /// bsdf × |cos θᵢ|, 1/sr.
    pub value_cos: Spectral<N>,
    /// Density with which sampling would give this `wi`, 1/sr.
    pub pdf: f32,
}

impl<const N: usize> BsdfValue<N> {
    /// Nothing goes this way.
    pub const ZERO: Self = Self { value_cos: Spectral::ZERO, pdf: 0.0 };
}

/// What happened to a path at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// It was scattered, by a finite density.
    Scatter,
    /// It was reflected or refracted in the one exact direction.
    Specular,
    /// It went straight on, as if nothing had been there: no scattering event. The path keeps the direction it had.
    Null,
}

/// A direction drawn from a bsdf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample<const N: usize> {
    /// Where light comes from; unit, never in the surface's plane.
    pub wi: Vec3,
    /// bsdf × |cos θᵢ| / pdf; of an exact direction its reflectance or transmittance over the probability of choosing it.
    pub weight: Spectral<N>,
    /// Density of `wi`, 1/sr; 0 and without meaning for an exact direction.
    pub pdf: f32,
    /// What happened.
    pub event: Event,
}

impl<const N: usize> BsdfSample<N> {
    pub(super) fn mirror(wo: Vec3, weight: Spectral<N>) -> Self {
        Self { wi: Vec3::new(-wo.x, -wo.y, wo.z), weight, pdf: 0.0, event: Event::Specular }
    }
}
