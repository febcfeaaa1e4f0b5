//! The ray table as an EXR: where each pixel's ray begins and where it goes.

use etendue_core::Plane;
use etendue_core::quantity::{Identity, Length, Vector};

use super::encode::ExrImage;
use super::ground_truth::add_vector;
use crate::Provenance;

/// Origins (m) and unit directions in the camera's frame, by which ray a pixel looks, and of a camera with a mirror the path
/// from the pupil to the origin (m).
#[must_use]
pub fn rays_image<'a>(
    origin: &'a Plane<Vector>,
    direction: &'a Plane<Vector>,
    ray: &'a Plane<Identity>,
    path: Option<&'a Plane<Length>>,
    provenance: &Provenance,
) -> ExrImage<'a> {
    let mut image = ExrImage::new(origin.width(), origin.height(), provenance);
    add_vector(&mut image, "origin", origin);
    add_vector(&mut image, "direction", direction);
    image.uint("ray.ID".to_owned(), ray.samples());
    if let Some(path) = path {
        image.float("path.Z", path.samples());
        image.state("path", "m from the pupil to the mirror, where the ray's origin is; part of distance.Z");
    }
    image.state("quantity", "rays");
    image.state("units", "origin: m; direction: 1; both in the camera frame, x right, y down, z forward; NaN: no ray");
    image.state("sampling", "principal rays of pixel centres at 587.56 nm, those of the ground truth");
    image
}
