//! What a path tracer asks: a view, its materials and its lights.

use super::level::Level;
use super::medium::Medium;
use super::settings::PathSettings;
use super::surroundings::Surroundings;
use crate::lights::Lights;
use crate::materials::MaterialTable;
use crate::media::Media;
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
    /// Whether any light goes up and down.
    pub(super) is_modulated: bool,
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
        Self { view, material_table, lights, settings, medium, media: None, is_modulated }
    }

    /// The same with what scatters light between surfaces, of the same view.
    #[must_use]
    pub fn with_media(self, media: &'a Media<'a>) -> Self {
        Self { media: Some(media).filter(|media| !media.is_empty()), ..self }
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
