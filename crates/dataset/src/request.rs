//! Request of a data set, and its variations: changes of keys with their places in a file.

use std::{ops::Range, path::PathBuf};

use clap::Args;
use etendue::{Error, JobRequest, Simd};
use etendue_arguments::{Word, choice, frames, samples};
use etendue_scene::Place;
use etendue_scene::record::variations::{Distribution, Preset, SetFormat, Variation, Variations, WeightedChoice};

const FORMATS: [Word<SetFormat>; 11] = [
    (SetFormat::Coco, "coco", "Images, and one JSON file with boxes and masks"),
    (SetFormat::Kitti, "kitti", "Images, calibrations and labels of objects"),
    (SetFormat::Cityscapes, "cityscapes", "Images of label and instance ids"),
    (SetFormat::Yolo, "yolo", "Images, and boxes as lines of text"),
    (SetFormat::Bop, "bop", "Poses of objects, depth and masks"),
    (SetFormat::WebDataset, "webdataset", "Shards (tar) of images with ground truth"),
    (SetFormat::NuScenes, "nuscenes", "JSON tables of scenes, poses and boxes in space"),
    (SetFormat::Cryptomatte, "cryptomatte", "EXR files of objects and materials with their coverage"),
    (SetFormat::Mcap, "mcap", "ROS 2 messages: images, depth, point clouds, calibrations and poses"),
    (SetFormat::OpenLabel, "openlabel", "ASAM OpenLABEL: boxes in images and in space, JSON"),
    (SetFormat::Osi, "osi", "ASAM OSI: ground truth of the world's objects, protocol-buffer traces"),
];

/// A data set of a job.
#[derive(Args, Clone, Debug)]
pub struct DatasetRequest {
    /// The job and what is changed in it for all samples. Its seed stands in the place of that of the variations.
    #[arg(skip = JobRequest::new(""))]
    pub job: JobRequest,
    /// The variations file (TOML): keys of the job, its scene and its cameras with the distributions of their values [default: only
    /// noise varies]
    #[arg(long, value_name = "FILE")]
    pub variations: Option<PathBuf>,
    /// Samples to make, first to last (the last excluded); a sample does not depend on the others
    #[arg(long, value_name = "A..B", value_parser = samples, default_value = "0..1")]
    pub samples: Range<u32>,
    /// Frames of each sample, first to last (the last excluded)
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: Range<u32>,
    /// Formats to write, separated by commas [default: those of the variations file, or coco]
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

/// Change `key=value` in the form of `--set`, and its place in the file.
pub(crate) type Change = (String, Place);

/// Changes that give all keys of a variation a value.
pub(crate) fn value_changes<'a>(entry: &'a Variation, value: &'a str) -> impl Iterator<Item = Change> + 'a {
    entry.key.iter().map(move |key| (format!("{}={value}", key.value), key.place.clone()))
}

/// Changes of a preset's choice.
pub(crate) fn choice_changes(preset: &Preset, choice: usize) -> Vec<Change> {
    preset.choices[choice].iter().map(|change| (change.value.clone(), change.place.clone())).collect()
}

/// Refuses unknown keys and unaccepted values before anything is rendered. It tests the limits of every distribution and all values and choices, one at a time
/// in place of the sample's own: all errors are reported. `groups` are the sample's: of each preset, then of each variation.
pub(crate) fn check(variations: &Variations, groups: &[Vec<Change>], job: &JobRequest) -> Result<(), Error> {
    // Errors without any change are those of the job alone.
    job.check_changes(&[])?;
    let mut errors = Vec::new();
    for (place, alternatives) in alternatives(variations).iter().enumerate() {
        for alternative in alternatives {
            let mut all = groups.to_vec();
            all[place].clone_from(alternative);
            match job.check_changes(&all.concat()) {
                Err(Error::Input(more)) => errors.extend(more),
                other => other?,
            }
        }
    }
    errors.sort_by(|a, b| (&a.file, a.line, a.column, &a.message).cmp(&(&b.file, b.line, b.column, &b.message)));
    errors.dedup();
    if errors.is_empty() { Ok(()) } else { Err(Error::Input(errors)) }
}

/// Choices of each preset, then the limits of each variation.
fn alternatives(variations: &Variations) -> Vec<Vec<Vec<Change>>> {
    let choices = |preset: &Preset| (0..preset.choices.len()).map(|choice| choice_changes(preset, choice)).collect();
    let ends = |entry: &Variation| {
        ends(&entry.distribution).iter().map(|value| value_changes(entry, value).collect()).collect()
    };
    variations.presets.iter().map(choices).chain(variations.vary.iter().map(ends)).collect()
}

/// Minimum and maximum value, or all values.
fn ends(distribution: &Distribution) -> Vec<String> {
    let numbers = |numbers: &[f64]| numbers.iter().map(|number| number_text(*number)).collect();
    match distribution {
        Distribution::Uniform(range) => numbers(&[range.min.value, range.max.value]),
        Distribution::LogUniform(range) => numbers(&[range.min.value, range.max.value]),
        Distribution::Normal(normal) => {
            let bounds = [Some(&normal.mean), normal.min.as_ref(), normal.max.as_ref()];
            numbers(&bounds.into_iter().flatten().map(|bound| bound.value).collect::<Vec<_>>())
        }
        Distribution::Integer(range) => vec![range.min.value.to_string(), range.max.value.to_string()],
        Distribution::Choice(choice) => choice_texts(choice),
    }
}

/// Values of a choice as TOML.
pub(crate) fn choice_texts(choice: &WeightedChoice) -> Vec<String> {
    choice.values.iter().map(etendue_scene::written::Item::in_one_line).collect()
}

/// A number as TOML: the shortest that reads back to the same bits.
pub(crate) fn number_text(number: f64) -> String {
    etendue_scene::written::Item::from(number).in_one_line()
}
