//! One path, vertex by vertex.
//!
//! Where a surface is not there (opacity), or light goes straight through it (a thin pane), the path goes on as if it had
//! met nothing: no scattering event, and light that it then meets is weighed as seen from where it was last scattered.

use core::marker::PhantomData;
use etendue_core::random::Draw;
use etendue_core::{FieldRay, Ray, Spectral, TimeInterval, Wavelengths};
use glam::Vec3;

use super::carried::Carried;
use super::caustic::History;
use super::cone::Cone;
use super::effects::Effects;
use super::medium::Medium;
use super::{Level, LightSampling, PathTracer};
use crate::MaterialId;
use crate::geometry::SurfacePoint;
use crate::guiding::DirectionDistribution;
use crate::lights::{LightSampleContext, ReceiverGloss};
use crate::materials::{Bsdf, BsdfSample, BsdfValue, Event, GlossLobe, ShadingFrame};
use crate::media::Phase;
use crate::precipitation::NearHit;
use crate::textures::Lookup;

/// Surfaces that a path meets at most, with those that it passes. No scene needs as many; among surfaces closer together
/// than the step from one to the next a path might turn in circles.
pub(super) const MAX_MET: u32 = 8192;

/// A path on its way.
#[derive(Clone)]
pub(super) struct Path<'a, const N: usize, E> {
    pub(super) tracer: &'a PathTracer<'a>,
    pub(super) wavelengths: &'a Wavelengths<N>,
    /// What the camera asked: its random address, and when lights are looked at.
    pub(super) asked: &'a FieldRay,
    pub(super) ray: Ray,
    pub(super) cone: Cone,
    /// Whether it branches at the first surface that is no mirror.
    pub(super) branches: bool,
    /// Scattering events so far.
    pub(super) bounces: u32,
    /// Surfaces met so far, with those that were passed: the vertex's number for random draws.
    pub(super) met: u32,
    /// Way since the last scattering, m: longer than the ray's where it has passed surfaces.
    pub(super) travelled_m: f32,
    /// Density of the ray's direction, 1/sr, times the branches of the path at the surface that scattered it; `None` where it came from the camera or a mirror.
    pub(super) scattered: Option<f32>,
    /// Where the ray was last scattered; `None` where it came from the camera or a mirror.
    pub(super) receiver: Option<LightSampleContext>,
    pub(super) medium: Medium<'a>,
    pub(super) history: History,
    /// Whether the path has met a drop or flake: it meets one at most.
    pub(super) beyond_particle: bool,
    /// Random numbers used for flights through media.
    pub(super) flights: u32,
    /// What roulette goes by.
    pub(super) carried: Carried,
    /// What radiance along the ray counts at the camera.
    pub(super) throughput: Spectral<N>,
    pub(super) radiance: Spectral<N>,
    pub(super) effects: PhantomData<E>,
}

/// A surface that the path has met.
#[derive(Clone, Copy)]
pub(super) struct Vertex<'a, const N: usize> {
    pub(super) point: SurfacePoint,
    pub(super) frame: ShadingFrame,
    pub(super) bsdf: Bsdf<'a, N>,
    /// Of mixes the part that was drawn.
    pub(super) material: MaterialId,
    /// What its directions are drawn by; `None` where by the bsdf alone.
    pub(super) guide: Option<&'a DirectionDistribution>,
}

/// What a path meets.
pub(super) enum Intersection<'a> {
    /// Nothing: infinity.
    Nothing,
    /// A surface that is not there for this path.
    Passed,
    /// A place between surfaces where light is scattered, in the render frame, m.
    Medium(Vec3, &'a Phase),
    /// A drop or flake, which the ray has been taken to.
    Particle(NearHit),
    /// A surface, and where its textures are read.
    Surface(SurfacePoint, Lookup),
}

