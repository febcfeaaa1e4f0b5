//! Raw digital numbers to a picture.
//!
//! | order | step | module |
//! | --- | --- | --- |
//! | 1 | black level off, white level to 1 | [`develop`](develop()) |
//! | 2 | white balance, highlights clipped at 1 | [`white_balance`] |
//! | 3 | bilinear demosaic | [`demosaic`] |
//! | 4 | camera colours to linear sRGB | [`colour_matrix`] |
//! | 5 | digital gain | [`develop`](develop()) |
//! | 6 | clip, sRGB encoding, 8 bits | [`tone`] |
//!
//! This is a plain, stated way to look at a raw picture, not the look of any camera. Left out for now: denoising,
//! sharpening, highlight recovery, local tone mapping, mosaics other than Bayer-like ones. This crate does not know
//! electrons: a raw picture is digital numbers between a black and a white level.

pub mod colour_matrix;
pub mod demosaic;
mod develop;
mod mosaic;
pub mod tone;
pub mod white_balance;

pub use colour_matrix::{ColourMatrix, FitError, fit_colour_matrix};
pub use develop::{Colour, DevelopError, Developed, Processing, RawPicture, develop};
pub use mosaic::{Filter, Mosaic, MosaicError};
pub use tone::encode;
pub use white_balance::{NoResponse, white_balance_from_illuminant};
