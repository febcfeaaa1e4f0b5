//! The particles of one view, and the medium beyond them.
//!
//! A ray from the camera hits particles and the hollowed medium; a ray that has been scattered hits the whole medium and no particle. Each is
//! complete by itself, so that light is right in the mean. The simplification is that rain seen in a mirror has no single drops. If caustics are off,
//! light behind the first diffuse surface or scattering passes through precipitation unattenuated. Over the tens of metres between the surfaces of a
//! scene, precipitation deflects some per cent of the light, mostly by less than 40°, and absorbs none.

use std::sync::Arc;

use etendue_core::{Motion, Ray, TimeInterval, maths::f64::cbrt};
use etendue_spectra::{Spectrum, dielectric};
use glam::{DAffine3, DVec3, Vec3};

use super::change_over::{ChangeOver, VisibleRegion};
use super::field::{Particle, PrecipitationField};
use crate::accel::{Simd, Streak, Streaks};
use crate::materials::fresnel;
use crate::media::{HollowPart, HollowRegion, Media, Medium, MediumError, MediumRegion, Phase, SpectralTable};

/// Mean cosine of scattering by an ice crystal, without diffraction: that of snow grains by geometric optics (Warren, Rev. Geophys. 20,
/// 1982: 0.89 with the half that is diffracted straight on).
const SNOW_G: f32 = 0.78;

impl PrecipitationField {
    /// The whole field as a medium: light that hits a particle, by geometric optics.
    ///
    /// # Errors
    /// None for a law within its range.
    pub fn medium(&self) -> Result<Medium, MediumError> {
        let phase = if self.law().is_snow() {
            Phase::HenyeyGreenstein { g: SNOW_G }
        } else {
            Phase::Table(SpectralTable::from_large_balls(water()))
        };
        let extinction = Spectrum::constant(self.extinction_per_m());
        let shape = MediumRegion::Below { top_m: self.top_m() };
        let place = Motion::constant(DAffine3::IDENTITY);
        let medium = Medium::new(extinction, Spectrum::constant(1.0), Arc::new(phase), shape, place)?;
        Ok(medium.absent_without_peaks())
    }

    /// The parts of the medium that are left out near a camera.
    #[must_use]
    pub fn hollow(&self, change_over: &ChangeOver) -> HollowRegion {
        let total_per_m = self.extinction_per_m();
        let part = |(class, radius_m): (&super::SizeClass, &f64)| HollowPart {
            from_m: *radius_m,
            fraction: class.extinction_per_m / total_per_m,
        };
        HollowRegion::new(self.classes().iter().zip(&change_over.radii_m).map(part).collect())
    }

    /// A particle as a spheroid in the render frame of a view.
    #[must_use]
    pub fn streak(
        &self,
        particle: &Particle,
        origin_m: DVec3,
        interval: TimeInterval,
        change_over: &ChangeOver,
    ) -> Streak {
        let radius_m = 0.5e-3 * self.law().diameter_mm(particle.size_mm);
        let flat = self.law().axis_ratio(particle.size_mm);
        Streak {
            start_m: (particle.at(interval.start_s()) - origin_m).as_vec3(),
            velocity_mps: particle.velocity_mps.as_vec3(),
            half_m: [radius_m / cbrt(flat), radius_m * cbrt(flat * flat)].map(|half| half as f32),
            from_m: change_over.clear_m as f32,
            to_m: change_over.radii_m[particle.class as usize] as f32,
        }
    }
}

/// The refractive index of water.
fn water() -> &'static Spectrum {
    &dielectric::by_name("water").expect("a name of the list").n
}

/// Position and time of a view.
#[derive(Clone, Copy, Debug)]
pub struct ViewPlacement {
    /// The origin of its render frame in the world, m.
    pub origin_m: DVec3,
    pub interval: TimeInterval,
    /// The instruction set of its accelerator.
    pub simd: Simd,
}

/// The particles of a view, and the media as rays from its camera find them.
#[derive(Clone, Debug)]
pub struct NearParticles<'a> {
    region: VisibleRegion,
    streaks: Streaks,
    media: Media<'a>,
    phase: &'a Phase,
    index: Option<&'static Spectrum>,
}

/// A particle that a ray has hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleHit {
    /// Ray parameter, in lengths of its direction.
    pub t: f32,
    /// Index of the particle in the view.
    pub particle: u32,
}

impl<'a> NearParticles<'a> {
    /// The particles of a view. `media` are those of the same view and `medium` is the index of the field's own among them.
    #[must_use]
    pub fn new(
        field: &PrecipitationField,
        media: Media<'a>,
        medium: usize,
        view: ViewPlacement,
        region: &VisibleRegion,
        change_over: &ChangeOver,
    ) -> Self {
        let ViewPlacement { origin_m, interval, simd } = view;
        let particles = field.particles_near(origin_m, interval, region, change_over);
        let streak = |particle| field.streak(particle, origin_m, interval, change_over);
        let streaks = Streaks::new(particles.iter().map(streak).collect(), interval.length_s() as f32, simd);
        let index = (!field.law().is_snow()).then(water);
        let phase = media.phase(medium);
        Self { region: *region, streaks, media: media.with_hollow(medium, field.hollow(change_over)), phase, index }
    }

