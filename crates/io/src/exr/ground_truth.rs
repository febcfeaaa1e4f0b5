//! Ground truth and rays as an EXR: point-sampled on the principal ray, never filtered.
//!
//! Lengths and positions are in metres; the sky is at +∞; identity 0 is the background.

use std::ops::Range;

use etendue_core::Plane;
use etendue_core::quantity::{Identity, Length, Vector};

use super::channel::{ChannelSource, EncodeError, SampleRows, Strips};
use super::encode::ExrImage;
use crate::Provenance;

/// Planes of ground truth; `None` for those that a job did not request.
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
    /// Remainder of that rounding, m.
    pub position_low: Option<&'a Plane<Vector>>,
    /// Position in the camera frame (x right, y down, z forward and negative behind), m.
    pub camera_space_position: Option<&'a Plane<Vector>>,
    /// Identity of the instance.
    pub instance: Option<&'a Plane<Identity>>,
    /// Identity of the class.
    pub semantic: Option<&'a Plane<Identity>>,
    /// Identity of the material.
    pub material: Option<&'a Plane<Identity>>,
    /// Kind of ray of the pixel: 0 none, 1 the principal ray, 2 one through the centroid of the open pupil.
    pub ray: Option<&'a Plane<Identity>>,
    /// Intersection of the ray with the camera's mirror, camera frame, m; NaN if there is none.
    pub mirror: Option<&'a Plane<Vector>>,
}

/// Encodes the planes of `truth` in one file.
///
/// # Errors
/// If there is no plane, or planes have different sizes.
pub fn encode_ground_truth(truth: &GroundTruth<'_>, provenance: &Provenance) -> Result<Vec<u8>, EncodeError> {
    ground_truth_from_planes(truth, provenance)?.into_bytes()
}

/// Returns [`encode_ground_truth`]'s image before encoding.
///
/// # Errors
/// There is no plane.
pub fn ground_truth_from_planes<'a>(
    truth: &GroundTruth<'a>,
    provenance: &Provenance,
) -> Result<ExrImage<'a>, EncodeError> {
    let (width, height) = truth.size().ok_or(EncodeError::NoChannels)?;
    let mut image = ExrImage::new(width, height, provenance);
    for (name, layer) in truth.layers() {
        match layer {
            TruthLayer::Float(samples) => image.float(name, samples),
            TruthLayer::Component(vectors, axis) => image.add(name, ChannelSource::Component(vectors, axis)),
            TruthLayer::Uint(samples) => image.uint(name, samples),
        }
    }
    let has_gaps = truth.depth.is_some_and(|depth| depth.samples().iter().any(|z| z.is_nan()));
    state(&mut image, truth, has_gaps);
    Ok(image)
}

/// Ground truth computed some rows at a time.
pub trait GroundTruthRows: Send + Sync {
    /// Passes the planes of some rows to `take`: the same planes for all rows.
    fn rows(&self, rows: Range<usize>, take: &mut dyn FnMut(&GroundTruth<'_>));
}

/// Returns the same file of `width` × `height` pixels for writing, whose rows are computed on demand. `has_gaps` is true if the depth of some pixel is NaN.
#[must_use]
pub fn ground_truth_image<'a>(
    width: usize,
    height: usize,
    has_gaps: bool,
    rows: impl GroundTruthRows + 'a,
    provenance: &Provenance,
) -> ExrImage<'a> {
    let mut image = ExrImage::new(width, height, provenance);
    rows.rows(0..1, &mut |truth| {
        for (place, (name, layer)) in truth.layers().into_iter().enumerate() {
            match layer {
                TruthLayer::Float(_) | TruthLayer::Component(..) => image.add(name, ChannelSource::StripFloat(place)),
                TruthLayer::Uint(_) => image.add(name, ChannelSource::StripUint(place)),
            }
        }
        state(&mut image, truth, has_gaps);
    });
    image.strips = Some(Box::new(TruthStrips(rows)));
    image
}

struct TruthStrips<T>(T);

