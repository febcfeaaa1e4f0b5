//! Rays, and the radiance field through which optics query the world.

use glam::{DVec3, Vec3};

use crate::wavelength::{Spectral, Wavelengths};
use crate::{TimeInterval, random::PathStream};

/// Primitive of a world, as stored in hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PrimitiveId {
    /// Index of the instance in the world.
    pub instance: u32,
    /// Primitive within the instance's shape.
    pub primitive: u32,
}

/// A ray of the tracer, in the render frame or (inside the accelerator) an instance's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin, m.
    pub origin: Vec3,
    /// Direction. Unit length where the ray leaves a camera or a surface; `t` is measured in its length.
    pub direction: Vec3,
    /// End of the ray (exclusive); infinity if it has none.
    pub t_max: f32,
    /// Simulated time at which the ray is traced, s, counted from the start of the interval of its view ([`crate::TimeInterval`]). The resolution of f32 is 2
    /// ns for an interval of 33 ms; counted from the world's beginning it would be 61 µs after 1 000 s. Ignored by a static world.
    pub time_s: f32,
    /// Primitive whose surface the ray leaves. A triangle is not hit again: it is flat, and the ray starts on the side that it travels to. `None` if the ray
    /// leaves no surface, or if the surface is unknown: the hits are the same, with more work.
    pub left: Option<PrimitiveId>,
}

impl Ray {
    /// Returns a ray without end.
    #[must_use]
    pub fn new(origin: Vec3, direction: Vec3, time_s: f32) -> Self {
        Self { origin, direction, t_max: f32::INFINITY, time_s, left: None }
    }

    /// Returns the same ray, marked as leaving the surface of a primitive.
    #[must_use]
    pub fn leaving(self, primitive: PrimitiveId) -> Self {
        Self { left: Some(primitive), ..self }
    }

    /// Returns the point at parameter `t`, m.
    #[must_use]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// Ray that leaves the lens towards the scene, in the camera frame, with its contribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PupilRay {
    /// Point of the entrance pupil (the front of the lens), m.
    pub origin_m: DVec3,
    /// Unit direction into the scene (z > 0 for lenses that look forward).
    pub direction: DVec3,
    /// Weight, sr: spectral irradiance on the sensor = expectation of `weight_sr × radiance` over the pupil sample. Includes the projected solid angle of the
    /// pupil, its sampling density, and the lens's transmittance.
    pub weight_sr: f64,
}

/// Field of spectral radiance, evaluated along rays.
pub trait RadianceField<const N: usize>: Sync {
    /// Returns the spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) that arrives at the ray's origin against its direction, at the path's wavelengths; an unbiased estimate
    /// if the field is a path tracer. Not divided by the density of the wavelengths.
    fn radiance(&self, field_ray: &FieldRay, wavelengths: &Wavelengths<N>) -> Spectral<N>;

    /// Appends to `radiance` the result of [`RadianceField::radiance`] for each of several rays of neighbouring pixels with the same wavelengths. Each is an
    /// unbiased estimate, but a field may share samples between them.
    fn radiance_of_group(&self, rays: &[FieldRay], wavelengths: &Wavelengths<N>, radiance: &mut Vec<Spectral<N>>) {
        radiance.extend(rays.iter().map(|field_ray| self.radiance(field_ray, wavelengths)));
    }
}

/// Ray at which a radiance field is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldRay {
    /// Ray in the render frame, with unit direction.
    pub ray: Ray,
    /// The sample's random address.
    pub stream: PathStream,
    /// Simulated time over which the strength of a modulated light is averaged: the exposure of the ray's row or, if the ray has a single time, that moment.
    /// Within the interval of the view.
    pub light_interval: TimeInterval,
}

/// Field with the same radiance in every direction and at every wavelength: for tests of optics and sensors without a tracer.
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
