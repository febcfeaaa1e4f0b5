//! Lamps that move, as points or with an opening.
//!
//! A lamp moves without changing its shape, so that its light of a moment is that of the lamp at the interval's start, asked for
//! from where the receiver would be had it moved back with the lamp: nothing of the lamp is made anew. The surface of an opening
//! is an instance of the world and moves as such. What the choice among clusters of lights knows of a lamp holds for the whole
//! interval; what the lamp by itself counts is that of the receiver's time.

use super::lamp::LampLight;
use super::light_sample::{LampIrradiance, LightHit, LightSample};
use super::opening_light::OpeningLight;
use super::sample_context::LightSampleContext;
use super::tree::LightBounds;
use super::way::Way;
use crate::geometry::SurfacePoint;
use core::f32::consts::PI;
use etendue_core::{Spectral, TimeInterval, Wavelengths};
use glam::{DAffine3, DVec3, Vec2, Vec3};

/// A lamp in motion.
#[derive(Clone, Debug)]
pub(super) struct CarriedLamp {
    way: Way,
    /// To the render frame at the interval's start, from the lamp's.
    start: DAffine3,
    lamp: Started,
}

/// The lamp where it is at the interval's start.
#[derive(Clone, Debug)]
enum Started {
    Point(LampLight),
    Opening(OpeningLight),
}

/// A rigid motion of the render frame, and back.
struct Carriage {
    forth: DAffine3,
    back: DAffine3,
}

impl CarriedLamp {
    /// A lamp made for the interval's start.
    pub(super) fn of_point(way: Way, lamp: LampLight) -> Self {
        let start = way.at(way.interval.start_s());
        Self { way, start, lamp: Started::Point(lamp) }
    }

    /// A lamp with an opening made for the interval's start.
    pub(super) fn of_opening(way: Way, opening: OpeningLight) -> Self {
        let start = way.at(way.interval.start_s());
        let reach = DVec3::splat(f64::from(opening.bounds().radius));
        let [low, high] = way.render_box(way.to_world.bounds_over(way.interval, (-reach, reach)));
        let farthest_m = low.abs().max(high.abs()).max_element();
        Self { way, start, lamp: Started::Opening(opening.carried_within(farthest_m)) }
    }

    /// Whether it has an opening.
    pub(super) fn is_open(&self) -> bool {
        matches!(self.lamp, Started::Opening(_))
    }

    /// Where a lamp without an opening is at a time, render frame, m, and its greatest intensity, W·sr⁻¹·nm⁻¹; of one with an opening 0.
    pub(super) fn point(&self, time_s: f32) -> (Vec3, f32) {
        let at = self.way.at(self.way.interval.moment(time_s)).translation.as_vec3();
        match &self.lamp {
            Started::Point(lamp) => (at, lamp.greatest()),
            Started::Opening(_) => (at, 0.0),
        }
    }

    /// For the choice among lights: a box of all the way, the cone of the start opened by how far the lamp turns.
    pub(super) fn bounds(&self) -> LightBounds {
        let started = match &self.lamp {
            Started::Point(lamp) => lamp.bounds(),
            Started::Opening(opening) => opening.bounds(),
        };
        let Way { to_world, interval, .. } = &self.way;
        let reach_m = f64::from(started.radius);
        let [low, high] = self.way.render_box(to_world.bounds_of_ball(*interval, DVec3::ZERO, reach_m));
        let radius = (high * 0.5 - low * 0.5).length() * (1.0 + 1e-5);
        LightBounds { low, high, radius, theta_o: (started.theta_o + self.way.turning()).min(PI), ..started }
    }

    /// Mean irradiance at a receiver, at its time.
    pub(super) fn irradiance(&self, receiver: &LightSampleContext) -> LampIrradiance {
        let started = self.carriage(receiver.time_s).receiver(receiver);
        match &self.lamp {
            Started::Point(lamp) => lamp.irradiance(&started),
            Started::Opening(opening) => opening.irradiance(&started),
        }
    }

    /// Light drawn for a receiver, without the probability of the choice.
    pub(super) fn sample<const N: usize>(
        &self,
        receiver: &LightSampleContext,
        u: Vec2,
        asked: (&Wavelengths<N>, &TimeInterval),
    ) -> Option<LightSample<N>> {
        let carriage = self.carriage(receiver.time_s);
        let from = carriage.point_back(receiver.position);
        let drawn = match &self.lamp {
            Started::Point(lamp) => lamp.sample(from, asked),
            Started::Opening(opening) => opening.sample(from, u, asked),
        }?;
        let direction = carriage.direction_forth(drawn.direction);
        // By the way to it, which is the same in both frames, so that it is rounded but once.
        let target = |target: Vec3| receiver.position + carriage.vector_forth(target - from);
        Some(LightSample { direction, target: drawn.target.map(target), ..drawn })
    }

    /// Density of what was met, without the probability of the choice, 1/sr.
    pub(super) fn pdf(&self, met: &LightHit<'_>) -> f32 {
        let Started::Opening(opening) = &self.lamp else { return 0.0 };
        let carriage = self.carriage(met.point.time_s);
        let (receiver, point) = (carriage.place_of(met.receiver), carriage.surface(met.point));
        let direction = carriage.direction_back(met.direction);
        opening.pdf(&LightHit { receiver: &receiver, point: &point, direction, distance_m: met.distance_m })
    }

    /// What a ray of unit `direction` finds at a point of the opening.
    pub(super) fn met<const N: usize>(
        &self,
        point: &SurfacePoint,
        direction: Vec3,
        asked: (&Wavelengths<N>, &TimeInterval),
    ) -> Option<Spectral<N>> {
        let Started::Opening(opening) = &self.lamp else { return None };
        let carriage = self.carriage(point.time_s);
        opening.met(&carriage.surface(point), carriage.direction_back(direction), asked)
    }

    fn carriage(&self, time_s: f32) -> Carriage {
        let now = self.way.at(self.way.interval.moment(time_s));
        Carriage { forth: now * self.start.inverse(), back: self.start * now.inverse() }
    }
}

impl Carriage {
    fn point_back(&self, point: Vec3) -> Vec3 {
        self.back.transform_point3(point.as_dvec3()).as_vec3()
    }

    fn direction_back(&self, direction: Vec3) -> Vec3 {
        self.back.transform_vector3(direction.as_dvec3()).normalize_or_zero().as_vec3()
    }

    fn vector_forth(&self, vector: Vec3) -> Vec3 {
        self.forth.transform_vector3(vector.as_dvec3()).as_vec3()
    }

    fn direction_forth(&self, direction: Vec3) -> Vec3 {
        self.forth.transform_vector3(direction.as_dvec3()).normalize_or_zero().as_vec3()
    }

    /// A receiver, with its gloss.
    fn receiver(&self, receiver: &LightSampleContext) -> LightSampleContext {
        let gloss = receiver.gloss.as_ref().map(|gloss| gloss.turned(&self.back.matrix3.as_mat3()));
        LightSampleContext { gloss, ..self.place_of(receiver) }
    }

    /// A receiver's place and normal.
    fn place_of(&self, receiver: &LightSampleContext) -> LightSampleContext {
        let (position, normal) = (self.point_back(receiver.position), self.direction_back(receiver.normal));
        LightSampleContext { position, normal, gloss: None, ..*receiver }
    }

    /// What of a surface point an opening looks at.
    fn surface(&self, point: &SurfacePoint) -> SurfacePoint {
        SurfacePoint {
            position: self.point_back(point.position),
            geometric_normal: self.direction_back(point.geometric_normal),
            ..*point
        }
    }
}
