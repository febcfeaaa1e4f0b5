//! Planes in a file: arbitrarily named planes for internal use, and one plane of a scalar quantity with its variance.
//!
//! Encoding of one plane of a scalar quantity, with its variance if known.
//!
//! The channel is named by the quantity (`electrons`), its variance `variance.electrons`, in squared units.

use etendue_core::quantity::{Quantity, Variance};
use etendue_core::{Plane, storage::BandReader};

use super::channel::{ChannelSource, EncodeError};
use super::encode::ExrImage;
use crate::Provenance;

/// The samples of a named plane, row by row from the top left.
#[derive(Clone, Copy, Debug)]
pub enum ExrLayer<'a> {
    /// 32-bit floats.
    Float(&'a [f32]),
    /// 32-bit unsigned integers.
    Uint(&'a [u32]),
    /// Band of a cube in memory or on the disk.
    Band(&'a dyn BandReader, usize),
}

/// Encodes named planes of `width` × `height` samples.
///
/// # Errors
/// If they cannot be stored.
pub fn encode_layers(
    width: usize,
    height: usize,
    layers: &[(String, ExrLayer<'_>)],
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    layers_image(width, height, layers, provenance).into_bytes()
}

/// Returns the same image for writing.
#[must_use]
pub fn layers_image<'a>(
    width: usize,
    height: usize,
    layers: &[(String, ExrLayer<'a>)],
    provenance: &Provenance,
) -> ExrImage<'a> {
    let mut image = ExrImage::new(width, height, provenance);
    for (name, layer) in layers {
        match *layer {
            ExrLayer::Float(samples) => image.float(name.as_str(), samples),
            ExrLayer::Uint(samples) => image.uint(name.as_str(), samples),
            ExrLayer::Band(reader, band) => image.add(name.as_str(), ChannelSource::Band(reader, band)),
        }
    }
    image
}

/// Encodes `plane`, with the variance of each pixel if given.
pub fn encode_plane<Q: Quantity<Sample = f32>>(
    plane: &Plane<Q>,
    variance: Option<&Plane<Variance>>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    plane_image(plane, variance, provenance).into_bytes()
}

/// Returns the same image for writing.
#[must_use]
pub fn plane_image<'a, Q: Quantity<Sample = f32>>(
    plane: &'a Plane<Q>,
    variance: Option<&'a Plane<Variance>>,
    provenance: &Provenance,
) -> ExrImage<'a> {
    let mut image = ExrImage::new(plane.width(), plane.height(), provenance);
    let name = Q::NAME.replace(' ', "_");
    if let Some(variance) = variance {
        image.float(format!("variance.{name}"), variance.samples());
    }
    image.float(name, plane.samples());
    image.state("quantity", Q::NAME);
    image.state("units", Q::UNIT);
    image
}
