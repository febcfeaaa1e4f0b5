//! Radiance along rays, alone and in groups.

use super::path::Path;
use super::path_tracer::PathTracer;
use etendue_core::{FieldRay, RadianceField, Spectral, Wavelengths};

impl<const N: usize> RadianceField<N> for PathTracer<'_> {
    fn radiance(&self, asked: &FieldRay, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        Path::new(self, asked, wavelengths).follow()
    }

    fn radiance_of_group(&self, rays: &[FieldRay], wavelengths: &Wavelengths<N>, radiance: &mut Vec<Spectral<N>>) {
        if rays.len() > 1 && self.shares() {
            self.radiance_shared(rays, wavelengths, radiance);
        } else {
            radiance.extend(rays.iter().map(|asked| self.radiance(asked, wavelengths)));
        }
    }
}
