//! Textures of other programs as trees, and what they become.

mod image;
mod noise;
mod placed;
mod tree;

pub(crate) use image::{
    ImageEncoding, ImageFile, ImageFormat, ImageUse, ImageWrap, NumberImage, number_image, read_light_image,
};
pub(crate) use noise::{MARBLE_MEAN, mean_of_turbulence};
pub(crate) use placed::{KnownTexture, PlacedTexture, TextureUse};
pub(crate) use tree::{ImageLeaf, Leaf, Pattern, Placement, TextureTree};
