//! A path tracer: the view, materials and lights that paths are traced through, and the effects that these paths may encounter.

use core::f32::consts::TAU;

use etendue_core::{Integrator, Ray, maths::f32::sin_cos};
use glam::Vec3;

use super::{path_state::PathMedium, settings::PathSettings};
use crate::{
    ALL_EFFECTS, MaterialId, guiding::Guide, lights::Lights, materials::MaterialTable, media::Media,
    precipitation::NearParticles, render_space::RenderSpace,
};

/// Traces rays of a view: the result is spectral radiance.
#[derive(Clone, Copy, Debug)]
pub struct PathTracer<'a> {
    pub(super) view: &'a RenderSpace<'a>,
    pub(super) material_table: &'a MaterialTable,
    pub(super) lights: &'a Lights,
    pub(super) settings: PathSettings,
    /// The medium around the entrance pupil: paths begin there.
    pub(super) medium: PathMedium<'a>,
    /// Media that scatter light between surfaces; `None` if there are none.
    pub(super) media: Option<&'a Media<'a>>,
    /// Drops or flakes that rays from the camera hit; `None` where none fall.
    pub(super) near: Option<&'a NearParticles<'a>>,
    /// The distributions by which diffuse surfaces sample directions; `None` if they sample by the cosine alone.
    pub(super) guide: Option<&'a Guide>,
    /// True if the strength of any light changes over time.
    pub(super) is_modulated: bool,
    /// The code variant compiled for the scene.
    pub(super) effects: SceneEffects,
}

impl<'a> PathTracer<'a> {
    /// A path tracer of a view with the materials that its instances name; `lights` must be collected from the same view and
    /// material_table.
    #[must_use]
    pub fn new(
        view: &'a RenderSpace<'a>,
        material_table: &'a MaterialTable,
        lights: &'a Lights,
        settings: PathSettings,
    ) -> Self {
        let solid = Surroundings::from_view(view, material_table).solid;
        let medium = solid.map_or_else(PathMedium::default, |id| PathMedium::inside(material_table.absorption(id)));
        let is_modulated = material_table.is_modulated() || lights.are_modulated();
        let effects = SceneEffects::All;
        let (media, near, guide) = (None, None, None);
        let tracer = Self { view, material_table, lights, settings, medium, media, near, guide, is_modulated, effects };
        tracer.with_effects()
    }

    /// Adds media that scatter light between surfaces, of the same view.
    #[must_use]
    pub fn with_media(self, media: &'a Media<'a>) -> Self {
        Self { media: Some(media).filter(|media| !media.is_empty()), ..self }.with_effects()
    }

    /// Adds drops or flakes around the camera, of the same view and media.
    #[must_use]
    pub fn with_near(self, near: Option<&'a NearParticles<'a>>) -> Self {
        Self { near, ..self }.with_effects()
    }

    /// Adds a guide, trained by paths of the same view and lights, by which diffuse surfaces sample directions. No mean depends on it.
    #[must_use]
    pub fn with_guide(self, guide: Option<&'a Guide>) -> Self {
        Self { guide, ..self }
    }

    /// Selects the code compiled for the effects that paths may encounter.
    fn with_effects(self) -> Self {
        let has_media = self.media.is_some() || self.near.is_some() || self.settings.only_airlight;
        let is_diffuse_only = self.material_table.is_diffuse_only() && !self.medium.is_solid();
        let effects = match (has_media, is_diffuse_only) {
            (true, _) => SceneEffects::All,
            (false, false) => SceneEffects::NoMedia,
            (false, true) => SceneEffects::DiffuseOnly,
        };
        Self { effects, ..self }
    }

    #[must_use]
    pub fn settings(&self) -> &PathSettings {
        &self.settings
    }

    /// Maximum number of scattering events of a path.
    pub(super) fn max_bounces(&self) -> u32 {
        match self.settings.integrator {
            Integrator::Flat | Integrator::Direct => 1,
            Integrator::Path => self.settings.max_bounces,
        }
    }

    #[must_use]
    pub fn lights(&self) -> &'a Lights {
        self.lights
    }
}

/// The effects that a path may encounter. A path is compiled once for each row of the table; [`super::PathTracer`] takes the first row that
/// has everything its scene needs. An effect that a row leaves out costs nothing at a vertex. All rows give the same bits.
///
/// | row | scenes |
/// | --- | --- |
/// | [`DiffuseOnly`] | diffuse surfaces without textures, no media |
/// | [`NoMedia`] | all surfaces, no media |
/// | [`AllEffects`] | all |
pub(super) trait Effects: Copy {
    /// Scattering of light between surfaces: fog, drops, flakes.
    const MEDIA: bool;
    /// Surfaces other than diffuse ones of one spectrum each: other models, textures, mixes, opacity, transparent solids.
    const SURFACES: bool;
}

