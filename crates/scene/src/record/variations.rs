//! A variations file: differences between the samples of a data set, and the layout of its files.

use super::render::MAX_SEED;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{
    RuleExt as _, any_value, choice, either, integer, keyed_by_name, list, number, record, text, variants, words,
};
use crate::written::Item;

/// Largest number of samples of a data set: file names have six digits for it.
pub const MAX_SAMPLES: u64 = 1_000_000;

record! {
    /// Variations between the samples of `etendue dataset`. Each drawn value depends only on the seed, the number of the sample and the key (of a
    /// preset: its name).
    pub struct Variations check(check) {
        /// Seed of drawn values, light and noise. Default: 0.
        optional seed: Placed<u64> = integer(0, MAX_SEED);
        /// Formats, as for `--format`, which overrides this. Default: "coco".
        many formats: Placed<SetFormat> = list(choice(), 1);
        /// Probability of "val"; other samples are "train". Default: 0.
        optional validation_fraction: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Samples per shard of "webdataset". Default: 1000.
        optional shard_samples: Placed<u64> = integer(1, MAX_SAMPLES);
        /// Unit of depth in "bop", at most 65 535 units. Default: 1.
        optional bop_depth_unit_mm: Placed<f64> = number("mm").above(0.0);
        /// Cityscapes classes: `{ car_body = "car" }`. Default: the name with blanks for "-" and "_", or "unlabeled".
        many cityscapes_labels: (Placed<String>, Placed<String>) = keyed_by_name(text("a label of Cityscapes"));
        /// KITTI types: `{ bike = "Cyclist" }`. Default: the capitalised name; omitted where KITTI has none.
        many kitti_types: (Placed<String>, Placed<String>) = keyed_by_name(text("a type of KITTI"));
        /// Keys that are drawn for every sample.
        many vary: Variation = list(record(), 1);
        /// Joint changes of keys; each sample draws one choice of each.
        many presets: Preset = list(record(), 1);
    }
}

words! {
    /// Formats of data sets.
    pub enum SetFormat {
        /// COCO: images, and one JSON file with boxes and masks.
        "coco" => Coco,
        /// KITTI: images, calibrations and labels of objects.
        "kitti" => Kitti,
        /// Cityscapes: images of label and instance ids.
        "cityscapes" => Cityscapes,
        /// YOLO: images, and boxes as lines of text.
        "yolo" => Yolo,
        /// BOP: poses of objects, depth and masks.
        "bop" => Bop,
        /// WebDataset: shards (tar) of images with ground truth.
        "webdataset" => WebDataset,
        /// nuScenes: JSON tables of scenes, poses and boxes in space.
        "nuscenes" => NuScenes,
        /// Cryptomatte: EXR files with the coverage of objects and materials.
        "cryptomatte" => Cryptomatte,
        /// MCAP: ROS 2 messages of images, depth, point clouds, calibrations and poses.
        "mcap" => Mcap,
        /// ASAM OpenLABEL: boxes in images and in space, JSON.
        "openlabel" => OpenLabel,
        /// ASAM OSI: ground truth of the world's objects, a trace of protocol buffers.
        "osi" => Osi,
    }
}

record! {
    /// A key of the job, its scene or a camera, and the distribution of its value.
    pub struct Variation {
        /// Dotted key, as for `--set` ("scene.objects.car.position_m.0"); keys of a list share the value.
        required key: Vec<Placed<String>> = either(
            text("a dotted key").map(|key| vec![key], |keys| (keys.len() == 1).then(|| keys[0].clone())),
            list(text("a dotted key"), 1),
        );
        /// Distribution of its value.
        inside distribution: Distribution;
    }
}

variants! {
    /// Distribution of a value.
    pub enum Distribution by "type" {
        /// Uniform between "min" and "max".
        "uniform" => Uniform(Uniform),
        /// Normal.
        "normal" => Normal(Normal),
        /// Uniform in the logarithm.
        "log_uniform" => LogUniform(LogUniform),
        /// Uniform over whole numbers.
        "integer" => Integer(Integer),
        /// One of several values.
        "choice" => Choice(WeightedChoice),
    }
}

record! {
    /// A uniform distribution.
    pub struct Uniform check(check_uniform) {
        /// Minimum.
        required min: Placed<f64> = number("");
        /// Maximum, excluded.
        required max: Placed<f64> = number("");
    }
}

record! {
    /// A normal distribution; with "min" or "max" truncated to that range.
    pub struct Normal check(check_normal) {
        /// Mean.
        required mean: Placed<f64> = number("");
        /// Standard deviation.
        required standard_deviation: Placed<f64> = number("").above(0.0);
        /// Minimum, at most the mean.
        optional min: Placed<f64> = number("");
        /// Maximum, at least the mean.
        optional max: Placed<f64> = number("");
    }
}

record! {
    /// A distribution uniform in the logarithm.
    pub struct LogUniform check(check_log_uniform) {
        /// Minimum.
        required min: Placed<f64> = number("").above(0.0);
        /// Maximum, excluded.
        required max: Placed<f64> = number("").above(0.0);
    }
}

record! {
    /// A uniform distribution of whole numbers.
    pub struct Integer check(check_integer) {
        /// Minimum.
        required min: Placed<u64> = integer(0, MAX_SEED);
        /// Maximum, included.
        required max: Placed<u64> = integer(0, MAX_SEED);
    }
}

record! {
    /// One of several values.
    pub struct WeightedChoice check(check_choice) {
        /// Values that the key accepts.
        required values: Vec<Item> = list(any_value(), 1);
        /// Relative frequencies. Default: equal.
        many weights: Placed<f64> = list(number("").at_least(0.0), 1);
    }
}

