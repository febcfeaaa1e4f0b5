//! A variations file: what differs from sample to sample of a data set, and how its files are laid out.

use super::render::MAX_SEED;
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{
    RuleExt as _, any_value, choice, either, keyed_by_name, list, number, record, text, variants, whole, words,
};
use crate::written::Item;

/// Most samples of a data set: their numbers have six digits in names of files.
pub const MAX_SAMPLES: u64 = 1_000_000;

record! {
    /// What `etendue dataset` varies, sample after sample. Each draw is a function of the seed, the number of the sample and the key (of a preset: its
    /// name) alone.
    pub struct Variations check(check) {
        /// The seed of all draws and of each sample's light and noise. Default: 0.
        optional seed: Placed<u64> = whole(0, MAX_SEED);
        /// Formats that are written, as `--format` names them, which comes before this. Default: "coco".
        many formats: Placed<SetFormat> = list(choice(), 1);
        /// The part of the samples, drawn each by itself, that is for validation ("val"); the others are for training ("train"). Default: 0.
        optional validation_fraction: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Samples of a shard of "webdataset". Default: 1000.
        optional shard_samples: Placed<u64> = whole(1, MAX_SAMPLES);
        /// The unit of depth in "bop", mm; 65 535 of them are the greatest depth. Default: 1.
        optional bop_depth_unit_mm: Placed<f64> = number("mm").above(0.0);
        /// The classes of Cityscapes for classes of the scene: `{ car_body = "car" }`. A class that is not listed has the label of its own name, "-" and "_"
        /// being blanks, or "unlabeled" where Cityscapes has none of that name.
        many cityscapes_labels: (Placed<String>, Placed<String>) = keyed_by_name(text("a label of Cityscapes"));
        /// The types of KITTI for classes of the scene: `{ bike = "Cyclist" }`. A class that is not listed has its own name with a capital letter ("person":
        /// "Pedestrian"), and is left out where KITTI has none of that name.
        many kitti_types: (Placed<String>, Placed<String>) = keyed_by_name(text("a type of KITTI"));
        /// Keys that are drawn; each sample draws every one.
        many vary: Variation = list(record(), 1);
        /// Changes of several keys that belong together; each sample draws one choice of every preset.
        many presets: Preset = list(record(), 1);
    }
}

words! {
    /// Formats of data sets.
    pub enum SetFormat {
        /// COCO: pictures, and one JSON file with boxes and masks.
        "coco" => Coco,
        /// KITTI: pictures, calibrations and labels of objects.
        "kitti" => Kitti,
        /// Cityscapes: pictures of label and instance ids.
        "cityscapes" => Cityscapes,
        /// YOLO: pictures, and boxes as lines of text.
        "yolo" => Yolo,
        /// BOP: poses of objects, depth and masks.
        "bop" => Bop,
        /// WebDataset: shards (tar) of pictures with their truth.
        "webdataset" => WebDataset,
        /// nuScenes: JSON tables of scenes, poses and boxes in space.
        "nuscenes" => NuScenes,
        /// Cryptomatte: EXR files of objects and materials with their coverage.
        "cryptomatte" => Cryptomatte,
        /// MCAP: messages of ROS 2, pictures, depth, point clouds, calibrations and poses.
        "mcap" => Mcap,
        /// ASAM OpenLABEL: boxes in pictures and in space, JSON.
        "openlabel" => OpenLabel,
        /// ASAM OSI: ground truth of the world's objects, a trace of protocol buffers.
        "osi" => Osi,
    }
}

record! {
    /// A key of the job, its scene or a camera, and how its value is drawn.
    pub struct Variation {
        /// The dotted key, as of `--set`: "scene.environment.luminance_cd_m2", "cameras.front.lens.f_number", "scene.objects.car.position_m.0" (the first of
        /// a list). Several keys in a list have the same value.
        required key: Vec<Placed<String>> = either(
            text("a dotted key").map(|key| vec![key], |keys| (keys.len() == 1).then(|| keys[0].clone())),
            list(text("a dotted key"), 1),
        );
        /// How its value is drawn.
        inside distribution: Distribution;
    }
}

