//! Scattering between surfaces: by participating media, and by the drops and flakes that camera rays hit.
//!
//! A pixel sees a small part of a drop or flake, anywhere on it. Averaged over these parts, the phase function gives the distribution of scattered
//! directions. A camera ray therefore continues in the direction in which the drop refracts it at the hit point. Lights are sampled as by the phase
//! function, and weighted against that ray. For a particle that a pixel does not resolve the mean is right. In a particle that fills pixels, glints
//! of lamps and of the sun are spread over its disc.

use etendue_core::{Integrator, Ray, Spectral, random::Draw};
use glam::Vec3;

use super::path::{Intersection, Path, PathStep};
use super::path_tracer::Effects;
use crate::lights::{LightSampleContext, RaySegment};
use crate::media::{FlightRandom, ForwardPeak, Media, MediaRay, Phase, RandomCounter, RaySpan};
use crate::precipitation::{NearParticles, ParticleHit};

/// Random numbers of a drop.
const NUMBERS_PER_DROP: u32 = 16;

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// Moves the ray through media and precipitation to `end`, or to the point where it is scattered; `None` if it reaches the end.
    pub(super) fn intersect_media(&mut self, end: f32) -> Option<Intersection<'a>> {
        let particle = match self.particles_along() {
            Some(near) if !self.medium.is_solid() => near.closest(&self.ray, end),
            _ => None,
        };
        if let Some(collision) = self.travel_through_media(particle.map_or(end, |hit| hit.t)) {
            return Some(collision);
        }
        let hit = particle?;
        self.cone.travel(hit.t);
        self.travelled_m += hit.t;
        Some(Intersection::Particle(hit))
    }

    /// The media along the ray. Near the camera, particles replace part of them.
    fn media_along(&self) -> Option<&'a Media<'a>> {
        self.particles_along().map(NearParticles::media).or(self.tracer.media)
    }

    /// The drops and flakes along the ray; only near the camera.
    fn particles_along(&self) -> Option<&'a NearParticles<'a>> {
        let is_camera_ray = self.bounces == 0 && !self.has_hit_particle;
        self.tracer.near.filter(|near| is_camera_ray && near.looks_along(self.ray.direction))
    }

    /// Treatment of forward peaks for a path; `has_diffuse` is true if more than smooth surfaces have scattered it.
    pub(super) fn forward_peak(&self, has_diffuse: bool) -> ForwardPeak {
        if has_diffuse && !self.tracer.settings.caustics { ForwardPeak::Unscattered } else { ForwardPeak::Exact }
    }

    /// True if light of surfaces does not count because no medium has scattered the path yet.
    #[inline(always)]
    pub(super) fn sees_only_air(&self) -> bool {
        E::MEDIA && self.tracer.settings.only_airlight && self.bounces == 0
    }

    /// True if lamps without an opening are sampled along the ray, and not where the path is scattered. This holds for rays that the camera
    /// sees straight or in mirrors. Later rays are many, and the light of each matters less than its cost.
    fn samples_lamps_along(&self) -> bool {
        self.tracer.lights.has_points() && !self.history.has_diffuse() && !self.is_at_max_bounces()
    }

    /// Adds the light of lamps that is scattered on the way to `end`, and samples where the path itself is scattered; `None` if it is not.
    fn travel_through_media(&mut self, end: f32) -> Option<Intersection<'a>> {
        if self.medium.is_solid() {
            return None;
        }
        let media = self.media_along()?;
        let peak = self.forward_peak(self.history.has_diffuse());
        if self.samples_lamps_along() {
            self.add_in_scattered_lamp(media, end);
        }
        let media_ray = MediaRay { ray: &self.ray, peak };
        let random = FlightRandom { stream: &self.camera_ray.stream, counter: &mut self.flight_draws };
        let collision = media.collide(media_ray, f64::from(end), random, self.wavelengths, &mut self.throughput)?;
        self.cone.travel(collision.t);
        self.travelled_m += collision.t;
        Some(Intersection::Medium(self.ray.at(collision.t), collision.phase))
    }

    /// Adds the light of one lamp without an opening that is scattered once on the way to `end`.
    fn add_in_scattered_lamp(&mut self, media: &Media<'_>, end: f32) {
        let Some(RaySpan { from, to }) = media.reach(&self.ray, f64::from(end)) else { return };
        let (segment, lights) = (RaySegment { from: from as f32, to: to as f32 }, self.tracer.lights);
        let stream = &self.camera_ray.stream;
        let u = stream.two(Draw::InScattering, self.vertex_index);
        let visible = |t: f32, to: Vec3| media.about(&self.ray, f64::from(t), to, self.wavelengths);
        let Some(lamp) = lights.lamp_along(&self.ray, segment, u.x, visible) else { return };
        let t = lamp.place(u.y);
        let density = lamp.density(t);
        if !(t > segment.from && t < segment.to && density > 0.0 && density.is_finite()) {
            return;
        }
        let position = self.ray.at(t);
        let receiver = LightSampleContext::in_medium(position, self.ray.time_s);
        let Some(light) = lights.sampled_lamp_light(&lamp, &receiver, self.emission_query()) else { return };
        let mut to_camera = self.ray;
        to_camera.t_max = t;
        let random = RandomCounter { stream, counter: 2 * self.vertex_index + 1 };
        let exact = |ray| MediaRay { ray, peak: ForwardPeak::Exact };
        let transmittance = media.transmittance(exact(&to_camera), random, self.wavelengths);
        let scattering = media.scattering(exact(&self.ray), f64::from(t), light.direction, self.wavelengths);
        let arriving = self.throughput * transmittance * scattering * light.radiance / (density * lamp.probability);
        let ray = self.ray_towards(position, light.direction, light.target);
        if !arriving.is_zero()
            && let Some(visibility) = self.visibility_along(ray, &light, self.medium, self.forward_peak(true))
        {
            self.radiance += arriving * visibility;
        }
    }

    /// Adds direct light at a point between surfaces and continues from it.
    pub(super) fn scatter_in_medium(&mut self, position: Vec3, phase: &Phase) -> PathStep {
        self.scatter_by_phase(position, phase, self.samples_lamps_along())
    }

    /// As `scatter_in_medium`, with `lamps_were_sampled` as in [`Path::sample_direct_light_in_medium`].
    fn scatter_by_phase(&mut self, position: Vec3, phase: &Phase, lamps_were_sampled: bool) -> PathStep {
        let from = self.ray.direction;
        let receiver = LightSampleContext::in_medium(position, self.ray.time_s);
        self.sample_direct_light_in_medium(&receiver, phase, lamps_were_sampled);
        let stream = &self.camera_ray.stream;
        let choice = stream.one(Draw::PhaseDirection, 2 * self.vertex_index);
        let u = stream.two(Draw::PhaseDirection, 2 * self.vertex_index + 1);
        let direction = phase.sample(from, choice, u, self.wavelengths);
        let density = phase.density(from, direction, self.wavelengths);
        if density <= 0.0 {
            return PathStep::End;
        }
        self.throughput *= Spectral(phase.values(from, direction, self.wavelengths)) / density;
        self.direction_pdf = Some(density);
        self.receiver = Some(receiver);
        // However narrow its forward peak, fog is no mirror.
        self.history.scatter(Some(0.0));
        self.cone.scatter(density);
        self.continue_along(Ray::new(position, direction, self.ray.time_s))
    }

    /// Direct light at a point between surfaces. Lamps that only sampling can find are left out if they were sampled along the ray.
    fn sample_direct_light_in_medium(
        &mut self,
        receiver: &LightSampleContext,
        phase: &Phase,
        lamps_were_sampled: bool,
    ) {
        let lights = self.tracer.lights;
        if !lights.can_sample() {
            return;
        }
        let stream = &self.camera_ray.stream;
        let choice = if lights.are_many() { stream.one(Draw::LightChoice, self.vertex_index) } else { 0.0 };
        let u = stream.two(Draw::LightPoint, self.vertex_index);
        let (spread_rad, table) = (self.cone.spread_rad, self.tracer.material_table);
        let Some(light) = lights.sample(receiver, choice, u, spread_rad, table, self.emission_query()) else {
            return;
        };
        if light.delta && lamps_were_sampled {
            return;
        }
        let density = phase.density(self.ray.direction, light.direction, self.wavelengths);
        let values = Spectral(phase.values(self.ray.direction, light.direction, self.wavelengths));
        let arriving = self.throughput * values * light.radiance * self.light_weight(&light, density);
        let ray = self.ray_towards(receiver.position, light.direction, light.target);
        if !arriving.is_zero()
            && let Some(visibility) = self.visibility_along(ray, &light, self.medium, self.forward_peak(true))
        {
            self.radiance += arriving * visibility;
        }
    }

    /// Continues from a drop or flake.
    pub(super) fn scatter_at_particle(&mut self, hit: &ParticleHit) -> PathStep {
        let Some(near) = self.tracer.near else { return PathStep::End };
        let stream = &self.camera_ray.stream;
        let chosen = stream.one(Draw::PhaseDirection, 2 * self.vertex_index) * N as f32;
        let wavelength_nm = self.wavelengths.nm[(chosen as usize).min(N - 1)];
        let uniform = |k: u32| f64::from(stream.one(Draw::DropInterface, NUMBERS_PER_DROP * self.vertex_index + k));
        match near.refracted(&self.ray, hit, wavelength_nm, uniform) {
            None if self.is_at_max_bounces() => PathStep::End,
            None => self.scatter_at_flake(self.ray.at(hit.t), near.phase()),
            Some((position, direction)) => self.scatter_at_drop(near.phase(), position, direction),
        }
    }

    fn scatter_at_flake(&mut self, position: Vec3, phase: &Phase) -> PathStep {
        self.has_hit_particle = true;
        // The lamps sampled along the ray were those of the medium in front of the flake.
        self.scatter_by_phase(position, phase, false)
    }

    /// Continues from the point where a drop refracts the ray. A drop is no scattering event: a path of a single event still sees what is
    /// behind it.
    fn scatter_at_drop(&mut self, phase: &Phase, position: Vec3, direction: Vec3) -> PathStep {
        let from = self.ray.direction;
        let density = phase.density(from, direction, self.wavelengths);
        if density <= 0.0 {
            return PathStep::End;
        }
        let values = Spectral(phase.values(from, direction, self.wavelengths));
        self.direction_pdf = None;
        if self.tracer.settings.integrator != Integrator::Flat && !self.is_at_max_bounces() {
            let receiver = LightSampleContext::in_medium(position, self.ray.time_s);
            self.has_hit_particle = true;
            self.sample_direct_light_in_medium(&receiver, phase, false);
            self.direction_pdf = Some(density);
            self.receiver = Some(receiver);
        }
        self.has_hit_particle = true;
        self.throughput *= values / density;
        self.ray = Ray::new(position, direction, self.ray.time_s);
        self.travelled_m = 0.0;
        self.history.scatter(Some(0.0));
        self.cone.scatter(density);
        self.end_if_dark()
    }
}