    /// Number of particles.
    #[must_use]
    pub fn count(&self) -> usize {
        self.streaks.streaks().len()
    }

    /// True if particles are modelled along a unit direction from the camera. If not, the whole medium represents them: behind drops on a
    /// windscreen, rays look beyond the camera's region.
    #[must_use]
    pub fn looks_along(&self, direction: Vec3) -> bool {
        self.region.holds(direction.as_dvec3())
    }

    /// The media as rays from the camera find them.
    #[must_use]
    pub fn media(&self) -> &Media<'a> {
        &self.media
    }

    /// Mean phase function of the particles.
    pub(crate) fn phase(&self) -> &'a Phase {
        self.phase
    }

    /// The first particle that a ray hits before `end`.
    #[must_use]
    pub fn closest(&self, ray: &Ray, end: f32) -> Option<ParticleHit> {
        self.streaks.closest(ray, end).map(|(t, particle)| ParticleHit { t, particle })
    }

    /// The ray that leaves a drop, from its centre; `None` for a flake. `drawn` are numbers in [0, 1).
    pub(crate) fn refracted(
        &self,
        ray: &Ray,
        hit: &ParticleHit,
        wavelength_nm: f32,
        random_number: impl Fn(u32) -> f64,
    ) -> Option<(Vec3, Vec3)> {
        let n = f64::from(self.index?.at(wavelength_nm));
        let streak = &self.streaks.streaks()[hit.particle as usize];
        let centre = streak.centre(ray.time_s);
        let half_m = streak.half_m.map(f64::from);
        let scale = DVec3::new(half_m[0], half_m[0], half_m[1]);
        // On the spheroid, up to rounding.
        let place = (ray.at(hit.t) - centre).as_dvec3();
        let place = place / (place / scale).length();
        let incident = DropRay { place_m: place, direction: ray.direction.as_dvec3().normalize() };
        let DropRay { place_m, direction } = refracted(half_m[0], half_m[1], n, incident, random_number);
        Some((centre + place_m.as_vec3(), direction.as_vec3().normalize()))
    }
}

// A ray through a drop: a spheroid of water about an upright axis.
//
// At each interface reflection or refraction is sampled, by Fresnel's equations of one polarisation, which is sampled at the first
// interface and kept. (In a ball the plane of incidence is the same at all interfaces; in a flattened drop it turns a little, and the
// polarisation with it, which is left out.) Water absorbs nothing over millimetres.

/// Maximum number of passages through a drop that are traced; the remainder leaves with the last.
const MAX_PASSAGES: u32 = 12;

/// A ray at the surface of a drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DropRay {
    /// Position relative to the drop's centre, m.
    pub(crate) place_m: DVec3,
    /// Unit direction.
    pub(crate) direction: DVec3,
}

/// Traces a ray that hits a spheroid of given half-axes and index `n`, and returns the ray that leaves it. `drawn` are numbers in [0, 1),
/// one for each interface and one for the polarisation.
pub(crate) fn refracted(
    half_width_m: f64,
    half_height_m: f64,
    n: f64,
    incident: DropRay,
    random_number: impl Fn(u32) -> f64,
) -> DropRay {
    let DropRay { mut place_m, mut direction } = incident;
    let half_m = DVec3::new(half_width_m, half_width_m, half_height_m);
    let inverse2 = (half_m * half_m).recip();
    let plane = usize::from(random_number(0) < 0.5);
    for passage in 0..=MAX_PASSAGES {
        // The normal against the ray.
        let out = (place_m * inverse2).normalize();
        let (normal, eta) = if passage == 0 { (out, n) } else { (-out, 1.0 / n) };
        let cos = (-direction.dot(normal)).max(0.0);
        let is_mirrored = random_number(1 + passage) < mirrored(cos, eta, plane);
        let through = refract(direction, normal, cos, eta);
        let leaves = (passage == 0) == is_mirrored || passage == MAX_PASSAGES;
        direction = match through {
            Some(through) if !is_mirrored || (passage == MAX_PASSAGES && leaves) => through,
            _ => (direction + normal * (2.0 * cos)).normalize(),
        };
        if leaves {
            return DropRay { place_m, direction };
        }
        let scaled = direction * inverse2;
        place_m += direction * (-2.0 * place_m.dot(scaled) / direction.dot(scaled));
    }
    DropRay { place_m, direction }
}

/// Reflectance of one polarisation at an interface into `eta` times the index.
fn mirrored(cos: f64, eta: f64, plane: usize) -> f64 {
    if (eta * eta - 1.0) + cos * cos <= 0.0 {
        return 1.0;
    }
    f64::from(fresnel::planes(cos as f32, eta as f32)[plane])
}

/// Snell's law; `None` beyond the critical angle.
fn refract(direction: DVec3, normal: DVec3, cos: f64, eta: f64) -> Option<DVec3> {
    let square = eta * eta - 1.0 + cos * cos;
    (square > 0.0).then(|| ((direction + normal * (cos - square.sqrt())) / eta).normalize())
}
