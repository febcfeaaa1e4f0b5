//! Planes of any name in one file: what a program keeps for itself.

use etendue_core::storage::BandReader;

use super::channel::Channel;
use super::encode::ExrImage;
use super::encode_error::EncodeError;
use crate::Provenance;

/// The samples of a named plane, row by row from the top left.
#[derive(Clone, Copy, Debug)]
pub enum Layer<'a> {
    /// 32-bit floats.
    Float(&'a [f32]),
    /// 32-bit unsigned integers.
    Uint(&'a [u32]),
    /// A band of a cube in memory or on the disk.
    Band(&'a dyn BandReader, usize),
}

/// Named planes of `width` × `height` samples.
///
/// # Errors
/// Where they cannot be stored.
pub fn encode_layers(
    width: usize,
    height: usize,
    layers: &[(String, Layer<'_>)],
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    layers_image(width, height, layers, provenance).into_bytes()
}

/// The same, to be written.
#[must_use]
pub fn layers_image<'a>(
    width: usize,
    height: usize,
    layers: &[(String, Layer<'a>)],
    provenance: &Provenance,
) -> ExrImage<'a> {
    let mut image = ExrImage::new(width, height, provenance);
    for (name, layer) in layers {
        match *layer {
            Layer::Float(samples) => image.float(name.as_str(), samples),
            Layer::Uint(samples) => image.uint(name.as_str(), samples),
            Layer::Band(reader, band) => image.add(name.as_str(), Channel::Band(reader, band)),
        }
    }
    image
}
