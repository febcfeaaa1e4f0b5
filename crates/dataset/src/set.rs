//! Common data of all samples: cameras, classes, formats; and the file that states them.

use std::ops::Range;

use etendue::{Error, ErrorCode, Job, pinhole_view, ros_view};
use etendue_scene::Placed;
use etendue_scene::record::variations::{SetFormat, Variations};
use serde_json::{Value, json};

use crate::{picture::no_image, request::DatasetRequest};

/// Common data of all samples.
pub(crate) struct Set {
    pub(crate) seed: u64,
    pub(crate) formats: Vec<SetFormat>,
    pub(crate) frames: Range<u32>,
    /// Camera names, in the order of the job.
    pub(crate) cameras: Vec<String>,
    /// Rectified pairs: the left and the right camera.
    pub(crate) pairs: Vec<(String, String)>,
    /// Names and ids of the scene's classes, in the order of ids.
    pub(crate) classes: Vec<(String, u32)>,
    pub(crate) variations: Option<Variations>,
    /// Content of `dataset.json`.
    pub(crate) facts: Value,
}

impl Set {
    /// Returns the set of a request and its job without variations. Refuses cameras that a format cannot describe.
    pub(crate) fn new(
        request: &DatasetRequest,
        job: &Job,
        variations: Option<Variations>,
        text_hash: Option<String>,
    ) -> Result<Self, Error> {
        let stated = variations.as_ref().and_then(|v| v.seed.as_ref()).map(|seed| seed.value);
        let seed = request.job.seed.or(stated).unwrap_or(0);
        let formats = formats(request, variations.as_ref());
        check_cameras(job, &formats)?;
        let plan = job.plan();
        if let Some(variations) = &variations {
            check_class_names(variations, &plan.classes)?;
        }
        let mut classes = plan.classes.clone();
        classes.sort_by_key(|(_, id)| *id);
        let cameras: Vec<String> = plan.cameras.iter().map(|camera| camera.name.clone()).collect();
        let pairs = plan.cameras.iter().filter_map(|left| {
            let right = left.products.annotations.disparity?.right;
            let right = plan.cameras.iter().find(|camera| camera.index == right)?;
            Some((left.name.clone(), right.name.clone()))
        });
        let pairs = pairs.collect();
        let facts = json!({
            "format": 1,
            "program": format!("etendue {}", env!("CARGO_PKG_VERSION")),
            "plan": plan.hash_text(),
            "variations": text_hash,
            "seed": seed,
            "formats": formats.iter().map(|format| name(*format)).collect::<Vec<_>>(),
            "frames": [request.frames.start, request.frames.end],
            "cameras": cameras,
            "classes": classes.iter().map(|(name, id)| json!({ "name": name, "id": id })).collect::<Vec<_>>(),
        });
        Ok(Self { seed, formats, frames: request.frames.clone(), cameras, pairs, classes, variations, facts })
    }

    /// Id of a class; `None` for an object without one.
    pub(crate) fn class_id(&self, class: Option<&str>) -> Option<u32> {
        self.classes.iter().find(|(name, _)| Some(name.as_str()) == class).map(|(_, id)| *id)
    }

    /// Index among the classes, from 0.
    pub(crate) fn class_place(&self, class: Option<&str>) -> Option<usize> {
        self.classes.iter().position(|(name, _)| Some(name.as_str()) == class)
    }

    /// Images of a camera per sample.
    pub(crate) fn frame_count(&self) -> u64 {
        u64::from(self.frames.end - self.frames.start)
    }

    /// Keys of the variations that no format of the run uses, in sentences.
    pub(crate) fn unused_keys(&self) -> Vec<String> {
        let Some(file) = &self.variations else { return Vec::new() };
        let keys = [
            (file.shard_samples.is_some(), "shard_samples", SetFormat::WebDataset),
            (file.bop_depth_unit_mm.is_some(), "bop_depth_unit_mm", SetFormat::Bop),
            (!file.cityscapes_labels.is_empty(), "cityscapes_labels", SetFormat::Cityscapes),
            (!file.kitti_types.is_empty(), "kitti_types", SetFormat::Kitti),
        ];
        let idle = keys.into_iter().filter(|(is_given, _, format)| *is_given && !self.formats.contains(format));
        idle.map(|(_, key, format)| format!("\"{key}\" has no effect without the format {}", name(format))).collect()
    }

    /// Refuses a sample whose cameras a format cannot describe.
    pub(crate) fn check_cameras(&self, job: &Job) -> Result<(), Error> {
        check_cameras(job, &self.formats)
    }

    /// Refuses a sample with other classes: numbers would differ in meaning between files.
    pub(crate) fn check_classes(&self, job: &Job, sample: u32) -> Result<(), Error> {
        let mut classes = job.plan().classes.clone();
        classes.sort_by_key(|(_, id)| *id);
        if classes == self.classes {
            return Ok(());
        }
        let problem = "its scene has other [classes] than that of the unchanged job";
        Err(Error::coded(
            ErrorCode::Contradiction,
            format!("sample {sample}: {problem}; give all scenes that are varied the same classes"),
        ))
    }
}

/// Requested formats, each once; else those of the file, else COCO.
fn formats(request: &DatasetRequest, variations: Option<&Variations>) -> Vec<SetFormat> {
    let stated = variations.map_or(Vec::new(), |v| v.formats.iter().map(|format| format.value).collect());
    let requested = [&request.formats, &stated].into_iter().find(|list| !list.is_empty()).cloned();
    let mut formats = requested.unwrap_or_else(|| vec![SetFormat::Coco]);
    formats.sort_unstable();
    formats.dedup();
    formats
}