variants! {
    /// How a value is drawn.
    pub enum Distribution by "type" {
        /// Every number from "min" to "max" alike.
        "uniform" => Uniform(Uniform),
        /// Normally distributed numbers.
        "normal" => Normal(Normal),
        /// Numbers whose logarithm is uniform.
        "log_uniform" => LogUniform(LogUniform),
        /// Every whole number from "min" to "max", both included, alike.
        "integer" => Integer(Integer),
        /// One of some values.
        "choice" => Choice(ChoiceOf),
    }
}

record! {
    /// Every number alike.
    pub struct Uniform check(check_uniform) {
        /// The least, in the unit of the key.
        required min: Placed<f64> = number("");
        /// The greatest, which is not drawn itself.
        required max: Placed<f64> = number("");
    }
}

record! {
    /// Normally distributed numbers; with "min" or "max" those within, drawn until one is (a truncated normal distribution).
    pub struct Normal check(check_normal) {
        /// The mean, in the unit of the key.
        required mean: Placed<f64> = number("");
        /// The standard deviation, above 0.
        required standard_deviation: Placed<f64> = number("").above(0.0);
        /// The least, at most the mean. Default: none.
        optional min: Placed<f64> = number("");
        /// The greatest, at least the mean. Default: none.
        optional max: Placed<f64> = number("");
    }
}

record! {
    /// Numbers whose logarithm is uniform.
    pub struct LogUniform check(check_log_uniform) {
        /// The least, above 0, in the unit of the key.
        required min: Placed<f64> = number("").above(0.0);
        /// The greatest, which is not drawn itself.
        required max: Placed<f64> = number("").above(0.0);
    }
}

record! {
    /// Whole numbers.
    pub struct Integer check(check_integer) {
        /// The least.
        required min: Placed<u64> = whole(0, MAX_SEED);
        /// The greatest, which is drawn as well.
        required max: Placed<u64> = whole(0, MAX_SEED);
    }
}

record! {
    /// One of some values.
    pub struct ChoiceOf check(check_choice) {
        /// The values, each as the key takes it: numbers, texts, lists, tables.
        required values: Vec<Item> = list(any_value(), 1);
        /// How often each is drawn, in proportion; 0 for never. Default: all alike.
        many weights: Placed<f64> = list(number("").at_least(0.0), 1);
    }
}

record! {
    /// Choices of changes that belong together: clear weather or fog.
    pub struct Preset check(check_preset) {
        /// Its name, by which it is drawn and recorded.
        required name: Placed<String> = text("the name of the preset");
        /// The choices, each a list of changes as of `--set`: "scene.environment.luminance_cd_m2=80"; an empty list changes nothing, and "key=null" takes
        /// the key out.
        required choices: Vec<Vec<Placed<String>>> = list(list(text("a change KEY=VALUE"), 0), 1);
        /// How often each is drawn, in proportion; 0 for never. Default: all alike.
        many weights: Placed<f64> = list(number("").at_least(0.0), 1);
    }
}

fn check(file: &Variations, faults: &mut Faults) {
    if file.vary.is_empty() && file.presets.is_empty() {
        let remedy = "add [[vary]] with a \"key\" and a \"type\" of distribution, or [[presets]]";
        faults.add(ErrorCode::Empty, &file.place, "this names no key that varies", remedy);
    }
    let keys = file.vary.iter().flat_map(|entry| &entry.key);
    unique(keys, "is varied twice", "keep one of the two", faults);
    unique(file.presets.iter().map(|preset| &preset.name), "is the name of two presets", "rename one", faults);
    for key in file.vary.iter().flat_map(|entry| &entry.key).filter(|key| key.contains('=')) {
        faults.add(
            ErrorCode::InvalidChange,
            &key.place,
            format!("found the change \"{}\"", key.value),
            "give the key alone",
        );
    }
}

