//! Light that a path meets by chance: of surfaces that glow, of the openings of lamps, and from beyond the scene.

use super::effects::Effects;
use super::path::Path;
use crate::geometry::SurfacePoint;
use crate::lights::LightHit;
use crate::textures::Lookup;
use etendue_core::Spectral;

impl<const N: usize, E: Effects> Path<'_, N, E> {
    /// Light from beyond the scene, along the ray.
    pub(super) fn gather_distant(&mut self) {
        let strategies = self.tracer.settings.strategies;
        for light in self.tracer.lights.distant(self.ray.direction, self.receiver.as_ref(), self.wavelengths) {
            if (light.surrounds || self.follows(self.history.is_caustic())) && !self.sees_only_air() {
                self.radiance += self.throughput * light.radiance * strategies.met(self.scattered, light.pdf);
            }
        }
    }

    /// Light that the surface met emits against the ray.
    pub(super) fn add_emission(&mut self, point: &SurfacePoint, lookup: &Lookup) {
        let Some(emitted) = self.emitted(point, lookup) else { return };
        if !self.follows(self.history.is_caustic()) {
            return;
        }
        let (direction, distance_m) = (self.ray.direction, self.travelled_m);
        let met = |receiver| LightHit { receiver, point, direction, distance_m };
        let drawn = self.receiver.as_ref().map_or(0.0, |receiver| self.tracer.lights.light_pdf(&met(receiver)));
        let weight = self.tracer.settings.strategies.met(self.scattered, drawn);
        self.radiance += self.throughput * emitted * weight;
    }

    /// Radiance of a surface against the ray: by its material, or as the opening of a lamp; `None` where its side does not shine.
    #[inline(always)]
    fn emitted(&self, point: &SurfacePoint, lookup: &Lookup) -> Option<Spectral<N>> {
        let material_table = self.tracer.material_table;
        match material_table.emission(point.material) {
            None => self.tracer.lights.of_opening(point, self.ray.direction, (self.wavelengths, self.lit())),
            Some(emission) => emission
                .leaves(point.geometric_normal, -self.ray.direction)
                .then(|| material_table.radiance(point.material, emission, lookup, (self.wavelengths, self.lit()))),
        }
    }
}
