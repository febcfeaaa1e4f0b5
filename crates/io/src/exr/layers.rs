//! Planes of any name in one file: what a program keeps for itself.

use super::encode::{EncodeError, ExrImage};
use crate::Provenance;

/// The samples of a named plane, row by row from the top left.
#[derive(Clone, Copy, Debug)]
pub enum Layer<'a> {
    /// 32-bit floats.
    Float(&'a [f32]),
    /// 32-bit unsigned integers.
    Uint(&'a [u32]),
}

/// Named planes of `width` × `height` samples.
pub fn encode_layers(
    width: usize,
    height: usize,
    layers: &[(String, Layer<'_>)],
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    let mut image = ExrImage::new(width, height, provenance);
    for (name, layer) in layers {
        match layer {
            Layer::Float(samples) => image.float(name.as_str(), samples.to_vec()),
            Layer::Uint(samples) => image.uint(name.as_str(), samples.to_vec()),
        }
    }
    image.into_bytes()
}
