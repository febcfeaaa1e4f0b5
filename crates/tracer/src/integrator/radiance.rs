//! Radiance along rays, alone and in groups, by the code that was made for the scene's effects.

use super::effects::{Clear, Effects, Every, Matt, SceneEffects};
use super::path::Path;
use super::path_tracer::PathTracer;
use crate::ALL_EFFECTS;
use crate::guiding::Training;
use etendue_core::{FieldRay, RadianceField, Spectral, Wavelengths};

/// Paths of `N` wavelengths, where `N` is 1, 4 or 8.
pub trait SpectralPaths<const N: usize>: RadianceField<N> {
    /// Follows a path and adds the radiance that it finds behind its first matt surfaces to `training`. The tracer must have no guide.
    fn train(&self, asked: &FieldRay, wavelengths: &Wavelengths<N>, training: &Training);
}

/// Implements paths of `N` wavelengths. The implementations are not generic, so that this crate compiles them once and no other crate does.
macro_rules! spectral_paths {
    ($($n:literal)*) => {$(
        impl RadianceField<$n> for PathTracer<'_> {
            fn radiance(&self, asked: &FieldRay, wavelengths: &Wavelengths<$n>) -> Spectral<$n> {
                self.radiance_along(asked, wavelengths)
            }

            fn radiance_of_group(
                &self,
                rays: &[FieldRay],
                wavelengths: &Wavelengths<$n>,
                radiance: &mut Vec<Spectral<$n>>,
            ) {
                self.radiance_along_group(rays, wavelengths, radiance);
            }
        }

        impl SpectralPaths<$n> for PathTracer<'_> {
            fn train(&self, asked: &FieldRay, wavelengths: &Wavelengths<$n>, training: &Training) {
                self.train_along(asked, wavelengths, training);
            }
        }
    )*};
}

spectral_paths!(1 4 8);

impl PathTracer<'_> {
    fn radiance_along<const N: usize>(&self, asked: &FieldRay, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        match self.effects {
            SceneEffects::Matt => self.radiance_of::<N, Matt>(asked, wavelengths),
            _ if !ALL_EFFECTS => unreachable!("a scene without optional effects"),
            SceneEffects::Clear => self.radiance_of::<N, Clear>(asked, wavelengths),
            SceneEffects::Every => self.radiance_of::<N, Every>(asked, wavelengths),
        }
    }

    fn radiance_along_group<const N: usize>(
        &self,
        rays: &[FieldRay],
        wavelengths: &Wavelengths<N>,
        radiance: &mut Vec<Spectral<N>>,
    ) {
        if rays.len() < 2 || !self.shares() {
            radiance.extend(rays.iter().map(|asked| self.radiance_along(asked, wavelengths)));
            return;
        }
        match self.effects {
            SceneEffects::Matt => self.radiance_shared::<N, Matt>(rays, wavelengths, radiance),
            // With media no path shares anything.
            SceneEffects::Clear | SceneEffects::Every => self.radiance_shared::<N, Clear>(rays, wavelengths, radiance),
        }
    }

    fn radiance_of<const N: usize, E: Effects>(&self, asked: &FieldRay, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        Path::<N, E>::new(self, asked, wavelengths).follow()
    }
}
