//! `etendue dataset`: a job varied sample after sample, in the formats of those who train and test by pictures.

use crate::args::choice::{Word, choice};
use crate::args::folder::Output;
use crate::args::job::JobArgs;
use crate::args::run::{frames, samples, whole};
use crate::console::{Console, print_paths};
use crate::machine;
use clap::Args;
use etendue::{Error, Existing, JobRequest};
use etendue_dataset::{DatasetRequest, SetFormat, dataset};
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

/// `etendue dataset`
#[derive(Debug, Args)]
pub struct Dataset {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub output: Output,
    /// The variations file (TOML): keys of the job, its scene and its cameras with how their values are drawn [default: nothing
    /// varies but noise]
    #[arg(long, value_name = "FILE")]
    pub variations: Option<PathBuf>,
    /// Samples to make, first to last (the last excluded); each is the same alone or among all
    #[arg(long, value_name = "A..B", value_parser = samples, default_value = "0..1")]
    pub samples: std::ops::Range<u32>,
    /// Frames of each sample, first to last (the last excluded)
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: std::ops::Range<u32>,
    /// Formats to write, with commas between them [default: those of the variations file, or coco]
    #[arg(long, value_delimiter = ',', value_parser = choice(FORMATS))]
    pub format: Vec<SetFormat>,
    /// Go on with the data set that is in the folder: samples that are whole are kept, and more may be added
    #[arg(long, conflicts_with = "overwrite")]
    pub resume: bool,
    /// Worker threads [default: one a processor]. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = whole(1, 1024))]
    pub threads: Option<u32>,
}

impl Dataset {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let simd = machine::simd()?;
        let pool = machine::pool(self.threads)?;
        let request = DatasetRequest {
            job: JobRequest::from(&self.job).into_output(&self.output.output),
            variations: self.variations.clone(),
            formats: self.format.clone(),
            samples: self.samples.clone(),
            frames: self.frames.clone(),
            simd,
        };
        let (folder, existing) = self.output.folder();
        let existing = if self.resume { Existing::Resume } else { existing };
        let written = pool.install(|| dataset(&request, (folder, existing), console.observer()))?;
        print_paths(console, &written);
        Ok(())
    }
}
