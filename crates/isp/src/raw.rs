//! A raw picture, and how its numbers become shares of the range from black to white.

use crate::mosaic::Mosaic;
use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Quantity};
use rayon::prelude::*;

/// A raw picture, with what development needs to know.
#[derive(Clone, Copy, Debug)]
pub struct RawPicture<'a> {
    /// Digital numbers.
    pub plane: &'a Plane<DigitalNumber>,
    /// Digital number of no light.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// Which pixel measures which colour.
    pub mosaic: &'a Mosaic,
    /// Digital numbers of pixels under a shield, of any shape, where the sensor has some.
    pub optical_black: Option<&'a Plane<DigitalNumber>>,
}

/// A digital number as a real one; exact to 24 bits.
pub(crate) fn real(dn: <DigitalNumber as Quantity>::Sample) -> f32 {
    f64::from(dn) as f32
}

/// Samples with black at 0 and white at 1; no sample exceeds 1. Noise below black stays negative.
pub(crate) fn normalised(plane: &Plane<DigitalNumber>, black_dn: f64, white_dn: f64) -> Vec<f32> {
    let black = black_dn as f32;
    let scale = (1.0 / (white_dn - black_dn)) as f32;
    plane.samples().par_iter().map(|dn| ((real(*dn) - black) * scale).min(1.0)).collect()
}
