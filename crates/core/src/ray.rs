//! Rays, and the field of radiance that optics asks of the world: the one open trait of the spine.

use glam::{DVec3, Vec3};

use crate::wavelength::{Spectral, Wavelengths};
use crate::{TimeInterval, random::PathStream};

/// A primitive of a world, as hits name it.
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
    /// The ray ends here (exclusive); infinity where it does not.
    pub t_max: f32,
    /// Simulated time at which the ray is traced, s, counted from the start of the interval of the view that it is traced in
    /// ([`crate::TimeInterval`]): of 33 ms, f32 tells 2 ns; of times since the world's beginning it would tell 61 µs after
    /// 1 000 s. A static world does not look at it.
    pub time_s: f32,
    /// The primitive whose surface the ray leaves: a triangle of it is not hit again, for it is flat and the ray starts on
    /// the side to which it goes. `None` where the ray leaves no surface, or nothing is known: the answers are the same, found
    /// with more work.
    pub left: Option<PrimitiveId>,
}

impl Ray {
    /// A ray without end.
    #[must_use]
    pub fn new(origin: Vec3, direction: Vec3, time_s: f32) -> Self {
        Self { origin, direction, t_max: f32::INFINITY, time_s, left: None }
    }

    /// The same ray, which leaves the surface of a primitive.
    #[must_use]
    pub fn leaving(self, primitive: PrimitiveId) -> Self {
        Self { left: Some(primitive), ..self }
    }

    /// The point at parameter `t`, m.
    #[must_use]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// A ray that leaves the lens towards the scene, in the camera frame, with what it contributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PupilRay {
    /// A point of the entrance pupil (the front of the lens), m.
    pub origin_m: DVec3,
    /// Unit direction into the scene (z > 0 for lenses that look forward).
    pub direction: DVec3,
    /// Weight, sr: spectral irradiance on the sensor = expectation of `weight_sr × radiance` over the pupil sample.
    /// Holds the projected solid angle of the pupil, its sampling density, and the lens's transmittance.
    pub weight_sr: f64,
}

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
