//! `[[textures]]`: pictures on surfaces.

use std::path::PathBuf;

use crate::place::Placed;
use crate::reader::{choice, path, record, text};

record! {
    /// A picture that materials use as reflectance.
    pub struct Texture {
        /// The name by which materials call it.
        required name: Placed<String> = text("the name of the texture");
        /// The picture. Its first row is at v = 1.
        required file: Placed<PathBuf> = path(&["png", "jpg", "jpeg", "hdr"]);
        /// What the numbers of the file mean.
        required encoding: Placed<Encoding> = choice();
        /// What is outside of u, v = 0 … 1. Default: "repeat".
        optional wrap: Placed<Wrap> = choice();
    }
}

choice! {
    /// What the numbers of a picture mean.
    pub enum Encoding {
        /// Encoded by the curve of IEC 61966-2-1.
        "srgb" => Srgb,
        /// In proportion to the reflectance, primaries of sRGB.
        "linear" => Linear,
    }
}

choice! {
    /// What is outside of a picture.
    pub enum Wrap {
        /// The picture again.
        "repeat" => Repeat,
        /// Its edge.
        "clamp" => Clamp,
        /// The picture, mirrored.
        "mirror" => Mirror,
    }
}
