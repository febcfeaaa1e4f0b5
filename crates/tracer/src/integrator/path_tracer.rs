//! What a path tracer asks: a view, its materials and its lights.

use super::effects::SceneEffects;
use super::level::Level;
use super::medium::Medium;
use super::settings::PathSettings;
use super::surroundings::Surroundings;
use crate::guiding::Guide;
use crate::lights::Lights;
use crate::materials::MaterialTable;
use crate::media::Media;
use crate::precipitation::Near;
use crate::render_space::RenderSpace;

/// Answers rays of a view with spectral radiance.
#[derive(Clone, Copy, Debug)]
pub struct PathTracer<'a> {
    pub(super) view: &'a RenderSpace<'a>,
    pub(super) material_table: &'a MaterialTable,
    pub(super) lights: &'a Lights,
    pub(super) settings: PathSettings,
    /// What the entrance pupil lies in: paths begin there.
    pub(super) medium: Medium<'a>,
    /// What scatters light between surfaces; `None` where nothing does.
    pub(super) media: Option<&'a Media<'a>>,
    /// Drops or flakes that rays from the camera meet; `None` where none fall.
    pub(super) near: Option<&'a Near<'a>>,
    /// What matt surfaces draw directions by; `None` where they go by the cosine alone.
    pub(super) guide: Option<&'a Guide>,
    /// Whether any light goes up and down.
    pub(super) is_modulated: bool,
    /// The code that is made for the scene.
    pub(super) effects: SceneEffects,
}

impl<'a> PathTracer<'a> {
    /// A path tracer of a view with the materials that its instances name; `lights` must be collected from the same
    /// view and material_table.
    #[must_use]
    pub fn new(
        view: &'a RenderSpace<'a>,
        material_table: &'a MaterialTable,
        lights: &'a Lights,
        settings: PathSettings,
    ) -> Self {
        let solid = Surroundings::of(view, material_table).solid;
        let medium = solid.map_or_else(Medium::default, |id| Medium::inside(material_table.absorption(id)));
        let is_modulated = material_table.is_modulated() || lights.are_modulated();
        let effects = SceneEffects::Every;
        let (media, near, guide) = (None, None, None);
        let tracer = Self { view, material_table, lights, settings, medium, media, near, guide, is_modulated, effects };
        tracer.with_effects()
    }

    /// The same with what scatters light between surfaces, of the same view.
    #[must_use]
    pub fn with_media(self, media: &'a Media<'a>) -> Self {
        Self { media: Some(media).filter(|media| !media.is_empty()), ..self }.with_effects()
    }

    /// The same with drops or flakes about the camera, of the same view and media.
    #[must_use]
    pub fn with_near(self, near: Option<&'a Near<'a>>) -> Self {
        Self { near, ..self }.with_effects()
    }

    /// The same with what paths of the same view and lights have found, by which matt surfaces draw directions. No mean depends on it.
    #[must_use]
    pub fn with_guide(self, guide: Option<&'a Guide>) -> Self {
        Self { guide, ..self }
    }

    /// The same by the code that is made for what it may meet.
    fn with_effects(self) -> Self {
        let has_media = self.media.is_some() || self.near.is_some() || self.settings.only_airlight;
        let is_matt = self.material_table.is_matt() && !self.medium.is_solid();
        let effects = match (has_media, is_matt) {
            (true, _) => SceneEffects::Every,
            (false, false) => SceneEffects::Clear,
            (false, true) => SceneEffects::Matt,
        };
        Self { effects, ..self }
    }

    /// How paths are followed.
    #[must_use]
    pub fn settings(&self) -> &PathSettings {
        &self.settings
    }

    /// Scattering events that a path may have.
    pub(super) fn max_bounces(&self) -> u32 {
        match self.settings.level {
            Level::Flat | Level::Direct => 1,
            Level::Path => self.settings.max_bounces,
        }
    }

    /// The lights.
    #[must_use]
    pub fn lights(&self) -> &'a Lights {
        self.lights
    }
}
