//! Next-event estimation: light of drawn lights at a surface.

use etendue_core::Spectral;
use etendue_core::random::Draw;

use super::Level;
use super::effects::Effects;
use super::path::{Path, Vertex};
use crate::lights::{LightSample, LightSampleContext};

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// Light of as many drawn lights as the receiver draws, as far as it comes through.
    #[inline(always)]
    pub(super) fn sample_direct(&mut self, vertex: &Vertex<'a, N>, receiver: &LightSampleContext) {
        let lights = self.tracer.lights;
        if !lights.can_be_drawn() || (E::SURFACES && vertex.bsdf.is_delta()) {
            return;
        }
        let drawing = lights.drawing(receiver);
        for k in 0..receiver.draws {
            let stream = self.asked.stream.branch(k, receiver.draws);
            let choice = if lights.are_many() { stream.one(Draw::LightChoice, self.met) } else { 0.0 };
            let u = stream.two(Draw::LightPoint, self.met);
            let asked = (self.wavelengths, self.lit());
            let drawn = drawing.sample((choice, u), self.cone.spread_rad, self.tracer.material_table, asked);
            if let Some(light) = drawn.and_then(|light| self.drawn(vertex, &light, receiver)) {
                self.radiance += light;
            }
        }
    }

    /// What a drawn light counts at the camera by way of a surface; `None` where nothing.
    #[inline(always)]
    fn drawn(
        &self,
        vertex: &Vertex<'a, N>,
        light: &LightSample<N>,
        receiver: &LightSampleContext,
    ) -> Option<Spectral<N>> {
        let wi = vertex.frame.inward(light.direction)?;
        let value = self.evaluate(vertex, wi);
        if !(light.surrounds || self.follows(self.history.would_be_caustic(value.pdf))) {
            return None;
        }
        let scattered = vertex.density(wi, value.pdf) * receiver.draws as f32;
        let arriving = self.throughput * value.value_cos * light.radiance * self.drawn_weight(light, scattered);
        let following = self.following(self.history.would_be_matt(value.pdf));
        if arriving.is_zero() {
            return None;
        }
        let share = self.share(vertex, light, (self.medium_towards(vertex, wi), following))?;
        Some(arriving * share)
    }

    /// What drawn light counts beside the other way of finding it, over its density. A lamp without an opening is found in no
    /// other way, and nor are surfaces where no ray is sent out to meet them.
    pub(super) fn drawn_weight(&self, light: &LightSample<N>, scattered: f32) -> f32 {
        let settings = &self.tracer.settings;
        let only = light.delta || (settings.level == Level::Flat && light.target.is_some());
        if only { 1.0 / light.pdf } else { settings.strategies.drawn(light.pdf, scattered) / light.pdf }
    }
}