/// The word of a format.
pub(crate) fn name(format: SetFormat) -> &'static str {
    match format {
        SetFormat::Coco => "coco",
        SetFormat::Kitti => "kitti",
        SetFormat::Cityscapes => "cityscapes",
        SetFormat::Yolo => "yolo",
        SetFormat::Bop => "bop",
        SetFormat::WebDataset => "webdataset",
        SetFormat::NuScenes => "nuscenes",
        SetFormat::Cryptomatte => "cryptomatte",
        SetFormat::Mcap => "mcap",
        SetFormat::OpenLabel => "openlabel",
        SetFormat::Osi => "osi",
    }
}

/// Refuses names for classes that the scene does not have.
fn check_class_names(variations: &Variations, classes: &[(String, u32)]) -> Result<(), Error> {
    let names = variations.cityscapes_labels.iter().chain(&variations.kitti_types).map(|(class, _)| class);
    let unknown = names.filter(|name| !classes.iter().any(|(known, _)| *known == name.value));
    let known = || classes.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
    if let Some((_, kind)) = variations.kitti_types.iter().find(|(_, kind)| kind.value.contains(char::is_whitespace)) {
        let problem = "a KITTI type is one word, the first column of its labels; remove the spaces";
        return Err(Error::coded(
            ErrorCode::UnsupportedOutput,
            format!("{}: \"{}\": {problem}", kind.place, kind.value.escape_debug()),
        ));
    }
    let message = |name: &Placed<String>| {
        format!("{}: the scene has no class \"{}\"; give one of its [classes]: {}", name.place, name.value, known())
    };
    let messages: Vec<String> = unknown.map(message).collect();
    if messages.is_empty() { Ok(()) } else { Err(Error::all_coded(ErrorCode::UnknownName, messages)) }
}

/// Maximum length of a camera name in an archive, whose names have 100 characters.
const MAX_NAME_IN_TAR: usize = 69;

fn check_cameras(job: &Job, formats: &[SetFormat]) -> Result<(), Error> {
    let needs_matrix = [SetFormat::Kitti, SetFormat::Bop, SetFormat::NuScenes];
    let needs_png = [SetFormat::Kitti, SetFormat::Cityscapes];
    let names: Vec<&str> = job.plan().cameras.iter().map(|camera| camera.name.as_str()).collect();
    for camera in &job.plan().cameras {
        let refuse = |format: SetFormat, why: &str| {
            Err(Error::argument("formats", format!("`formats` {}: camera {}: {why}", name(format), camera.name))
                .with_code(ErrorCode::UnsupportedOutput))
        };
        let Some(development) = &camera.body.development else { return Err(no_image(&camera.name)) };
        if let Some(format) = formats.iter().find(|format| needs_png.contains(format))
            && development.format.extension() != "png"
        {
            return refuse(*format, "its images are JPEG, but the format needs PNG; set isp.format to \"png\"");
        }
        if formats.contains(&SetFormat::WebDataset) && camera.name.len() > MAX_NAME_IN_TAR {
            return refuse(
                SetFormat::WebDataset,
                &format!("its name is longer than {MAX_NAME_IN_TAR} characters; rename it"),
            );
        }
        if let Some((format, why)) = unfit_name(&camera.name, &names, formats) {
            return refuse(format, &why);
        }
        if let Some(format) = formats.iter().find(|format| needs_matrix.contains(format))
            && let Err(why) = pinhole_view(camera)
        {
            return refuse(*format, &format!("{why}; remove the format, or use a lens without distortion"));
        }
        if formats.contains(&SetFormat::Mcap)
            && pinhole_view(camera).is_err()
            && let Err(why) = ros_view(camera)
        {
            let remedy = "remove the format, or use a projection that ROS has";
            return refuse(SetFormat::Mcap, &format!("{why}; {remedy}"));
        }
    }
    Ok(())
}

/// A format that does not support a camera of this name, and the reason.
fn unfit_name(name: &str, names: &[&str], formats: &[SetFormat]) -> Option<(SetFormat, String)> {
    let with_world = [SetFormat::Mcap, SetFormat::OpenLabel].into_iter().find(|format| formats.contains(format))?;
    if name == "world" {
        return Some((with_world, "\"world\" is the name of the cameras' reference frame; rename it".to_owned()));
    }
    let has_same_topic = |other: &&&str| **other != name && topic_name(other) == topic_name(name);
    let other = names.iter().find(has_same_topic).filter(|_| formats.contains(&SetFormat::Mcap))?;
    Some((SetFormat::Mcap, format!("its topics have the same names as those of {other}; rename it")))
}

/// Name of a camera in topics: ROS 2 allows letters, digits and underscores, and no leading digit.
pub(crate) fn topic_name(camera: &str) -> String {
    let name = camera.replace('-', "_");
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("camera_{name}") } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_cameras_that_formats_cannot_have_are_reported() {
        let refusal_of = |name, names: &[&str], format| {
            unfit_name(name, names, &[SetFormat::Coco, format]).map(|(format, _)| format)
        };
        assert_eq!(refusal_of("world", &["world"], SetFormat::Mcap), Some(SetFormat::Mcap));
        assert_eq!(refusal_of("world", &["world"], SetFormat::OpenLabel), Some(SetFormat::OpenLabel));
        assert_eq!(refusal_of("world", &["world"], SetFormat::Kitti), None);
        assert_eq!(refusal_of("a-b", &["a-b", "a_b"], SetFormat::Mcap), Some(SetFormat::Mcap));
        assert_eq!(refusal_of("a-b", &["a-b", "a_b"], SetFormat::OpenLabel), None);
        assert_eq!(refusal_of("a-b", &["a-b", "c"], SetFormat::Mcap), None);
        assert_eq!([topic_name("0-left"), topic_name("front")], ["camera_0_left", "front"]);
    }
}
