//! Near drops and flakes over a stored image: the fraction of each pixel and of the exposure that each covers.
//!
//! The drops are those of traced weather for a camera with the image's view. The silhouette of each, an ellipse, is swept along its path by points that
//! represent equal parts of its area and of the exposure. They are evenly distributed (Hammersley's points with Roberts' additive recurrence), so that edges
//! are smooth and the covered area is exact in the mean. A point counts if it is nearer than the surface in its pixel.
//!
//! Not included: the camera's own motion (one pose represents the exposure), and rolling shutters.

use super::image::PosedImage;
use super::shown_light::ParticleRadiance;
use super::{ForegroundMedia, WeatheredImage};
use crate::plan::PrecipitationExposure;
use crate::render::region_of_projection;
use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::sin_cos;
use etendue_core::quantity::Cover;
use etendue_core::{Plane, Ray, TimeInterval};
use etendue_tracer::accel::Streak;
use etendue_tracer::media::{HollowRegion, Media};
use etendue_tracer::precipitation::ChangeOver;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Number of points per pixel that a silhouette crosses.
const DENSITY: f64 = 24.0;

/// Minimum and maximum number of points of one particle.
const POINTS: [f64; 2] = [64.0, 4.0e6];

/// Roberts' recurrence in two dimensions: the powers of the inverse of the plastic number.
const STEP: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// Number of particles composed together, to limit memory.
const PARTICLE_BATCH: usize = 4096;

/// The near particles of an image.
pub(super) struct ParticleStreaks {
    /// In order of increasing distance.
    streaks: Vec<Streak>,
    exposure_s: f64,
    hollow: HollowRegion,
    /// Index of the medium beyond them.
    medium: usize,
}

/// Pixels covered by a particle, with the fraction of each.
struct StreakFootprint {
    pixels: Vec<(u32, f32)>,
    /// Radiance of the particle, by band.
    light: Vec<f64>,
}

impl PrecipitationExposure {
    /// Particles before an image, exposed from a start time on.
    pub(super) fn streaks(&self, image: &PosedImage<'_>, start_s: f64) -> ParticleStreaks {
        let Self { precipitation, exposure_s } = self;
        let interval = TimeInterval::new(start_s, start_s + exposure_s).expect("both are finite");
        let field = &precipitation.field;
        let projection = image.stored.projection;
        let region = region_of_projection(projection, image.pose.rotation);
        let resolution = precipitation.resolution(projection.pitch_tan(), *exposure_s);
        let change_over = ChangeOver::new(field.classes(), &resolution, &region);
        let origin_m = image.pose.position_m;
        let particles = field.particles_near(origin_m, interval, &region, &change_over);
        let streak = |particle| field.streak(particle, origin_m, interval, &change_over);
        let mut streaks: Vec<Streak> = particles.iter().map(streak).collect();
        let middle_s = (0.5 * exposure_s) as f32;
        streaks.sort_by(|a, b| a.centre(middle_s).length().total_cmp(&b.centre(middle_s).length()));
        ParticleStreaks {
            streaks,
            exposure_s: *exposure_s,
            hollow: field.hollow(&change_over),
            medium: precipitation.medium,
        }
    }
}

