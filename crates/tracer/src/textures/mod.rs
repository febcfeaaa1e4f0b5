//! Textures: numbers over a surface.
//!
//! # Conventions
//! - Texture coordinates: u to the right, v up, (0, 0) the bottom-left corner of the picture (as OBJ files have it).
//!   Rows of texels are stored from the top.
//! - Texels are box-shaped; their centres lie at half-integers. Filtering is done in linear light.
//! - A lookup names its footprint, of what it stands for: the width of its short side, in texture coordinates and in the
//!   shape's own frame, and where it is longer one way, that side with its direction.

mod channel;
mod error;
mod image;
mod mipmap;
mod projection;
#[cfg(test)]
mod tests;
mod texels;
mod tiled;
mod wrap;

pub use channel::Channel;
pub use error::{TextureError, TiledError};
pub use image::{Filter, ImageTexture, Sampling};
pub use projection::Projection;
pub use texels::{TexelEncoding, Texels};
pub use tiled::{PyramidWriter, TileMemory};
pub use wrap::Wrap;

use glam::{DVec3, Vec2, Vec3};

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
