//! Textures: numbers over a surface.
//!
//! # Conventions
//! - Texture coordinates: u to the right, v up, (0, 0) the bottom-left corner of the picture (as OBJ files have it).
//!   Rows of texels are stored from the top.
//! - Texels are box-shaped; their centres lie at half-integers. Filtering is done in linear light.
//! - A lookup names its footprint, of what it stands for: the width of its short side, in texture coordinates and in the
//!   shape's own frame, and where it is longer one way, that side with its direction.

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

/// A texture's place in the tracer's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureId(pub u32);

/// Where a texture is asked, and how widely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lookup {
    /// Texture coordinates.
    pub uv: Vec2,
    /// Width of the footprint's short side in texture coordinates; 0 for a point.
    pub width: f32,
    /// The footprint's long side in texture coordinates, from end to end; zero where it is round.
    pub long: Vec2,
    /// The point in the shape's own frame less `origin`, m.
    pub local: Vec3,
    /// What `local` is relative to, m: zero but for meshes far from their file's origin.
    pub origin: DVec3,
    /// The surface's unit normal there in the shape's own frame.
    pub local_normal: Vec3,
    /// Width of the footprint's short side in the shape's own frame, m; 0 for a point.
    pub width_local: f32,
    /// The footprint's long side in the shape's own frame, m, from end to end; zero where it is round.
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

    fn picture(width: u32, height: u32, sampling: Sampling, texel: impl Fn(u32, u32) -> f32) -> ImageTexture {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let texels = places.map(|(x, y)| [texel(x, y); 3]).collect();
        ImageTexture::new(width, height, Texels::Float(texels), sampling).expect("a picture")
    }
}
