//! Image with its ground truth, from a camera's results.
//!
//! Masks are stored as COCO's run lengths.
//!
//! Pixels are taken column by column; runs of pixels outside and inside alternate, beginning outside. The text of the runs is that of COCO's API
//! (`rleToString`, Lin et al. 2014): from the fourth run on the difference to the run two before, in groups of five bits from the lowest, each with a bit that
//! is set if more follow, plus 48.

use core::cell::OnceCell;
use std::collections::BTreeMap;

use etendue::{CameraPlan, CameraResults, Error, ErrorCode, GroundTruth, WorldObject, camera_mount, pinhole_view};
use etendue_core::{CameraPose, Plane, quantity::Display};
use glam::DQuat;

use crate::draw::Split;
use crate::record::{ImageRecord, Pose, objects};

/// Image of a sample with its ground truth.
pub(crate) struct SampleImage<'a> {
    /// Number and split of its sample.
    pub(crate) sample: (u32, Split),
    pub(crate) record: ImageRecord,
    /// Bytes of the file.
    pub(crate) bytes: Vec<u8>,
    pub(crate) truth: &'a GroundTruth,
    /// Display-referred image.
    pub(crate) display: &'a Plane<Display>,
    results: &'a CameraResults,
    /// Made on first use, for all frames of the results.
    cryptomatte: &'a OnceCell<Vec<u8>>,
}

impl SampleImage<'_> {
    /// Coverage of objects and materials, as the bytes of a Cryptomatte file.
    pub(crate) fn cryptomatte(&self) -> Result<&[u8], Error> {
        if let Some(known) = self.cryptomatte.get() {
            return Ok(known);
        }
        let encoded = self.results.cryptomatte()?;
        Ok(self.cryptomatte.get_or_init(|| encoded))
    }

    /// Camera of the image.
    pub(crate) fn camera(&self) -> &CameraPlan {
        self.results.camera()
    }

    /// All objects of the world at the image's time.
    pub(crate) fn world_objects(&self) -> Vec<WorldObject> {
        self.results.world_objects(self.record.frame)
    }

    /// Pixels of each object without occlusion.
    pub(crate) fn silhouettes(&self) -> BTreeMap<u32, Vec<usize>> {
        self.results.silhouettes(&self.truth.instance)
    }
}

