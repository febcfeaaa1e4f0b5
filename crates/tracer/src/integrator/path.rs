//! One path, in the order of the algorithm: intersect, add emission, sample direct light, sample the BSDF, Russian roulette.
//!
//! Where a surface is transparent to a path (opacity), or passes light straight (a thin pane), the path continues as if there were no surface: there
//! is no scattering event, and the light that it hits next is weighted as seen from the last scattering.
//!
//! **Branches** (splitting; Arvo and Kirk, "Particle transport and image synthesis", 1990): from one point that the camera sees, several lights are
//! sampled and several paths continue. The cost of that point (the ray through the lens, the textures, the cut of lights that the samples share) is
//! paid once. The light of lamps and of other surfaces has the noise of as many more samples. Edges, depth of field and motion do not benefit: their
//! noise depends on the number of samples. A path branches once, at the first surface that is no mirror. Points in media, drops and flakes do not
//! branch. Each branch has its part of the throughput. Densities are those of all branches and light samples together, so that multiple importance
//! sampling weights as many of both.
//!
//! **Russian roulette** (Arvo and Kirk 1990): the survival probability is proportional to the throughput (its largest component) relative to that
//! behind the first surface that is no mirror (`path_state.rs`). The throughput itself would end paths behind a dark first surface early, although
//! that surface scales all light of the pixel, and its noise, by the same factor. Under uniform light the optimal probability is the relative
//! throughput times the square root of the cost of a whole path over that of its remainder (Bolin and Meyer 1997; Rath and others 2022, "EARS").

use core::marker::PhantomData;

use etendue_core::{FieldRay, Integrator, Ray, Spectral, TimeInterval, Wavelengths, random::Draw};
use glam::Vec3;

use super::path_state::{PathCone, PathMedium, RouletteState, ScatteringHistory};
use super::{PathTracer, path_tracer::Effects};
use crate::lights::{LightHit, LightSampleContext};
use crate::materials::{Bsdf, BsdfSample, EmissionQuery, Event, ShadingFrame};
use crate::{
    MaterialId, geometry::SurfacePoint, guiding::DirectionDistribution, media::Phase, precipitation::ParticleHit,
    textures::Lookup,
};

/// Maximum number of surfaces that a path hits, including those that it passes. No scene needs as many. Among surfaces closer together than
/// the step from one to the next, a path might loop forever.
pub(super) const MAX_VERTICES: u32 = 8192;

/// A path and the radiance it has gathered so far.
#[derive(Clone)]
pub(super) struct Path<'a, const N: usize, E> {
    pub(super) tracer: &'a PathTracer<'a>,
    pub(super) wavelengths: &'a Wavelengths<N>,
    /// Camera ray: its random stream, and the interval over which lights are averaged.
    pub(super) camera_ray: &'a FieldRay,
    pub(super) ray: Ray,
    pub(super) cone: PathCone,
    /// True if it branches at the first surface that is no mirror.
    pub(super) branches: bool,
    /// Scattering events so far.
    pub(super) bounces: u32,
    /// Surfaces hit so far, including those passed: the vertex's index for random numbers.
    pub(super) vertex_index: u32,
    /// Distance since the last scattering, m: longer than the ray's if it has passed surfaces.
    pub(super) travelled_m: f32,
    /// Density of the ray's direction, 1/sr, times the branches of the path at the surface that scattered it; `None` if it came from the
    /// camera or a mirror.
    pub(super) direction_pdf: Option<f32>,
    /// Point of the last scattering; `None` if the ray came from the camera or a mirror.
    pub(super) receiver: Option<LightSampleContext>,
    pub(super) medium: PathMedium<'a>,
    pub(super) history: ScatteringHistory,
    /// True if the path has hit a drop or flake. It hits one at most.
    pub(super) has_hit_particle: bool,
    /// Random numbers used for free flights in media.
    pub(super) flight_draws: u32,
    pub(super) roulette: RouletteState,
    /// Weight of radiance along the ray at the camera.
    pub(super) throughput: Spectral<N>,
    pub(super) radiance: Spectral<N>,
    pub(super) effects: PhantomData<E>,
}

