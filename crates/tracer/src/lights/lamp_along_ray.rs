//! Lamps without an opening as light that falls on a ray through fog.
//!
//! A lamp of intensity I sends light on a ray between two points. Each part of the ray receives light in proportion to the angle that it subtends at
//! the lamp: ∫ I/d² dt = I (θ_b − θ_a)/D, with D the lamp's distance from the ray (Kulla and Fajardo, "Importance sampling techniques for path
//! tracing in participating media", 2012). The angle is divided into cells. They are narrow at both ends, where a beam that barely touches the ray
//! may cover a long part of it. The light of the lamp in the middle of each cell, and the fraction of it that reaches the camera, are evaluated. The
//! cell is sampled by that product, the lamp by the same product at three places.

use core::f32::consts::FRAC_PI_2;

use etendue_core::Ray;
use etendue_core::maths::f32::{atan, sin_cos};
use glam::Vec3;

use super::light_sample::{LightSample, LightSampleContext};
use super::{light::Light, scene_lights::Lights};
use crate::materials::EmissionQuery;

/// Minimum lamp-to-ray distance, m.
const MIN_DISTANCE_M: f32 = 1e-4;

/// Fraction of a lamp's maximum intensity that is added to its intensity in the middle of a cell.
const FLOOR: f32 = 0.02;

/// Fractions of the angle at which a lamp is evaluated, with their weights.
const EVALUATION_FRACTIONS: [(f32, f32); 3] = [(0.04, 0.25), (0.5, 0.5), (0.96, 0.25)];

/// Number of cells of the angle.
const CELLS: usize = 16;

/// A part of a ray, in lengths of its direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RaySegment {
    pub(crate) from: f32,
    pub(crate) to: f32,
}

/// A lamp sampled for a segment of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampledLamp {
    light: usize,
    /// The probability of its choice.
    pub(crate) probability: f32,
    angles: SegmentAngles,
    cells: AngleCells,
}

/// The angle that a segment of a ray subtends at a lamp.
#[derive(Clone, Copy, Debug)]
struct SegmentAngles {
    /// Ray parameter nearest to the lamp, m.
    nearest_m: f32,
    /// Its distance from the ray there, m.
    away_m: f32,
    /// θ of both ends, from that place on.
    ends: [f32; 2],
}

impl SegmentAngles {
    fn new(lamp: Vec3, ray: &Ray, segment: RaySegment) -> Self {
        let nearest_m = (lamp - ray.origin).dot(ray.direction);
        let away_m = (lamp - ray.at(nearest_m)).length().max(MIN_DISTANCE_M);
        let angle = |t: f32| if t.is_finite() { atan((t - nearest_m) / away_m) } else { FRAC_PI_2 };
        Self { nearest_m, away_m, ends: [angle(segment.from), angle(segment.to)] }
    }

    fn extent_rad(&self) -> f32 {
        self.ends[1] - self.ends[0]
    }

    /// The place at a fraction of the angle, m.
    fn place(&self, fraction: f32) -> f32 {
        let (sin, cos) = sin_cos(self.ends[0] + fraction * self.extent_rad());
        self.nearest_m + self.away_m * sin / cos.max(f32::MIN_POSITIVE)
    }

    /// The fraction of the angle up to a place, m.
    fn fraction_at(&self, t: f32) -> f32 {
        (atan((t - self.nearest_m) / self.away_m) - self.ends[0]) / self.extent_rad()
    }

    /// Density of places by the angle, 1/m.
    fn density(&self, t: f32) -> f32 {
        let aside = t - self.nearest_m;
        self.away_m / (self.extent_rad() * (self.away_m * self.away_m + aside * aside))
    }
}

/// Cells of the angle, by the light that comes from each.
#[derive(Clone, Copy, Debug)]
struct AngleCells([f32; CELLS]);

impl AngleCells {
    /// Start of cell `i`, as a fraction of the angle: cells are narrow at both ends.
    fn edge(i: usize) -> f32 {
        let x = i as f32 / CELLS as f32;
        x * x * (3.0 - 2.0 * x)
    }

    /// Computes the light of each cell from the value in its middle.
    fn new(light: impl Fn(f32) -> f32) -> Self {
        Self(core::array::from_fn(|i| {
            let (from, to) = (Self::edge(i), Self::edge(i + 1));
            light(0.5 * (from + to)) * (to - from)
        }))
    }

    fn total(&self) -> f32 {
        self.0.iter().sum()
    }

    /// Samples a fraction of the angle.
    fn sample_fraction(&self, u: f32) -> f32 {
        let mut rest = u * self.total();
        let last = self.0.iter().rposition(|light| *light > 0.0).unwrap_or(0);
        for (i, light) in self.0.iter().enumerate() {
            if rest < *light || i == last {
                let within = (rest / light).clamp(0.0, 1.0);
                return Self::edge(i) + within * (Self::edge(i + 1) - Self::edge(i));
            }
            rest -= light;
        }
        1.0
    }

    /// Density of fractions.
    fn density(&self, fraction: f32) -> f32 {
        let i = (1..CELLS).take_while(|i| Self::edge(*i) <= fraction).count();
        self.0[i] / (self.total() * (Self::edge(i + 1) - Self::edge(i)))
    }
}

