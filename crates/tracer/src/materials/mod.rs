//! Materials: how a surface scatters light, and what it emits.
//!
//! # Contract
//! - A [`Material`] is a [`Surface`] and, where it glows, an [`Emission`]. Both sides of a surface scatter alike;
//!   emission says which sides glow.
//! - At a point of a surface, [`Palette::bsdf`] evaluates textures and spectra once and gives a [`Bsdf`] for the path's
//!   wavelengths.
//! - Directions `wo` (towards the viewer) and `wi` (towards the light) are unit vectors that point away from the
//!   surface, in the shading frame: z is the shading normal on the side of `wo`. Both have z > 0: nothing here transmits.
//! - `value_cos` is bsdf × cos θᵢ (1/sr), so that nothing divides by a cosine that vanishes. `weight` of a sample is
//!   bsdf × cos θᵢ / pdf. `pdf` is by solid angle, 1/sr, of the whole sampling routine.
//! - A mirror's direction has no finite density: its sample says `mirror`, and evaluation leaves that lobe out.
//! - Every bsdf is reciprocal and reflects no more than arrives; no input in range gives a NaN.

mod coated;
mod conductor;
mod diffuse;
mod emission;
pub mod fresnel;
mod microfacet;
mod palette;
mod reflectance;
mod shading;
#[cfg(test)]
mod tests;

pub use coated::{COAT_INDICES, Coated, CoatedBsdf};
pub use conductor::{Conductor, ConductorBsdf, MIRROR_ALPHA};
pub use diffuse::DiffuseBsdf;
pub use emission::{Emission, Glow};
pub use palette::Palette;
pub use reflectance::Reflectance;
pub use shading::ShadingFrame;

use etendue_core::Spectral;
use glam::{Vec2, Vec3};

/// A material: what happens to light at a surface, and what light starts there.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// How it scatters.
    pub surface: Surface,
    /// What it emits; `None` where it does not glow.
    pub emission: Option<Emission>,
}

/// How a surface scatters light.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// All light that arrives is absorbed: a pure emitter, or black.
    Absorber,
    /// Lambert's law with a reflectance.
    Diffuse(Reflectance),
    /// A smooth or rough metal.
    Conductor(Box<Conductor>),
    /// A matt base under a clear coat.
    Coated(Box<Coated>),
}

/// Scattering at one point, at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub enum Bsdf<'a, const N: usize> {
    /// Nothing is scattered.
    Absorber,
    /// Lambert's law.
    Diffuse(DiffuseBsdf<N>),
    /// A metal.
    Conductor(ConductorBsdf<N>),
    /// A coated base.
    Coated(CoatedBsdf<'a, N>),
}

/// What a bsdf says of a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfValue<const N: usize> {
    /// bsdf × cos θᵢ, 1/sr.
    pub value_cos: Spectral<N>,
    /// Density with which sampling would give this `wi`, 1/sr.
    pub pdf: f32,
}

impl<const N: usize> BsdfValue<N> {
    /// Nothing goes this way.
    pub const ZERO: Self = Self { value_cos: Spectral::ZERO, pdf: 0.0 };
}

/// A direction drawn from a bsdf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample<const N: usize> {
    /// Where light comes from; unit, z > 0.
    pub wi: Vec3,
    /// bsdf × cos θᵢ / pdf; for a mirror its reflectance over the probability of choosing it.
    pub weight: Spectral<N>,
    /// Density of `wi`, 1/sr; 0 and without meaning for a mirror.
    pub pdf: f32,
    /// Whether the direction is the exact mirror direction.
    pub mirror: bool,
}

impl<const N: usize> BsdfSample<N> {
    fn mirror(wo: Vec3, weight: Spectral<N>) -> Self {
        Self { wi: Vec3::new(-wo.x, -wo.y, wo.z), weight, pdf: 0.0, mirror: true }
    }
}

impl<const N: usize> Bsdf<'_, N> {
    /// Whether all light is mirrored exactly, so that asking for a light drawn elsewhere is in vain.
    #[must_use]
    pub fn is_mirror(&self) -> bool {
        matches!(self, Self::Conductor(conductor) if conductor.is_mirror())
    }

    /// Value and density of a pair of directions; zero where either is below the surface.
    #[must_use]
    pub fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return BsdfValue::ZERO;
        }
        match self {
            Self::Absorber => BsdfValue::ZERO,
            Self::Diffuse(diffuse) => diffuse.evaluate(wi),
            Self::Conductor(conductor) => conductor.evaluate(wo, wi),
            Self::Coated(coated) => coated.evaluate(wo, wi),
        }
    }

    /// A direction for light to come from; `None` where the light is absorbed. `choice` picks a lobe, `u` a direction.
    #[must_use]
    pub fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        if wo.z <= 0.0 {
            return None;
        }
        match self {
            Self::Absorber => None,
            Self::Diffuse(diffuse) => diffuse.sample(u),
            Self::Conductor(conductor) => conductor.sample(wo, u),
            Self::Coated(coated) => coated.sample(wo, choice, u),
        }
    }
}

/// Why a material is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A roughness is outside its range.
    #[error("a roughness α of {alpha} was given, but it must lie between 0 (mirror) and 1; correct it")]
    Roughness {
        /// What was given.
        alpha: f64,
    },
    /// A coat's refractive index is outside its range.
    #[error("a coat of refractive index {n} was given, but it must lie between 1.1 and 4; correct it")]
    CoatIndex {
        /// What was given.
        n: f64,
    },
    /// A metal's index is not a substance's.
    #[error("the complex index at {nm} nm is not a substance's: n and k must be 0 or more, not both 0, and finite")]
    Index {
        /// Where, nm.
        nm: u16,
    },
    /// A reflectance leaves the range 0–1.
    #[error("material {material} has a reflectance of {value}, but it must lie between 0 and 1; scale it")]
    Reflectance {
        /// The material's place.
        material: usize,
        /// The value found.
        value: f32,
    },
    /// An emission is negative or not finite.
    #[error("material {material} emits {value} W.m^-2.sr^-1.nm^-1, but radiance must be 0 or more and finite")]
    Radiance {
        /// The material's place.
        material: usize,
        /// The value found.
        value: f32,
    },
    /// A material names a texture that is not there.
    #[error("material {material} names texture {texture}, but there are {textures}; add the texture first")]
    UnknownTexture {
        /// The material's place.
        material: usize,
        /// The texture it names.
        texture: u32,
        /// Number of textures.
        textures: usize,
    },
}

fn check_alpha(alpha: f64) -> Result<f32, MaterialError> {
    if (0.0..=1.0).contains(&alpha) { Ok(alpha as f32) } else { Err(MaterialError::Roughness { alpha }) }
}
