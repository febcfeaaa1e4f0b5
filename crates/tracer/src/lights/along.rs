//! Lamps without an opening as light that falls on a ray through fog.
//!
//! Of all light that a lamp of intensity I sends on a ray between two points, as much falls on a part as it fills of the angle at the lamp:
//! ∫ I/d² dt = I (θ_b − θ_a)/D, D the lamp's distance from the ray (Kulla and Fajardo, "Importance sampling techniques for path tracing in
//! participating media", 2012). A lamp is drawn by that, its intensity taken at three places of the part.

use core::f32::consts::FRAC_PI_2;
use etendue_core::maths::f32::{atan, sin_cos};
use etendue_core::{Ray, TimeInterval, Wavelengths};
use glam::Vec3;

use super::light::Light;
use super::light_sample::LightSample;
use super::sample_context::LightSampleContext;
use super::scene_lights::Lights;

/// Least distance of a lamp from a ray that is reckoned with, m.
const NEAREST_M: f32 = 1e-4;

/// Share of a lamp's greatest intensity that it counts at least.
const FLOOR: f32 = 0.01;

/// A lamp drawn for a part of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LampAlong {
    light: usize,
    /// The probability of its choice.
    pub(crate) probability: f32,
    angles: Angles,
}

/// A part of a ray as seen from a lamp.
#[derive(Clone, Copy, Debug)]
struct Angles {
    /// Where the ray is nearest to it, m.
    nearest_m: f32,
    /// Its distance from the ray there, m.
    away_m: f32,
    /// θ of both ends, from that place on.
    ends: [f32; 2],
}

impl Angles {
    fn of(lamp: Vec3, ray: &Ray, [from_m, to_m]: [f32; 2]) -> Self {
        let nearest_m = (lamp - ray.origin).dot(ray.direction);
        let away_m = (lamp - ray.at(nearest_m)).length().max(NEAREST_M);
        let angle = |t: f32| if t.is_finite() { atan((t - nearest_m) / away_m) } else { FRAC_PI_2 };
        Self { nearest_m, away_m, ends: [angle(from_m), angle(to_m)] }
    }

    fn whole(&self) -> f32 {
        self.ends[1] - self.ends[0]
    }

    /// The place at a share of the angle, m.
    fn place(&self, share: f32) -> f32 {
        let (sin, cos) = sin_cos(self.ends[0] + share * self.whole());
        self.nearest_m + self.away_m * sin / cos.max(f32::MIN_POSITIVE)
    }

    /// Density of places, 1/m.
    fn density(&self, t: f32) -> f32 {
        let aside = t - self.nearest_m;
        self.away_m / (self.whole() * (self.away_m * self.away_m + aside * aside))
    }
}

impl LampAlong {
    /// A place of the ray, m, drawn by the angle at the lamp.
    pub(crate) fn place(&self, u: f32) -> f32 {
        self.angles.place(u)
    }

    /// The density of that, 1/m.
    pub(crate) fn density(&self, t: f32) -> f32 {
        self.angles.density(t)
    }
}

impl Lights {
    /// Whether there are lamps without an opening.
    pub(crate) fn has_points(&self) -> bool {
        !self.points.is_empty()
    }

    /// A lamp without an opening for a part of a ray of unit direction, m; `None` where none sends light there.
    pub(crate) fn lamp_along(&self, ray: &Ray, part: [f32; 2], u: f32) -> Option<LampAlong> {
        let (mut whole, mut rest, mut chosen) = (0.0_f32, f64::from(u), None);
        for light in &self.points {
            let (counts, angles) = self.counts(*light, ray, part);
            if counts > 0.0 {
                // Each replaces the one before with the probability of its share so far; what is left of the number is as even as it was.
                whole += counts;
                let share = f64::from(counts / whole);
                if rest < share {
                    chosen = Some((*light, counts, angles));
                    rest /= share;
                } else {
                    rest = (rest - share) / (1.0 - share);
                }
            }
        }
        let (light, counts, angles) = chosen.filter(|_| whole.is_finite())?;
        Some(LampAlong { light, probability: counts / whole, angles })
    }

    /// The light of a lamp that was drawn, at a place.
    pub(crate) fn of_lamp<const N: usize>(
        &self,
        lamp: &LampAlong,
        receiver: &LightSampleContext,
        asked: (&Wavelengths<N>, &TimeInterval),
    ) -> Option<LightSample<N>> {
        match &self.lights[lamp.light] {
            Light::Lamp(light) => light.sample(receiver.position, asked),
            Light::Carried(light) => light.sample(receiver, glam::Vec2::ZERO, asked),
            _ => None,
        }
    }

    /// About what a lamp sends on a part of a ray.
    fn counts(&self, light: usize, ray: &Ray, part: [f32; 2]) -> (f32, Angles) {
        let (position, peak) = match &self.lights[light] {
            Light::Lamp(lamp) => (lamp.position(), lamp.greatest()),
            Light::Carried(lamp) => lamp.point(ray.time_s),
            _ => (Vec3::ZERO, 0.0),
        };
        let angles = Angles::of(position, ray, part);
        let at = |share: f32| {
            let place = ray.at(angles.place(share));
            let receiver = LightSampleContext { position: place, normal: Vec3::ZERO, gloss: None, time_s: ray.time_s };
            let irradiance = match &self.lights[light] {
                Light::Lamp(lamp) => lamp.irradiance(&receiver).plain,
                Light::Carried(lamp) => lamp.irradiance(&receiver).plain,
                _ => 0.0,
            };
            irradiance * (place - position).length_squared()
        };
        let mean = (at(0.1) + at(0.5) + at(0.9)) / 3.0;
        let intensity = mean.max(FLOOR * peak);
        let counts = intensity * angles.whole() / angles.away_m;
        (if counts.is_finite() { counts } else { 0.0 }, angles)
    }
}
