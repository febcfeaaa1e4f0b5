//! Radiance along rays, alone and in groups, by the code that was made for the scene's effects.

use super::effects::{Clear, Effects, Every, Matt, SceneEffects};
use super::path::Path;
use super::path_tracer::PathTracer;
use crate::ALL_EFFECTS;
use etendue_core::{FieldRay, RadianceField, Spectral, Wavelengths};

impl<const N: usize> RadianceField<N> for PathTracer<'_> {
    fn radiance(&self, asked: &FieldRay, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        match self.effects {
            SceneEffects::Matt => self.radiance_of::<N, Matt>(asked, wavelengths),
            _ if !ALL_EFFECTS => unreachable!("a scene without optional effects"),
            SceneEffects::Clear => self.radiance_of::<N, Clear>(asked, wavelengths),
            SceneEffects::Every => self.radiance_of::<N, Every>(asked, wavelengths),
        }
    }

    fn radiance_of_group(&self, rays: &[FieldRay], wavelengths: &Wavelengths<N>, radiance: &mut Vec<Spectral<N>>) {
        if rays.len() < 2 || !self.shares() {
            radiance.extend(rays.iter().map(|asked| self.radiance(asked, wavelengths)));
            return;
        }
        match self.effects {
            SceneEffects::Matt => self.radiance_shared::<N, Matt>(rays, wavelengths, radiance),
            // With media no path shares anything.
            SceneEffects::Clear | SceneEffects::Every => self.radiance_shared::<N, Clear>(rays, wavelengths, radiance),
        }
    }
}

impl PathTracer<'_> {
    fn radiance_of<const N: usize, E: Effects>(&self, asked: &FieldRay, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        Path::<N, E>::new(self, asked, wavelengths).follow()
    }
}