/// A surface that the path has hit and that may scatter it.
#[derive(Clone, Copy)]
pub(super) struct Vertex<'a, const N: usize> {
    pub(super) point: SurfacePoint,
    pub(super) frame: ShadingFrame,
    pub(super) bsdf: Bsdf<'a, N>,
    /// Material; for mixes, the sampled component.
    pub(super) material: MaterialId,
    /// Distribution of sampled directions; `None` if the BSDF samples them.
    pub(super) guide: Option<&'a DirectionDistribution>,
}

/// The end of a ray.
pub(super) enum Intersection<'a> {
    /// Infinity.
    Nothing,
    /// A surface that is transparent to this path; the ray continues behind it.
    Passed,
    /// A point between surfaces where light is scattered, in the render frame, m.
    Medium(Vec3, &'a Phase),
    /// A drop or flake; the ray ends there.
    Particle(ParticleHit),
    /// A surface, and the place of its texture look-ups.
    Surface(SurfacePoint, Lookup),
}

/// The next step of a path: another vertex, or its end.
pub(super) enum PathStep {
    Continue,
    End,
}

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    pub(super) fn new(tracer: &'a PathTracer<'a>, camera_ray: &'a FieldRay, wavelengths: &'a Wavelengths<N>) -> Self {
        Self {
            tracer,
            wavelengths,
            camera_ray,
            ray: camera_ray.ray,
            cone: PathCone::new(tracer.settings.cone_spread_rad),
            branches: tracer.settings.branches > 1,
            bounces: 0,
            vertex_index: 0,
            travelled_m: 0.0,
            direction_pdf: None,
            receiver: None,
            medium: tracer.medium,
            history: ScatteringHistory::default(),
            has_hit_particle: false,
            flight_draws: 0,
            roulette: RouletteState::default(),
            throughput: Spectral::ONE,
            radiance: Spectral::ZERO,
            effects: PhantomData,
        }
    }

    /// Traces the path to its end and returns the radiance at the camera.
    pub(super) fn trace(mut self) -> Spectral<N> {
        while self.vertex_index < MAX_VERTICES && matches!(self.step(), PathStep::Continue) {
            self.vertex_index += 1;
        }
        self.radiance
    }

    /// Moves to the next surface and on from it, or to infinity.
    fn step(&mut self) -> PathStep {
        let intersection = self.intersect();
        self.scatter(intersection)
    }

    /// Moves the ray to the next surface, whose emission is added, or to infinity.
    #[inline(always)]
    pub(super) fn intersect(&mut self) -> Intersection<'a> {
        let hit = self.tracer.view.closest(&self.ray);
        if E::MEDIA
            && self.tracer.media.is_some()
            && let Some(intersection) = self.intersect_media(hit.as_ref().map_or(f32::INFINITY, |hit| hit.t))
        {
            return intersection;
        }
        let Some(hit) = hit else {
            self.add_distant_light();
            return Intersection::Nothing;
        };
        let point = self.tracer.view.surface(&self.ray, &hit);
        self.cone.travel(hit.t);
        self.travelled_m += hit.t;
        if E::SURFACES {
            self.throughput = self.medium.attenuate(self.throughput, hit.t, self.wavelengths);
        }
        let lookup = self.lookup(&point, self.cone, self.ray.direction);
        if !self.sees_only_air() {
            self.add_emission(&point, &lookup);
        }
        if self.is_transparent(&point, &lookup) {
            self.pass(&point);
            return Intersection::Passed;
        }
        if self.sees_only_air() { Intersection::Nothing } else { Intersection::Surface(point, lookup) }
    }

    /// Adds light from infinity, along the ray.
    fn add_distant_light(&mut self) {
        let strategies = self.tracer.settings.strategies;
        for light in self.tracer.lights.distant(self.ray.direction, self.receiver.as_ref(), self.wavelengths) {
            if (light.is_environment || self.includes(self.history.is_caustic())) && !self.sees_only_air() {
                self.radiance +=
                    self.throughput * light.radiance * strategies.hit_weight(self.direction_pdf, light.pdf);
            }
        }
    }

    /// Adds the light that the surface hit emits against the ray.
    fn add_emission(&mut self, point: &SurfacePoint, lookup: &Lookup) {
        let Some(emitted) = self.emitted(point, lookup) else { return };
        if !self.includes(self.history.is_caustic()) {
            return;
        }
        let (direction, distance_m) = (self.ray.direction, self.travelled_m);
        let hit = |receiver| LightHit { receiver, point, direction, distance_m };
        let light_pdf = self.receiver.as_ref().map_or(0.0, |receiver| self.tracer.lights.light_pdf(&hit(receiver)));
        let weight = self.tracer.settings.strategies.hit_weight(self.direction_pdf, light_pdf);
        self.radiance += self.throughput * emitted * weight;
    }

    /// Radiance of a surface against the ray: by its material, or as the opening of a lamp; `None` if this side does not emit.
    #[inline(always)]
    fn emitted(&self, point: &SurfacePoint, lookup: &Lookup) -> Option<Spectral<N>> {
        let material_table = self.tracer.material_table;
        match material_table.emission(point.material) {
            None => self.tracer.lights.opening_radiance(point, self.ray.direction, self.emission_query()),
            Some(emission) if emission.emits_towards(point.geometric_normal, -self.ray.direction) => {
                Some(material_table.radiance(point.material, emission, lookup, self.emission_query()))
            }
            Some(_) => None,
        }
    }

    /// True if the surface is transparent to this path.
    fn is_transparent(&self, point: &SurfacePoint, lookup: &Lookup) -> bool {
        let material_table = self.tracer.material_table;
        E::SURFACES
            && material_table.lets_pass(point.material)
            && self.camera_ray.stream.one(Draw::Opacity, self.vertex_index)
                >= material_table.opacity(point.material, lookup)
    }

    /// Continues the ray straight behind a surface.
    fn pass(&mut self, point: &SurfacePoint) {
        self.ray.origin = point.spawn(self.ray.direction);
        self.ray.left = Some(point.primitive_id());
    }

    /// Scatters the path at the end of its ray.
    #[inline(always)]
    pub(super) fn scatter(&mut self, intersection: Intersection<'a>) -> PathStep {
        match intersection {
            Intersection::Nothing => PathStep::End,
            Intersection::Passed => PathStep::Continue,
            Intersection::Medium(..) | Intersection::Particle(_) if !E::MEDIA => PathStep::End,
            Intersection::Medium(..) if self.is_at_max_bounces() => PathStep::End,
            Intersection::Medium(position, phase) => self.scatter_in_medium(position, phase),
            Intersection::Particle(_) if self.tracer.settings.only_airlight => PathStep::End,
            Intersection::Particle(hit) => self.scatter_at_particle(&hit),
            Intersection::Surface(point, lookup) if self.is_at_max_bounces() => self.only_pass(point, &lookup),
            Intersection::Surface(point, lookup) => self.scatter_at_surface(&self.vertex(point, &lookup)),
        }
    }

    /// True if the path has reached the maximum number of scattering events.
    pub(super) fn is_at_max_bounces(&self) -> bool {
        self.bounces == self.tracer.max_bounces()
    }

    /// Passes surfaces only: after the last scattering event light may still come straight through.
    pub(super) fn only_pass(&mut self, point: SurfacePoint, lookup: &Lookup) -> PathStep {
        if !(E::SURFACES && self.tracer.material_table.lets_pass(point.material)) {
            return PathStep::End;
        }
        let vertex = self.vertex(point, lookup);
        match self.sample_bsdf(&vertex) {
            Some(sample) if sample.event == Event::Null => self.pass_through(&vertex, &sample),
            _ => PathStep::End,
        }
    }

    /// Adds direct light at a surface and continues from it.
    #[inline(always)]
    pub(super) fn scatter_at_surface(&mut self, vertex: &Vertex<'a, N>) -> PathStep {
        if matches!(vertex.bsdf, Bsdf::Absorber) {
            return PathStep::End;
        }
        // Light from behind counts if the surface transmits it.
        let transmits = E::SURFACES && vertex.bsdf.transmits();
        let normal = if transmits { Vec3::ZERO } else { vertex.frame.normal() };
        let gloss = if !E::SURFACES || transmits { None } else { self.gloss(vertex) };
        let (position, time_s) = (vertex.point.position, vertex.point.time_s);
        let samples = self.branch_count(vertex);
        let receiver = LightSampleContext {
            position,
            normal,
            gloss,
            in_view: self.history.is_directly_visible(),
            samples,
            time_s,
        };
        self.sample_direct_light(vertex, &receiver);
        if samples > 1 { self.branch(vertex, &receiver) } else { self.continue_from(vertex, &receiver) }
    }

    /// Number of paths that continue from a surface that the path has hit.
    #[inline(always)]
    fn branch_count(&self, vertex: &Vertex<'a, N>) -> u32 {
        let here = self.branches && self.history.is_directly_visible() && !(E::SURFACES && vertex.bsdf.is_delta());
        if here { self.tracer.settings.branches } else { 1 }
    }

    /// Traces all branches to their ends.
    #[inline(never)]
    fn branch(&mut self, vertex: &Vertex<'a, N>, receiver: &LightSampleContext) -> PathStep {
        let count = receiver.samples;
        for k in 0..count {
            let camera_ray = FieldRay { stream: self.camera_ray.stream.branch(k, count), ..*self.camera_ray };
            let (throughput, radiance) = (self.throughput / count as f32, Spectral::ZERO);
            let mut branch = Path { camera_ray: &camera_ray, branches: false, throughput, radiance, ..self.clone() };
            let gathered = match branch.continue_from(vertex, receiver) {
                PathStep::End => branch.radiance,
                PathStep::Continue => {
                    branch.vertex_index += 1;
                    branch.trace()
                }
            };
            self.radiance += gathered;
        }
        PathStep::End
    }

    /// Continues from a surface in a sampled direction.
    #[inline(always)]
    fn continue_from(&mut self, vertex: &Vertex<'a, N>, receiver: &LightSampleContext) -> PathStep {
        match self.sample_bsdf(vertex) {
            None => PathStep::End,
            Some(sample) if E::SURFACES && sample.event == Event::Null => self.pass_through(vertex, &sample),
            Some(sample) => self.follow_sample(vertex, &sample, receiver),
        }
    }

    /// Samples the direction in which the path continues; `None` if the light is absorbed.
    #[inline(always)]
    fn sample_bsdf(&self, vertex: &Vertex<'_, N>) -> Option<BsdfSample<N>> {
        let choice = if E::SURFACES && vertex.bsdf.has_parts() {
            self.camera_ray.stream.one(Draw::BsdfChoice, self.vertex_index)
        } else {
            0.0
        };
        let u = self.camera_ray.stream.two(Draw::BsdfDirection, self.vertex_index);
        match &vertex.bsdf {
            Bsdf::Diffuse(bsdf) if vertex.guide.is_some() => vertex.guided_sample(bsdf, u),
            Bsdf::Diffuse(bsdf) if !E::SURFACES => bsdf.sample_above(u),
            bsdf => bsdf.sample(vertex.frame.wo, choice, u),
        }
    }

    /// Passes straight through a surface that attenuates the path.
    fn pass_through(&mut self, vertex: &Vertex<'_, N>, sample: &BsdfSample<N>) -> PathStep {
        self.throughput *= sample.weight;
        self.pass(&vertex.point);
        self.end_if_dark()
    }

    /// Continues in a new direction.
    fn follow_sample(
        &mut self,
        vertex: &Vertex<'a, N>,
        sample: &BsdfSample<N>,
        receiver: &LightSampleContext,
    ) -> PathStep {
        let outward = vertex.frame.outward(sample.wi);
        let Some(direction) = outward.or_else(|| Self::along_surface(vertex, sample)) else { return PathStep::End };
        self.throughput *= sample.weight;
        // Caustics and the width of texture look-ups depend on the surface, not on the sampling of its directions. No light is sampled
        // along a surface.
        let has_density = outward.is_some() && (!E::SURFACES || sample.event == Event::Scatter);
        let bsdf_pdf = has_density.then_some(sample.pdf);
        self.history.scatter(bsdf_pdf);
        if let Some(pdf) = bsdf_pdf {
            self.cone.scatter(pdf);
        }
        let relative_density = vertex.relative_density(sample.wi);
        self.direction_pdf = bsdf_pdf.map(|pdf| pdf * relative_density * receiver.samples as f32);
        self.roulette.scale(relative_density);
        self.receiver = self.direction_pdf.map(|_| *receiver);
        self.medium = self.medium_towards(vertex, sample.wi);
        self.continue_along(Ray { time_s: self.ray.time_s, ..vertex.point.leave(direction) })
    }

    /// Direction along the surface, if the shading normal sends light to the wrong side of the true surface: mirrors and glass absorb
    /// nothing there. `None` for all others.
    #[inline(always)]
    fn along_surface(vertex: &Vertex<'a, N>, sample: &BsdfSample<N>) -> Option<Vec3> {
        let is_lossless =
            E::SURFACES && (sample.event == Event::Specular || matches!(vertex.bsdf, Bsdf::Dielectric(_)));
        is_lossless.then(|| vertex.frame.outward_to_horizon(sample.wi))
    }

    /// Leaves the point that has scattered the path.
    #[inline(always)]
    pub(super) fn continue_along(&mut self, ray: Ray) -> PathStep {
        self.ray = ray;
        self.travelled_m = 0.0;
        self.bounces += 1;
        if self.tracer.settings.integrator == Integrator::Flat {
            self.add_distant_light();
            return PathStep::End;
        }
        match self.end_if_dark() {
            PathStep::Continue if self.russian_roulette() => PathStep::Continue,
            _ => PathStep::End,
        }
    }

    /// Ends a path without throughput.
    pub(super) fn end_if_dark(&self) -> PathStep {
        if self.throughput.is_zero() { PathStep::End } else { PathStep::Continue }
    }

    /// Samples whether the path continues; if so it is weighted for those that ended. Paths that only mirrors have scattered all continue.
    fn russian_roulette(&mut self) -> bool {
        if self.history.is_directly_visible() {
            return true;
        }
        let probability = self.roulette.survival_probability(self.throughput.max_value());
        let starts = self.bounces >= self.tracer.settings.roulette_start;
        if !starts || probability >= 1.0 || !probability.is_finite() {
            return true;
        }
        self.throughput = self.throughput / probability;
        self.camera_ray.stream.one(Draw::Roulette, self.bounces) < probability
    }

    /// True if light of a light source counts; `is_caustic` is true if it is part of a caustic. Diffuse surfaces alone make no caustics.
    pub(super) fn includes(&self, is_caustic: bool) -> bool {
        !E::SURFACES || self.tracer.settings.caustics || !is_caustic
    }

    /// Arguments for the evaluation of lights.
    pub(super) fn emission_query(&self) -> EmissionQuery<'a, N> {
        EmissionQuery { wavelengths: self.wavelengths, interval: self.light_interval() }
    }

    /// The interval over which lights are averaged.
    pub(super) fn light_interval(&self) -> &'a TimeInterval {
        &self.camera_ray.light_interval
    }
}
