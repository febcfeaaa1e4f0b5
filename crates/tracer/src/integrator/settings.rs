//! Settings of a path tracer.

use etendue_core::{Integrator, LightSampling, Setting, Word as _, words::SettingValue};

/// Settings of a path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// Simulated light paths.
    pub integrator: Integrator,
    /// Maximum number of scattering events; 1 if no paths are traced.
    pub max_bounces: u32,
    /// Scattering events after which paths may end at random. Paths that only mirrors have scattered never do.
    pub roulette_start: u32,
    /// Number of sampled lights, and of paths that continue, at the first surface that is no mirror; 1 or more (`path.rs`).
    pub branches: u32,
    /// Samples of a replicate, or of a run of them if their number is not known before. Paths that share their tails take turns over them.
    pub samples: u32,
    /// Full angle of the cone around a camera ray, rad: that of a pixel over the root of its samples. Selects the resolution of textures.
    pub cone_spread_rad: f32,
    /// Sampling strategies in use.
    pub strategies: Strategies,
    /// Method of light sampling.
    pub light_sampling: LightSampling,
    /// Includes caustics: light of suns and emitting surfaces that smooth surfaces focus on diffuse ones, and mirrors on much less glossy
    /// ones (`path_state.rs`). Without it the image is darker by that light, and free of the rare bright samples that find it.
    pub caustics: bool,
    /// Path-space regularisation (biased): widens microfacet lobes that the path would find by chance only (`surface.rs`).
    pub regularize: bool,
    /// Includes only airlight: light that media scatter into camera rays before these hit a surface, a drop or a flake.
    pub only_airlight: bool,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            integrator: Integrator::Path,
            max_bounces: 16,
            roulette_start: 2,
            branches: 1,
            samples: 1,
            cone_spread_rad: 0.0,
            strategies: Strategies::Both,
            light_sampling: LightSampling::Gloss,
            caustics: true,
            regularize: false,
            only_airlight: false,
        }
    }
}

impl PathSettings {
    /// The settings that a description states, by their keys.
    #[must_use]
    pub fn stated(&self) -> Vec<Setting> {
        vec![
            Setting::new("integrator", SettingValue::Word(self.integrator.word())),
            Setting::path_only("max_bounces", self.max_bounces.into()),
            Setting::path_only("caustics", (self.caustics && self.integrator == Integrator::Path).into()),
            Setting::path_only("regularize", self.regularize.into()),
            Setting::path_only("branches", self.branches.into()),
            Setting::new("light_sampling", SettingValue::Word(self.light_sampling.word())),
        ]
    }

    /// True if both settings give the same mean: they differ in noise at most.
    #[must_use]
    pub fn has_mean_of(&self, other: &Self) -> bool {
        Self { branches: other.branches, light_sampling: other.light_sampling, ..*self } == *other
    }
}

/// Sampling strategies that find light (multiple importance sampling). All give the same mean; those other than `Both` exist to verify it.
///
/// For textured emission the means differ by the filtering. The texture of a sampled light is averaged over the cone of the path as it
/// arrived; that of a light hit by chance is averaged over the cone widened by the scattering. `Both` then gives a mean of the two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strategies {
    /// Lights are sampled, and hit by chance; both are weighted.
    #[default]
    Both,
    /// Lights are only hit by chance.
    Scattering,
    /// Lights are only sampled, except those that cannot be: seen by the camera or in a mirror, or a uniform environment.
    Lights,
}

/// Weight of a strategy of density `this` against one of density `other`, for finite densities of 0 or more: the power heuristic with
/// exponent 2 (Veach and Guibas 1995), p²/(p² + q²).
fn power_heuristic(this: f32, other: f32) -> f32 {
    if this <= 0.0 {
        return 0.0;
    }
    // As a ratio, so that squares of large densities do not overflow.
    let ratio = other / this;
    1.0 / (1.0 + ratio * ratio)
}

impl Strategies {
    /// Weight of light hit by chance. `direction_pdf` is the density of the direction that hit it, `None` if it could not have been sampled
    /// from here (camera, mirror); `light_pdf` is the density of the same light under light sampling.
    pub(super) fn hit_weight(self, direction_pdf: Option<f32>, light_pdf: f32) -> f32 {
        match (self, direction_pdf) {
            (Self::Both, Some(direction_pdf)) if light_pdf > 0.0 => power_heuristic(direction_pdf, light_pdf),
            (Self::Lights, Some(_)) if light_pdf > 0.0 => 0.0,
            _ => 1.0,
        }
    }

    /// Weight of a sampled light.
    pub(super) fn sample_weight(self, light_pdf: f32, direction_pdf: f32) -> f32 {
        match self {
            Self::Both => power_heuristic(light_pdf, direction_pdf),
            Self::Scattering => 0.0,
            Self::Lights => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_sum_to_one_at_every_scale() {
        for (p, q) in [(1.0, 1.0), (1e-20, 1e20), (3e30, 2e30), (1e-38, 1e38), (5.0, 0.0)] {
            let sum = power_heuristic(p, q) + power_heuristic(q, p);
            assert!((sum - 1.0).abs() < 1e-6, "{p} {q}: {sum}");
        }
        assert_eq!(power_heuristic(0.0, 0.0), 0.0);
    }

    #[test]
    fn light_that_cannot_be_sampled_counts_in_full() {
        for strategies in [Strategies::Both, Strategies::Scattering, Strategies::Lights] {
            assert_eq!(strategies.hit_weight(None, 3.0), 1.0);
            assert_eq!(strategies.hit_weight(Some(3.0), 0.0), 1.0);
        }
    }
}
