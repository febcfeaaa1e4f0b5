//! Data sets: a sample is the same alone or among all, interrupted runs resume, and invalid variations are refused at their place.

use crate::support::{CommandOutput, contents, etendue, root, text};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

const JOB: &str = "scenes/cornell/cornell.toml";
const VARIATIONS: &str = "scenes/datasets/boxes.toml";
/// An image of few pixels, with suitable noise.
const SMALL: [&str; 7] = [
    "--set=cameras.front.sensor.width_px=24",
    "--set=cameras.front.sensor.height_px=18",
    "--set=cameras.front.sensor.pixel_pitch_um=1000",
    "--set=cameras.front.sensor.exposure_s=1e-5",
    "--spp=1",
    "--set=render.replicates=1",
    "--set=render.max_bounces=2",
];
const ALL: &str = "coco,kitti,cityscapes,yolo,bop,webdataset,nuscenes";

struct TestFolder(TempDir);

impl TestFolder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn arguments(&self, variations: &str, folder: &str, more: &[&str]) -> Vec<String> {
        let folder = text(&self.path(folder));
        let own = ["dataset", JOB, "--variations", variations, "-o", &folder];
        own.iter().chain(&SMALL).chain(more).map(|word| (*word).to_owned()).collect()
    }

    fn run(&self, folder: &str, more: &[&str]) -> CommandOutput {
        etendue(self.arguments(VARIATIONS, folder, more))
    }

    /// Runs with the given variations.
    fn run_of(&self, variations: &str, more: &[&str]) -> CommandOutput {
        let file = self.path("variations.toml");
        fs::write(&file, variations).expect("written");
        etendue(self.arguments(&text(&file), "out", more))
    }

    fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        contents(&self.path(folder))
    }
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).expect("a file")).expect("JSON")
}

#[test]
fn a_sample_is_the_same_alone_or_in_a_run_and_in_pieces() {
    let place = TestFolder::new();
    place.run("whole", &["--samples", "0..3", "--format", ALL]).ok();
    place.run("alone", &["--samples", "2..3", "--format", ALL, "--threads", "1"]).ok();
    let (all_files, alone) = (place.files("whole"), place.files("alone"));
    // Names of other samples' masks end with the number.
    let of_sample =
        |name: &&String| name.split('/').any(|part| part.starts_with("000002") || part.contains("front_000002"));
    let names: Vec<_> = all_files.keys().filter(of_sample).collect();
    assert!(names.len() > 12, "{names:?}");
    names.iter().for_each(|name| assert!(alone.get(*name) == all_files.get(*name), "{name}"));
    place.run("pieces", &["--samples", "2..3", "--format", ALL]).ok();
    place.run("pieces", &["--samples", "0..2", "--format", ALL]).refused(&["dataset.json", "--resume"]);
    place.run("pieces", &["--samples", "0..2", "--format", ALL, "--resume"]).ok();
    let pieces = place.files("pieces");
    all_files.iter().for_each(|(name, bytes)| assert!(pieces.get(name) == Some(bytes), "{name}"));
    assert_eq!(all_files.len(), pieces.len());
}

#[test]
fn a_sample_is_what_render_makes_of_its_changes() {
    let place = TestFolder::new();
    place.run("set", &["--samples", "5..6", "--format", "yolo", "--set=output.boxes=true"]).ok();
    let record = json(&place.path("set/samples/000005.json"));
    let changes: Vec<String> = record["set"]
        .as_array()
        .expect("changes")
        .iter()
        .map(|c| format!("--set={}", c.as_str().expect("a text")))
        .collect();
    let (out, seed) = (text(&place.path("render")), record["seed"].to_string());
    let own = ["render", JOB, "-o", &out, "--seed", &seed, "--set=output.boxes=true"];
    etendue(own.iter().copied().chain(SMALL).chain(changes.iter().map(String::as_str))).ok();
    let rendered = fs::read(place.path("render/front/picture.0000.png")).expect("a picture");
    let split = record["split"].as_str().expect("a split");
    let name = format!("set/yolo/images/{split}/000005_front_0000.png");
    assert!(fs::read(place.path(&name)).expect("a picture") == rendered);
    let boxes = json(&place.path("render/front/boxes.json"));
    let mut objects = record["pictures"][0]["objects"].clone();
    let masks: Vec<Value> = objects
        .as_array_mut()
        .expect("objects")
        .iter_mut()
        .map(|object| object.as_object_mut().expect("an object").remove("mask_rle").expect("a mask"))
        .collect();
    assert_eq!(objects, boxes["objects"]);
    assert!(
        masks
            .iter()
            .zip(boxes["objects"].as_array().expect("objects"))
            .all(|(mask, object)| mask.is_string() == (object["visible_pixels"] != 0))
    );
    assert_eq!(record["plan"], json(&place.path("render/front/camera.json"))["plan_hash"], "one plan");
}