fn unique<'a>(names: impl Iterator<Item = &'a Placed<String>>, problem: &str, remedy: &str, faults: &mut Faults) {
    let mut known = Vec::new();
    for name in names {
        if known.contains(&&name.value) {
            faults.add(ErrorCode::Duplicate, &name.place, format!("\"{}\" {problem}", name.value), remedy);
        }
        known.push(&name.value);
    }
}

fn check_uniform(range: &Uniform, faults: &mut Faults) {
    check_range(&range.min, &range.max, faults);
}

fn check_log_uniform(range: &LogUniform, faults: &mut Faults) {
    check_range(&range.min, &range.max, faults);
}

fn check_range(min: &Placed<f64>, max: &Placed<f64>, faults: &mut Faults) {
    if min.value >= max.value {
        let problem = format!("\"max\" is {} and \"min\" is {}", max.value, min.value);
        faults.add(ErrorCode::WrongOrder, &max.place, problem, "give a \"max\" above \"min\"");
    } else if !(max.value - min.value).is_finite() {
        faults.add(
            ErrorCode::OutOfRange,
            &max.place,
            "\"max\" less \"min\" is beyond what 64 bits hold",
            "give a shorter range",
        );
    }
}

fn check_integer(range: &Integer, faults: &mut Faults) {
    if range.min.value > range.max.value {
        let problem = format!("\"max\" is {} and \"min\" is {}", range.max.value, range.min.value);
        faults.add(ErrorCode::WrongOrder, &range.max.place, problem, "give a \"max\" of at least \"min\"");
    }
}

/// So that at least one number of some fifty is within: 4 % of a normal distribution lie within a tenth of its deviation beside the mean.
fn check_normal(normal: &Normal, faults: &mut Faults) {
    let (mean, least) = (normal.mean.value, 0.1 * normal.standard_deviation.value);
    if let Some(min) = normal.min.as_ref().filter(|min| min.value > mean) {
        faults.add(
            ErrorCode::WrongOrder,
            &min.place,
            format!("\"min\" is above the mean {mean}"),
            "give a \"min\" of at most the mean",
        );
    }
    if let Some(max) = normal.max.as_ref().filter(|max| max.value < mean) {
        faults.add(
            ErrorCode::WrongOrder,
            &max.place,
            format!("\"max\" is below the mean {mean}"),
            "give a \"max\" of at least the mean",
        );
    }
    if let (Some(min), Some(max)) = (&normal.min, &normal.max)
        && max.value - min.value < least
    {
        let problem = format!("\"min\" and \"max\" are nearer than a tenth of the standard deviation, {least}");
        faults.add(ErrorCode::OutOfRange, &max.place, problem, "give a wider range, or type = \"uniform\"");
    }
}

fn check_choice(choice: &ChoiceOf, faults: &mut Faults) {
    check_weights(&choice.weights, choice.values.len(), faults);
}

fn check_preset(preset: &Preset, faults: &mut Faults) {
    check_weights(&preset.weights, preset.choices.len(), faults);
    for change in preset.choices.iter().flatten().filter(|change| !change.contains('=')) {
        faults.add(
            ErrorCode::InvalidChange,
            &change.place,
            format!("\"{}\" is no change", change.value),
            "give KEY=VALUE",
        );
    }
}

fn check_weights(weights: &[Placed<f64>], choices: usize, faults: &mut Faults) {
    let Some(first) = weights.first() else { return };
    if weights.len() != choices {
        let problem = format!("found {} weights of {choices} choices", weights.len());
        faults.add(ErrorCode::WrongCount, &first.place, problem, "give a weight for each choice");
    } else if weights.iter().map(|weight| weight.value).sum::<f64>() <= 0.0 {
        faults.add(
            ErrorCode::Degenerate,
            &first.place,
            "all weights are 0, and nothing can be drawn",
            "give one of them a weight above 0",
        );
    }
}
