//! A lamp with its opening, in the render frame.

use etendue_core::Spectral;
use glam::{DAffine3, Vec2, Vec3};

use super::opening::{FacetSample, Opening, OpeningFacets};
use super::{
    LightHit, LightSample, LightSampleContext, ROUNDING, lamp::LampLight, light_sample::LampIrradiance,
    sphere::SphereLight, tree::LightBounds,
};
use crate::geometry::{Mesh, SurfacePoint};
use crate::materials::EmissionQuery;

/// A lamp that emits from a surface.
#[derive(Clone, Debug)]
pub(super) struct OpeningLight {
    lamp: LampLight,
    opening: Opening,
    surface: OpeningSurface,
    /// Radius of a sphere about the lamp's position that holds the opening, m.
    reach_m: f32,
    /// Additional distance of its points from where the accelerator sees them, m.
    room_m: f32,
}

#[derive(Clone, Debug)]
enum OpeningSurface {
    Sphere(Box<SphereLight>),
    Facets(OpeningFacets),
}

impl OpeningLight {
    /// The light of a lamp whose opening is this `mesh`, placed by `to_render`; `None` if rounding leaves it no area.
    pub(super) fn from_mesh(
        lamp: LampLight,
        opening: Opening,
        mesh: &Mesh,
        to_render: &DAffine3,
        material: crate::MaterialId,
    ) -> Option<Self> {
        let facets = OpeningFacets::new(&opening, mesh, to_render, material)?;
        (facets.triangles() == mesh.triangles().len()).then(|| Self::new(lamp, opening, OpeningSurface::Facets(facets)))
    }

    /// The light of a lamp whose opening is a sphere or an ellipsoid.
    pub(super) fn from_sphere(lamp: LampLight, opening: Opening, sphere: SphereLight) -> Self {
        Self::new(lamp, opening, OpeningSurface::Sphere(Box::new(sphere)))
    }

    fn new(lamp: LampLight, opening: Opening, surface: OpeningSurface) -> Self {
        // Margin for rounding.
        Self { reach_m: opening.reach_m() as f32 * (1.0 + 1e-5), lamp, opening, surface, room_m: 0.0 }
    }

    /// The same light with points that are moved and rounded again, within `farthest_m` of the origin.
    pub(super) fn moved_within(self, farthest_m: f32) -> Self {
        Self { room_m: ROUNDING * farthest_m, ..self }
    }

    /// Number of primitives of its surface.
    pub(super) fn primitives(&self) -> usize {
        match &self.surface {
            OpeningSurface::Sphere(_) => 1,
            OpeningSurface::Facets(facets) => facets.triangles(),
        }
    }

    /// Bounds for light selection.
    pub(super) fn bounds(&self) -> LightBounds {
        let lamp = self.lamp.bounds();
        LightBounds { low: lamp.low - self.reach_m, high: lamp.high + self.reach_m, radius: self.reach_m, ..lamp }
    }

    /// Mean irradiance at a receiver as if the lamp had no extent, except for receivers close by.
    pub(super) fn irradiance(&self, receiver: &LightSampleContext) -> LampIrradiance {
        self.lamp.irradiance_of_extent(receiver, self.reach_m)
    }

    /// Spectral radiance along the unit `direction`, W·m⁻²·sr⁻¹·nm⁻¹, on an emitting side.
    fn radiance<const N: usize>(&self, direction: Vec3, query: EmissionQuery<'_, N>) -> Spectral<N> {
        let own = self.lamp.to_lamp(direction);
        self.lamp.intensity_along(own, query) / self.opening.projected_area_m2(own)
    }

    /// True if the side on which `direction` leaves emits.
    fn emits_towards(&self, normal: Vec3, direction: Vec3) -> bool {
        self.opening.flat_axis().is_some() || normal.dot(direction) > 0.0
    }

    /// Radiance against a ray of unit `direction` at a point of the opening; `None` if its side does not emit.
    pub(super) fn emitted<const N: usize>(
        &self,
        point: &SurfacePoint,
        direction: Vec3,
        query: EmissionQuery<'_, N>,
    ) -> Option<Spectral<N>> {
        self.emits_towards(point.geometric_normal, -direction).then(|| self.radiance(-direction, query))
    }

    pub(super) fn sample<const N: usize>(
        &self,
        from: Vec3,
        u: Vec2,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        let FacetSample { surface, error_m, early_m } = match &self.surface {
            OpeningSurface::Facets(facets) => facets.sample(from, u)?,
            OpeningSurface::Sphere(sphere) => {
                FacetSample { surface: sphere.sample(from, u)?, error_m: sphere.error_m(), early_m: 0.0 }
            }
        };
        let direction = surface.direction().filter(|direction| self.emits_towards(surface.normal, -*direction))?;
        Some(LightSample {
            direction,
            target: Some(surface.target(from, direction, error_m + self.room_m, early_m)),
            radiance: self.radiance(-direction, query),
            pdf: surface.pdf,
            delta: false,
            is_environment: false,
        })
    }

    pub(super) fn pdf(&self, hit: &LightHit<'_>) -> f32 {
        match &self.surface {
            OpeningSurface::Sphere(sphere) => sphere.pdf(hit),
            OpeningSurface::Facets(facets) => facets.pdf(hit),
        }
    }
}
