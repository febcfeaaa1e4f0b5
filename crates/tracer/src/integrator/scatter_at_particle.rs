//! Rays from the camera that meet drops and flakes.
//!
//! What a pixel sees of a particle is a small part of it at some place: over these the direction in which light is scattered is spread by the
//! phase function. A ray is therefore sent on as the drop bends it where it is met, and lights are drawn for it, and weighed against that ray, as
//! by the phase function. For a particle that a pixel does not resolve this is right in the mean; in one that fills pixels, glints of
//! lamps and of the sun are spread over its disc.

use etendue_core::Spectral;
use etendue_core::random::Draw;
use glam::Vec3;

use super::Level;
use super::effects::Effects;
use super::path::{Intersection, Path, PathStep};
use crate::lights::LightSampleContext;
use crate::media::{Media, Phase};
use crate::precipitation::{Near, NearHit};

/// Random numbers of a drop.
const NUMBERS: u32 = 16;

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// Follows the ray through media and precipitation to `end`; `None` where it gets there.
    pub(super) fn travel_to(&mut self, end: f32) -> Option<Intersection<'a>> {
        let hit =
            self.near_of_camera().filter(|_| !self.medium.is_solid()).and_then(|near| near.closest(&self.ray, end));
        if let Some(met) = self.travel_through_media(hit.map_or(end, |hit| hit.t)) {
            return Some(met);
        }
        let hit = hit?;
        self.cone.travel(hit.t);
        self.travelled_m += hit.t;
        Some(Intersection::Particle(hit))
    }

    /// The media that the ray finds: about the camera, particles stand for a part of them.
    pub(super) fn media_along(&self) -> Option<&'a Media<'a>> {
        self.near_of_camera().map(Near::media).or(self.tracer.media)
    }

    fn near_of_camera(&self) -> Option<&'a Near<'a>> {
        let of_camera = self.bounces == 0 && !self.beyond_particle;
        self.tracer.near.filter(|near| of_camera && near.looks_along(self.ray.direction))
    }

    /// On from a drop or flake.
    pub(super) fn scatter_at_particle(&mut self, hit: &NearHit) -> PathStep {
        let Some(near) = self.tracer.near else { return PathStep::Ends };
        let stream = &self.asked.stream;
        let chosen = stream.one(Draw::PhaseDirection, 2 * self.met) * N as f32;
        let wavelength_nm = self.wavelengths.nm[(chosen as usize).min(N - 1)];
        let drawn = |k: u32| f64::from(stream.one(Draw::DropInterface, NUMBERS * self.met + k));
        match near.refracted(&self.ray, hit, wavelength_nm, drawn) {
            None if self.is_spent() => PathStep::Ends,
            None => self.scatter_at_flake(self.ray.at(hit.t), near.phase()),
            Some((position, direction)) => self.scatter_at_drop(near.phase(), (position, direction)),
        }
    }

    fn scatter_at_flake(&mut self, position: Vec3, phase: &Phase) -> PathStep {
        self.beyond_particle = true;
        // Lamps that were asked along the ray were asked for the medium before the flake.
        self.scatter_by_phase(position, phase, false)
    }

    /// A drop is no scattering event: who follows one event only still sees what is behind it.
    fn scatter_at_drop(&mut self, phase: &Phase, (position, direction): (Vec3, Vec3)) -> PathStep {
        let from = self.ray.direction;
        let density = phase.density(from, direction, self.wavelengths);
        if density <= 0.0 {
            return PathStep::Ends;
        }
        let values = Spectral(phase.values(from, direction, self.wavelengths));
        self.scattered = None;
        if self.tracer.settings.level != Level::Flat && !self.is_spent() {
            let receiver = LightSampleContext::in_medium(position, self.ray.time_s);
            self.beyond_particle = true;
            self.sample_direct_in_medium(&receiver, phase, false);
            self.scattered = Some(density);
            self.receiver = Some(receiver);
        }
        self.beyond_particle = true;
        self.throughput *= values / density;
        self.ray = etendue_core::Ray::new(position, direction, self.ray.time_s);
        self.travelled_m = 0.0;
        self.history.scatter(Some(0.0));
        self.cone.scatter(density);
        self.unless_dark()
    }
}
