//! Direct light (next-event estimation): sampled lights at a surface, and their transmittance.

use etendue_core::{Integrator, Ray, Spectral, random::Draw};
use glam::Vec3;

use super::path::{MAX_VERTICES, Path, Vertex};
use super::{path_state::PathMedium, path_tracer::Effects};
use crate::geometry::SurfacePoint;
use crate::lights::{LightSample, LightSampleContext};
use crate::media::{ForwardPeak, MediaRay, RandomCounter};

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// Adds the light of sampled lights, as many as the receiver requires, times its transmittance.
    #[inline(always)]
    pub(super) fn sample_direct_light(&mut self, vertex: &Vertex<'a, N>, receiver: &LightSampleContext) {
        let lights = self.tracer.lights;
        if !lights.can_sample() || (E::SURFACES && vertex.bsdf.is_delta()) {
            return;
        }
        let sampler = lights.sampler_for(receiver);
        for k in 0..receiver.samples {
            let stream = self.camera_ray.stream.branch(k, receiver.samples);
            let choice = if lights.are_many() { stream.one(Draw::LightChoice, self.vertex_index) } else { 0.0 };
            let u = stream.two(Draw::LightPoint, self.vertex_index);
            let (spread_rad, table) = (self.cone.spread_rad, self.tracer.material_table);
            let sample = sampler.sample(choice, u, spread_rad, table, self.emission_query());
            if let Some(light) = sample.and_then(|sample| self.direct_light(vertex, &sample, receiver)) {
                self.radiance += light;
            }
        }
    }

    /// Radiance at the camera of a sampled light that a surface scatters; `None` if there is none.
    #[inline(always)]
    fn direct_light(
        &self,
        vertex: &Vertex<'a, N>,
        light: &LightSample<N>,
        receiver: &LightSampleContext,
    ) -> Option<Spectral<N>> {
        let wi = vertex.frame.inward(light.direction)?;
        let value = self.evaluate(vertex, wi);
        if !(light.is_environment || self.includes(self.history.would_be_caustic(value.pdf))) {
            return None;
        }
        let direction_pdf = vertex.density(wi, value.pdf) * receiver.samples as f32;
        let arriving = self.throughput * value.value_cos * light.radiance * self.light_weight(light, direction_pdf);
        let peak = self.forward_peak(self.history.would_have_diffuse(value.pdf));
        if arriving.is_zero() {
            return None;
        }
        let visibility = self.visibility(vertex, light, self.medium_towards(vertex, wi), peak)?;
        Some(arriving * visibility)
    }

    /// Weight of a sampled light against the scattering that may hit it, over its density. Sampling is the only way to find a lamp without
    /// an opening, or a surface that no ray is traced to hit.
    pub(super) fn light_weight(&self, light: &LightSample<N>, direction_pdf: f32) -> f32 {
        let settings = &self.tracer.settings;
        let is_only_sampled = light.delta || (settings.integrator == Integrator::Flat && light.target.is_some());
        if is_only_sampled {
            1.0 / light.pdf
        } else {
            settings.strategies.sample_weight(light.pdf, direction_pdf) / light.pdf
        }
    }

    /// Fraction of a sampled light that reaches the vertex through a `medium`; `None` if something opaque stands between.
    fn visibility(
        &self,
        vertex: &Vertex<'_, N>,
        light: &LightSample<N>,
        medium: PathMedium<'_>,
        peak: ForwardPeak,
    ) -> Option<Spectral<N>> {
        let ray = self.ray_from_surface(&vertex.point, light);
        let fraction = self.visibility_along(ray, light, medium, peak)?;
        // As for a path that hits nothing, the distance to infinity absorbs nothing.
        let distance_m = light.target.map_or(0.0, |target| target.distance(vertex.point.position));
        Some(if E::SURFACES { medium.attenuate(fraction, distance_m, self.wavelengths) } else { fraction })
    }

    /// Transmittance along a ray towards a sampled light, without the absorption of a solid in which the ray begins.
    pub(super) fn visibility_along(
        &self,
        ray: Ray,
        light: &LightSample<N>,
        medium: PathMedium<'_>,
        peak: ForwardPeak,
    ) -> Option<Spectral<N>> {
        let fraction = if self.tracer.settings.integrator == Integrator::Flat {
            Spectral::ONE
        } else if E::SURFACES && self.tracer.material_table.has_passages() {
            self.transmittance_of_surfaces(ray, light)?
        } else if self.tracer.view.occluded(&ray) {
            return None;
        } else {
            Spectral::ONE
        };
        match self.tracer.media {
            Some(media) if E::MEDIA && !medium.is_solid() => {
                let random = RandomCounter { stream: &self.camera_ray.stream, counter: 2 * self.vertex_index };
                Some(fraction * media.transmittance(MediaRay { ray: &ray, peak }, random, self.wavelengths))
            }
            _ => Some(fraction),
        }
    }

    /// Ray from a point of a surface to that of the light, or to infinity.
    fn ray_from_surface(&self, point: &SurfacePoint, light: &LightSample<N>) -> Ray {
        let origin = point.spawn(light.direction);
        self.ray_towards(origin, light.direction, light.target).leaving(point.primitive_id())
    }

    /// Ray from a point off all surfaces to `target`, or to infinity.
    pub(super) fn ray_towards(&self, origin: Vec3, direction: Vec3, target: Option<Vec3>) -> Ray {
        let mut ray = Ray::new(origin, direction, self.ray.time_s);
        if let Some(target) = target {
            ray.direction = target - origin;
            ray.t_max = 1.0;
        }
        ray
    }

    /// Transmittance of the surfaces along a ray towards a sampled light. Cut-outs and thin panes pass light straight.
    fn transmittance_of_surfaces(&self, mut ray: Ray, light: &LightSample<N>) -> Option<Spectral<N>> {
        let material_table = self.tracer.material_table;
        let mut transmittance = Spectral::ONE;
        let mut cone = self.cone;
        for _ in 0..MAX_VERTICES {
            let Some(hit) = self.tracer.view.closest(&ray) else { return Some(transmittance) };
            let point = self.tracer.view.surface(&ray, &hit);
            if !material_table.lets_pass(point.material) {
                return None;
            }
            cone.travel(hit.t * ray.direction.length());
            let lookup = self.lookup(&point, cone, light.direction);
            let cos = |part| self.frame(part, &point, &lookup, light.direction).wo.z;
            transmittance *= material_table.passage(point.material, &lookup, &cos, self.wavelengths)?;
            if transmittance.is_zero() {
                return None;
            }
            ray = self.ray_from_surface(&point, light);
            if ray.direction.dot(light.direction) <= 0.0 {
                return Some(transmittance);
            }
        }
        None
    }
}
