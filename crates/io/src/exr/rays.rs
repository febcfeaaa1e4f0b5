//! The ray table as an EXR: where each pixel's ray begins and where it goes.

use etendue_core::Plane;
use etendue_core::quantity::{Identity, Vector};

use super::encode::{EncodeError, ExrImage};
use super::ground_truth::add_vector;
use crate::Provenance;

/// Origins (m) and unit directions in the camera's frame, and by which ray a pixel looks.
pub fn encode_rays(
    origin: &Plane<Vector>,
    direction: &Plane<Vector>,
    ray: &Plane<Identity>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    let mut image = ExrImage::new(origin.width(), origin.height(), provenance);
    add_vector(&mut image, "origin", origin);
    add_vector(&mut image, "direction", direction);
    image.uint("ray.ID".to_owned(), ray.samples().to_vec());
    image.state("quantity", "rays");
    image.state("units", "origin: m; direction: 1; both in the camera frame, x right, y down, z forward; NaN: no ray");
    image.state("sampling", "principal rays of pixel centres at 587.56 nm, those of the ground truth");
    image.into_bytes()
}
