//! What shines but is no surface that glows by its material.

use super::environment::Environment;
use super::lamp::Lamp;
use super::sun::Sun;

/// What shines but is no surface that glows by its material.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Suns.
    pub suns: Vec<Sun>,
    /// Lamps, as points or with the instances of the world that are their openings.
    pub lamps: Vec<Lamp>,
    /// What surrounds the scene.
    pub environment: Option<Environment>,
}

impl Sources {
    /// Whether the strength of any of them changes over time; [`crate::materials::MaterialTable::is_modulated`] tells it of surfaces.
    #[must_use]
    pub fn is_modulated(&self) -> bool {
        self.lamps.iter().any(|lamp| lamp.modulation().is_some())
    }
}
