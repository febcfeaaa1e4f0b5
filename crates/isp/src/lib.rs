//! From raw digital numbers to an image.
//!
//! | order | step | module |
//! | --- | --- | --- |
//! | 1 | black level off, white level to 1 | [`raw`] |
//! | 2 | defective pixels | [`correction`] |
//! | 3 | shading | [`correction`] |
//! | 4 | white balance, highlights clipped at what is shown as white | [`white_balance`] |
//! | 5 | demosaic | [`demosaic`] |
//! | 6 | noise reduction | [`detail`] |
//! | 7 | camera colours to linear sRGB, digital gain | [`colour_matrix`] |
//! | 8 | the paper's filters of linear light | [`paper`] |
//! | 9 | clip, tone curve | [`tone`] |
//! | 10 | sharpening | [`detail`] |
//! | 11 | the paper's filters of encoded images | [`paper`] |
//!
//! Black level, white balance, demosaic, colour and tone are always applied; the others only if requested. This is a plain, documented rendition of a
//! raw image, not the look of any camera. Left out: highlight recovery, local tone mapping, chromatic aberration, temporal noise reduction. This
//! crate has no notion of electrons: a raw image is digital numbers between a black and a white level.

pub mod colour_matrix;
pub mod correction;
pub mod demosaic;
pub mod detail;
mod develop;
pub mod paper;
pub mod raw;
pub mod tone;
pub mod white_balance;

pub use colour_matrix::{ColourMatrix, FitError, MatrixError, NOISE_OF_OTHER_CHANNELS, fit_colour_matrix};
pub use correction::{Defects, Shading, ShadingError};
pub use demosaic::Demosaic;
pub use detail::{Bilateral, DetailError, NoiseReduction, UnsharpMask};
pub use develop::{Colour, DevelopError, DevelopmentReport, DevelopmentResult, Processing, develop};
pub use raw::{BlackLevel, Filter, MAX_CHANNELS, Mosaic, MosaicError, RawImage, Tile};
pub use tone::{Oecf, SCurve, Table, ToneCurve, ToneError};
pub use white_balance::{NoResponse, WhiteBalance, white_balance_from_illuminant};