record! {
    /// Alternative sets of changes that belong together: clear weather or fog.
    pub struct Preset check(check_preset) {
        /// Name in the record of draws.
        required name: Placed<String> = text("the name of the preset");
        /// Choices, each a list of changes as for `--set`; an empty list changes nothing, "key=null" removes a key.
        required choices: Vec<Vec<Placed<String>>> = list(list(text("a change KEY=VALUE"), 0), 1);
        /// Relative frequencies. Default: equal.
        many weights: Placed<f64> = list(number("").at_least(0.0), 1);
    }
}

fn check(file: &Variations, errors: &mut DescriptionErrors) {
    if file.vary.is_empty() && file.presets.is_empty() {
        let remedy = "add [[vary]] with a \"key\" and a \"type\" of distribution, or [[presets]]";
        errors.add(ErrorCode::Empty, &file.place, "the file varies no key", remedy);
    }
    let keys = file.vary.iter().flat_map(|entry| &entry.key);
    unique(keys, "is varied twice", "keep one of the two", errors);
    unique(file.presets.iter().map(|preset| &preset.name), "is the name of two presets", "rename one", errors);
    for key in file.vary.iter().flat_map(|entry| &entry.key).filter(|key| key.contains('=')) {
        errors.add(
            ErrorCode::InvalidChange,
            &key.place,
            format!("found the change \"{}\" instead of a key", key.value),
            "give only the key",
        );
    }
}

fn unique<'a>(
    names: impl Iterator<Item = &'a Placed<String>>,
    problem: &str,
    remedy: &str,
    errors: &mut DescriptionErrors,
) {
    let mut known = Vec::new();
    for name in names {
        if known.contains(&&name.value) {
            errors.add(ErrorCode::Duplicate, &name.place, format!("\"{}\" {problem}", name.value), remedy);
        }
        known.push(&name.value);
    }
}

fn check_uniform(range: &Uniform, errors: &mut DescriptionErrors) {
    check_range(&range.min, &range.max, errors);
}

fn check_log_uniform(range: &LogUniform, errors: &mut DescriptionErrors) {
    check_range(&range.min, &range.max, errors);
}

fn check_range(min: &Placed<f64>, max: &Placed<f64>, errors: &mut DescriptionErrors) {
    if min.value >= max.value {
        let problem = format!("\"max\" is {} and \"min\" is {}", max.value, min.value);
        errors.add(ErrorCode::WrongOrder, &max.place, problem, "give a \"max\" above \"min\"");
    } else if !(max.value - min.value).is_finite() {
        errors.add(
            ErrorCode::OutOfRange,
            &max.place,
            "\"max\" − \"min\" exceeds the range of 64 bits",
            "give a shorter range",
        );
    }
}

fn check_integer(range: &Integer, errors: &mut DescriptionErrors) {
    if range.min.value > range.max.value {
        let problem = format!("\"max\" is {} and \"min\" is {}", range.max.value, range.min.value);
        errors.add(ErrorCode::WrongOrder, &range.max.place, problem, "give a \"max\" of at least \"min\"");
    }
}

/// Refuses a distribution with less than about one number in fifty within the limits: 4 % of a normal distribution lie within a tenth of a deviation
/// next to the mean.
fn check_normal(normal: &Normal, errors: &mut DescriptionErrors) {
    let (mean, lower) = (normal.mean.value, 0.1 * normal.standard_deviation.value);
    if let Some(min) = normal.min.as_ref().filter(|min| min.value > mean) {
        errors.add(
            ErrorCode::WrongOrder,
            &min.place,
            format!("\"min\" is above the mean {mean}"),
            "give a \"min\" of at most the mean",
        );
    }
    if let Some(max) = normal.max.as_ref().filter(|max| max.value < mean) {
        errors.add(
            ErrorCode::WrongOrder,
            &max.place,
            format!("\"max\" is below the mean {mean}"),
            "give a \"max\" of at least the mean",
        );
    }
    if let (Some(min), Some(max)) = (&normal.min, &normal.max)
        && max.value - min.value < lower
    {
        let problem = format!("\"min\" and \"max\" differ by less than a tenth of the standard deviation, {lower}");
        errors.add(ErrorCode::OutOfRange, &max.place, problem, "give a wider range, or type = \"uniform\"");
    }
}

fn check_choice(choice: &WeightedChoice, errors: &mut DescriptionErrors) {
    check_weights(&choice.weights, choice.values.len(), errors);
}

fn check_preset(preset: &Preset, errors: &mut DescriptionErrors) {
    check_weights(&preset.weights, preset.choices.len(), errors);
    for change in preset.choices.iter().flatten().filter(|change| !change.contains('=')) {
        errors.add(
            ErrorCode::InvalidChange,
            &change.place,
            format!("\"{}\" is not a change", change.value),
            "give KEY=VALUE",
        );
    }
}

fn check_weights(weights: &[Placed<f64>], choices: usize, errors: &mut DescriptionErrors) {
    let Some(first) = weights.first() else { return };
    if weights.len() != choices {
        let problem = format!("the numbers of weights ({}) and choices ({choices}) differ", weights.len());
        errors.add(ErrorCode::WrongCount, &first.place, problem, "give a weight for each choice");
    } else if weights.iter().map(|weight| weight.value).sum::<f64>() <= 0.0 {
        errors.add(
            ErrorCode::Degenerate,
            &first.place,
            "all weights are 0, so nothing can be selected",
            "give one of them a weight above 0",
        );
    }
}
