//! Texture: how much of fine structure a camera keeps.
//!
//! [`star`]: modulation of a Siemens star over frequency. [`leaves`]: response to a texture with all frequencies, as dead leaves are, against
//! its reference.

pub mod leaves;
pub mod star;

/// Why texture cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TextureError {
    /// A star that is not in the picture or has no cycles.
    #[error(
        "the star must lie within the picture: expected 4 or more cycles, an outer radius above the inner one, and {0}"
    )]
    Star(&'static str),
    /// No star there.
    #[error("no star is at this place: its modulation at the outer radius is {percent:.1} %, below 5 %")]
    NoStar {
        /// Modulation.
        percent: f64,
    },
    /// It is clipped.
    #[error("{percent:.1} % of the pixels are saturated, which bends light and dark apart: expose less")]
    Saturated {
        /// Share of pixels.
        percent: f64,
    },
    /// A reading is NaN or infinite.
    #[error("the picture holds readings that are no numbers: give finite values")]
    NotFinite,
    /// Pictures of different sizes, or too small ones.
    #[error("picture and reference must have one size of at least {least} × {least} pixels, not {} × {} and {} × {}", picture.0, picture.1, reference.0, reference.1)]
    Size {
        /// The least side.
        least: usize,
        /// Width and height of the picture.
        picture: (usize, usize),
        /// Width and height of the reference.
        reference: (usize, usize),
    },
    /// The picture for the noise is too small.
    #[error("the picture of an even surface must have at least {least} × {least} pixels, not {} × {}", size.0, size.1)]
    Even {
        /// The least side.
        least: usize,
        /// Its width and height.
        size: (usize, usize),
    },
    /// Picture and reference are displaced.
    #[error("the picture shows the texture {:.1} px right and {:.1} px down of where the reference does: give a reference of the same place, within 2 px", shift_px[0], shift_px[1])]
    Shifted {
        /// To the right and down, px.
        shift_px: [f64; 2],
    },
    /// The reference has no texture, or the picture another one.
    #[error(
        "picture and reference share no texture: are they of the same place, pixel by pixel? A reference is a sharp render without noise: `set` output.radiance=true writes radiance.exr"
    )]
    Unlike,
}
