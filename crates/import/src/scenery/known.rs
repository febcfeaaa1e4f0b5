//! What the names of a file stand for.

use etendue_scene::record::Curve;
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// What stands in the place of a material's name where a surface only parts two media.
pub(crate) const INTERFACE: &str = "interface/";

/// What a texture became.
#[derive(Clone)]
pub(crate) enum KnownTexture {
    /// The same everywhere.
    Even([f64; 3]),
    /// A texture of ours, times a number.
    Picture {
        name: String,
        scale: f64,
        /// Whether its number is its opacity, as of pbrt's pictures with one.
        has_alpha: bool,
    },
}

/// A homogeneous medium.
#[derive(Clone)]
pub(crate) struct Homogeneous {
    pub(crate) extinction: Curve,
    pub(crate) albedo: Curve,
    pub(crate) g: f64,
}

/// Names and what they stand for.
#[derive(Default)]
pub(crate) struct Known {
    /// Textures, those of colours (true) and those of numbers apart.
    pub(crate) textures: HashMap<(bool, String), KnownTexture>,
    /// Names of ours of the file's materials; the empty name is that of the grey one.
    pub(crate) materials: HashMap<String, Rc<str>>,
    /// Names of ours of the materials that lay a picture by texture coordinates.
    pub(crate) pictured: HashSet<Rc<str>>,
    /// How often a material has laid a picture so far.
    pub(crate) pictures_laid: usize,
    /// Names of copies of which only a share is there, by what they are copies of and the share.
    pub(crate) thinned: HashMap<String, Rc<str>>,
    /// Media that are understood.
    pub(crate) media: HashMap<String, Homogeneous>,
}
