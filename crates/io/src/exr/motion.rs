//! Ground truth of motion as an EXR: correspondence of each pixel with the frames before and after it, and velocities.

use etendue_core::Plane;
use etendue_core::quantity::{Disparity, Identity, ImageVelocity, OpticalFlow, Quantity, Time, Vector};

use super::{channel::EncodeError, encode::ExrImage, ground_truth::add_vector};
use crate::Provenance;

/// State of a pixel's surface point in one neighbouring frame.
#[derive(Clone, Copy, Debug)]
pub struct NeighbourTruth<'a> {
    /// Image position in that frame minus the position here, px; NaN if it has no image there. `None` if not requested.
    pub flow: Option<&'a Plane<OpticalFlow>>,
    /// Visibility in that frame: [`VISIBILITY`]. `None` if not requested.
    pub visibility: Option<&'a Plane<Identity>>,
    /// Position in the camera's frame there minus that here, each in its own camera frame, m; NaN for the background. `None` if not requested.
    pub scene_flow: Option<&'a Plane<Vector>>,
}

/// Planes of motion ground truth of one frame; `None` for those that a job did not request.
#[derive(Clone, Copy, Debug, Default)]
pub struct MotionTruth<'a> {
    /// Correspondence with the next frame.
    pub forward: Option<NeighbourTruth<'a>>,
    /// Correspondence with the previous frame.
    pub backward: Option<NeighbourTruth<'a>>,
    /// Velocity of the image at the middle of the pixel's exposure, px/s.
    pub motion_vector: Option<&'a Plane<ImageVelocity>>,
    /// Velocity of the surface point in the world, m/s; NaN for the background.
    pub velocity: Option<&'a Plane<Vector>>,
    /// Time of the pixel's ground truth, s from the frame's start.
    pub time: Option<&'a Plane<Time>>,
}

/// Meaning of the numbers of a visibility plane.
pub const VISIBILITY: &str =
    "0 not known, 1 seen, 2 hidden by what is before it, 3 outside the picture, 4 no image by the lens";

/// Encodes the planes of `truth` in one file.
///
/// # Errors
/// If there is no plane, or planes have different sizes.
pub fn encode_motion(truth: &MotionTruth<'_>, provenance: &Provenance) -> Result<Vec<u8>, EncodeError> {
    let (width, height) = truth.size().ok_or(EncodeError::NoChannels)?;
    let mut image = ExrImage::new(width, height, provenance);
    for (direction, neighbour) in [("forward", truth.forward), ("backward", truth.backward)] {
        let Some(neighbour) = neighbour else { continue };
        if let Some(plane) = neighbour.flow {
            add_pair(&mut image, &format!("flow.{direction}"), plane.samples());
        }
        if let Some(plane) = neighbour.visibility {
            image.uint(format!("visibility.{direction}.ID"), plane.samples());
        }
        if let Some(plane) = neighbour.scene_flow {
            add_vector(&mut image, &format!("scene_flow.{direction}"), plane);
        }
    }
    if let Some(plane) = truth.motion_vector {
        add_pair(&mut image, "motion_vector", plane.samples());
    }
    if let Some(plane) = truth.velocity {
        add_vector(&mut image, "velocity", plane);
    }
    if let Some(plane) = truth.time {
        image.float("time.T", plane.samples());
    }
    image.state("quantity", "ground truth of motion");
    image.state("units", "flow: px; motion_vector: px/s; scene_flow: m, camera frames; velocity: m/s, world; time: s");
    image.state("flow", "place in the other frame minus place here, x right, y down; NaN: no image there");
    image.state("visibility", VISIBILITY);
    image.state("sampling", "point sample on the principal ray at the middle of the row's exposure, never filtered");
    image.into_bytes()
}

/// Encodes the disparity to a right camera, and the visibility of the point there, in one file.
///
/// # Errors
/// If planes have different sizes or none.
pub fn encode_disparity(
    disparity: &Plane<Disparity>,
    visibility: &Plane<Identity>,
    right: &str,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    let mut image = ExrImage::new(disparity.width(), disparity.height(), provenance);
    image.float("disparity.X", disparity.samples());
    image.uint("visibility.ID", visibility.samples());
    image.state("quantity", "disparity");
    image.state("units", "px; the column here minus that in the right camera's picture; NaN: no image there");
    image.state("right_camera", right);
    image.state("visibility", VISIBILITY);
    image.into_bytes()
}

impl MotionTruth<'_> {
    fn size(&self) -> Option<(usize, usize)> {
        fn plane_size<Q: Quantity>(plane: &Plane<Q>) -> (usize, usize) {
            (plane.width(), plane.height())
        }
        let neighbour =
            self.forward.or(self.backward).and_then(|n| n.flow.map(plane_size).or(n.scene_flow.map(plane_size)));
        neighbour.or(self.motion_vector.map(plane_size)).or(self.velocity.map(plane_size)).or(self.time.map(plane_size))
    }
}

fn add_pair(image: &mut ExrImage<'_>, layer: &str, samples: &[[f32; 2]]) {
    for (axis, letter) in ["X", "Y"].into_iter().enumerate() {
        image.float(format!("{layer}.{letter}"), samples.iter().map(|v| v[axis]).collect::<Vec<_>>());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exr::{ExrSamples, decode_exr};
    use std::path::Path;

    #[test]
    fn every_plane_has_its_layer_and_keeps_its_numbers() {
        let flow = Plane::<OpticalFlow>::filled(2, 1, [1.5, f32::NAN]);
        let ids = Plane::<Identity>::from_samples(2, 1, vec![1, 3]).expect("two pixels");
        let vector = Plane::<Vector>::filled(2, 1, [1.0, -2.0, 3.0]);
        let velocity = Plane::<ImageVelocity>::filled(2, 1, [-4.0, 5.0]);
        let time = Plane::<Time>::filled(2, 1, 0.25);
        let neighbour = NeighbourTruth { flow: Some(&flow), visibility: Some(&ids), scene_flow: Some(&vector) };
        let truth = MotionTruth {
            forward: Some(neighbour),
            backward: Some(NeighbourTruth { scene_flow: None, ..neighbour }),
            motion_vector: Some(&velocity),
            velocity: Some(&vector),
            time: Some(&time),
        };
        let bytes = encode_motion(&truth, &Provenance::default()).expect("encodable");
        let read = decode_exr(Path::new("motion.0000.exr"), &bytes).expect("our own");
        let names: Vec<&str> = read.channels.iter().map(|c| c.name.as_str()).collect();
        let layers = [
            "flow.backward.X",
            "flow.backward.Y",
            "flow.forward.X",
            "flow.forward.Y",
            "motion_vector.X",
            "motion_vector.Y",
            "scene_flow.forward.X",
            "scene_flow.forward.Y",
            "scene_flow.forward.Z",
            "time.T",
            "velocity.X",
            "velocity.Y",
            "velocity.Z",
            "visibility.backward.ID",
            "visibility.forward.ID",
        ];
        assert_eq!(names, layers);
        let first = |name: &str| read.channel(name).map(|samples| samples.to_floats()[0]);
        assert_eq!(first("flow.forward.X").zip(first("motion_vector.Y")), Some((1.5, 5.0)));
        assert!(first("flow.backward.Y").is_some_and(f32::is_nan));
        assert_eq!(read.channel("visibility.forward.ID"), Some(&ExrSamples::Uint(vec![1, 3])));
        assert_eq!(encode_motion(&MotionTruth::default(), &Provenance::default()), Err(EncodeError::NoChannels));
    }
}
