//! One path, vertex by vertex.

use etendue_core::random::{Draw, PathStream};
use etendue_core::{Ray, Spectral, Wavelengths};
use glam::Vec3;

use super::PathTracer;
use super::caustic::History;
use super::cone::Cone;
use crate::geometry::SurfacePoint;
use crate::lights::{Met, Receiver};
use crate::materials::{Bsdf, Event, ShadingFrame};
use crate::textures::Lookup;

/// A path on its way.
pub(super) struct Path<'a, const N: usize> {
    tracer: &'a PathTracer<'a>,
    wavelengths: &'a Wavelengths<N>,
    stream: &'a PathStream,
    ray: Ray,
    cone: Cone,
    /// Scattering events so far.
    bounces: u32,
    /// Density of the ray's direction, 1/sr; `None` where it came from the camera or a mirror.
    scattered: Option<f32>,
    /// Where `scattered` is told: the point that the ray came from.
    receiver: Option<Receiver>,
    history: History,
    /// What radiance along the ray counts at the camera.
    throughput: Spectral<N>,
    radiance: Spectral<N>,
}

/// A surface that the path has met.
struct Vertex<'a, const N: usize> {
    point: SurfacePoint,
    frame: ShadingFrame,
    bsdf: Bsdf<'a, N>,
    receiver: Receiver,
}

impl<'a, const N: usize> Path<'a, N> {
    pub(super) fn new(
        tracer: &'a PathTracer<'a>,
        ray: &Ray,
        wavelengths: &'a Wavelengths<N>,
        stream: &'a PathStream,
    ) -> Self {
        Self {
            tracer,
            wavelengths,
            stream,
            ray: *ray,
            cone: Cone::new(tracer.settings.cone_spread_rad),
            bounces: 0,
            scattered: None,
            receiver: None,
            history: History::default(),
            throughput: Spectral::ONE,
            radiance: Spectral::ZERO,
        }
    }

    /// Radiance at the camera.
    pub(super) fn follow(mut self) -> Spectral<N> {
        loop {
            let Some(hit) = self.tracer.view.closest(&self.ray) else {
                self.gather_distant();
                return self.radiance;
            };
            let point = self.tracer.view.surface(&self.ray, &hit);
            self.cone.travel(hit.t);
            let lookup = self.lookup(&point);
            self.gather_glow(&point, &lookup, hit.t);
            if self.bounces == self.tracer.settings.max_bounces || !self.scatter(point, &lookup) {
                return self.radiance;
            }
        }
    }

    /// Where textures are read at a point that the path has met.
    fn lookup(&self, point: &SurfacePoint) -> Lookup {
        let at = Lookup { local: point.local, local_normal: point.local_normal, ..Lookup::point(point.uv) };
        if !self.tracer.palette.needs_footprint(point.material) {
            return at;
        }
        let footprint = self.tracer.view.footprint(point);
        let width_m = self.cone.width_m;
        Lookup { width: width_m * footprint.uv_per_m, width_local: width_m * footprint.local_per_m, ..at }
    }

    /// Light from beyond the scene, along the ray.
    fn gather_distant(&mut self) {
        let strategies = self.tracer.settings.strategies;
        for light in self.tracer.lights.distant(self.ray.direction, self.receiver.as_ref(), self.wavelengths) {
            if light.surrounds || self.follows(self.history.is_caustic()) {
                self.radiance += self.throughput * light.radiance * strategies.met(self.scattered, light.pdf);
            }
        }
    }

    /// Light that the surface met emits against the ray.
    fn gather_glow(&mut self, point: &SurfacePoint, lookup: &Lookup, distance_m: f32) {
        let palette = self.tracer.palette;
        let Some(emission) = palette.emission(point.material) else { return };
        if !emission.leaves(point.geometric_normal, -self.ray.direction) || !self.follows(self.history.is_caustic()) {
            return;
        }
        let met = |receiver| Met { receiver, point, direction: self.ray.direction, distance_m };
        let drawn = self.receiver.as_ref().map_or(0.0, |receiver| self.tracer.lights.met_pdf(&met(receiver)));
        let weight = self.tracer.settings.strategies.met(self.scattered, drawn);
        self.radiance +=
            self.throughput * palette.radiance(point.material, emission, lookup, self.wavelengths) * weight;
    }

