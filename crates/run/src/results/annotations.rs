//! Ground truth between frames, between cameras and of objects, in memory and as files.

use super::camera::CameraResults;
use super::metadata::add_time;
use super::writer::{Encoder, ResultWriter};
use crate::result_files::ResultFiles;
use etendue_core::Plane;
use etendue_core::quantity::{Disparity, Identity};
use etendue_io::Provenance;
use etendue_io::correspondence::{encode_flo, encode_kitti_disparity, encode_kitti_flow, encode_pfm};
use etendue_io::exr::{self, CryptomatteLayer, ExrImage, cryptomatte_image, encode_disparity, encode_motion};
use etendue_io::failure::Error;
use etendue_pipeline::boxes::{
    BoxPose, ObjectBoxes, PixelBox, SolidBox, WorldObject, object_boxes, silhouettes, world_objects,
};
use etendue_pipeline::frame_view::FrameView;
use etendue_pipeline::identity_coverage::{IdentityCoverage, IdentityFraction, identity_coverage};
use etendue_pipeline::motion::{MotionTruth, NeighbourTruth, disparity, motion_truth};
use etendue_pipeline::plan::{CorrespondenceFormat, Plan, Products};
use serde_json::{Value, json};
use std::collections::BTreeMap;

impl CameraResults {
    /// Returns optical flow, visibility and motion in space of the first frame: to the next frame, then to the previous one (none for frame 0). Traced at
    /// each call, on the caller's thread pool. Without a frame rate all frames are at one time.
    #[must_use]
    pub fn motion_truth(&self) -> MotionTruth {
        let here = self.frame_view();
        let before = here.frame.checked_sub(1);
        let others: Vec<FrameView<'_>> =
            [Some(here.frame + 1), before].into_iter().flatten().map(|frame| FrameView { frame, ..here }).collect();
        motion_truth(&self.plan, &here, &others, self.simd)
    }

    /// Returns the disparity to the camera that the job names, and the visibility of each point there, of the first frame; `None` if the job names no camera.
    /// Traced at each call, on the caller's thread pool.
    #[must_use]
    pub fn disparity(&self) -> Option<(Plane<Disparity>, Plane<Identity>)> {
        let here = self.frame_view();
        let right = self.camera().products.annotations.disparity?.right;
        let camera = self.plan.cameras.iter().find(|camera| camera.index == right)?;
        Some(disparity(&self.plan, &here, &FrameView { camera, ..here }, self.simd))
    }

    /// Returns the boxes of the objects in the first frame. Traced at each call, on the caller's thread pool.
    #[must_use]
    pub fn boxes(&self) -> Vec<ObjectBoxes> {
        object_boxes(&self.plan, &self.frame_view(), &self.ground_truth().instance, self.simd)
    }

    /// Returns the content of `boxes.json`, with names, classes and conventions.
    #[must_use]
    pub fn boxes_json(&self) -> Value {
        self.boxes_json_of(&self.ground_truth().instance)
    }

    /// Does the same for the known identities of [`ground_truth`](Self::ground_truth).
    #[must_use]
    pub fn boxes_json_of(&self, instances: &Plane<Identity>) -> Value {
        let boxes = object_boxes(&self.plan, &self.frame_view(), instances, self.simd);
        boxes_json(&self.plan, &self.frame_view(), &boxes)
    }

    /// Returns, by identity, the pixels (row by row from the top left) that would show each object of the first frame if it were alone, or that show it in
    /// the ground truth's `instances`. Traced at each call, on the caller's thread pool.
    #[must_use]
    pub fn silhouettes(&self, instances: &Plane<Identity>) -> BTreeMap<u32, Vec<usize>> {
        silhouettes(&self.plan, &self.frame_view(), instances, self.simd)
    }

    /// Returns all objects of the world at the middle of a frame's first exposure, visible to the camera or not.
    #[must_use]
    pub fn world_objects(&self, frame: u32) -> Vec<WorldObject> {
        world_objects(&self.plan, self.camera().timing.capture(frame, 0).middle_s())
    }

