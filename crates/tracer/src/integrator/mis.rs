//! Weighing two ways of finding the same light.
//!
//! The power heuristic with exponent 2 (Veach and Guibas 1995): a way of density p counts p²/(p² + q²).

/// Which ways of finding light are used. All give the same mean; the others than `Both` exist to prove it.
///
/// Where a glow is textured they do but for the filtering: a drawn light's texture is averaged over the cone of the path
/// as it arrived, one met by chance over the cone widened by the scattering. `Both` then gives a mean of the two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strategies {
    /// Lights are drawn, and met by chance; both are weighed.
    #[default]
    Both,
    /// Lights are only met by chance.
    Scattering,
    /// Lights are only drawn, but for those that cannot be: seen by the camera or in a mirror, or a uniform environment.
    Lights,
}

/// Share of a way of density `this` beside one of density `other`, for finite densities of 0 or more.
pub(super) fn power_heuristic(this: f32, other: f32) -> f32 {
    if this <= 0.0 {
        return 0.0;
    }
    // As a ratio, so that squares of large densities do not overflow.
    let ratio = other / this;
    1.0 / (1.0 + ratio * ratio)
}

impl Strategies {
    /// Weight of light met by chance. `scattered` is the density of the direction that met it, `None` where it could
    /// not have been drawn from here (camera, mirror); `drawn` is the density by which the light would have been drawn.
    pub(super) fn met(self, scattered: Option<f32>, drawn: f32) -> f32 {
        let Some(scattered) = scattered.filter(|_| drawn > 0.0) else { return 1.0 };
        match self {
            Self::Both => power_heuristic(scattered, drawn),
            Self::Scattering => 1.0,
            Self::Lights => 0.0,
        }
    }

    /// Weight of light that was drawn.
    pub(super) fn drawn(self, drawn: f32, scattered: f32) -> f32 {
        match self {
            Self::Both => power_heuristic(drawn, scattered),
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
    fn light_that_cannot_be_drawn_counts_in_full() {
        for strategies in [Strategies::Both, Strategies::Scattering, Strategies::Lights] {
            assert_eq!(strategies.met(None, 3.0), 1.0);
            assert_eq!(strategies.met(Some(3.0), 0.0), 1.0);
        }
    }
}
