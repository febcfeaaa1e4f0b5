//! Lights that move: emitting surfaces and lamps. Each is evaluated at the receiver's time.
//!
//! The bounds of a light in light selection hold for the whole interval of the view, and so does the probability of its choice. All other values,
//! sampled or hit, are those of the light at that time.

use core::f32::consts::PI;

use etendue_core::{Motion, Spectral, TimeInterval};
use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::light_sample::{LampIrradiance, LightHit, LightSample, LightSampleContext};
use super::sphere::{SphereLight, SphereSurface};
use super::triangle::{FlatShape, TriangleLight};
use super::{lamp::LampLight, opening_light::OpeningLight, tree::LightBounds};
use crate::materials::{EmissionQuery, MaterialTable};
use crate::{MaterialId, geometry::SurfacePoint};

/// A triangle, a parallelogram or a sphere in motion.
#[derive(Clone, Debug)]
pub(super) struct MovingLight {
    shape: MovingShape,
    motion: LightMotion,
    material: MaterialId,
}

#[derive(Clone, Debug)]
enum MovingShape {
    Facets(FlatShape),
    Sphere { radius_m: f64, surface: SphereSurface },
}

impl MovingLight {
    pub(super) fn from_facets(facets: FlatShape, motion: LightMotion, material: MaterialId) -> Self {
        Self { shape: MovingShape::Facets(facets), motion, material }
    }

    pub(super) fn from_sphere(
        radius_m: f64,
        motion: LightMotion,
        material: MaterialId,
        material_table: &MaterialTable,
    ) -> Self {
        Self {
            shape: MovingShape::Sphere { radius_m, surface: SphereSurface::new(material, material_table) },
            motion,
            material,
        }
    }

    /// Number of its triangles.
    pub(super) fn triangles(&self) -> usize {
        match &self.shape {
            MovingShape::Facets(facets) => facets.triangles(),
            MovingShape::Sphere { .. } => 0,
        }
    }

    /// Bounds for light selection at a mean radiance. If `both`, both sides of triangles emit, else only the front; `None` if it has no
    /// area at any time.
    pub(super) fn bounds(&self, radiance: f64, both: bool) -> Option<LightBounds> {
        let LightMotion { to_world, interval, .. } = &self.motion;
        match &self.shape {
            MovingShape::Facets(facets) => {
                let moments = self.motion.moments().filter_map(|place| facets.light(&place, self.material));
                let bounds = moments.map(|light| light.bounds(radiance, both)).collect();
                let (low, high) = to_world.bounds_over(*interval, facets.own_box());
                self.motion.bounds(bounds, low, high)
            }
            MovingShape::Sphere { radius_m, surface } => {
                let moments = self
                    .motion
                    .moments()
                    .map(|place| SphereLight::with_surface(*radius_m, &place, self.material, *surface));
                let bounds = moments.map(|light| light.bounds(radiance)).collect();
                let (low, high) = to_world.bounds_of_ball(*interval, DVec3::ZERO, *radius_m);
                self.motion.bounds(bounds, low, high)
            }
        }
    }

    /// Samples a point for a receiver, without the probability of the choice.
    pub(super) fn sample<const N: usize>(
        &self,
        receiver: &LightSampleContext,
        u: Vec2,
        spread_rad: f32,
        material_table: &MaterialTable,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        let from = receiver.position;
        let (emission, sample) = match self.at(receiver.time_s)? {
            FrozenLight::Triangle(light) => (light.glowing(material_table), light.sample(from, u)?),
            FrozenLight::Sphere(light) => (light.glowing(material_table), light.sample(from, u)?),
        };
        emission.towards(&sample, from, spread_rad, query)
    }

    /// Density of the point hit, without the probability of the choice, 1/sr.
    pub(super) fn pdf(&self, hit: &LightHit<'_>) -> f32 {
        match self.at(hit.point.time_s) {
            Some(FrozenLight::Triangle(light)) => light.pdf(hit),
            Some(FrozenLight::Sphere(light)) => light.pdf(hit),
            None => 0.0,
        }
    }