    fn frame_view(&self) -> FrameView<'_> {
        FrameView { camera: self.camera(), frame: self.frame_numbers().start }
    }

    pub(super) fn write_annotations(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let annotations = &self.camera().products.annotations;
        if annotations.needs_neighbours() {
            self.write_motion(writer)?;
        }
        if annotations.boxes {
            writer.json(&self.file(ResultFiles::BOXES), &self.boxes_json())?;
        }
        if annotations.cryptomatte {
            writer.exr(&self.file(ResultFiles::CRYPTOMATTE), self.cryptomatte_image())?;
        }
        self.write_disparity(writer)
    }

    /// Returns the coverage of each pixel of the first frame by objects and materials. Traced at each call, on the caller's thread pool.
    #[must_use]
    pub fn identity_coverage(&self) -> IdentityCoverage {
        identity_coverage(&self.plan, self.camera(), self.frame_numbers().start, self.simd)
    }

    /// Returns the coverage as the bytes of a Cryptomatte: layers `CryptoObject` and `CryptoMaterial`, with the names of the plan.
    ///
    /// # Errors
    /// It cannot be stored.
    pub fn cryptomatte(&self) -> Result<Vec<u8>, Error> {
        let bytes = self.cryptomatte_image().into_bytes();
        bytes.map_err(|error| Error::Run(format!("{}: {error}", ResultFiles::CRYPTOMATTE)))
    }

    fn cryptomatte_image(&self) -> ExrImage<'static> {
        cryptomatte_image_of(&self.identity_coverage(), &self.plan, &self.provenance())
    }

    fn write_motion(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let (truth, facts) = (self.motion_truth(), self.provenance());
        let products = &self.camera().products;
        let mut files: Vec<(String, Encoder<'_>)> =
            vec![(self.file(ResultFiles::MOTION), Box::new(|| encode_motion(&planes(&truth, products), &facts)))];
        let flow = &truth.neighbours[0].flow;
        match products.annotations.optical_flow {
            None | Some(CorrespondenceFormat::Exr) => {}
            Some(CorrespondenceFormat::Middlebury) => {
                files.push((self.file(ResultFiles::FLOW_FLO), Box::new(|| encode_flo(flow))));
            }
            Some(CorrespondenceFormat::Kitti) => {
                files.push((self.file(ResultFiles::FLOW_PNG), Box::new(|| encode_kitti_flow(flow))));
            }
        }
        writer.write_all(files)
    }

    fn write_disparity(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let Some((disparity, visibility)) = self.disparity() else { return Ok(()) };
        let product = self.camera().products.annotations.disparity.expect("disparity is asked for");
        let right =
            self.plan.cameras.iter().find(|camera| camera.index == product.right).expect("a camera of the plan");
        let facts: Provenance = self.provenance();
        let exr = encode_disparity(&disparity, &visibility, &right.name, &facts);
        writer.write(&self.file(ResultFiles::DISPARITY), exr)?;
        match product.format {
            CorrespondenceFormat::Exr => Ok(()),
            CorrespondenceFormat::Middlebury => {
                let bytes = encode_pfm(disparity.width(), disparity.samples());
                writer.write(&self.file(ResultFiles::DISPARITY_PFM), bytes)
            }
            CorrespondenceFormat::Kitti => {
                writer.write(&self.file(ResultFiles::DISPARITY_PNG), encode_kitti_disparity(&disparity))
            }
        }
    }
}

/// The requested layers.
fn planes<'a>(truth: &'a MotionTruth, products: &Products) -> exr::MotionTruth<'a> {
    let annotations = &products.annotations;
    let flow = annotations.optical_flow.is_some();
    let neighbour = |neighbour_truth: &'a NeighbourTruth| exr::NeighbourTruth {
        flow: flow.then_some(&neighbour_truth.flow),
        visibility: flow.then_some(&neighbour_truth.visibility),
        scene_flow: annotations.scene_flow.then_some(&neighbour_truth.scene_flow),
    };
    exr::MotionTruth {
        forward: truth.neighbours.first().map(neighbour),
        backward: truth.neighbours.get(1).map(neighbour),
        motion_vector: flow.then_some(&truth.motion_vector),
        velocity: annotations.scene_flow.then_some(&truth.velocity),
        time: Some(&truth.time),
    }
}

