//! What a path travels in: air, or the inside of clear, absorbing matter.
//!
//! Beer–Lambert: over d metres of absorption coefficient a (1/m) the share exp(−a d) is left. A path is inside from where
//! it was refracted in, or from a camera inside (`surroundings`), until it is refracted out. Fog and the like (`crate::media`) are not in
//! solids. Left out: scattering inside, and solids within solids (coming out of the inner one leaves the path in air).

use etendue_core::maths::f32::exp;
use etendue_core::{Spectral, Wavelengths};
use etendue_spectra::Spectrum;

/// What surrounds a path.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Medium<'a> {
    /// Absorption coefficient, 1/m; `None` where nothing absorbs.
    absorption: Option<&'a Spectrum>,
    /// Whether it is the inside of a solid.
    solid: bool,
}

impl<'a> Medium<'a> {
    /// What is beyond a surface whose inside has this `absorption`, for a path that comes from its front or its back.
    pub(super) fn beyond(front: bool, solid: bool, absorption: Option<&'a Spectrum>) -> Self {
        Self { absorption: absorption.filter(|_| front), solid: solid && front }
    }

    /// The inside of a solid of this `absorption`.
    pub(super) fn inside(absorption: Option<&'a Spectrum>) -> Self {
        Self { absorption, solid: true }
    }

    /// Whether it is the inside of a solid.
    pub(super) fn is_solid(self) -> bool {
        self.solid
    }

    /// Whether nothing absorbs.
    pub(super) fn is_clear(self) -> bool {
        self.absorption.is_none()
    }

    /// What is left of `light` after `distance_m`.
    pub(super) fn attenuate<const N: usize>(
        self,
        light: Spectral<N>,
        distance_m: f32,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        match self.absorption {
            None => light,
            Some(absorption) => light * absorption.sample(wavelengths).map(|a| exp(-a * distance_m)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_law_of_beer_and_lambert() {
        let wavelengths = Wavelengths::<4>::uniform(400.0, 700.0, 0.3);
        let absorption = Spectrum::constant(50.0);
        let left = |medium: Medium<'_>, d: f32| medium.attenuate(Spectral::splat(2.0), d, &wavelengths)[1];
        // exp(−0.5) = 0.606 531; two roundings.
        assert!((left(Medium::beyond(true, true, Some(&absorption)), 0.01) - 2.0 * 0.606_530_7).abs() < 3e-7);
        assert_eq!(left(Medium::beyond(true, true, Some(&absorption)), 1e9), 0.0, "no light is left, and no NaN");
        assert_eq!(left(Medium::beyond(false, true, Some(&absorption)), 7.0), 2.0, "outside");
        assert_eq!(left(Medium::beyond(true, true, None), 7.0), 2.0, "perfectly clear");
    }
}