#[test]
fn a_run_that_was_interrupted_goes_on_and_leaves_what_is_done() {
    let place = TestFolder::new();
    place.run("whole", &["--samples", "0..3"]).ok().says(&["\"kitti_types\" has no effect without the format kitti"]);
    place.run("part", &["--samples", "0..2"]).ok();
    // State after a kill: files of a sample without its record.
    fs::remove_file(place.path("part/samples/000001.json")).expect("it was there");
    let first = place.path("part/samples/000000.json");
    let before = fs::metadata(&first).expect("a file").modified().expect("a time");
    place.run("part", &["--samples", "0..3", "--resume"]).ok();
    assert_eq!(fs::metadata(&first).expect("a file").modified().expect("a time"), before, "it is left");
    assert!(place.files("part") == place.files("whole"));
    place.run("part", &["--samples", "0..4", "--resume", "--seed", "4"]).refused(&[
        "dataset.json",
        "a different ",
        "\"seed\"",
    ]);
    place
        .run("part", &["--samples", "0..4", "--overwrite", "--frames", "0..2"])
        .refused(&["a different ", "\"frames\""]);
}

/// The record of a sample states the digests of its files, and a hash of itself.
#[test]
fn incomplete_samples_are_computed_again() {
    let place = TestFolder::new();
    place.run("out", &["--samples", "0..3", "--format", "coco,yolo"]).ok();
    let all_files = place.files("out");
    let label =
        all_files.keys().find(|name| name.starts_with("yolo/labels") && name.contains("000001")).expect("a label");
    let spoil = |name: &str, change: &dyn Fn(&Path)| change(&place.path(&format!("out/{name}")));
    let resume = |samples: &str| place.run("out", &["--samples", samples, "--format", "coco,yolo", "--resume"]);
    spoil(label, &|file| fs::remove_file(file).expect("it was there"));
    resume("0..3").ok().says(&["samples/000001.json", "is missing or was changed; sample 1 is made again"]);
    assert!(place.files("out") == all_files);
    let record = "samples/000001.json";
    let edit = |from: &str, to: &str| {
        let (from, to) = (from.to_owned(), to.to_owned());
        move |file: &Path| {
            let text = fs::read_to_string(file).expect("a record");
            assert!(text.contains(&from));
            fs::write(file, text.replacen(&from, &to, 1)).expect("written");
        }
    };
    spoil(record, &edit("\"frame\": 0", "\"frame\": 7"));
    resume("2..4").refused(&["samples/000001.json", "changed after it was written", "make sample 1 again"]);
    resume("0..3").ok().says(&["sample 1 is made again"]);
    assert!(place.files("out") == all_files);
    spoil(record, &|file| _ = fs::copy(file.with_file_name("000002.json"), file).expect("copied"));
    resume("0..3").ok().says(&["this is the record of sample 2; sample 1 is made again"]);
    assert!(place.files("out") == all_files);
}