/// The content of `boxes.json` for a frame.
fn boxes_json(plan: &Plan, frame: &FrameView<'_>, boxes: &[ObjectBoxes]) -> Value {
    let raster = &frame.camera.body.raster;
    let (width, height) = (raster.width(), raster.height());
    let mut facts = json!({
        "camera": frame.camera.name,
        "frame": frame.frame,
        "width_px": width,
        "height_px": height,
        "conventions": {
            "boxes": "left, top, right, bottom; raster coordinates, px: a pixel (x, y) fills x to x + 1 and y to y + 1",
            "visible_box_px": "encloses the pixels that show the object; null: none",
            "amodal_box_px": "encloses the whole object, also beyond the image; if is_cut, only the parts that are imaged",
            "amodal_box_in_picture_px": "encloses the part of the whole object within the image, including occluded parts; null: none",
            "visible_fraction": "visible pixels over the pixels of the unoccluded object",
            "truncated_fraction": "fraction of the amodal box's area outside the image; null if is_cut",
            "box_3d": "along the object's axes (x forward, y left, z up) at time_s: size; centre and rotation (quaternion w, x, y, z) in the \
                       camera's frame (x right, y down, z forward) and in the world (x forward, y left, z up)",
            "id": "as instance.ID of the ground truth, the same in all frames",
        },
        "objects": boxes.iter().map(|object| object_json(plan, width, height, object)).collect::<Vec<_>>(),
    });
    let timing = &frame.camera.timing;
    add_time(&mut facts, timing, "time", timing.frame_middle(frame.frame));
    facts
}

fn object_json(plan: &Plan, width: usize, height: usize, object: &ObjectBoxes) -> Value {
    let identity = plan.identity(object.id);
    json!({
        "id": object.id,
        "name": identity.map(|identity| &identity.name),
        "class": identity.and_then(|identity| identity.class.as_ref()),
        "visible_box_px": object.visible.map(edges),
        "amodal_box_px": object.amodal.map(edges),
        "amodal_box_in_picture_px": object.amodal_in_picture.map(edges),
        "is_cut": object.is_cut,
        "visible_pixels": object.visible_pixels,
        "alone_pixels": object.alone_pixels,
        "visible_fraction": object.visible_fraction(),
        "truncated_fraction": object.truncated_fraction(width, height),
        "box_3d": solid(&object.solid),
    })
}

fn edges(pixel_box: PixelBox) -> [f64; 4] {
    pixel_box.edges_px()
}

fn solid(solid_box: &SolidBox) -> Value {
    json!({ "size_m": solid_box.size_m.to_array(), "world": stance(&solid_box.world), "camera": stance(&solid_box.camera) })
}

fn stance(pose: &BoxPose) -> Value {
    let [x, y, z, w] = pose.rotation.to_array();
    json!({ "centre_m": pose.centre_m.to_array(), "rotation_wxyz": [w, x, y, z] })
}

/// Layers of objects and of materials.
fn cryptomatte_image_of(coverage: &IdentityCoverage, plan: &Plan, provenance: &Provenance) -> ExrImage<'static> {
    let objects = numbered(plan.identities.iter().map(|identity| identity.name.as_str()));
    let materials = numbered(plan.materials.iter().map(String::as_str));
    let (ranked_objects, ranked_materials) =
        (ranked_identities(&coverage.instances), ranked_identities(&coverage.materials));
    let layers = [
        CryptomatteLayer { name: "CryptoObject", names: &objects, pixels: &ranked_objects },
        CryptomatteLayer { name: "CryptoMaterial", names: &materials, pixels: &ranked_materials },
    ];
    cryptomatte_image(coverage.width, coverage.height, &layers, provenance)
}

/// Ids count from 1 in the order of the plan.
fn numbered<'a>(names: impl Iterator<Item = &'a str>) -> BTreeMap<u32, &'a str> {
    (1..).zip(names).collect()
}

fn ranked_identities(pixels: &[Vec<IdentityFraction>]) -> Vec<Vec<(u32, f32)>> {
    pixels.iter().map(|pixel| pixel.iter().map(|identity| (identity.id, identity.coverage)).collect()).collect()
}