    fn at(&self, time_s: f32) -> Option<FrozenLight> {
        let place = self.motion.at(self.motion.interval.moment(time_s));
        match &self.shape {
            MovingShape::Facets(facets) => Some(FrozenLight::Triangle(facets.light(&place, self.material)?)),
            MovingShape::Sphere { radius_m, surface } => {
                Some(FrozenLight::Sphere(SphereLight::with_surface(*radius_m, &place, self.material, *surface)))
            }
        }
    }
}

/// The light at one time.
enum FrozenLight {
    Triangle(TriangleLight),
    Sphere(SphereLight),
}

// Lamps that move, as points or with an opening.
//
// A lamp moves without changing its shape. Its light at a time is therefore that of the lamp at the interval's start, for a receiver that
// is moved back with the lamp: no part of the lamp is rebuilt. The surface of an opening is an instance of the world and moves as such.
// Bounds of a lamp in the choice among clusters of lights hold for the whole interval; the weight of the lamp itself is that of the
// receiver's time.

#[derive(Clone, Debug)]
pub(super) struct MovingLamp {
    motion: LightMotion,
    /// Transform from the lamp's frame to the render frame at the interval's start.
    start: DAffine3,
    lamp: LampAtStart,
}

/// The lamp at its place at the interval's start.
#[derive(Clone, Debug)]
enum LampAtStart {
    Point(LampLight),
    Opening(OpeningLight),
}

/// A rigid motion of the render frame, and its inverse.
struct RigidMotion {
    forward: DAffine3,
    back: DAffine3,
}

impl MovingLamp {
    /// A point lamp built for the interval's start.
    pub(super) fn from_point(motion: LightMotion, lamp: LampLight) -> Self {
        let start = motion.at(motion.interval.start_s());
        Self { motion, start, lamp: LampAtStart::Point(lamp) }
    }

    /// A lamp with an opening built for the interval's start.
    pub(super) fn from_opening(motion: LightMotion, opening: OpeningLight) -> Self {
        let start = motion.at(motion.interval.start_s());
        let reach = DVec3::splat(f64::from(opening.bounds().radius));
        let (low, high) = motion.to_world.bounds_over(motion.interval, (-reach, reach));
        let [low, high] = motion.render_box(low, high);
        let farthest_m = low.abs().max(high.abs()).max_element();
        Self { motion, start, lamp: LampAtStart::Opening(opening.moved_within(farthest_m)) }
    }

    /// True if it has an opening.
    pub(super) fn is_open(&self) -> bool {
        matches!(self.lamp, LampAtStart::Opening(_))
    }

    /// Position of a lamp without an opening at a time, render frame, m, and its maximum intensity, W·sr⁻¹·nm⁻¹ (0 for one with an
    /// opening).
    pub(super) fn point(&self, time_s: f32) -> (Vec3, f32) {
        let at = self.motion.at(self.motion.interval.moment(time_s)).translation.as_vec3();
        match &self.lamp {
            LampAtStart::Point(lamp) => (at, lamp.max_intensity()),
            LampAtStart::Opening(_) => (at, 0.0),
        }
    }

    /// Bounds for light selection: a box of the whole motion, and the cone at the start, widened by the rotation of the lamp.
    pub(super) fn bounds(&self) -> LightBounds {
        let at_start = match &self.lamp {
            LampAtStart::Point(lamp) => lamp.bounds(),
            LampAtStart::Opening(opening) => opening.bounds(),
        };
        let LightMotion { to_world, interval, .. } = &self.motion;
        let reach_m = f64::from(at_start.radius);
        let (low, high) = to_world.bounds_of_ball(*interval, DVec3::ZERO, reach_m);
        let [low, high] = self.motion.render_box(low, high);
        let radius = (high * 0.5 - low * 0.5).length() * (1.0 + 1e-5);
        LightBounds { low, high, radius, theta_o: (at_start.theta_o + self.motion.turning()).min(PI), ..at_start }
    }

    /// Mean irradiance at a receiver, at its time.
    pub(super) fn irradiance(&self, receiver: &LightSampleContext) -> LampIrradiance {
        let at_start = self.motion_since_start(receiver.time_s).receiver(receiver);
        match &self.lamp {
            LampAtStart::Point(lamp) => lamp.irradiance(&at_start),
            LampAtStart::Opening(opening) => opening.irradiance(&at_start),
        }
    }

