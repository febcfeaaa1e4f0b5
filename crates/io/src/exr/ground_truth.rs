//! Ground truth as an EXR: point-sampled on the principal ray, never filtered.
//!
//! Lengths and positions are in metres; the sky is at +∞; identity 0 is the background.

use etendue_core::Plane;
use etendue_core::quantity::{Identity, Length, Vector};

use super::channel::Channel;
use super::encode::{EncodeError, ExrImage};
use crate::Provenance;

/// Planes of ground truth; what a job did not ask for is `None`.
#[derive(Clone, Copy, Debug, Default)]
pub struct GroundTruth<'a> {
    /// Distance along the camera's axis, m.
    pub depth: Option<&'a Plane<Length>>,
    /// Distance along the ray from the plane of the entrance pupil, m.
    pub distance: Option<&'a Plane<Length>>,
    /// Unit shading normal in the world.
    pub normal: Option<&'a Plane<Vector>>,
    /// Position in the world, m, rounded to 32-bit floats (at 100 km from the origin by up to 4 mm, at 5 000 km by 0.25 m).
    pub position: Option<&'a Plane<Vector>>,
    /// Position in the camera frame (x right, y down, z forward and negative behind), m.
    pub camera_space_position: Option<&'a Plane<Vector>>,
    /// Identity of the instance.
    pub instance: Option<&'a Plane<Identity>>,
    /// Identity of the class.
    pub semantic: Option<&'a Plane<Identity>>,
    /// Identity of the material.
    pub material: Option<&'a Plane<Identity>>,
    /// By which ray the pixel looks: 0 none, 1 the principal ray, 2 one through the centroid of the open pupil.
    pub ray: Option<&'a Plane<Identity>>,
    /// Where the ray meets the camera's mirror, camera frame, m; NaN where it does not.
    pub mirror: Option<&'a Plane<Vector>>,
}

/// The planes of `truth` in one file.
pub fn encode_ground_truth(truth: &GroundTruth<'_>, provenance: &Provenance) -> Result<Vec<u8>, EncodeError> {
    let (width, height) = truth.size().ok_or(EncodeError::NoChannels)?;
    let mut image = ExrImage::new(width, height, provenance);
    for (name, plane) in [("depth.Z", truth.depth), ("distance.Z", truth.distance)] {
        if let Some(plane) = plane {
            image.float(name, plane.samples());
        }
    }
    let vectors = [
        ("N", truth.normal),
        ("P", truth.position),
        ("P_camera", truth.camera_space_position),
        ("mirror", truth.mirror),
    ];
    for (layer, plane) in vectors {
        if let Some(plane) = plane {
            add_vector(&mut image, layer, plane);
        }
    }
    for (layer, plane) in
        [("instance", truth.instance), ("semantic", truth.semantic), ("material", truth.material), ("ray", truth.ray)]
    {
        if let Some(plane) = plane {
            image.uint(format!("{layer}.ID"), plane.samples());
        }
    }
    image.state("quantity", "ground truth");
    image.state("units", "depth, distance, P: m; N: 1; ID: identity, 0 is the background");
    if truth.depth.is_some_and(|depth| depth.samples().iter().any(|z| z.is_nan())) {
        image.state("depth", "NaN where a pixel has no ray, and where it looks sideways, back or at a mirror: distance.Z is defined there");
    }
    if truth.camera_space_position.is_some() {
        image.state("P_camera", "camera frame (x right, y down, z forward, negative behind), m; 0 for the sky");
    }
    if truth.mirror.is_some() {
        image.state("mirror", "point of the mirror, camera frame (x right, y down, z forward), m; NaN: beside it");
    }
    image.state("sampling", "point sample on the principal ray, never filtered; sky at +inf");
    image.into_bytes()
}

impl GroundTruth<'_> {
    fn size(&self) -> Option<(usize, usize)> {
        let lengths = [self.depth, self.distance].into_iter().flatten().map(|p| (p.width(), p.height()));
        let vectors = [self.normal, self.position, self.camera_space_position]
            .into_iter()
            .flatten()
            .map(|p| (p.width(), p.height()));
        let ids = [self.instance, self.semantic, self.material, self.ray]
            .into_iter()
            .flatten()
            .map(|p| (p.width(), p.height()));
        lengths.chain(vectors).chain(ids).next()
    }
}

pub(super) fn add_vector<'a>(image: &mut ExrImage<'a>, layer: &str, plane: &'a Plane<Vector>) {
    for (axis, letter) in ["X", "Y", "Z"].into_iter().enumerate() {
        image.add(format!("{layer}.{letter}"), Channel::Component(plane.samples(), axis));
    }
}