/// How a path goes on.
pub(super) enum PathStep {
    /// To another surface.
    Goes,
    /// Not at all.
    Ends,
}

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    pub(super) fn new(tracer: &'a PathTracer<'a>, asked: &'a FieldRay, wavelengths: &'a Wavelengths<N>) -> Self {
        Self {
            tracer,
            wavelengths,
            asked,
            ray: asked.ray,
            cone: Cone::new(tracer.settings.cone_spread_rad),
            branches: tracer.settings.branches > 1,
            bounces: 0,
            met: 0,
            travelled_m: 0.0,
            scattered: None,
            receiver: None,
            medium: tracer.medium,
            history: History::default(),
            beyond_particle: false,
            flights: 0,
            carried: Carried::default(),
            throughput: Spectral::ONE,
            radiance: Spectral::ZERO,
            effects: PhantomData,
        }
    }

    /// Radiance at the camera.
    pub(super) fn follow(mut self) -> Spectral<N> {
        while self.met < MAX_MET && matches!(self.step(), PathStep::Goes) {
            self.met += 1;
        }
        self.radiance
    }

    /// The light that a surface, which the path has just met, scatters against it: what the rest of the path gathers.
    /// Roulette goes on as if the path were not cut.
    pub(super) fn tail(mut self, vertex: &Vertex<'a, N>) -> Spectral<N> {
        self.carried.scale(self.throughput.max_value());
        self.throughput = Spectral::ONE;
        self.radiance = Spectral::ZERO;
        match self.scatter(vertex) {
            PathStep::Ends => self.radiance,
            PathStep::Goes => {
                self.met += 1;
                self.follow()
            }
        }
    }

    /// To the next surface and on from it, or to infinity.
    fn step(&mut self) -> PathStep {
        let met = self.meet();
        self.go_on_from(met)
    }

    /// On from what the path has met.
    #[inline(always)]
    pub(super) fn go_on_from(&mut self, met: Intersection<'a>) -> PathStep {
        match met {
            Intersection::Nothing => PathStep::Ends,
            Intersection::Passed => PathStep::Goes,
            Intersection::Medium(..) | Intersection::Particle(_) if !E::MEDIA => PathStep::Ends,
            Intersection::Medium(..) if self.is_spent() => PathStep::Ends,
            Intersection::Medium(position, phase) => self.scatter_in_medium(position, phase),
            Intersection::Particle(_) if self.tracer.settings.only_airlight => PathStep::Ends,
            Intersection::Particle(hit) => self.scatter_at_particle(&hit),
            Intersection::Surface(point, lookup) if self.is_spent() => self.only_pass(point, &lookup),
            Intersection::Surface(point, lookup) => self.scatter(&self.vertex(point, &lookup)),
        }
    }

    /// Whether the path has scattered as often as it may.
    pub(super) fn is_spent(&self) -> bool {
        self.bounces == self.tracer.max_bounces()
    }

    /// To the next surface, whose glow is gathered, or to infinity.
    #[inline(always)]
    pub(super) fn meet(&mut self) -> Intersection<'a> {
        let hit = self.tracer.view.closest(&self.ray);
        if E::MEDIA
            && self.tracer.media.is_some()
            && let Some(met) = self.travel_to(hit.as_ref().map_or(f32::INFINITY, |hit| hit.t))
        {
            return met;
        }
        let Some(hit) = hit else {
            self.gather_distant();
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
        if self.is_passed(&point, &lookup) {
            self.pass(&point);
            return Intersection::Passed;
        }
        if self.sees_only_air() { Intersection::Nothing } else { Intersection::Surface(point, lookup) }
    }

    /// Where textures are read at a point that a ray of unit `direction` has met whose cone is `cone` there.
    #[inline(always)]
    pub(super) fn lookup(&self, point: &SurfacePoint, cone: Cone, direction: Vec3) -> Lookup {
        let at = Lookup { local: point.local, local_normal: point.local_normal, ..Lookup::point(point.uv) };
        if !(E::SURFACES && self.tracer.material_table.needs_footprint(point.material)) {
            return at;
        }
        let at = Lookup { origin: self.tracer.view.local_origin(point.instance), ..at };
        let footprint = self.tracer.view.footprint(point);
        let width_m = cone.width_m;
        let round = Lookup { width: width_m * footprint.uv_per_m, width_local: width_m * footprint.local_per_m, ..at };
        match cone.long_side(point.geometric_normal, direction) {
            None => round,
            Some(vector) => {
                let (long, long_local) = self.tracer.view.change_along(point, vector);
                Lookup { long, long_local, ..round }
            }
        }
    }

    /// Whether the surface is not there for this path.
    fn is_passed(&self, point: &SurfacePoint, lookup: &Lookup) -> bool {
        let material_table = self.tracer.material_table;
        E::SURFACES
            && material_table.lets_pass(point.material)
            && self.asked.stream.one(Draw::Opacity, self.met) >= material_table.opacity(point.material, lookup)
    }

    /// Straight on from a surface.
    fn pass(&mut self, point: &SurfacePoint) {
        self.ray.origin = point.spawn(self.ray.direction);
        self.ray.left = Some(point.primitive_id());
    }

    /// Beyond the last scattering event light may still come straight through.
    pub(super) fn only_pass(&mut self, point: SurfacePoint, lookup: &Lookup) -> PathStep {
        if !(E::SURFACES && self.tracer.material_table.lets_pass(point.material)) {
            return PathStep::Ends;
        }
        let vertex = self.vertex(point, lookup);
        let through = self.sample(&vertex).filter(|sample| sample.event == Event::Null);
        through.map_or(PathStep::Ends, |sample| self.go_through(&vertex, &sample))
    }

    /// Gathers drawn light at a surface and goes on from it.
    #[inline(always)]
    pub(super) fn scatter(&mut self, vertex: &Vertex<'a, N>) -> PathStep {
        if matches!(vertex.bsdf, Bsdf::Absorber) {
            return PathStep::Ends;
        }
        // Light from behind counts where the surface lets it through.
        let transmits = E::SURFACES && vertex.bsdf.transmits();
        let normal = if transmits { Vec3::ZERO } else { vertex.frame.normal() };
        let gloss = if !E::SURFACES || transmits { None } else { self.gloss(vertex) };
        let (position, time_s) = (vertex.point.position, vertex.point.time_s);
        let draws = self.branches(vertex);
        let receiver = LightSampleContext { position, normal, gloss, in_view: self.history.is_seen(), draws, time_s };
        self.sample_direct(vertex, &receiver);
        if draws > 1 { self.branch(vertex, &receiver) } else { self.scatter_on(vertex, &receiver) }
    }

    /// On from a surface in a drawn direction.
    #[inline(always)]
    pub(super) fn scatter_on(&mut self, vertex: &Vertex<'a, N>, receiver: &LightSampleContext) -> PathStep {
        match self.sample(vertex) {
            None => PathStep::Ends,
            Some(sample) if E::SURFACES && sample.event == Event::Null => self.go_through(vertex, &sample),
            Some(sample) => self.go_on(vertex, &sample, receiver),
        }
    }

    /// What the choice among lights is told of a surface: nothing where light that lobes send on is left out as a caustic, or lobes do not count.
    #[inline(always)]
    fn gloss(&self, vertex: &Vertex<'a, N>) -> Option<ReceiverGloss> {
        let asked = self.tracer.settings.light_sampling == LightSampling::Gloss;
        if !asked || !self.follows(self.history.is_matt()) {
            return None;
        }
        let counts = |lobe: &GlossLobe| self.follows(self.history.would_be_caustic(lobe.density_at_axis()));
        ReceiverGloss::new(&vertex.bsdf.gloss(vertex.frame.wo).keeping(counts), &vertex.frame)
    }

    #[inline(always)]
    pub(super) fn vertex(&self, point: SurfacePoint, lookup: &Lookup) -> Vertex<'a, N> {
        let material_table = self.tracer.material_table;
        let material = if E::SURFACES && material_table.is_mix(point.material) {
            material_table.resolve(point.material, lookup, self.asked.stream.one(Draw::Mix, self.met))
        } else {
            point.material
        };
        let frame = self.frame(material, &point, lookup, self.ray.direction);
        let bsdf = if E::SURFACES {
            material_table.widened_bsdf(material, lookup, (frame.front, self.least_alpha(&frame)), self.wavelengths)
        } else {
            material_table.matt_bsdf(material, self.wavelengths)
        };
        Vertex { guide: self.guide(&bsdf, &point, &frame), bsdf, point, frame, material }
    }

    /// The shading frame of a material at a point that a ray of unit `direction` has met.
    #[inline(always)]
    pub(super) fn frame(
        &self,
        material: MaterialId,
        point: &SurfacePoint,
        lookup: &Lookup,
        direction: Vec3,
    ) -> ShadingFrame {
        let material_table = self.tracer.material_table;
        let normal = if E::SURFACES && material_table.needs_tangents(material) {
            material_table.shading_normal(material, lookup, point, self.tracer.view.tangents(point))
        } else {
            point.shading_normal
        };
        ShadingFrame::new(point, normal, -direction)
    }

    /// Value and density of light that arrives at a surface from `wi`.
    #[inline(always)]
    pub(super) fn evaluate(&self, vertex: &Vertex<'_, N>, wi: Vec3) -> BsdfValue<N> {
        match &vertex.bsdf {
            Bsdf::Diffuse(bsdf) if !E::SURFACES => bsdf.evaluate_above(wi),
            bsdf => bsdf.evaluate(vertex.frame.wo, wi),
        }
    }

    /// Whether light of a lamp counts, given whether it is part of a caustic: matt surfaces alone make none.
    pub(super) fn follows(&self, is_caustic: bool) -> bool {
        !E::SURFACES || self.tracer.settings.caustics || !is_caustic
    }

    /// Unit direction of the ray.
    pub(super) fn direction(&self) -> Vec3 {
        self.ray.direction
    }

    /// The time at which the path looks at the scene.
    pub(super) fn time_s(&self) -> f32 {
        self.ray.time_s
    }

    /// The time over which lights are averaged.
    pub(super) fn lit(&self) -> &'a TimeInterval {
        &self.asked.lit
    }

    /// Draws where the path goes; `None` where the light would be absorbed.
    #[inline(always)]
    fn sample(&self, vertex: &Vertex<'_, N>) -> Option<BsdfSample<N>> {
        let choice = if E::SURFACES && vertex.bsdf.has_parts() {
            self.asked.stream.one(Draw::BsdfChoice, self.met)
        } else {
            0.0
        };
        let u = self.asked.stream.two(Draw::BsdfDirection, self.met);
        match &vertex.bsdf {
            Bsdf::Diffuse(bsdf) if vertex.guide.is_some() => vertex.guided_sample(bsdf, u),
            Bsdf::Diffuse(bsdf) if !E::SURFACES => bsdf.sample_above(u),
            bsdf => bsdf.sample(vertex.frame.wo, choice, u),
        }
    }

    /// What light crosses that arrives at a surface from `wi`.
    pub(super) fn medium_towards(&self, vertex: &Vertex<'a, N>, wi: Vec3) -> Medium<'a> {
        if E::SURFACES && wi.z < 0.0 {
            let table = self.tracer.material_table;
            Medium::beyond(
                vertex.frame.front,
                table.solid(vertex.material).is_some(),
                table.absorption(vertex.material),
            )
        } else {
            self.medium
        }
    }

    /// Straight through a surface that takes its share.
    fn go_through(&mut self, vertex: &Vertex<'_, N>, sample: &BsdfSample<N>) -> PathStep {
        self.throughput *= sample.weight;
        self.pass(&vertex.point);
        self.unless_dark()
    }

    /// On in a new direction.
    fn go_on(&mut self, vertex: &Vertex<'a, N>, sample: &BsdfSample<N>, receiver: &LightSampleContext) -> PathStep {
        let kept = vertex.frame.outward(sample.wi);
        let Some(direction) = kept.or_else(|| Self::along_surface(vertex, sample)) else { return PathStep::Ends };
        self.throughput *= sample.weight;
        // What counts as a caustic, and how wide textures are read, goes by the surface, not by how its directions are drawn. No light is drawn along a
        // surface.
        let has_density = kept.is_some() && (!E::SURFACES || sample.event == Event::Scatter);
        let bsdf_density = has_density.then_some(sample.pdf);
        self.history.scatter(bsdf_density);
        if let Some(pdf) = bsdf_density {
            self.cone.scatter(pdf);
        }
        let relative = vertex.relative_density(sample.wi);
        self.scattered = bsdf_density.map(|pdf| pdf * relative * receiver.draws as f32);
        self.carried.scale(relative);
        self.receiver = self.scattered.map(|_| *receiver);
        self.medium = self.medium_towards(vertex, sample.wi);
        self.leave(Ray { time_s: self.ray.time_s, ..vertex.point.leave(direction) })
    }

    /// Where the shading normal sends light to the wrong side of the true surface: along it for mirrors and glass, which absorb nothing there; `None`
    /// for all others.
    #[inline(always)]
    fn along_surface(vertex: &Vertex<'a, N>, sample: &BsdfSample<N>) -> Option<Vec3> {
        let keeps_light =
            E::SURFACES && (sample.event == Event::Specular || matches!(vertex.bsdf, Bsdf::Dielectric(_)));
        keeps_light.then(|| vertex.frame.outward_to_horizon(sample.wi))
    }

    /// On from where the path was scattered.
    #[inline(always)]
    pub(super) fn leave(&mut self, ray: Ray) -> PathStep {
        self.ray = ray;
        self.travelled_m = 0.0;
        self.bounces += 1;
        if self.tracer.settings.level == Level::Flat {
            self.gather_distant();
            return PathStep::Ends;
        }
        match self.unless_dark() {
            PathStep::Goes if self.survives() => PathStep::Goes,
            _ => PathStep::Ends,
        }
    }
}
