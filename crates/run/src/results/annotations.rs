//! Ground truth between frames, between cameras and of objects: in memory, and as files.

use super::boxes::boxes_json;
use super::camera::CameraResults;
use super::cryptomatte::cryptomatte_image_of;
use super::products::{FileEntries, ProductFiles, Stage};
use super::writer::{Encoder, ResultWriter};
use crate::result_files::{Files, entry};
use etendue_core::Plane;
use etendue_core::quantity::{Disparity, Identity};
use etendue_io::Provenance;
use etendue_io::correspondence::{encode_flo, encode_kitti_disparity, encode_kitti_flow, encode_pfm};
use etendue_io::exr::{self, ExrImage, encode_disparity, encode_motion};
use etendue_io::failure::Error;
use etendue_pipeline::boxes::{ObjectBoxes, WorldObject, object_boxes, silhouettes, world_objects};
use etendue_pipeline::frame_view::FrameView;
use etendue_pipeline::identity_coverage::{IdentityCoverage, identity_coverage};
use etendue_pipeline::motion::{MotionTruth, NeighbourTruth, disparity, motion_truth};
use etendue_pipeline::plan::{CorrespondenceFormat, Products};
use serde_json::Value;
use std::collections::BTreeMap;

/// The files of what lies between frames, between cameras and of objects.
pub(super) const ANNOTATIONS: ProductFiles =
    ProductFiles { entries, stage: Stage::GroundTruth, write: |results, writer| results.write_annotations(writer) };

fn entries(products: &Products, files: &mut FileEntries) {
    let asked = &products.annotations;
    let flow = entry("optical flow to the next frame", "px");
    let layers = "flow, visibility, image velocity, scene flow, velocity and time, as far as asked for";
    files.add(asked.needs_neighbours(), Files::MOTION, entry(layers, "px, 1, px/s, m, m/s, s"));
    files.add(asked.optical_flow == Some(CorrespondenceFormat::Middlebury), Files::FLOW_FLO, flow.clone());
    files.add(asked.optical_flow == Some(CorrespondenceFormat::Kitti), Files::FLOW_PNG, flow);
    let disparity = asked.disparity.map(|asked| asked.format);
    files.add(disparity.is_some(), Files::DISPARITY, entry("disparity, visibility", "px, 1"));
    let map = entry("disparity; infinite where it is not known", "px");
    files.add(disparity == Some(CorrespondenceFormat::Middlebury), Files::DISPARITY_PFM, map);
    let picture = entry("disparity; 0 where it is not known", "1/256 px");
    files.add(disparity == Some(CorrespondenceFormat::Kitti), Files::DISPARITY_PNG, picture);
    files.add(asked.boxes, Files::BOXES, entry("boxes of objects in the picture and in space", "px, m"));
    let ranked = "objects and materials of each pixel by falling coverage, Cryptomatte 1.2";
    files.add(asked.cryptomatte, Files::CRYPTOMATTE, entry(ranked, "1"));
}

impl CameraResults {
    /// Optical flow, visibility and motion in space of the first of the frames: against the next frame, and then against the one before it,
    /// but for frame 0, before which there is none. Traced anew at each call, on the caller's thread pool. Where no period of frames is stated
    /// all frames are one moment.
    #[must_use]
    pub fn motion_truth(&self) -> MotionTruth {
        let here = self.frame_view();
        let before = here.frame.checked_sub(1);
        let others: Vec<FrameView<'_>> =
            [Some(here.frame + 1), before].into_iter().flatten().map(|frame| FrameView { frame, ..here }).collect();
        motion_truth(&self.plan, &here, &others, self.simd)
    }

    /// Disparity to the camera that the job names, and whether that sees each point, of the first of the frames; `None` where it names none. Traced
    /// anew at each call, on the caller's thread pool.
    #[must_use]
    pub fn disparity(&self) -> Option<(Plane<Disparity>, Plane<Identity>)> {
        let here = self.frame_view();
        let right = self.camera().products.annotations.disparity?.right;
        let camera = self.plan.cameras.iter().find(|camera| camera.index == right)?;
        Some(disparity(&self.plan, &here, &FrameView { camera, ..here }, self.simd))
    }

    /// The boxes of the objects in the first of the frames. Traced anew at each call, on the caller's thread pool.
    #[must_use]
    pub fn boxes(&self) -> Vec<ObjectBoxes> {
        object_boxes(&self.plan, &self.frame_view(), &self.ground_truth().instance, self.simd)
    }

    /// The same as `boxes.json` says it, with names, classes and conventions.
    #[must_use]
    pub fn boxes_json(&self) -> Value {
        self.boxes_json_of(&self.ground_truth().instance)
    }

    /// The same of identities that are known, those of [`ground_truth`](Self::ground_truth).
    #[must_use]
    pub fn boxes_json_of(&self, instances: &Plane<Identity>) -> Value {
        let boxes = object_boxes(&self.plan, &self.frame_view(), instances, self.simd);
        boxes_json(&self.plan, &self.frame_view(), &boxes)
    }