impl ParticleStreaks {
    /// Media without the individually modelled particles.
    pub(super) fn without_near_particles<'a>(&self, media: Media<'a>) -> Media<'a> {
        media.with_hollow(self.medium, self.hollow.clone())
    }

    /// Composes the particles over the view.
    pub(super) fn compose(&self, weathered: &mut WeatheredImage, image: &PosedImage<'_>, before: &ForegroundMedia<'_>) {
        let light = ParticleRadiance::new(image, before.media.phase(self.medium), before.airlight);
        let count = image.distance.samples().len();
        let mut transmittance = vec![1.0_f32; count];
        let mut added: Vec<Vec<f32>> = vec![vec![0.0; count]; before.airlight.len()];
        for streaks in self.streaks.chunks(PARTICLE_BATCH) {
            let scratch = || vec![0.0_f32; count];
            let footprint =
                |scratch: &mut Vec<f32>, streak: &Streak| self.footprint(streak, image, scratch, &light, before);
            let footprints: Vec<_> =
                streaks.par_iter().map_init(scratch, footprint).filter(|of| !of.pixels.is_empty()).collect();
            compose(&footprints, &mut transmittance, &mut added);
        }
        for (band, added) in added.iter().enumerate() {
            let radiance = weathered.radiance.planes_mut()[band].samples_mut().iter_mut();
            let scene_transmittance = weathered.transmittance.planes_mut()[band].samples_mut().iter_mut();
            let air = weathered.airlight.planes_mut()[band].samples_mut().iter_mut();
            for ((((radiance, scene_transmittance), air), transmittance), added) in
                radiance.zip(scene_transmittance).zip(air).zip(&transmittance).zip(added)
            {
                *scene_transmittance *= transmittance;
                *air = *air * transmittance + added;
                *radiance = *radiance * transmittance + added;
            }
        }
        let cover = transmittance.into_iter().map(|transmittance| 1.0 - transmittance).collect();
        let (width, height) = (image.distance.width(), image.distance.height());
        weathered.cover = Some(Plane::<Cover>::from_samples(width, height, cover).expect("one sample a pixel"));
    }

    fn footprint(
        &self,
        streak: &Streak,
        image: &PosedImage<'_>,
        scratch: &mut [f32],
        shown: &ParticleRadiance,
        before: &ForegroundMedia<'_>,
    ) -> StreakFootprint {
        let pixels = self.pixels(streak, image, scratch);
        let Some((pixel, _)) = pixels.get(pixels.len() / 2) else { return StreakFootprint { pixels, light: vec![] } };
        let centre = streak.centre((0.5 * self.exposure_s) as f32);
        let mut ray = Ray::new(Vec3::ZERO, centre.normalize_or(Vec3::X), 0.0);
        ray.t_max = centre.length();
        StreakFootprint { light: before.radiance_along(shown.in_front_of(*pixel as usize), &ray), pixels }
    }

    /// Fraction of each pixel and of the exposure that a particle covers; `scratch` is 0 everywhere, before and after.
    fn pixels(&self, streak: &Streak, image: &PosedImage<'_>, scratch: &mut [f32]) -> Vec<(u32, f32)> {
        let n = self.points(streak, image.stored.projection.pitch_tan());
        let mut touched = vec![];
        for k in 0..n {
            let x = f64::from(k) + 0.5;
            let time_s = x / f64::from(n) * self.exposure_s;
            let Some(silhouette) = Silhouette::new(streak, time_s) else { continue };
            let point = silhouette.point([(x * STEP[0]).fract(), (x * STEP[1]).fract()]);
            let Some((pixel, area_px)) = image.pixel_and_area(point, silhouette.away_m) else { continue };
            if f64::from(image.distance.samples()[pixel]) > silhouette.away_m {
                if scratch[pixel] == 0.0 {
                    touched.push(pixel);
                }
                scratch[pixel] += (silhouette.area_m2() * area_px / f64::from(n)) as f32;
            }
        }
        let take_cover = |pixel: usize| (pixel as u32, core::mem::take(&mut scratch[pixel]).min(1.0));
        touched.into_iter().map(take_cover).collect()
    }

    /// Number of points that represent a particle.
    fn points(&self, streak: &Streak, pitch: f64) -> u32 {
        let (start, velocity) = (streak.start_m.as_dvec3(), streak.velocity_mps.as_dvec3());
        let nearest_s = (-start.dot(velocity) / velocity.length_squared().max(1e-12)).clamp(0.0, self.exposure_s);
        let nearest_m = (start + velocity * nearest_s).length().max(f64::from(streak.from_m));
        let width_px = 2.0 * f64::from(streak.half_m[0]) / nearest_m / pitch;
        let length_px = velocity.length() * self.exposure_s / nearest_m / pitch;
        let passed_px = (width_px + 1.0) * (length_px + width_px + 1.0);
        (DENSITY * passed_px).clamp(POINTS[0], POINTS[1]) as u32
    }
}

/// Composes footprints, from near to far, over the light behind and before them.
fn compose(footprints: &[StreakFootprint], transmittance: &mut [f32], added: &mut [Vec<f32>]) {
    let mut weights = Vec::with_capacity(footprints.iter().map(|of| of.pixels.len()).sum());
    for (pixel, cover) in footprints.iter().flat_map(|of| &of.pixels) {
        let left = &mut transmittance[*pixel as usize];
        weights.push(*left * cover);
        *left *= 1.0 - cover;
    }
    added.par_iter_mut().enumerate().for_each(|(band, added)| {
        let pixels =
            footprints.iter().flat_map(|of| of.pixels.iter().map(|(pixel, _)| (*pixel, of.light[band] as f32)));
        for ((pixel, light), weight) in pixels.zip(&weights) {
            added[pixel as usize] += weight * light;
        }
    });
}

/// A spheroid seen from the camera: an ellipse perpendicular to the line of sight.
struct Silhouette {
    /// Distance of its centre, m.
    away_m: f64,
    centre_m: DVec3,
    /// Half-axes, m.
    half_m: [DVec3; 2],
}

impl Silhouette {
    /// Silhouette at a time of the exposure; `None` if the particle is not modelled there, or contains the camera.
    fn new(streak: &Streak, time_s: f64) -> Option<Self> {
        let centre_m = streak.centre(time_s as f32).as_dvec3();
        let away_m = centre_m.length();
        let [wide_m, high_m] = streak.half_m.map(f64::from);
        if away_m < f64::from(streak.from_m) || away_m >= f64::from(streak.to_m) || away_m <= wide_m * 1.001 {
            return None;
        }
        let line_of_sight = centre_m / away_m;
        let level = DVec3::Z.cross(line_of_sight).try_normalize().unwrap_or(DVec3::X);
        let upright = line_of_sight.cross(level);
        let rise2 = line_of_sight.z * line_of_sight.z;
        let upright_m = (wide_m * wide_m * rise2 + high_m * high_m * (1.0 - rise2)).sqrt();
        // A ball's tangents meet the plane through its centre farther out.
        let wider = (1.0 - (wide_m / away_m) * (wide_m / away_m)).sqrt().recip();
        Some(Self { away_m, centre_m, half_m: [level * (wide_m * wider), upright * (upright_m * wider)] })
    }

    fn area_m2(&self) -> f64 {
        PI * self.half_m[0].length() * self.half_m[1].length()
    }

    /// A point of the ellipse, uniform in area for two numbers in [0, 1), from the camera, m.
    fn point(&self, [u, turn]: [f64; 2]) -> DVec3 {
        let (sin, cos) = sin_cos(TAU * turn);
        self.centre_m + (self.half_m[0] * cos + self.half_m[1] * sin) * u.sqrt()
    }
}
