//! Textures: values over a surface.
//!
//! # Conventions
//! - Texture coordinates: u to the right, v up, (0, 0) the bottom-left corner of the image (as in OBJ files).
//!   Rows of texels are stored from the top.
//! - Texels are box-shaped; their centres lie at half-integers. Filtering is done in linear light.
//! - A look-up states its footprint: the width of its short side, in texture coordinates and in the
//!   shape's own frame, and its long side with its direction if it is elongated.

mod image;
mod mipmap;
mod projection;
mod texels;
mod tiled;

use glam::{DVec3, Vec2, Vec3};

pub use image::{Filter, ImageTexture, Sampling};
pub use projection::{Projection, Wrap};
pub use texels::{Channel, TexelEncoding, Texels, TextureError, TiledError};
pub use tiled::{PyramidWriter, TileMemory};

/// Index of a texture in the tracer's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureId(pub u32);

/// Place and footprint of a texture look-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lookup {
    /// Texture coordinates.
    pub uv: Vec2,
    /// Width of the footprint's short side in texture coordinates; 0 for a point.
    pub width: f32,
    /// The footprint's long side in texture coordinates, from end to end; zero if it is round.
    pub long: Vec2,
    /// The point in the shape's own frame minus `origin`, m.
    pub local: Vec3,
    /// Origin of `local`, m: zero except for meshes far from their file's origin.
    pub origin: DVec3,
    /// The surface's unit normal there in the shape's own frame.
    pub local_normal: Vec3,
    /// Width of the footprint's short side in the shape's own frame, m; 0 for a point.
    pub width_local: f32,
    /// The footprint's long side in the shape's own frame, m, from end to end; zero if it is round.
    pub long_local: Vec3,
}

impl Lookup {
    /// A point in texture coordinates, of no width, at the origin of its shape.
    #[must_use]
    pub const fn point(uv: Vec2) -> Self {
        let (local, local_normal) = (Vec3::ZERO, Vec3::Z);
        Self {
            uv,
            width: 0.0,
            long: Vec2::ZERO,
            local,
            origin: DVec3::ZERO,
            local_normal,
            width_local: 0.0,
            long_local: Vec3::ZERO,
        }
    }
}

#[cfg(test)]
mod tests {
    mod alpha;
    mod grazing;
    mod tiled;

    use super::*;

    fn test_image(width: u32, height: u32, sampling: Sampling, texel: impl Fn(u32, u32) -> f32) -> ImageTexture {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let texels = places.map(|(x, y)| [texel(x, y); 3]).collect();
        ImageTexture::new(width, height, Texels::Float(texels), sampling).expect("a picture")
    }
}
