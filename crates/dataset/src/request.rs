//! What is asked for.

use clap::Args;
use etendue::{JobRequest, Simd};
use etendue_arguments::{Word, choice, frames, samples};
use etendue_scene::record::variations::SetFormat;
use std::ops::Range;
use std::path::PathBuf;

const FORMATS: [Word<SetFormat>; 11] = [
    (SetFormat::Coco, "coco", "Pictures, and one JSON file with boxes and masks"),
    (SetFormat::Kitti, "kitti", "Pictures, calibrations and labels of objects"),
    (SetFormat::Cityscapes, "cityscapes", "Pictures of label and instance ids"),
    (SetFormat::Yolo, "yolo", "Pictures, and boxes as lines of text"),
    (SetFormat::Bop, "bop", "Poses of objects, depth and masks"),
    (SetFormat::WebDataset, "webdataset", "Shards (tar) of pictures with their truth"),
    (SetFormat::NuScenes, "nuscenes", "JSON tables of scenes, poses and boxes in space"),
    (SetFormat::Cryptomatte, "cryptomatte", "EXR files of objects and materials with their coverage"),
    (SetFormat::Mcap, "mcap", "Messages of ROS 2: pictures, depth, point clouds, calibrations and poses"),
    (SetFormat::OpenLabel, "openlabel", "ASAM OpenLABEL: boxes in pictures and in space, JSON"),
    (SetFormat::Osi, "osi", "ASAM OSI: ground truth of the world's objects, traces of protocol buffers"),
];

/// A data set of a job.
#[derive(Args, Clone, Debug)]
pub struct DatasetRequest {
    /// The job and what is changed in it for all samples. Its seed stands in the place of that of the variations.
    #[arg(skip = JobRequest::new(""))]
    pub job: JobRequest,
    /// The variations file (TOML): keys of the job, its scene and its cameras with how their values are drawn [default: nothing
    /// varies but noise]
    #[arg(long, value_name = "FILE")]
    pub variations: Option<PathBuf>,
    /// Samples to make, first to last (the last excluded); each is the same alone or among all
    #[arg(long, value_name = "A..B", value_parser = samples, default_value = "0..1")]
    pub samples: Range<u32>,
    /// Frames of each sample, first to last (the last excluded)
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: Range<u32>,
    /// Formats to write, with commas between them [default: those of the variations file, or coco]
    #[arg(long = "format", value_name = "FORMAT", value_delimiter = ',', value_parser = choice(FORMATS))]
    pub formats: Vec<SetFormat>,
    /// The instruction set; the result does not depend on it.
    #[arg(skip)]
    pub simd: Simd,
}

impl DatasetRequest {
    /// One sample of one frame, in the format that the variations name.
    #[must_use]
    pub fn new(job: JobRequest) -> Self {
        Self { job, variations: None, formats: Vec::new(), samples: 0..1, frames: 0..1, simd: Simd::Auto }
    }
}