/// Passes on the images of a camera's frames, one after the other; `warn` receives the pixels without valid light.
pub(crate) fn each(
    results: &CameraResults,
    number: u32,
    split: Split,
    warn: &dyn Fn(&str),
    mut take: impl FnMut(&SampleImage<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let truth = results.ground_truth();
    let (width_px, height_px) = (truth.instance.width(), truth.instance.height());
    let masks = run_lengths(truth.instance.samples(), width_px);
    let mut objects = objects(results.boxes_json_of(&truth.instance));
    for object in &mut objects {
        object.mask_rle = masks.get(&object.id).map(|runs| text(runs));
    }
    let camera = results.name();
    let cryptomatte = OnceCell::new();
    let view = pinhole_view(results.camera()).ok();
    for (frame, frame_result) in results.frame_numbers().zip(results.frames()) {
        let file = results.image_file(&frame_result).ok_or_else(|| no_image(camera))?;
        let display = &frame_result.picture.as_ref().ok_or_else(|| no_image(camera))?.display;
        if (display.width(), display.height()) != (width_px, height_px) {
            let problem =
                "its images are a region, or of binned or skipped pixels, but its ground truth is of all pixels";
            return Err(Error::coded(
                ErrorCode::UnsupportedOutput,
                format!("camera {camera}: {problem}; remove these keys"),
            ));
        }
        if !frame_result.raw.invalid.is_empty() {
            let count = frame_result.raw.invalid.len();
            warn(&format!("{camera}, frame {frame}: pixels without valid light, whose digital number is 0: {count}"));
        }
        let (extension, bytes) = file?;
        let (pose, time) = results.pose(frame);
        let record = ImageRecord {
            camera: camera.to_owned(),
            frame,
            time_s: time.seconds(),
            time: (!time.is_number()).then(|| time.to_string()),
            extension: extension.to_owned(),
            width_px,
            height_px,
            camera_matrix_px: view.map(|view| view.matrix_px),
            pose: pose_record(&pose),
            mount: camera_mount(results.camera()).as_ref().map(pose_record),
            objects: objects.clone(),
        };
        take(&SampleImage {
            sample: (number, split),
            record,
            bytes,
            truth: &truth,
            display,
            results,
            cryptomatte: &cryptomatte,
        })?;
    }
    Ok(())
}

/// Error for a camera without processing.
pub(crate) fn no_image(camera: &str) -> Error {
    Error::coded(
        ErrorCode::UnavailableOutput,
        format!("camera {camera}: it makes no image; give it a sensor with electronics and [isp]"),
    )
}

fn pose_record(pose: &CameraPose) -> Pose {
    let [x, y, z, w] = DQuat::from_mat3(&pose.rotation).to_array();
    Pose { position_m: pose.position_m.to_array(), rotation_wxyz: [w, x, y, z] }
}

/// Run lengths of every identity except 0, for `width` columns.
fn run_lengths(ids: &[u32], width: usize) -> BTreeMap<u32, Vec<u32>> {
    let height = ids.len().checked_div(width).unwrap_or(0);
    let mut runs: BTreeMap<u32, RunLengths> = BTreeMap::new();
    for at in 0..ids.len() {
        let id = ids[(at % height) * width + at / height];
        if id > 0 {
            runs.entry(id).or_default().add(at);
        }
    }
    runs.into_iter().map(|(id, runs)| (id, runs.ended(ids.len()))).collect()
}

/// Runs so far.
#[derive(Default)]
struct RunLengths {
    lengths: Vec<u32>,
    /// One past the last pixel inside.
    end: usize,
}

impl RunLengths {
    /// Adds a pixel inside, after all others.
    fn add(&mut self, at: usize) {
        match self.lengths.last_mut() {
            Some(inside) if at == self.end => *inside += 1,
            _ => self.lengths.extend([(at - self.end) as u32, 1]),
        }
        self.end = at + 1;
    }

    fn ended(mut self, pixels: usize) -> Vec<u32> {
        if self.end < pixels {
            self.lengths.push((pixels - self.end) as u32);
        }
        self.lengths
    }
}

/// The text of run lengths.
pub(crate) fn text(runs: &[u32]) -> String {
    let mut text = String::new();
    for (i, run) in runs.iter().enumerate() {
        let before = if i > 2 { i64::from(runs[i - 2]) } else { 0 };
        let mut remaining = i64::from(*run) - before;
        loop {
            let bits = (remaining & 0x1f) as u8;
            remaining >>= 5;
            let ends = if bits & 0x10 != 0 { remaining == -1 } else { remaining == 0 };
            text.push(char::from(48 + if ends { bits } else { bits | 0x20 }));
            if ends {
                break;
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_go_down_the_columns_and_begin_outside() {
        // Columns: 1 1, 2 0, 1 2.
        let runs = run_lengths(&[1, 2, 1, 1, 0, 2], 3);
        assert_eq!(runs[&1], [0, 2, 2, 1, 1]);
        assert_eq!(runs[&2], [2, 1, 2, 1]);
        assert!(run_lengths(&[], 0).is_empty());
    }

    #[test]
    fn texts_are_those_of_coco_s_api() {
        // From pycocotools 2.0.11, mask.frPyObjects of the same counts.
        assert_eq!(text(&[0, 2, 2, 1, 1]), "022OO");
        assert_eq!(text(&[6, 1, 40, 4, 5, 4, 5, 4, 21]), "61X13mN000`0");
    }
}