    /// Samples light for a receiver, without the probability of the choice.
    pub(super) fn sample<const N: usize>(
        &self,
        receiver: &LightSampleContext,
        u: Vec2,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        let motion = self.motion_since_start(receiver.time_s);
        let from = motion.point_back(receiver.position);
        let lamp_sample = match &self.lamp {
            LampAtStart::Point(lamp) => lamp.sample(from, query),
            LampAtStart::Opening(opening) => opening.sample(from, u, query),
        }?;
        let direction = motion.direction_forward(lamp_sample.direction);
        // By the vector to it, which is the same in both frames, so that it is rounded only once.
        let target = |target: Vec3| receiver.position + motion.vector_forward(target - from);
        Some(LightSample { direction, target: lamp_sample.target.map(target), ..lamp_sample })
    }

    /// Density of the point hit, without the probability of the choice, 1/sr.
    pub(super) fn pdf(&self, hit: &LightHit<'_>) -> f32 {
        let LampAtStart::Opening(opening) = &self.lamp else { return 0.0 };
        let motion = self.motion_since_start(hit.point.time_s);
        let (receiver, point) = (motion.place_of(hit.receiver), motion.surface(hit.point));
        let direction = motion.direction_back(hit.direction);
        opening.pdf(&LightHit { receiver: &receiver, point: &point, direction, distance_m: hit.distance_m })
    }

    /// Radiance against a ray of unit `direction` at a point of the opening; `None` if its side does not emit.
    pub(super) fn emitted<const N: usize>(
        &self,
        point: &SurfacePoint,
        direction: Vec3,
        query: EmissionQuery<'_, N>,
    ) -> Option<Spectral<N>> {
        let LampAtStart::Opening(opening) = &self.lamp else { return None };
        let motion = self.motion_since_start(point.time_s);
        opening.emitted(&motion.surface(point), motion.direction_back(direction), query)
    }

    fn motion_since_start(&self, time_s: f32) -> RigidMotion {
        let now = self.motion.at(self.motion.interval.moment(time_s));
        RigidMotion { forward: now * self.start.inverse(), back: self.start * now.inverse() }
    }
}

impl RigidMotion {
    fn point_back(&self, point: Vec3) -> Vec3 {
        self.back.transform_point3(point.as_dvec3()).as_vec3()
    }

    fn direction_back(&self, direction: Vec3) -> Vec3 {
        self.back.transform_vector3(direction.as_dvec3()).normalize_or_zero().as_vec3()
    }

    fn vector_forward(&self, vector: Vec3) -> Vec3 {
        self.forward.transform_vector3(vector.as_dvec3()).as_vec3()
    }

    fn direction_forward(&self, direction: Vec3) -> Vec3 {
        self.forward.transform_vector3(direction.as_dvec3()).normalize_or_zero().as_vec3()
    }

    /// The receiver moved back to the interval's start, with its gloss.
    fn receiver(&self, receiver: &LightSampleContext) -> LightSampleContext {
        let gloss = receiver.gloss.as_ref().map(|gloss| gloss.turned(&self.back.matrix3.as_mat3()));
        LightSampleContext { gloss, ..self.place_of(receiver) }
    }

    /// The receiver's position and normal, moved back to the interval's start.
    fn place_of(&self, receiver: &LightSampleContext) -> LightSampleContext {
        let (position, normal) = (self.point_back(receiver.position), self.direction_back(receiver.normal));
        LightSampleContext { position, normal, gloss: None, ..*receiver }
    }

    /// The data of a surface point that an opening reads.
    fn surface(&self, point: &SurfacePoint) -> SurfacePoint {
        SurfacePoint {
            position: self.point_back(point.position),
            geometric_normal: self.direction_back(point.geometric_normal),
            ..*point
        }
    }
}

/// Times of an interval at which a light's intensity is evaluated.
const TIME_STEPS: u32 = 16;

/// The motion of a light during a view's interval.
#[derive(Clone, Debug)]
pub(super) struct LightMotion {
    /// Motion of its instance.
    pub(super) to_world: Motion,
    /// The origin of the render frame in the world, m.
    pub(super) origin_m: DVec3,
    /// Interval of the view.
    pub(super) interval: TimeInterval,
}

impl LightMotion {
    /// Transform to the render frame at a simulated time, s.
    pub(super) fn at(&self, time_s: f64) -> DAffine3 {
        let mut to_render = self.to_world.at(time_s);
        to_render.translation -= self.origin_m;
        to_render
    }

