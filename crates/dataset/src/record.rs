//! Record of a sample: its changes and the ground truth of its images, in `samples/NNNNNN.json`.

use std::collections::BTreeMap;

use etendue::FileDigest;
use etendue_core::ExactTime;
use etendue_io::sidecar;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::draw::Split;

/// Complete sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SampleRecord {
    pub(crate) sample: u32,
    pub(crate) split: Split,
    /// Seed of its light and noise.
    pub(crate) seed: u64,
    /// Changes of keys, in the form of `--set`.
    pub(crate) set: Vec<String>,
    /// Hash of the sample's plan.
    pub(crate) plan: String,
    pub(crate) pictures: Vec<ImageRecord>,
    /// Digests of the sample's files, by their names in the data set's folder.
    pub(crate) files: BTreeMap<String, FileDigest>,
    /// Hash of everything else.
    pub(crate) sha256: Option<String>,
}

impl SampleRecord {
    /// Returns the same record with its hash.
    pub(crate) fn sealed(mut self) -> Self {
        self.sha256 = None;
        let bytes = sidecar::encode(&self).unwrap_or_default();
        self.sha256 = Some(FileDigest::from_bytes(&bytes).sha256);
        self
    }

    /// Returns true if it is unchanged since it was written.
    pub(crate) fn is_sealed(&self) -> bool {
        self.sha256.is_some() && self.clone().sealed().sha256 == self.sha256
    }
}

/// Image of a sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ImageRecord {
    pub(crate) camera: String,
    pub(crate) frame: u32,
    /// Middle of the exposure, s.
    pub(crate) time_s: f64,
    /// The same time with all digits, if the number is rounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) time: Option<String>,
    /// `png` or `jpg`.
    pub(crate) extension: String,
    pub(crate) width_px: usize,
    pub(crate) height_px: usize,
    /// fx, skew, cx, fy, cy in raster coordinates; `None` if images are not rectilinear.
    pub(crate) camera_matrix_px: Option<[f64; 5]>,
    /// Transform from the camera's frame to the world.
    pub(crate) pose: Pose,
    /// Transform from the camera's frame to the frame that carries it.
    pub(crate) mount: Option<Pose>,
    pub(crate) objects: Vec<ObjectRecord>,
}

impl ImageRecord {
    /// Returns the exact middle of the exposure.
    pub(crate) fn exact_time(&self) -> ExactTime {
        self.time.as_ref().and_then(|text| text.parse().ok()).unwrap_or_else(|| self.time_s.into())
    }
}

/// Position and rotation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pose {
    pub(crate) position_m: [f64; 3],
    pub(crate) rotation_wxyz: [f64; 4],
}

/// Object of an image: the keys of `boxes.json`, and its mask.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ObjectRecord {
    pub(crate) id: u32,
    pub(crate) name: String,
    pub(crate) class: Option<String>,
    pub(crate) visible_box_px: Option<[f64; 4]>,
    pub(crate) amodal_box_px: Option<[f64; 4]>,
    pub(crate) amodal_box_in_picture_px: Option<[f64; 4]>,
    pub(crate) is_cut: bool,
    pub(crate) visible_pixels: usize,
    pub(crate) alone_pixels: usize,
    pub(crate) visible_fraction: f64,
    pub(crate) truncated_fraction: Option<f64>,
    pub(crate) box_3d: SolidRecord,
    /// Visible pixels, as COCO's compressed run lengths; `None` if there are none.
    #[serde(default)]
    pub(crate) mask_rle: Option<String>,
}

/// Box in space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SolidRecord {
    pub(crate) size_m: [f64; 3],
    pub(crate) camera: BoxPose,
    pub(crate) world: BoxPose,
}

/// Pose of a box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BoxPose {
    pub(crate) centre_m: [f64; 3],
    pub(crate) rotation_wxyz: [f64; 4],
}

impl ImageRecord {
    /// Unique part of file names in the set.
    pub(crate) fn stem(&self, sample: u32) -> String {
        format!("{sample:06}_{}_{:04}", self.camera, self.frame)
    }

    /// Objects with a visible pixel, with their masks.
    pub(crate) fn visible(&self) -> impl Iterator<Item = (&ObjectRecord, &str, [f64; 4])> {
        self.objects.iter().filter_map(|object| Some((object, object.mask_rle.as_deref()?, object.visible_box_px?)))
    }
}

/// Objects of a frame's boxes.
pub(crate) fn objects(boxes: Value) -> Vec<ObjectRecord> {
    let Value::Object(mut boxes) = boxes else { return Vec::new() };
    let objects = boxes.remove("objects").unwrap_or_default();
    serde_json::from_value(objects).expect("objects of the library have the keys of boxes.json")
}
