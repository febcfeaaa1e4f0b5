//! The GGX distribution of microfacets with height-correlated Smith shadowing.
//!
//! D(m) = 1 / (π α² ((mₓ² + m_y²)/α² + m_z²)²) (Walter et al. 2007), isotropic, roughness α in (0, 1]. Reflection: f = F · D · G₂ / (4 cos θₒ cos
//! θᵢ), G₂ = 1/(1 + Λₒ + Λᵢ) (Heitz 2014). Visible facets are sampled (Heitz 2018) by the spherical-cap construction (Dupuy & Benyoub 2023). Multiple
//! scattering among facets is left out: a rough white surface of α = 1 loses up to six tenths.
//!
//! All directions are in the shading frame (z = normal), unit, on the side z > 0.

use core::f32::consts::{PI, TAU};

use etendue_core::maths::f32::sin_cos;
use glam::{Vec2, Vec3};

use super::beckmann::Beckmann;
use super::gloss::{GlossLobe, LobeCentre};

/// Roughness α below which a surface is an exact mirror: the lobe would be narrower than a hundredth of a degree.
pub const MIRROR_ALPHA: f32 = 1e-4;

/// A GGX distribution. Directions are unit, in the shading frame, on the side z > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    pub(super) alpha: f32,
}

impl Ggx {
    /// The facets of a surface of roughness `alpha` (0 to 1); `None` if it is smooth.
    #[must_use]
    pub fn from_alpha(alpha: f32) -> Option<Self> {
        (alpha >= MIRROR_ALPHA).then_some(Self { alpha })
    }

    /// Density of facet normals by solid angle, over the projected area; 1/sr.
    #[must_use]
    pub fn density(self, m: Vec3) -> f32 {
        let a2 = self.alpha * self.alpha;
        let t = (m.x * m.x + m.y * m.y) / a2 + m.z * m.z;
        1.0 / (PI * a2 * t * t)
    }

    /// cos θ · √(1 + α² tan² θ), finite at grazing: 2 Λ + 1 = this / cos θ.
    fn slant(self, w: Vec3) -> f32 {
        let a2 = self.alpha * self.alpha;
        (w.z * w.z + a2 * (w.x * w.x + w.y * w.y)).sqrt()
    }

    /// f · cos θᵢ without the Fresnel factor, 1/sr; `m` is the unit half vector.
    #[must_use]
    pub fn reflect(self, wo: Vec3, wi: Vec3, m: Vec3) -> f32 {
        0.5 * self.density(m) * wi.z / (wi.z * self.slant(wo) + wo.z * self.slant(wi))
    }

    /// Density by solid angle of the direction reflected at a visible facet `m`, 1/sr.
    #[must_use]
    pub fn reflect_pdf(self, wo: Vec3, m: Vec3) -> f32 {
        0.5 * self.density(m) / (wo.z + self.slant(wo))
    }

    /// The lobe of facets of reflectance `f0` at normal incidence: its value at the axis is that of [`Self::reflect`] there.
    pub(super) fn gloss(self, wo: Vec3, f0: f32) -> GlossLobe {
        let peak = 0.5 * self.density(Vec3::Z) / (wo.z + self.slant(wo));
        GlossLobe { about: LobeCentre::HalfVector, width: self.alpha, peak, f0 }
    }

    /// G₂/G₁ = f cos θᵢ / (F · pdf) of a direction reflected at a visible facet.
    pub(super) fn weight(self, wo: Vec3, wi: Vec3) -> f32 {
        let so = self.slant(wo);
        wi.z * (wo.z + so) / (wi.z * so + wo.z * self.slant(wi))
    }

    /// Density by solid angle of the facet normals visible from `wo`, 1/sr: D · G₁ · (wo·m) / cos θₒ.
    pub(super) fn visible_pdf(self, wo: Vec3, m: Vec3) -> f32 {
        2.0 * wo.dot(m) * self.density(m) / (wo.z + self.slant(wo))
    }

    /// G₁: the visible fraction of facets facing `w`, on either side of the surface.
    #[must_use]
    pub fn shadowing(self, w: Vec3) -> f32 {
        2.0 * w.z.abs() / (w.z.abs() + self.slant(w))
    }

    /// Samples a facet normal visible from `wo`, by two numbers of [0, 1).
    #[must_use]
    pub fn sample(self, wo: Vec3, u: Vec2) -> Vec3 {
        let stretched = Vec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        let (sin_phi, cos_phi) = sin_cos(TAU * u.x);
        let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let h = Vec3::new(r * cos_phi, r * sin_phi, z) + stretched;
        // In exact arithmetic h.z > 0; rounding must not make it zero together with the rest.
        Vec3::new(self.alpha * h.x, self.alpha * h.y, h.z.max(1e-9)).normalize()
    }
}

