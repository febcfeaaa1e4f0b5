//! What shines but is no surface.

use super::environment::Environment;
use super::lamp::Lamp;
use super::sun::Sun;

/// What shines but is no surface.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Suns.
    pub suns: Vec<Sun>,
    /// Lamps without extent.
    pub lamps: Vec<Lamp>,
    /// What surrounds the scene.
    pub environment: Option<Environment>,
}