    /// Transforms to the render frame at equidistant times of the interval, including both its ends.
    pub(super) fn moments(&self) -> impl Iterator<Item = DAffine3> {
        let part = |i: u32| f64::from(i) / f64::from(TIME_STEPS);
        (0..=TIME_STEPS).map(move |i| self.at(self.interval.start_s() + self.interval.length_s() * part(i)))
    }

    /// Bounds from those at some times, and the box of the whole motion. The intensity is the maximum. The cone is that of the start
    /// widened by the rotation of the light, or all directions if the light has none at some of the times.
    pub(super) fn bounds(&self, moments: Vec<LightBounds>, low: DVec3, high: DVec3) -> Option<LightBounds> {
        let first = *moments.first()?;
        let intensity = moments.iter().map(|bounds| bounds.intensity).fold(0.0, f64::max);
        let over_interval = LightBounds::from_surface(&self.render_box(low, high), intensity, None);
        let theta_o = first.theta_o + self.turning();
        if theta_o >= PI || moments.len() <= TIME_STEPS as usize {
            return Some(over_interval);
        }
        Some(LightBounds { axis: first.axis, theta_o, theta_e: first.theta_e, ..over_interval })
    }

    /// Minimum and maximum coordinates, render frame, m, of a box of the world, with a margin for rounding to f32.
    fn render_box(&self, low: DVec3, high: DVec3) -> [Vec3; 2] {
        let box_of = [low, high].map(|corner| (corner - self.origin_m).as_vec3());
        let room = (box_of[0].abs().max(box_of[1].abs()) + Vec3::splat(f32::MIN_POSITIVE)) * f32::EPSILON;
        [box_of[0] - room, box_of[1] + room]
    }

    /// Upper bound of the angle by which directions turn from the start, rad, with a margin for rounding.
    fn turning(&self) -> f32 {
        self.to_world.turning_over(self.interval) as f32 * (1.0 + 1e-5) + 1e-5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Mesh;
    use etendue_core::track::{Interpolation, Key, Track};
    use etendue_core::{TimeInterval, maths};
    use glam::{DQuat, Vec3};

    /// At times between those evaluated: corners in the box, the normal in the cone (f32 rounds cosines to 1e-7).
    #[test]
    fn bounds_hold_the_light_at_every_moment() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let mesh = Mesh::new(corners, vec![], vec![], vec![[0, 1, 2]], vec![]).expect("a mesh").0;
        let key = |i: f64| {
            let (sin, cos) = maths::f64::sin_cos(0.35 * i);
            let rotation = DQuat::from_xyzw(sin * 0.6, sin * 0.8, 0.0, cos);
            Key { time_s: i, position_m: DVec3::new(3.0 * i, i * i, -i), rotation, scale: DVec3::splat(2.0) }
        };
        for interpolation in [Interpolation::Linear, Interpolation::Smooth] {
            let to_world = Track::new(&[0.0, 1.0, 3.0].map(key), interpolation).expect("legal").into();
            let interval = TimeInterval::new(0.4, 1.3).expect("in order");
            let motion = LightMotion { to_world, origin_m: DVec3::new(0.5, 0.2, 0.1), interval };
            let light = MovingLight::from_facets(FlatShape::one(&mesh, 0), motion, MaterialId(0));
            let bounds = light.bounds(3.0, false).expect("an area");
            assert!(bounds.theta_o > 0.2 && bounds.theta_o < 2.0, "{bounds:?}");
            let mut widest: f32 = 0.0;
            for i in 0..=1000_u16 {
                let Some(FrozenLight::Triangle(moment)) = light.at(0.0009 * f32::from(i)) else { panic!("a triangle") };
                let own = moment.bounds(3.0, false);
                assert!(bounds.low.cmple(own.low).all() && own.high.cmple(bounds.high).all());
                let angle = maths::f32::atan2(own.axis.cross(bounds.axis).length(), own.axis.dot(bounds.axis));
                assert!(
                    angle <= bounds.theta_o && own.intensity <= bounds.intensity * (1.0 + 1e-6),
                    "{angle} {bounds:?}"
                );
                widest = widest.max(angle);
            }
            assert!(bounds.theta_o < 1.5 * widest, "{widest} {bounds:?}");
        }
    }
}
