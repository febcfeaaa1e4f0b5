//! Lamps whose openings are yet to be placed in the world.

use etendue_scene::Place;
use etendue_tracer::lights::{Lamp, Opening};

/// A lamp with an opening, everywhere where it stands.
pub(super) struct OpenLamp {
    /// By the names of its places.
    pub(super) alike: Vec<(String, Lamp)>,
    pub(super) opening: Opening,
    pub(super) place: Place,
}