    /// Gathers drawn light at a surface and goes on from it; false where the path ends.
    fn scatter(&mut self, point: SurfacePoint, lookup: &Lookup) -> bool {
        let to_viewer = -self.ray.direction;
        let frame = ShadingFrame::new(&point, point.shading_normal, to_viewer);
        let bsdf = self.tracer.palette.bsdf(point.material, lookup, frame.front, self.wavelengths);
        if matches!(bsdf, Bsdf::Absorber) {
            return false;
        }
        // Light from behind counts where the surface lets it through.
        let normal = if bsdf.transmits() { Vec3::ZERO } else { frame.normal() };
        let receiver = Receiver { position: point.position, normal };
        let vertex = Vertex { frame, point, bsdf, receiver };
        self.gather_drawn(&vertex);
        self.go_on(&vertex) && self.survives()
    }

    /// Next-event estimation: light of one drawn light, if nothing stands between.
    fn gather_drawn(&mut self, vertex: &Vertex<'_, N>) {
        let lights = self.tracer.lights;
        if !lights.can_be_drawn() || vertex.bsdf.is_mirror() {
            return;
        }
        let choice = self.stream.one(Draw::LightChoice, self.bounces);
        let u = self.stream.two(Draw::LightPoint, self.bounces);
        let spread = self.cone.spread_rad;
        let Some(light) = lights.sample(&vertex.receiver, (choice, u), spread, self.tracer.palette, self.wavelengths)
        else {
            return;
        };
        let Some(wi) = vertex.frame.inward(light.direction) else { return };
        let value = vertex.bsdf.evaluate(vertex.frame.wo, wi);
        if !(light.surrounds || self.follows(self.history.would_be_caustic(value.pdf))) {
            return;
        }
        let weight =
            if light.delta { 1.0 } else { self.tracer.settings.strategies.drawn(light.pdf, value.pdf) } / light.pdf;
        let arriving = self.throughput * value.value_cos * light.radiance * weight;
        if !arriving.is_zero() && self.is_free(&vertex.point, light.direction, light.target) {
            self.radiance += arriving;
        }
    }

    /// Whether light of a lamp counts, given whether it is part of a caustic.
    fn follows(&self, is_caustic: bool) -> bool {
        self.tracer.settings.caustics || !is_caustic
    }

    /// Whether light comes through from `target`, or from infinity.
    fn is_free(&self, point: &SurfacePoint, direction: Vec3, target: Option<Vec3>) -> bool {
        let origin = point.spawn(direction);
        let mut ray = Ray::new(origin, direction, self.ray.time_s);
        if let Some(target) = target {
            ray.direction = target - origin;
            ray.t_max = 1.0;
        }
        !self.tracer.view.occluded(&ray)
    }

    /// Draws where the path goes; false where the light would be absorbed.
    fn go_on(&mut self, vertex: &Vertex<'_, N>) -> bool {
        let choice = self.stream.one(Draw::BsdfChoice, self.bounces);
        let u = self.stream.two(Draw::BsdfDirection, self.bounces);
        let Some(sample) = vertex.bsdf.sample(vertex.frame.wo, choice, u) else { return false };
        let Some(direction) = vertex.frame.outward(sample.wi) else { return false };
        self.throughput *= sample.weight;
        self.scattered = (sample.event == Event::Scatter).then_some(sample.pdf);
        self.receiver = self.scattered.map(|_| vertex.receiver);
        self.history.scatter(self.scattered);
        if let Some(pdf) = self.scattered {
            self.cone.scatter(pdf);
        }
        self.ray = Ray::new(vertex.point.spawn(direction), direction, self.ray.time_s);
        self.bounces += 1;
        !self.throughput.is_zero()
    }

    /// Russian roulette: the path goes on with the probability of its greatest throughput, and then counts for those
    /// that ended.
    fn survives(&mut self) -> bool {
        if self.bounces < self.tracer.settings.roulette_start {
            return true;
        }
        let chance = self.throughput.max_value();
        if chance >= 1.0 || !chance.is_finite() {
            return true;
        }
        self.throughput = self.throughput / chance;
        self.stream.one(Draw::Roulette, self.bounces) < chance
    }
}
