//! Data of a surface for light selection: its diffuse part, and its narrow lobes.
//!
//! A lobe is described by a kernel of one shape (that of GGX, Walter et al. 2007),
//!
//! f cos θᵢ ≈ peak · F · [w²/(w² + t²)]²,
//!
//! t the distance from the lobe's axis. The kernel equals the model at the axis, where a lobe is brightest. Elsewhere they may differ, as a choice
//! may use any probabilities.

use glam::Vec3;

/// Maximum number of described lobes: the brightest.
pub(crate) const MAX_GLOSS_LOBES: usize = 2;

/// A surface's gloss at one point for one viewer, in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gloss {
    /// Mean BSDF of the diffuse part, 1/sr.
    pub(crate) diffuse: f32,
    /// Lobes; those without a peak do not exist.
    pub(crate) lobes: [GlossLobe; MAX_GLOSS_LOBES],
}

/// A narrow lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GlossLobe {
    /// Origin of t.
    pub(crate) about: LobeCentre,
    /// w, in units of t.
    pub(crate) width: f32,
    /// f cos θᵢ at the axis without the Fresnel factor, 1/sr.
    pub(crate) peak: f32,
    /// F at normal incidence; elsewhere it is Schlick's (1994).
    pub(crate) f0: f32,
}

/// The axis of a lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LobeCentre {
    /// The normal, to be compared with the half vector of viewer and light: t is the tangent of the angle between them.
    HalfVector,
    /// A unit direction of incoming light: t is the distance from it on the unit sphere.
    Direction(Vec3),
}

impl GlossLobe {
    const NONE: Self = Self { about: LobeCentre::HalfVector, width: 1.0, peak: 0.0, f0: 0.0 };

    /// A lobe about a unit direction with the total albedo `albedo`: ∫ [w²/(w² + t²)]² 2π t dt = π w².
    pub(super) fn from_albedo(direction: Vec3, peak: f32, albedo: f32) -> Self {
        let width2 = core::f32::consts::FRAC_1_PI * albedo / peak.max(f32::MIN_POSITIVE);
        Self { about: LobeCentre::Direction(direction), width: width2.sqrt(), peak, f0: 1.0 }
    }

    /// Approximate density with which the lobe alone is sampled at its axis, 1/sr: that of a kernel whose integral is 1.
    pub(crate) fn density_at_axis(&self) -> f32 {
        let kernel = core::f32::consts::FRAC_1_PI / (self.width * self.width).max(f32::MIN_POSITIVE);
        match self.about {
            // Half vectors turn by half the angle of directions.
            LobeCentre::HalfVector => 0.25 * kernel,
            LobeCentre::Direction(_) => kernel,
        }
    }

    /// F at the axis, for a viewer of this cosine.
    pub(crate) fn fresnel_at_axis(&self, cos_o: f32) -> f32 {
        schlick(self.f0, cos_o)
    }
}

impl Gloss {
    /// A surface without narrow lobes.
    pub(super) const MATT: Self = Self { diffuse: 1.0, lobes: [GlossLobe::NONE; MAX_GLOSS_LOBES] };

    /// A diffuse part alone, of mean BSDF `matt`, 1/sr.
    pub(super) fn from_diffuse(diffuse: f32) -> Self {
        Self { diffuse, ..Self::MATT }
    }

    /// Keeps only the lobes that `keep` selects.
    pub(crate) fn retain_lobes(mut self, keep: impl Fn(&GlossLobe) -> bool) -> Self {
        for lobe in &mut self.lobes {
            if lobe.peak > 0.0 && !keep(lobe) {
                *lobe = GlossLobe::NONE;
            }
        }
        self
    }

    /// Adds a lobe; of too many the weakest is left out.
    pub(super) fn with(mut self, lobe: GlossLobe) -> Self {
        let weakest = (0..MAX_GLOSS_LOBES)
            .fold(0, |weakest, i| if self.lobes[i].peak < self.lobes[weakest].peak { i } else { weakest });
        if lobe.peak > self.lobes[weakest].peak && lobe.peak.is_finite() {
            self.lobes[weakest] = lobe;
        }
        self
    }
}

/// Schlick's approximation of Fresnel's reflectance.
pub(crate) fn schlick(f0: f32, cos: f32) -> f32 {
    let x = 1.0 - cos.clamp(0.0, 1.0);
    let x2 = x * x;
    f0 + (1.0 - f0) * (x2 * x2 * x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::microfacet::Ggx;
    use core::f32::consts::PI;

    /// GGX has D = 1/(πα²) at the normal (Walter et al. 2007), and half vectors along it are sampled with the density D/4 by direction.
    #[test]
    fn a_lobe_is_as_dense_at_its_axis_as_what_it_tells_of() {
        for alpha in [0.005, 0.06, 0.2] {
            let lobe = Ggx { alpha }.gloss(Vec3::Z, 0.04);
            assert!((lobe.density_at_axis() * 4.0 * PI * alpha * alpha - 1.0).abs() < 1e-4, "{lobe:?}");
        }
        let wide = GlossLobe::from_albedo(Vec3::Z, 3.0, 0.5);
        // All reflected light lies within the lobe: peak over albedo.
        assert!((wide.density_at_axis() - 6.0).abs() < 1e-4, "{wide:?}");
    }
}
