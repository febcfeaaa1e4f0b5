//! Factors over a surface, and normal maps.

use crate::fault::NameKind;
use crate::place::Placed;
use crate::reader::{Rule, choice, either, name_of, number, record, variant, words};

/// A number from 0 to 1 over a surface.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a description has few of them, and places of values take most of it")]
pub enum Factor {
    /// Constant over the surface.
    Number(Placed<f64>),
    /// A channel of a texture.
    Texture(FactorTexture),
}

record! {
    /// A number from an image.
    pub struct FactorTexture {
        /// Name of a texture.
        required texture: Placed<String> = name_of(NameKind::Texture);
        /// Channel. Default: "luminance".
        optional channel: Placed<Channel> = choice();
        /// Factor on the values. Default: 1.
        optional scale: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

words! {
    /// A channel of an image.
    pub enum Channel {
        /// Red.
        "r" => Red,
        /// Green.
        "g" => Green,
        /// Blue.
        "b" => Blue,
        /// Opacity; linear whatever the encoding.
        "a" => Alpha,
        /// The luminance of the colour, 1 for white.
        "luminance" => Luminance,
    }
}

record! {
    /// Normals from an image: (r, g, b) = 0 … 1 is the vector (2r − 1, 2g − 1, 2b − 1) along u, v and the normal.
    pub struct NormalMap {
        /// Texture with encoding = "data".
        required texture: Placed<String> = name_of(NameKind::Texture);
        /// Factor on the slopes. Default: 1.
        optional strength: Placed<f64> = number("").at_least(0.0).at_most(10.0);
        /// Direction of green: up (OpenGL) or down (DirectX). Default: "up".
        optional y: Placed<Green> = choice();
    }
}

words! {
    /// Direction of green.
    pub enum Green {
        /// To greater v (OpenGL).
        "up" => Up,
        /// To smaller v (DirectX).
        "down" => Down,
    }
}

/// A number, or a texture.
pub(crate) fn any_factor() -> impl Rule<Out = Factor> {
    let fraction = number("").at_least(0.0).at_most(1.0);
    either(variant!(fraction, Factor::Number), variant!(record::<FactorTexture>(), Factor::Texture))
}