impl SampledLamp {
    /// Samples a place of the ray, m, by the light that comes from there.
    pub(crate) fn place(&self, u: f32) -> f32 {
        self.angles.place(self.cells.sample_fraction(u))
    }

    /// Density of [`SampledLamp::place`], 1/m.
    pub(crate) fn density(&self, t: f32) -> f32 {
        self.angles.density(t) * self.cells.density(self.angles.fraction_at(t))
    }
}

impl Lights {
    /// True if there are lamps without an opening.
    pub(crate) fn has_points(&self) -> bool {
        !self.points.is_empty()
    }

    /// Samples a lamp without an opening for a segment of a ray of unit direction; `None` if none sends light there. `visibility` is the
    /// approximate fraction of light from the unit direction of its second argument that reaches the camera from a place of the ray, m.
    pub(crate) fn lamp_along(
        &self,
        ray: &Ray,
        segment: RaySegment,
        u: f32,
        visibility: impl Fn(f32, Vec3) -> f32,
    ) -> Option<SampledLamp> {
        let (mut total, mut rest, mut chosen) = (0.0_f32, f64::from(u), None);
        for light in &self.points {
            let along = self.lamp_near_ray(*light, ray, segment);
            let places = EVALUATION_FRACTIONS
                .map(|(fraction, weight)| weight * self.visible_light(&along, ray, fraction, &visibility));
            let counts = places.iter().sum::<f32>() * along.angles.extent_rad() / along.angles.away_m;
            if counts > 0.0 && counts.is_finite() {
                // Each lamp replaces the one before with the probability of its fraction so far. The remainder of the number stays uniform.
                total += counts;
                let probability = f64::from(counts / total);
                if rest < probability {
                    chosen = Some((along, counts));
                    rest /= probability;
                } else {
                    rest = (rest - probability) / (1.0 - probability);
                }
            }
        }
        let (along, counts) = chosen.filter(|_| total.is_finite())?;
        let cells = AngleCells::new(|fraction| self.visible_light(&along, ray, fraction, &visibility));
        Some(SampledLamp { light: along.light, probability: counts / total, angles: along.angles, cells })
    }

    /// The light of a sampled lamp at a place.
    pub(crate) fn sampled_lamp_light<const N: usize>(
        &self,
        lamp: &SampledLamp,
        receiver: &LightSampleContext,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        match &self.lights[lamp.light] {
            Light::Lamp(light) => light.sample(receiver.position, query),
            Light::MovingLamp(light) => light.sample(receiver, glam::Vec2::ZERO, query),
            _ => None,
        }
    }

    fn lamp_near_ray(&self, light: usize, ray: &Ray, segment: RaySegment) -> LampNearRay {
        let (position, maximum) = match &self.lights[light] {
            Light::Lamp(lamp) => (lamp.position(), lamp.max_intensity()),
            Light::MovingLamp(lamp) => lamp.point(ray.time_s),
            _ => (Vec3::ZERO, 0.0),
        };
        LampNearRay { light, position, max_intensity: maximum, angles: SegmentAngles::new(position, ray, segment) }
    }

    /// Approximate visible light of a lamp per angle at the lamp, at a fraction of that angle.
    fn visible_light(
        &self,
        lamp: &LampNearRay,
        ray: &Ray,
        fraction: f32,
        visibility: impl Fn(f32, Vec3) -> f32,
    ) -> f32 {
        let t = lamp.angles.place(fraction);
        let place = ray.at(t);
        let receiver = LightSampleContext::in_medium(place, ray.time_s);
        let irradiance = match &self.lights[lamp.light] {
            Light::Lamp(lamp) => lamp.irradiance(&receiver).diffuse,
            Light::MovingLamp(lamp) => lamp.irradiance(&receiver).diffuse,
            _ => 0.0,
        };
        let to_lamp = lamp.position - place;
        let intensity = irradiance * to_lamp.length_squared() + FLOOR * lamp.max_intensity;
        intensity * visibility(t, to_lamp.normalize_or_zero())
    }
}

/// A lamp next to a segment of a ray.
#[derive(Clone, Copy, Debug)]
struct LampNearRay {
    light: usize,
    position: Vec3,
    /// Maximum intensity.
    max_intensity: f32,
    angles: SegmentAngles,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sampled places have the stated density: the mean of 1/density over places is the length of the part.
    #[test]
    fn places_are_sampled_by_their_density() {
        let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0);
        let angles = SegmentAngles::new(Vec3::new(2.0, 0.5, 0.0), &ray, RaySegment { from: 0.0, to: 9.0 });
        let cells = AngleCells::new(|fraction| 0.1 + if fraction > 0.4 && fraction < 0.6 { 5.0 } else { fraction });
        let lamp = SampledLamp { light: 0, probability: 1.0, angles, cells };
        let n = 100_000;
        let (mut sum, mut places) = (0.0_f64, [0_u32; 2]);
        for i in 0..n {
            let t = lamp.place((i as f32 + 0.5) / n as f32);
            sum += 1.0 / f64::from(lamp.density(t));
            places[usize::from(t > 2.0)] += 1;
        }
        // A midpoint rule in u over cells that u falls into by thousands; f32 places near their edges.
        assert!((sum / f64::from(n) - 9.0).abs() < 0.01, "{}", sum / f64::from(n));
        assert!(places[0] > 0 && places[1] > 0);
    }
}