/// The row of [`Effects`] that a scene takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SceneEffects {
    DiffuseOnly,
    NoMedia,
    /// [`AllEffects`].
    All,
}

/// Media and all surfaces.
#[derive(Clone, Copy)]
pub(super) struct AllEffects;

#[derive(Clone, Copy)]
pub(super) struct NoMedia;

/// Neither media nor surfaces other than diffuse ones.
#[derive(Clone, Copy)]
pub(super) struct DiffuseOnly;

impl Effects for AllEffects {
    const MEDIA: bool = ALL_EFFECTS;
    const SURFACES: bool = ALL_EFFECTS;
}

impl Effects for NoMedia {
    const MEDIA: bool = false;
    const SURFACES: bool = ALL_EFFECTS;
}

impl Effects for DiffuseOnly {
    const MEDIA: bool = false;
    const SURFACES: bool = false;
}

/// Number of traced rays.
const RAYS: u32 = 15;

/// Maximum number of surfaces that a ray is traced through.
const MAX_PASSED: u32 = 4096;

/// The solid that surrounds a camera.
///
/// From the centre of the entrance pupil, rays of fixed directions are traced straight through everything. A solid holds the camera if a
/// ray leaves it once more than it enters it. Of several such solids the one left first counts: it is the innermost. Most of the rays
/// decide: for a solid with a closed surface all agree. Moving objects are taken half-way through the view's interval. Left out is a camera
/// that enters or leaves a solid during its exposure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Surroundings {
    /// The material of the solid that most rays leave; `None` for air.
    pub solid: Option<MaterialId>,
    /// A solid that only some rays leave: its surface is not closed.
    pub open_solid: Option<MaterialId>,
}

impl Surroundings {
    /// The surroundings of a view's camera.
    #[must_use]
    pub fn from_view(view: &RenderSpace<'_>, material_table: &MaterialTable) -> Self {
        if !material_table.has_solids() {
            return Self::default();
        }
        let solids: Vec<_> = (0..RAYS).map(|i| first_exited(view, material_table, direction(i))).collect();
        let votes = |id: Option<MaterialId>| solids.iter().filter(|solid| **solid == id).count();
        let solid = solids.iter().flatten().copied().find(|id| 2 * votes(Some(*id)) > solids.len());
        let open = solids.iter().flatten().copied().find(|id| votes(Some(*id)) < solids.len());
        Self { solid, open_solid: open }
    }
}

/// Unit directions spread over the sphere (a Fibonacci lattice), none of them along an axis.
fn direction(i: u32) -> Vec3 {
    let z = 1.0 - (2.0 * i as f32 + 1.0) / RAYS as f32 + 0.013;
    let (sin, cos) = sin_cos((0.618_034 * i as f32 + 0.137).fract() * TAU);
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * cos, r * sin, z).normalize()
}

/// A solid whose surface a ray has crossed.
struct CrossedSolid {
    instance: u32,
    material: MaterialId,
    /// Number of exits minus number of entries of the ray.
    exits: i32,
}

/// Of the solids that hold the camera as seen along one direction, the one that the ray leaves first.
fn first_exited(view: &RenderSpace<'_>, material_table: &MaterialTable, direction: Vec3) -> Option<MaterialId> {
    // In the order in which they were first crossed.
    let mut solids: Vec<CrossedSolid> = vec![];
    let mut ray = Ray::new(Vec3::ZERO, direction, (0.5 * view.interval().length_s()) as f32);
    for _ in 0..MAX_PASSED {
        let Some(hit) = view.closest(&ray) else { break };
        let point = view.surface(&ray, &hit);
        if let Some(material) = material_table.solid(point.material) {
            let step = if point.geometric_normal.dot(direction) > 0.0 { 1 } else { -1 };
            match solids.iter_mut().find(|solid| solid.instance == hit.instance) {
                Some(solid) => solid.exits += step,
                None => solids.push(CrossedSolid { instance: hit.instance, material, exits: step }),
            }
        }
        ray.origin = point.spawn(direction);
    }
    solids.into_iter().find(|solid| solid.exits > 0).map(|solid| solid.material)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_unit_and_spread() {
        let all: Vec<_> = (0..RAYS).map(direction).collect();
        assert!(all.iter().all(|d| (d.length() - 1.0).abs() < 1e-6 && d.abs().min_element() > 1e-3));
        let sum: Vec3 = all.iter().sum();
        assert!(sum.length() < 1.0, "{sum}");
    }
}
