//! What optics asks of the world: the one open trait of the spine.

use crate::TimeInterval;
use crate::random::PathStream;
use crate::ray::Ray;
use crate::wavelength::{Spectral, Wavelengths};

/// Anything that answers a ray with spectral radiance.
pub trait RadianceField<const N: usize>: Sync {
    /// Spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) that arrives at the ray's origin against its direction, at the path's
    /// wavelengths; an unbiased estimate where the field is a path tracer. Not divided by the density of the
    /// wavelengths.
    fn radiance(&self, asked: &FieldRay, wavelengths: &Wavelengths<N>) -> Spectral<N>;

    /// As [`RadianceField::radiance`] for each of several rays of neighbouring pixels that carry the same wavelengths,
    /// appended to `radiance`. Each is an unbiased estimate, but a field may let them share what it finds.
    fn radiance_of_group(&self, rays: &[FieldRay], wavelengths: &Wavelengths<N>, radiance: &mut Vec<Spectral<N>>) {
        radiance.extend(rays.iter().map(|asked| self.radiance(asked, wavelengths)));
    }
}

/// A ray to be answered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldRay {
    /// In the render frame, with unit direction.
    pub ray: Ray,
    /// The sample's random address.
    pub stream: PathStream,
    /// The simulated time over which the strength of a light that goes up and down is averaged: the exposure of the ray's row or,
    /// where the ray has a moment of its own, that moment. Within the interval of the view.
    pub lit: TimeInterval,
}

/// The same radiance in every direction and at every wavelength: for tests of optics and sensors without a tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantField {
    /// Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: f32,
}

impl<const N: usize> RadianceField<N> for ConstantField {
    fn radiance(&self, _asked: &FieldRay, _wavelengths: &Wavelengths<N>) -> Spectral<N> {
        Spectral::splat(self.radiance)
    }
}
