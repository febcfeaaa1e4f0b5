//! What can be wrong with a texture.

/// Why a texture is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TextureError {
    /// The texels do not fill the picture.
    #[error("a picture of {width} × {height} needs as many texels, but {found} were given; check its size")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Texels given.
        found: usize,
    },
    /// A texel is not a finite number.
    #[error("texel {texel} of the picture is not a finite number; correct the file")]
    NonFinite {
        /// The texel, counted by rows from the top.
        texel: usize,
    },
    /// The size or sharpness of a projection from three sides is out of range.
    #[error("a picture laid on from three sides needs a size above 0 m and a sharpness of 1 to 64; correct them")]
    Projection,
    /// Scale or offset are not finite numbers.
    #[error("the texture's scale and offset must be finite numbers; correct them")]
    Placement,
}

/// Why a picture in tiles is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TiledError {
    /// As any picture.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// A tile cannot be written or read; in words for the user.
    #[error("{0}")]
    Tiles(String),
}
