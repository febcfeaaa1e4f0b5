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
    plane_image(plane, variance, provenance).into_bytes()
}

/// The same, to be written.
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
