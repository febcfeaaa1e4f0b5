//! What the names of a file stand for.

use etendue_scene::record::Curve;
use std::collections::HashMap;
use std::rc::Rc;

/// What stands in the place of a material's name where a surface only parts two media.
pub(super) const INTERFACE: &str = "interface/";

/// What a texture became.
#[derive(Clone)]
pub(super) enum KnownTexture {
    /// The same everywhere.
    Even([f64; 3]),
    /// A texture of ours, times a number.
    Picture { name: String, scale: f64 },
}

/// A homogeneous medium.
#[derive(Clone)]
pub(super) struct Homogeneous {
    pub(super) extinction: Curve,
    pub(super) albedo: Curve,
    pub(super) g: f64,
}

/// Names and what they stand for.
#[derive(Default)]
pub(super) struct Known {
    /// Textures, those of colours (true) and those of numbers apart.
    pub(super) textures: HashMap<(bool, String), KnownTexture>,
    /// Names of ours of the file's materials; the empty name is that of the grey one.
    pub(super) materials: HashMap<String, Rc<str>>,
    /// Media that are understood.
    pub(super) media: HashMap<String, Homogeneous>,
}
