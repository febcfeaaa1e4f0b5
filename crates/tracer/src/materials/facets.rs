//! Micro-facet distributions by name.

use glam::{Vec2, Vec3};

use super::beckmann::Beckmann;
use super::gloss::GlossLobe;
use super::microfacet::Ggx;

/// How the slopes of a rough surface's facets are distributed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distribution {
    /// GGX (Trowbridge and Reitz 1975, Walter et al. 2007): long tails, as measured surfaces have.
    #[default]
    Ggx,
    /// Beckmann: normally distributed slopes.
    Beckmann,
}

impl Distribution {
    pub(super) fn of_alpha(self, alpha: f32) -> Facets {
        match self {
            Self::Ggx => Facets::Ggx(Ggx { alpha }),
            Self::Beckmann => Facets::Beckmann(Beckmann { alpha }),
        }
    }
}

/// A distribution of a roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Facets {
    Ggx(Ggx),
    Beckmann(Beckmann),
}

impl Facets {
    /// f · cos θᵢ without the Fresnel factor, 1/sr; `m` is the unit half vector.
    pub(super) fn reflect(self, wo: Vec3, wi: Vec3, m: Vec3) -> f32 {
        match self {
            Self::Ggx(ggx) => ggx.reflect(wo, wi, m),
            Self::Beckmann(beckmann) => beckmann.reflect(wo, wi, m),
        }
    }

    /// Density by solid angle of the direction mirrored at a visible facet `m`, 1/sr.
    pub(super) fn reflect_pdf(self, wo: Vec3, m: Vec3) -> f32 {
        match self {
            Self::Ggx(ggx) => ggx.reflect_pdf(wo, m),
            Self::Beckmann(beckmann) => beckmann.reflect_pdf(wo, m),
        }
    }

    /// The lobe of facets of reflectance `f0` at normal incidence. A Gaussian of slopes has the same peak as GGX of its roughness.
    pub(super) fn gloss(self, wo: Vec3, f0: f32) -> GlossLobe {
        match self {
            Self::Ggx(ggx) => ggx.gloss(wo, f0),
            Self::Beckmann(beckmann) => Ggx { alpha: beckmann.alpha }.gloss(wo, f0),
        }
    }

    /// f cos θᵢ / (F · pdf) of a direction mirrored at a visible facet.
    pub(super) fn weight(self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            Self::Ggx(ggx) => ggx.weight(wo, wi),
            Self::Beckmann(beckmann) => beckmann.weight(wo, wi),
        }
    }

    /// A facet normal drawn from those that `wo` sees.
    pub(super) fn sample(self, wo: Vec3, u: Vec2) -> Vec3 {
        match self {
            Self::Ggx(ggx) => ggx.sample(wo, u),
            Self::Beckmann(beckmann) => beckmann.sample(wo, u),
        }
    }
}
