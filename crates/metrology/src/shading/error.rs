//! Why a picture shows no shading.

/// Why a flat field cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShadingError {
    /// Saturated.
    #[error("{percent:.1} % of the flat field's pixels are saturated: expose less")]
    Saturated {
        /// Share of pixels.
        percent: f64,
    },
    /// No light.
    #[error(
        "the flat field's centre reads {reading}, no more than black ({black}): expose more, or check the black level"
    )]
    Dark {
        /// Reading of the centre.
        reading: f64,
        /// The black level.
        black: f64,
    },
    /// Not a flat field.
    #[error(
        "this is no picture of an evenly lit surface: it differs from a smooth fall-off by {percent:.0} % (root mean square of {blocks} × {blocks} blocks)"
    )]
    NotFlat {
        /// Relative deviation.
        percent: f64,
        /// Blocks along a side.
        blocks: usize,
    },
    /// A reading is NaN or infinite.
    #[error("the picture holds readings that are no numbers: give finite values")]
    NotFinite,
    /// Too few pixels for the rings and blocks.
    #[error(
        "a picture of {width} × {height} pixels is too small for {rings} rings and {blocks} × {blocks} blocks (an odd number of blocks, four pixels or more each)"
    )]
    TooSmall {
        /// Pixels a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Rings asked for.
        rings: usize,
        /// Blocks asked for.
        blocks: usize,
    },
    /// Channels of different sizes.
    #[error("the channels differ in size: give pictures of one size")]
    Sizes,
}
