//! The particles of one view, and the medium beyond them.
//!
//! A ray from the camera meets particles and the hollowed medium; a ray that has been scattered meets the whole medium and no particle. Each is
//! whole by itself, so that light is right in the mean: what is simplified is that rain seen in a mirror has no single drops. Where caustics are
//! off, light behind the first matt surface or scattering goes through precipitation unhindered: over the tens of metres between the surfaces
//! of a scene it turns some per cent of the light, mostly by less than 40°, and takes none.

use std::sync::Arc;

use etendue_core::{Ray, TimeInterval};
use etendue_spectra::{Spectrum, dielectric};
use glam::{DVec3, Vec3};

use super::change_over::ChangeOver;
use super::drop_optics::{Refracted, refracted};
use super::field::{Field, Particle};
use super::region::SeenRegion;
use crate::accel::{Simd, Streak, Streaks};
use crate::media::{Hollow, Media, Medium, MediumError, Phase, Shape, SpectralTable};
use etendue_core::Motion;
use etendue_core::maths::f64::cbrt;
use glam::DAffine3;

/// Mean cosine of what a crystal of ice does to light that meets it, without diffraction: that of grains of snow by geometric optics (Warren,
/// Rev. Geophys. 20, 1982: 0.89 with the half that is diffracted straight on).
const SNOW_G: f32 = 0.78;

impl Field {
    /// All of the field as a medium: light that meets a particle, by geometric optics.
    ///
    /// # Errors
    /// None for a law within its range.
    pub fn medium(&self) -> Result<Medium, MediumError> {
        let phase = if self.law().is_snow() {
            Phase::HenyeyGreenstein { g: SNOW_G }
        } else {
            Phase::Table(SpectralTable::of_large_balls(water()))
        };
        let extinction = Spectrum::constant(self.extinction_per_m());
        let shape = Shape::Below { top_m: self.top_m() };
        let place = Motion::still(DAffine3::IDENTITY);
        let medium = Medium::new((extinction, Spectrum::constant(1.0)), Arc::new(phase), shape, place)?;
        Ok(medium.unless_without_peak())
    }

    /// What of the medium is left out about a camera.
    #[must_use]
    pub fn hollow(&self, change_over: &ChangeOver) -> Hollow {
        let whole = self.extinction_per_m();
        let part = |(class, radius): (&super::SizeClass, &f64)| (*radius, class.extinction_per_m / whole);
        Hollow::new(self.classes().iter().zip(&change_over.radii_m).map(part).collect())
    }

    /// A particle as a spheroid in the render frame of a view.
    #[must_use]
    pub fn streak(
        &self,
        particle: &Particle,
        (origin_m, interval): (DVec3, TimeInterval),
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
    &dielectric::named("water").expect("a name of the list").n
}

/// The particles of a view, and the media as rays from its camera find them.
#[derive(Clone, Debug)]
pub struct Near<'a> {
    region: SeenRegion,
    streaks: Streaks,
    media: Media<'a>,
    phase: &'a Phase,
    index: Option<&'static Spectrum>,
}

/// A particle that a ray has met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearHit {
    /// Where along the ray, in lengths of its direction.
    pub t: f32,
    /// Which one of the view.
    pub particle: u32,
}

impl<'a> Near<'a> {
    /// Those of a view about `origin_m` of the world during an interval, `media` being those of the same view and `medium` the place of the
    /// field's own among them.
    #[must_use]
    pub fn new(
        field: &Field,
        (media, medium): (Media<'a>, usize),
        (origin_m, interval, simd): (DVec3, TimeInterval, Simd),
        region: &SeenRegion,
        change_over: &ChangeOver,
    ) -> Self {
        let particles = field.about(origin_m, interval, region, change_over);
        let streak = |particle| field.streak(particle, (origin_m, interval), change_over);
        let streaks = Streaks::new(particles.iter().map(streak).collect(), interval.length_s() as f32, simd);
        let index = (!field.law().is_snow()).then(water);
        let phase = media.phase(medium);
        Self { region: *region, streaks, media: media.hollowed(medium, field.hollow(change_over)), phase, index }
    }

    /// How many particles there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.streaks.streaks().len()
    }

    /// Whether particles are modelled along a unit direction from the camera. Where they are not, the whole medium stands for them: behind
    /// drops on a wind-screen rays look where the camera's region did not reach.
    #[must_use]
    pub fn looks_along(&self, direction: Vec3) -> bool {
        self.region.holds(direction.as_dvec3())
    }

    /// The media as rays from the camera find them.
    #[must_use]
    pub fn media(&self) -> &Media<'a> {
        &self.media
    }

    /// How particles scatter light in the mean.
    pub(crate) fn phase(&self) -> &'a Phase {
        self.phase
    }

    /// The first particle that a ray meets before `end`.
    #[must_use]
    pub fn closest(&self, ray: &Ray, end: f32) -> Option<NearHit> {
        self.streaks.closest(ray, end).map(|(t, particle)| NearHit { t, particle })
    }

    /// The ray that leaves a drop, from its centre; `None` for a flake. `drawn` as numbers in [0, 1).
    pub(crate) fn refracted(
        &self,
        ray: &Ray,
        hit: &NearHit,
        wavelength_nm: f32,
        drawn: impl Fn(u32) -> f64,
    ) -> Option<(Vec3, Vec3)> {
        let n = f64::from(self.index?.at(wavelength_nm));
        let streak = &self.streaks.streaks()[hit.particle as usize];
        let centre = streak.centre(ray.time_s);
        let half_m = streak.half_m.map(f64::from);
        let scale = DVec3::new(half_m[0], half_m[0], half_m[1]);
        // On the spheroid, as rounding has left it.
        let place = (ray.at(hit.t) - centre).as_dvec3();
        let place = place / (place / scale).length();
        let Refracted { place_m, direction } =
            refracted(half_m, n, (place, ray.direction.as_dvec3().normalize()), drawn);
        Some((centre + place_m.as_vec3(), direction.as_vec3().normalize()))
    }
}