/// Files of more than this many blocks of 512 bytes cannot be written, as on a full disk.
fn with_file_limit(blocks: u32, arguments: &[String]) -> (Option<i32>, String) {
    let mut shell = Command::new("sh");
    let before = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    shell.args(["-c", &before, env!("CARGO_BIN_EXE_etendue")]).args(arguments);
    let output = shell.current_dir(root()).output().expect("a shell");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Images of two sizes: files that fit the limit for some samples do not for others.
const TWO_SIZES: &str = r#"format = 1
[[presets]]
name = "size"
choices = [[], ["cameras.front.sensor.width_px=240", "cameras.front.sensor.height_px=180", "cameras.front.sensor.pixel_pitch_um=100"]]
"#;

#[test]
fn a_disk_that_fills_keeps_whole_samples_and_a_run_goes_on() {
    let place = TestFolder::new();
    let file = text(&place.path("sizes.toml"));
    fs::write(&file, TWO_SIZES).expect("written");
    let arguments =
        |folder: &str, more: &[&str]| place.arguments(&file, folder, &[&["--samples", "0..6"], more].concat());
    etendue(arguments("whole", &[])).ok();
    let all_files = place.files("whole");
    let bytes_of = |sample: usize| {
        let name = format!("000{sample:03}");
        all_files.iter().filter(|(file, _)| file.contains(&name)).map(|(_, bytes)| bytes.len()).max().expect("files")
    };
    let large = (0..6).find(|sample| bytes_of(*sample) > 20_000).expect("a large one");
    assert!(large > 0 && (0..large).all(|sample| bytes_of(sample) < 16_000), "some that fit come first");
    let (status, stderr) = with_file_limit(36, &arguments("part", &[]));
    assert_eq!(status, Some(1), "{stderr}");
    let expected = if large == 1 { "1 complete sample".to_owned() } else { format!("{large} complete samples") };
    assert!(stderr.contains(&format!("saved {expected}; to continue, use --resume")), "{stderr}");
    let part = place.files("part");
    assert_eq!(part.keys().filter(|name| name.starts_with("samples/")).count(), large);
    assert!(
        part.iter().all(|(name, bytes)| all_files.get(name) == Some(bytes)),
        "whole files or none: {:?}",
        part.keys()
    );
    let (status, stderr) = with_file_limit(1, &arguments("none", &[]));
    assert!(status == Some(1) && stderr.contains("nothing of this run was saved"), "{stderr}");
    assert!(!place.path("none").exists());
    etendue(arguments("part", &["--resume"])).ok();
    assert!(place.files("part") == all_files);
}

#[test]
fn bad_variations_are_refused_where_they_stand() {
    let place = TestFolder::new();
    let vary = |key: &str, rest: &str| format!("format = 1\n[[vary]]\nkey = \"{key}\"\n{rest}\n");
    let uniform = "type = \"uniform\"\nmin = 1\nmax = 2";
    let exposure = "cameras.front.sensor.exposure_s";
    for (file, phrases) in [
        ("format = 1\nseed = 3\n".to_owned(), &["variations.toml:1:1", "file varies no key", "[[vary]]"][..]),
        ("format = 1\nvary = []\n".to_owned(), &["variations.toml:2:8: vary", "a list of 1 or more"]),
        (format!("format = 1\n[[vary]]\n{uniform}\n"), &["variations.toml:2:1", "the key \"key\" is missing"]),
        (
            vary("cameras.frnt.lens.f_number", uniform),
            &["variations.toml:3:7", "cameras.frnt", "did you mean \"front\""],
        ),
        (
            vary("cameras.front.lens.f_numbr", uniform),
            &["variations.toml:3:7", "cameras.front.lens.f_numbr", "f_number"],
        ),
        (vary("scene.objects.12.material", uniform), &["variations.toml:3:7", "give a number from 0 to 7"]),
        (vary(exposure, "type = \"uniform\"\nmin = -1\nmax = 2"), &["variations.toml:3:7", exposure, "-1"]),
        (
            vary(exposure, "type = \"choice\"\nvalues = [1e-3, \"long\"]"),
            &["variations.toml:3:7", exposure, "the text \"long\""],
        ),
        (vary(exposure, "type = \"uniform\"\nmin = 2\nmax = 1"), &["variations.toml:6:7", "above \"min\""]),
        (vary(exposure, "type = \"gamma\""), &["variations.toml:4:8", "gamma", "log_uniform"]),
        (
            vary(exposure, "type = \"choice\"\nvalues = [1, 2]\nweights = [1]"),
            &["variations.toml:6:", "the numbers of weights (1) and choices (2) differ"],
        ),
        (
            vary(exposure, "type = \"normal\"\nmean = 1\nstandard_deviation = 1\nmin = 2"),
            &["variations.toml:7:7", "above the mean"],
        ),
        (
            "format = 1\n[[presets]]\nname = \"p\"\nchoices = [[], [\"scene.fog=1\"]]\n".to_owned(),
            &["variations.toml:4:", "scene.fog"],
        ),
        (
            format!(
                "kitti_types = {{ dog = \"Misc\" }}\n{}",
                vary(exposure, "type = \"uniform\"\nmin = 1e-4\nmax = 1e-3")
            ),
            &["variations.toml:1:", "no class \"dog\"", "wall, block, lamp"],
        ),
        (
            format!(
                "kitti_types = {{ block = \"Big box\" }}\n{}",
                vary(exposure, "type = \"uniform\"\nmin = 1e-4\nmax = 1e-3")
            ),
            &["variations.toml:1:", "Big box", "one word"],
        ),
    ] {
        place.run_of(&file, &[]).refused(phrases);
        assert!(!place.path("out").exists(), "{file}");
    }
    let file = vary(exposure, "type = \"uniform\"\nmin = 1e-4\nmax = 1e-3");
    let distorted = "--set=cameras.front.lens.distortion={ k1 = -0.1, k2 = 0, direction = \"ideal_to_observed\", radius_unit = \"focal_lengths\" }";
    for format in ["kitti", "bop", "nuscenes"] {
        place.run_of(&file, &["--format", format, distorted]).refused(&[
            "--format",
            format,
            "camera front",
            "distorted",
        ]);
    }
    let change_text = distorted.trim_start_matches("--set=").replace('"', "\\\"");
    let varied = format!("format = 1\n[[presets]]\nname = \"lens\"\nchoices = [[\"{change_text}\"]]\n");
    place.run_of(&varied, &["--format", "kitti"]).refused(&["sample 0", "--format kitti", "distorted"]);
    let equisolid = "--set=cameras.front.lens={ type = \"calibrated\", f_number = 8, projection = { type = \"equisolid\", fx_px = 20 } }";
    place.run_of(&file, &["--format", "mcap", equisolid]).refused(&[
        "--format mcap",
        "camera front",
        "ROS has no model",
    ]);
    place.run_of(&file, &["--set=cameras.front.isp=null"]).refused(&["camera front", "[isp]"]);
    place.run_of(&file, &["--samples", "0..2000000"]).refused(&["--samples"]);
}

/// Model and coefficients as `etendue rig` writes them: k₁ = −0.1 in focal lengths is D[0] of plumb_bob.
#[test]
fn mcap_has_the_distortion_of_a_camera() {
    let place = TestFolder::new();
    let distorted = "--set=cameras.front.lens.distortion={ k1 = -0.1, k2 = 0, direction = \"ideal_to_observed\", radius_unit = \"focal_lengths\" }";
    place.run("out", &["--samples", "0..1", "--format", "mcap", distorted]).ok();
    let files = place.files("out");
    let (_, bytes) = files.iter().find(|(name, _)| name.ends_with(".mcap")).expect("a file");
    let name = b"plumb_bob\0";
    let end = bytes.windows(name.len()).position(|window| window == name).expect("the model") + name.len();
    let numbers = |at: usize| {
        let number = |i: usize| f64::from_le_bytes(bytes[at + 8 * i..][..8].try_into().expect("8 bytes"));
        [0, 1, 2, 3, 4].map(number)
    };
    // The list, after its length, begins at the next multiple of 8 of the message.
    let has_coefficients = |at: usize| {
        let [k1, rest @ ..] = numbers(at);
        (k1 + 0.1).abs() < 1e-15 && rest == [0.0; 4]
    };
    assert!((end..end + 16).any(has_coefficients), "{:?}", &bytes[end..end + 64]);
}

/// A BOP model has one size: a sample that violates that is discarded, and the set of the preceding ones is complete.
#[test]
fn bop_keeps_the_samples_before_one_of_another_size() {
    let place = TestFolder::new();
    let file =
        "format = 1\n[[vary]]\nkey = \"scene.objects.short-block.scale\"\ntype = \"uniform\"\nmin = 0.5\nmax = 0.9\n";
    let run = |more: &[&str]| place.run_of(file, &[&["--format", "bop,yolo"], more].concat());
    drop(run(&["--samples", "0..3"]).refused(&["--format bop", "\"short-block\"", "sample 1", "has one size"]));
    let samples: Vec<_> = place.files("out/samples").into_keys().collect();
    assert_eq!(samples, ["000000.json"]);
    run(&["--samples", "0..1", "--resume"]).ok();
    assert!(place.path("out/bop/models/models_info.json").exists() && place.path("out/yolo/data.yaml").exists());
    drop(run(&["--samples", "1..2", "--resume"]).refused(&["\"short-block\"", "sample 1", "has one size"]));
}

/// A complete shard has no parts left that could be made again individually.
#[test]
fn samples_of_a_complete_shard_are_computed_again_together() {
    let place = TestFolder::new();
    let file = "format = 1\nshard_samples = 2\n[[vary]]\nkey = \"cameras.front.sensor.exposure_s\"\ntype = \"uniform\"\nmin = 1e-5\nmax = 2e-5\n";
    let run = |more: &[&str]| place.run_of(file, &[&["--format", "webdataset"], more].concat());
    run(&["--samples", "0..3"]).ok();
    let all_files = place.files("out");
    drop(run(&["--samples", "1..3", "--overwrite"]).refused(&[
        "--samples 1..3",
        "samples 0 to 1 is complete",
        "--samples 0..2",
    ]));
    assert!(place.files("out") == all_files, "nothing was touched");
    run(&["--samples", "0..3", "--overwrite"]).ok();
    run(&["--samples", "2..3", "--overwrite"]).ok();
    assert!(place.files("out") == all_files);
    run(&["--samples", "0..3", "--resume"]).ok();
    let shard = place.path("out/webdataset/train-000000.tar");
    let bytes = fs::read(&shard).expect("it is there");
    fs::write(&shard, &bytes[..bytes.len() - 600]).expect("written");
    let lost = ["samples 0 to 1 is complete", "--samples 0..2"];
    drop(
        run(&["--samples", "0..3", "--resume"])
            .refused(&lost)
            .says(&["webdataset/parts/000000.tar is missing or was changed"]),
    );
    fs::remove_file(&shard).expect("it was there");
    drop(run(&["--samples", "0..3", "--resume"]).refused(&lost));
    run(&["--samples", "0..2", "--overwrite"]).ok();
    assert!(place.files("out") == all_files);
}

#[test]
fn variations_that_ship_are_whole() {
    let plan = |job: &str, variations: &str, more: &[&str]| {
        let place = TestFolder::new();
        let out = text(&place.path("out"));
        let words = ["dataset", job, "--variations", variations, "-o", &out];
        etendue(words.iter().chain(more)).ok();
        place.files("out").into_keys().collect::<Vec<_>>()
    };
    let small = ["left", "right"].map(|camera| {
        ["width_px=32", "height_px=20", "pixel_pitch_um=180"].map(|key| format!("--set=cameras.{camera}.sensor.{key}"))
    });
    let mut more = vec!["--set=cameras.rear=null", "--spp=1", "--integrator=flat"];
    more.extend(small.iter().flatten().map(String::as_str));
    let files = plan("scenes/drive/drive.toml", "scenes/datasets/drive.toml", &more);
    let has = |name: &str| files.iter().any(|file| file == name);
    assert!(has("kitti/left/training/image_3/000000.png") && has("kitti/right/training/calib/000000.txt"), "{files:?}");
    assert!(has("nuscenes/v1.0-train/sample_annotation.json") && has("nuscenes/samples/left/000000_left_0000.png"));
}
