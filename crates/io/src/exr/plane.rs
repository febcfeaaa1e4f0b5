//! One plane of a scalar quantity as an EXR, with its variance where known.
//!
//! The channel is named by the quantity (`electrons`), its variance `variance.electrons`, in squared units.

use etendue_core::Plane;
use etendue_core::quantity::{Quantity, Variance};

use super::encode::{EncodeError, ExrImage};
use crate::Provenance;

/// `plane`, with the variance of each pixel where given.
pub fn encode_plane<Q: Quantity<Sample = f32>>(
    plane: &Plane<Q>,
    variance: Option<&Plane<Variance>>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    let mut image = ExrImage::new(plane.width(), plane.height(), provenance);
    let name = Q::NAME.replace(' ', "_");
    if let Some(variance) = variance {
        image.float(format!("variance.{name}"), variance.samples().to_vec());
    }
    image.float(name, plane.samples().to_vec());
    image.state("quantity", Q::NAME);
    image.state("units", Q::UNIT);
    image.into_bytes()
}