impl<T: GroundTruthRows> Strips for TruthStrips<T> {
    fn rows(&self, rows: Range<usize>) -> Result<Vec<SampleRows>, String> {
        let mut strips = Vec::new();
        self.0.rows(rows, &mut |truth| {
            strips = truth.layers().into_iter().map(|(_, layer)| layer.samples()).collect();
        });
        Ok(strips)
    }
}

/// The samples of a channel.
enum TruthLayer<'a> {
    Float(&'a [f32]),
    Component(&'a [[f32; 3]], usize),
    Uint(&'a [u32]),
}

impl TruthLayer<'_> {
    fn samples(&self) -> SampleRows {
        match self {
            Self::Float(samples) => SampleRows::Float(samples.to_vec()),
            Self::Component(vectors, axis) => SampleRows::Float(vectors.iter().map(|v| v[*axis]).collect()),
            Self::Uint(samples) => SampleRows::Uint(samples.to_vec()),
        }
    }
}

/// States the header facts of the planes.
fn state(image: &mut ExrImage<'_>, truth: &GroundTruth<'_>, has_gaps: bool) {
    image.state("quantity", "ground truth");
    let metres = [
        ("depth", truth.depth.is_some()),
        ("distance", truth.distance.is_some()),
        ("P", truth.position.is_some()),
        ("P_low", truth.position_low.is_some()),
        ("P_camera", truth.camera_space_position.is_some()),
        ("mirror", truth.mirror.is_some()),
    ];
    let metres: Vec<_> = metres.into_iter().filter_map(|(name, is_there)| is_there.then_some(name)).collect();
    image.state("units", format!("{}: m; N: 1; ID: identity, 0 is the background", metres.join(", ")));
    if has_gaps {
        image.state("depth", "NaN where a pixel has no ray, and where it looks sideways, back or at a mirror: distance.Z is defined there");
    }
    if truth.camera_space_position.is_some() {
        image.state("P_camera", "camera frame (x right, y down, z forward, negative behind), m; 0 for the sky");
    }
    if truth.position_low.is_some() {
        image.state("P_low", "P + P_low is the position, m: what P is rounded by to 32 bits");
    }
    if truth.mirror.is_some() {
        image.state("mirror", "point of the mirror, camera frame (x right, y down, z forward), m; NaN: beside it");
    }
    image.state("sampling", "point sample on the principal ray, never filtered; sky at +inf");
}

impl<'a> GroundTruth<'a> {
    /// Channels of the planes that are present.
    fn layers(&self) -> Vec<(String, TruthLayer<'a>)> {
        let lengths = [("depth.Z", self.depth), ("distance.Z", self.distance)];
        let lengths = lengths
            .into_iter()
            .filter_map(|(name, plane)| Some((name.to_owned(), TruthLayer::Float(plane?.samples()))));
        let vectors = [
            ("N", self.normal),
            ("P", self.position),
            ("P_low", self.position_low),
            ("P_camera", self.camera_space_position),
            ("mirror", self.mirror),
        ];
        let vectors = vectors.into_iter().filter_map(|(name, plane)| Some((name, plane?)));
        let components = vectors.flat_map(|(name, plane)| {
            let component =
                move |(axis, letter)| (format!("{name}.{letter}"), TruthLayer::Component(plane.samples(), axis));
            ["X", "Y", "Z"].into_iter().enumerate().map(component)
        });
        let identities =
            [("instance", self.instance), ("semantic", self.semantic), ("material", self.material), ("ray", self.ray)];
        let identities = identities
            .into_iter()
            .filter_map(|(name, plane)| Some((format!("{name}.ID"), TruthLayer::Uint(plane?.samples()))));
        lengths.chain(components).chain(identities).collect()
    }

    fn size(&self) -> Option<(usize, usize)> {
        let lengths = [self.depth, self.distance].into_iter().flatten().map(|p| (p.width(), p.height()));
        let vectors = [self.normal, self.position, self.position_low, self.camera_space_position, self.mirror]
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
        image.add(format!("{layer}.{letter}"), ChannelSource::Component(plane.samples(), axis));
    }
}

/// Rays: origins (m) and unit directions in the camera's frame, the kind of ray of each pixel, and for a camera with a mirror the path from the pupil to the
/// origin (m).
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