    /// The pixels (row by row from the top left) that would show each object of the first of the frames were it alone, or that show it in the ground
    /// truth's `instances`, by identity. Traced anew at each call, on the caller's thread pool.
    #[must_use]
    pub fn silhouettes(&self, instances: &Plane<Identity>) -> BTreeMap<u32, Vec<usize>> {
        silhouettes(&self.plan, &self.frame_view(), instances, self.simd)
    }

    /// All objects of the world half-way through a frame's first exposure, whether the camera sees them or not.
    #[must_use]
    pub fn world_objects(&self, frame: u32) -> Vec<WorldObject> {
        world_objects(&self.plan, self.camera().timing.capture(frame, 0).middle_s())
    }

    fn frame_view(&self) -> FrameView<'_> {
        FrameView { camera: self.camera(), frame: self.frame_numbers().start }
    }

    pub(super) fn write_annotations(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let asked = &self.camera().products.annotations;
        if asked.needs_neighbours() {
            self.write_motion(writer)?;
        }
        if asked.boxes {
            writer.json(&self.file(Files::BOXES), &self.boxes_json())?;
        }
        if asked.cryptomatte {
            writer.exr(&self.file(Files::CRYPTOMATTE), self.cryptomatte_image())?;
        }
        self.write_disparity(writer)
    }

    /// Which objects and materials the pixels of the first of the frames see, and how much of each they cover. Traced anew at each call, on the caller's thread pool.
    #[must_use]
    pub fn identity_coverage(&self) -> IdentityCoverage {
        identity_coverage(&self.plan, self.camera(), self.frame_numbers().start, self.simd)
    }

    /// The same as the bytes of a Cryptomatte: layers `CryptoObject` and `CryptoMaterial`, by the names of the plan.
    ///
    /// # Errors
    /// Where it cannot be stored.
    pub fn cryptomatte(&self) -> Result<Vec<u8>, Error> {
        let bytes = self.cryptomatte_image().into_bytes();
        bytes.map_err(|error| Error::Run(format!("{}: {error}", Files::CRYPTOMATTE)))
    }

    fn cryptomatte_image(&self) -> ExrImage<'static> {
        cryptomatte_image_of(&self.identity_coverage(), &self.plan, &self.provenance())
    }

    fn write_motion(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let (truth, facts) = (self.motion_truth(), self.provenance());
        let products = &self.camera().products;
        let mut files: Vec<(String, Encoder<'_>)> =
            vec![(self.file(Files::MOTION), Box::new(|| encode_motion(&planes(&truth, products), &facts)))];
        let flow = &truth.neighbours[0].flow;
        match products.annotations.optical_flow {
            None | Some(CorrespondenceFormat::Exr) => {}
            Some(CorrespondenceFormat::Middlebury) => {
                files.push((self.file(Files::FLOW_FLO), Box::new(|| encode_flo(flow))));
            }
            Some(CorrespondenceFormat::Kitti) => {
                files.push((self.file(Files::FLOW_PNG), Box::new(|| encode_kitti_flow(flow))));
            }
        }
        writer.write_together(files)
    }

    fn write_disparity(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let Some((disparity, seen)) = self.disparity() else { return Ok(()) };
        let asked = self.camera().products.annotations.disparity.expect("disparity is asked for");
        let right = self.plan.cameras.iter().find(|camera| camera.index == asked.right).expect("a camera of the plan");
        let facts: Provenance = self.provenance();
        let exr = encode_disparity(&disparity, &seen, &right.name, &facts);
        writer.write(&self.file(Files::DISPARITY), exr)?;
        match asked.format {
            CorrespondenceFormat::Exr => Ok(()),
            CorrespondenceFormat::Middlebury => {
                let bytes = encode_pfm(disparity.width(), disparity.samples());
                writer.write(&self.file(Files::DISPARITY_PFM), bytes)
            }
            CorrespondenceFormat::Kitti => {
                writer.write(&self.file(Files::DISPARITY_PNG), encode_kitti_disparity(&disparity))
            }
        }
    }
}

/// The layers that are asked for.
fn planes<'a>(truth: &'a MotionTruth, products: &Products) -> exr::MotionTruth<'a> {
    let asked = &products.annotations;
    let flow = asked.optical_flow.is_some();
    let neighbour = |found: &'a NeighbourTruth| exr::NeighbourTruth {
        flow: flow.then_some(&found.flow),
        visibility: flow.then_some(&found.visibility),
        scene_flow: asked.scene_flow.then_some(&found.scene_flow),
    };
    exr::MotionTruth {
        forward: truth.neighbours.first().map(neighbour),
        backward: truth.neighbours.get(1).map(neighbour),
        motion_vector: flow.then_some(&truth.motion_vector),
        velocity: asked.scene_flow.then_some(&truth.velocity),
        time: Some(&truth.time),
    }
}
