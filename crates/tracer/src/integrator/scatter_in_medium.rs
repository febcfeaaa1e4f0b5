//! Scattering between surfaces.

use etendue_core::random::Draw;
use etendue_core::{Ray, Spectral};
use glam::Vec3;

use super::effects::Effects;
use super::path::{Intersection, Path, PathStep};
use crate::lights::LightSampleContext;
use crate::media::{Following, Media, Phase};

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// How media are followed by a path, given whether it has been scattered by more than smooth surfaces.
    pub(super) fn following(&self, matt: bool) -> Following {
        if matt && !self.tracer.settings.caustics { Following::WithoutPeak } else { Following::Exact }
    }

    /// Whether what the ray meets does not count, as no medium has scattered it yet.
    #[inline(always)]
    pub(super) fn sees_only_air(&self) -> bool {
        E::MEDIA && self.tracer.settings.only_airlight && self.bounces == 0
    }

    /// Whether lamps without an opening are asked along the ray, rather than where the path is scattered: as far as the camera sees it straight
    /// or in mirrors. Behind that a ray is one of so many that its own light matters less than its price.
    fn asks_along(&self) -> bool {
        self.tracer.lights.has_points() && !self.history.is_matt() && !self.is_spent()
    }

    /// Gathers the light of lamps that is scattered on the way to `end`, and finds where the path is scattered itself; `None` where it is not.
    pub(super) fn travel_through_media(&mut self, end: f32) -> Option<Intersection<'a>> {
        let media = self.media_along().filter(|_| !self.medium.is_solid())?;
        let following = self.following(self.history.is_matt());
        if self.asks_along() {
            self.gather_from_lamps(media, end);
        }
        let stream = (&self.asked.stream, &mut self.flights);
        let collision =
            media.collide((&self.ray, following), f64::from(end), stream, self.wavelengths, &mut self.throughput)?;
        self.cone.travel(collision.t);
        self.travelled_m += collision.t;
        Some(Intersection::Medium(self.ray.at(collision.t), collision.phase))
    }

    /// Light of one lamp without an opening that is scattered once on the way to `end`.
    fn gather_from_lamps(&mut self, media: &Media<'_>, end: f32) {
        let Some((from, to)) = media.reach(&self.ray, f64::from(end)) else { return };
        let (part, lights) = ([from as f32, to as f32], self.tracer.lights);
        let stream = &self.asked.stream;
        let u = stream.two(Draw::InScattering, self.met);
        let seen = |t: f32, to: Vec3| media.about(&self.ray, f64::from(t), to, self.wavelengths);
        let Some(lamp) = lights.lamp_along(&self.ray, part, u.x, seen) else { return };
        let t = lamp.place(u.y);
        let density = lamp.density(t);
        if !(t > part[0] && t < part[1] && density > 0.0 && density.is_finite()) {
            return;
        }
        let position = self.ray.at(t);
        let receiver = LightSampleContext::in_medium(position, self.ray.time_s);
        let Some(light) = lights.of_lamp(&lamp, &receiver, (self.wavelengths, self.lit())) else { return };
        let mut way = self.ray;
        way.t_max = t;
        let seen = media.transmittance((&way, Following::Exact), (stream, 2 * self.met + 1), self.wavelengths);
        let scattered =
            media.scattering((&self.ray, Following::Exact), f64::from(t), light.direction, self.wavelengths);
        let arriving = self.throughput * seen * scattered * light.radiance / (density * lamp.probability);
        let ray = self.towards(position, light.direction, light.target);
        if !arriving.is_zero()
            && let Some(share) = self.share_along(ray, &light, (self.medium, self.following(true)))
        {
            self.radiance += arriving * share;
        }
    }

    /// Gathers drawn light at a place between surfaces and goes on from it.
    pub(super) fn scatter_in_medium(&mut self, position: Vec3, phase: &Phase) -> PathStep {
        self.scatter_by_phase(position, phase, self.asks_along())
    }

    /// The same; `asked_along` as of [`Path::sample_direct_in_medium`].
    pub(super) fn scatter_by_phase(&mut self, position: Vec3, phase: &Phase, asked_along: bool) -> PathStep {
        let from = self.ray.direction;
        let receiver = LightSampleContext::in_medium(position, self.ray.time_s);
        self.sample_direct_in_medium(&receiver, phase, asked_along);
        let stream = &self.asked.stream;
        let (choice, u) =
            (stream.one(Draw::PhaseDirection, 2 * self.met), stream.two(Draw::PhaseDirection, 2 * self.met + 1));
        let direction = phase.sample(from, choice, u, self.wavelengths);
        let density = phase.density(from, direction, self.wavelengths);
        if density <= 0.0 {
            return PathStep::Ends;
        }
        self.throughput *= Spectral(phase.values(from, direction, self.wavelengths)) / density;
        self.scattered = Some(density);
        self.receiver = Some(receiver);
        // However narrow its forward peak, fog is no mirror.
        self.history.scatter(Some(0.0));
        self.cone.scatter(density);
        self.leave(Ray::new(position, direction, self.ray.time_s))
    }

    /// Next-event estimation at a place between surfaces; lamps that nothing but a draw can find are left out where they were asked along the ray.
    pub(super) fn sample_direct_in_medium(&mut self, receiver: &LightSampleContext, phase: &Phase, asked_along: bool) {
        let lights = self.tracer.lights;
        if !lights.can_be_drawn() {
            return;
        }
        let stream = &self.asked.stream;
        let choice = if lights.are_many() { stream.one(Draw::LightChoice, self.met) } else { 0.0 };
        let u = stream.two(Draw::LightPoint, self.met);
        let asked = (self.wavelengths, self.lit());
        let Some(light) = lights.sample(receiver, (choice, u), self.cone.spread_rad, self.tracer.material_table, asked)
        else {
            return;
        };
        if light.delta && asked_along {
            return;
        }
        let density = phase.density(self.ray.direction, light.direction, self.wavelengths);
        let values = Spectral(phase.values(self.ray.direction, light.direction, self.wavelengths));
        let arriving = self.throughput * values * light.radiance * self.drawn_weight(&light, density);
        let ray = self.towards(receiver.position, light.direction, light.target);
        if !arriving.is_zero()
            && let Some(share) = self.share_along(ray, &light, (self.medium, self.following(true)))
        {
            self.radiance += arriving * share;
        }
    }
}
