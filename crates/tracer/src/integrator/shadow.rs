//! What comes through between a surface and a light.

use etendue_core::{Ray, Spectral};
use glam::Vec3;

use super::Level;
use super::effects::Effects;
use super::medium::Medium;
use super::path::{MAX_MET, Path, Vertex};
use crate::geometry::SurfacePoint;
use crate::lights::LightSample;
use crate::media::Following;

impl<const N: usize, E: Effects> Path<'_, N, E> {
    /// The share of a drawn light that reaches the vertex through a `medium`; `None` where something opaque stands
    /// between.
    pub(super) fn share(
        &self,
        vertex: &Vertex<'_, N>,
        light: &LightSample<N>,
        (medium, following): (Medium<'_>, Following),
    ) -> Option<Spectral<N>> {
        let ray = self.ray_from_surface(&vertex.point, light);
        let share = self.share_along(ray, light, (medium, following))?;
        // As for a path that meets nothing, the way to infinity takes nothing.
        let way_m = light.target.map_or(0.0, |target| target.distance(vertex.point.position));
        Some(if E::SURFACES { medium.attenuate(share, way_m, self.wavelengths) } else { share })
    }

    /// The share of a drawn light that comes through along a ray towards it, but for what a solid absorbs in which the ray begins.
    pub(super) fn share_along(
        &self,
        ray: Ray,
        light: &LightSample<N>,
        (medium, following): (Medium<'_>, Following),
    ) -> Option<Spectral<N>> {
        let share = if self.tracer.settings.level == Level::Flat {
            Spectral::ONE
        } else if E::SURFACES && self.tracer.material_table.has_passages() {
            self.share_through(ray, light)?
        } else if self.tracer.view.occluded(&ray) {
            return None;
        } else {
            Spectral::ONE
        };
        match self.tracer.media {
            Some(media) if E::MEDIA && !medium.is_solid() => Some(
                share * media.transmittance((&ray, following), (&self.asked.stream, 2 * self.met), self.wavelengths),
            ),
            _ => Some(share),
        }
    }

    /// The ray from a point of a surface to the light's, or to infinity.
    fn ray_from_surface(&self, point: &SurfacePoint, light: &LightSample<N>) -> Ray {
        let origin = point.spawn(light.direction);
        self.towards(origin, light.direction, light.target).leaving(point.primitive_id())
    }

    /// The ray from a point off all surfaces to `target`, or to infinity.
    pub(super) fn towards(&self, origin: Vec3, direction: Vec3, target: Option<Vec3>) -> Ray {
        let mut ray = Ray::new(origin, direction, self.time_s());
        if let Some(target) = target {
            ray.direction = target - origin;
            ray.t_max = 1.0;
        }
        ray
    }

    /// As [`Path::share`], surface by surface: cut-outs and thin panes let light pass straight.
    fn share_through(&self, mut ray: Ray, light: &LightSample<N>) -> Option<Spectral<N>> {
        let material_table = self.tracer.material_table;
        let mut share = Spectral::ONE;
        let mut cone = self.cone;
        for _ in 0..MAX_MET {
            let Some(hit) = self.tracer.view.closest(&ray) else { return Some(share) };
            let point = self.tracer.view.surface(&ray, &hit);
            if !material_table.lets_pass(point.material) {
                return None;
            }
            cone.travel(hit.t * ray.direction.length());
            let lookup = self.lookup(&point, cone, light.direction);
            let cos = |part| self.frame(part, &point, &lookup, light.direction).wo.z;
            share *= material_table.passage(point.material, &lookup, &cos, self.wavelengths)?;
            if share.is_zero() {
                return None;
            }
            ray = self.ray_from_surface(&point, light);
            if ray.direction.dot(light.direction) <= 0.0 {
                return Some(share);
            }
        }
        None
    }
}