/// The unit vector half-way between two directions of the upper hemisphere.
pub(super) fn half_vector(wo: Vec3, wi: Vec3) -> Vec3 {
    (wo + wi).normalize_or(Vec3::Z)
}

/// `w` reflected at the unit vector `m`.
pub(super) fn mirrored(w: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * w.dot(m)) - w
}

/// Distribution of the slopes of a rough surface's facets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distribution {
    /// GGX (Trowbridge and Reitz 1975, Walter et al. 2007): long tails, as measured surfaces have.
    #[default]
    Ggx,
    /// Beckmann: normally distributed slopes.
    Beckmann,
}

impl Distribution {
    pub(super) fn facets(self, alpha: f32) -> Facets {
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

    /// Density by solid angle of the direction reflected at a visible facet `m`, 1/sr.
    pub(super) fn reflect_pdf(self, wo: Vec3, m: Vec3) -> f32 {
        match self {
            Self::Ggx(ggx) => ggx.reflect_pdf(wo, m),
            Self::Beckmann(beckmann) => beckmann.reflect_pdf(wo, m),
        }
    }

    /// The lobe of facets of reflectance `f0` at normal incidence. Beckmann has the same peak as GGX of its roughness.
    pub(super) fn gloss(self, wo: Vec3, f0: f32) -> GlossLobe {
        match self {
            Self::Ggx(ggx) => ggx.gloss(wo, f0),
            Self::Beckmann(beckmann) => Ggx { alpha: beckmann.alpha }.gloss(wo, f0),
        }
    }

    /// f cos θᵢ / (F · pdf) of a direction reflected at a visible facet.
    pub(super) fn weight(self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            Self::Ggx(ggx) => ggx.weight(wo, wi),
            Self::Beckmann(beckmann) => beckmann.weight(wo, wi),
        }
    }

    /// Samples a facet normal visible from `wo`.
    pub(super) fn sample(self, wo: Vec3, u: Vec2) -> Vec3 {
        match self {
            Self::Ggx(ggx) => ggx.sample(wo, u),
            Self::Beckmann(beckmann) => beckmann.sample(wo, u),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_cover_the_plane_once() {
        // ∫ D(m) cos θ dω = 1, for every roughness; substitution tan θ = α t/(1 − t) keeps the peak resolved.
        for alpha in [1e-3_f32, 0.05, 0.3, 1.0] {
            let n = 4000;
            let sum: f64 = (0..n)
                .map(|i| {
                    let t = (i as f32 + 0.5) / n as f32;
                    let tan = alpha * t / (1.0 - t);
                    let cos = 1.0 / (1.0 + tan * tan).sqrt();
                    let m = Vec3::new(tan * cos, 0.0, cos);
                    let d_tan = alpha / ((1.0 - t) * (1.0 - t)) / n as f32;
                    // dω = 2π sin θ dθ and dθ = cos² θ d tan θ.
                    f64::from(Ggx { alpha }.density(m) * cos * TAU * (tan * cos) * cos * cos * d_tan)
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-4, "α {alpha}: {sum}");
        }
    }

    #[test]
    fn weights_are_value_over_density() {
        let wo = Vec3::new(0.6, 0.0, 0.8);
        for alpha in [0.01, 0.2, 0.9] {
            let ggx = Ggx { alpha };
            for i in 0..64 {
                let m = ggx.sample(wo, Vec2::new((i % 8) as f32 / 8.0, (i / 8) as f32 / 8.0));
                let wi = mirrored(wo, m);
                if wi.z > 1e-3 {
                    let ratio = ggx.reflect(wo, wi, m) / ggx.reflect_pdf(wo, m);
                    assert!((ratio - ggx.weight(wo, wi)).abs() < 1e-4 * ratio, "{alpha} {wi}");
                    assert!(ratio <= 1.0 + 1e-5);
                }
            }
        }
    }

    #[test]
    fn extremes_of_the_square_give_unit_normals() {
        for wo in [Vec3::Z, Vec3::X, Vec3::new(1.0, 0.0, 1e-7).normalize(), Vec3::new(0.0, 0.8, 0.6)] {
            for alpha in [1e-4, 1e-2, 1.0] {
                for u in [Vec2::ZERO, Vec2::new(0.5, 0.999_999_94), Vec2::splat(0.999_999_94), Vec2::new(0.5, 0.0)] {
                    let m = Ggx { alpha }.sample(wo, u);
                    assert!((m.length() - 1.0).abs() < 1e-5 && m.z > 0.0, "{wo} {alpha} {u}: {m}");
                }
            }
        }
    }
}
