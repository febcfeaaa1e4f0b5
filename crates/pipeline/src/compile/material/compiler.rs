//! What makes the tracer's materials of records.

use super::super::context::Context;
use super::picture::Pictures;
use etendue_scene::record::{self, Scene};
use etendue_tracer::MaterialId;

/// What materials are made with.
pub(super) struct MaterialCompiler<'w, 'a> {
    pub(super) scene: &'w Scene,
    pub(super) pictures: &'w mut Pictures,
    pub(super) context: &'w mut Context<'a>,
    /// Whether a texture was used that is laid by texture coordinates.
    pub(super) needs_coordinates: bool,
    /// Of a material whose light is stated as a flux: how many sides glow.
    pub(super) flux_sides: Option<f64>,
    /// Of a material whose light goes up and down: whether each of its objects has a phase of its own.
    pub(super) has_random_phases: bool,
}

impl MaterialCompiler<'_, '_> {
    /// The texture of a name; a description that was read names only what it has.
    pub(super) fn named_texture(&self, name: &str) -> Option<&record::Texture> {
        self.scene.textures.iter().find(|t| t.name.value == name)
    }

    /// The id that a material of the scene has, or will have: that of its place, as no faulty material comes to a plan.
    pub(super) fn id_of(&self, name: &str) -> Option<MaterialId> {
        let place = self.scene.materials.iter().position(|m| m.name.value == name)?;
        Some(MaterialId(place as u32))
    }
}
