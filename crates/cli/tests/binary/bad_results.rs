//! Stored results that are unsuitable for the request.

use crate::support::{etendue, small, tests, text};
use etendue_io::Provenance;
use etendue_io::exr::{ExrChannel, ExrLayer, ExrSamples, encode_layers, read_exr};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn place() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Renders the small job into `place/name`; returns that folder.
fn into(place: &Path, name: &str, options: &[&str]) -> String {
    let output = text(&place.join(name));
    etendue(["render", &small(), "-o", &output].iter().chain(options)).ok();
    output
}

fn laboratory() -> String {
    text(&crate::support::root().join("scenes/cameras/laboratory.toml"))
}

#[test]
fn radiance_made_through_a_lens_is_not_exposed_again() {
    let place = place();
    let folder = into(place.path(), "scene", &[]);
    let output = place.path().join("out");
    let radiance = format!("{folder}/front/radiance.exr");
    let expose = |file: &str, camera: &str| etendue(["expose", file, "--camera", camera, "-o", &text(&output)]);
    expose(&radiance, &laboratory()).refused(&["radiance.exr", "through a lens", "render.route"]);
    expose(&format!("{folder}/front/irradiance.exr"), &laboratory()).refused(&["irradiance.exr", "expected radiance"]);
    expose(&format!("{folder}/front/picture.0000.png"), &laboratory()).refused(&["picture.0000.png"]);
    expose("no/such/radiance.exr", &laboratory()).refused(&["no/such/radiance.exr"]);
    expose(&radiance, "no/such/camera.toml").refused(&["no/such/camera.toml", "no such file"]);
    assert!(!output.exists());
}

#[test]
fn a_camera_that_sees_more_than_was_stored_is_refused() {
    let place = place();
    let folder = into(place.path(), "scene", &["--set", "render.route=pupil"]);
    let camera = place.path().join("wide.toml");
    fs::write(
        &camera,
        "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 2\nf_number = 8\n\
         [sensor]\nwidth_px = 46\nheight_px = 30\npixel_pitch_um = 120\n",
    )
    .expect("written");
    let output = place.path().join("out");
    let radiance = format!("{folder}/front/radiance.exr");
    etendue(["expose", &radiance, "--camera", &text(&camera), "-o", &text(&output)]).refused(&[
        "radiance.exr",
        "wide.toml",
        "overscan",
    ]);
    assert!(!output.exists());
}

#[test]
fn a_camera_file_with_faults_is_refused_by_line_and_key() {
    let place = place();
    let camera = place.path().join("camera.toml");
    fs::write(&camera, "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 2\n[sensor]\nwidth = 3\n")
        .expect("written");
    etendue(["expose", "x.exr", "--camera", &text(&camera), "-o", "y"])
        .refused(&["camera.toml:6", "sensor.width", "\"width_px\""])
        .says(&["camera.toml:", "lens", "f_number"]);
}

#[test]
fn pictures_of_different_sizes_or_kinds_are_not_compared() {
    let place = place();
    let a = into(place.path(), "a", &[]);
    let b = into(place.path(), "b", &["--set", "cameras.front.sensor.width_px=44"]);
    let file = |folder: &str, name: &str| format!("{folder}/front/{name}");
    for name in ["radiance.exr", "picture.0000.png"] {
        etendue(["compare", &file(&a, name), &file(&b, name)]).refused(&[name, "44 × 30", "46 × 30"]);
    }
    etendue(["compare", &file(&a, "radiance.exr"), &file(&a, "picture.0000.png")])
        .refused(&["two EXR files or two images"]);
    etendue(["compare", &file(&a, "radiance.exr"), &file(&a, "ground_truth.exr")])
        .refused(&["ground_truth.exr", "the quantity is \"ground truth\""]);
    etendue(["compare", &file(&a, "none.exr"), &file(&a, "radiance.exr")]).refused(&["none.exr"]);
    etendue(["compare", &file(&a, "radiance.exr"), &file(&a, "radiance.exr"), "--significance", "2"])
        .refused(&["--significance 2", "probability"]);
}

/// An EXR file of four samples of `light`, with the variance of each.
fn four_sample_image(place: &Path, name: &str, light: [f32; 4], variance: [f32; 4]) -> String {
    let eight = Provenance { further: [("replicates".to_owned(), "8".to_owned())].into(), ..Provenance::default() };
    let layers =
        [("light".to_owned(), ExrLayer::Float(&light)), ("variance.light".to_owned(), ExrLayer::Float(&variance))];
    let file = place.join(name);
    fs::write(&file, encode_layers(2, 2, &layers, &eight).expect("a picture")).expect("written");
    text(&file)
}

#[test]
fn what_is_not_finite_in_exr_files_is_counted_and_never_agrees() {
    let place = place();
    let light = |second: f32| [1.0, second, 3.0, 4.0];
    let variance = |second: f32| [0.01, second, 0.01, 0.01];
    let good = four_sample_image(place.path(), "good.exr", light(2.0), variance(0.01));
    etendue(["compare", &good, &good]).ok();
    for (name, second, its_variance) in [
        ("nan.exr", f32::NAN, 0.01),
        ("infinite.exr", f32::INFINITY, 0.01),
        ("nan-variance.exr", 2.0, f32::NAN),
        ("negative-variance.exr", 2.0, -0.01),
    ] {
        let job = four_sample_image(place.path(), name, light(second), variance(its_variance));
        for (a, b) in [(&good, &job), (&job, &good), (&job, &job)] {
            let run = etendue(["compare", a, b]);
            assert_eq!(run.status, 1, "{}", run.err);
            assert!(run.out.contains("differs, 1 not finite"), "{}", run.out);
            assert!(!run.out.contains("NaN"), "{}", run.out);
        }
    }
}

/// An editable copy of the small job.
fn own_job(place: &Path) -> PathBuf {
    let folder = place.join("job");
    fs::create_dir(&folder).expect("made");
    for file in ["small.toml", "tower.obj", "tower.mtl", "checker.png", "sky.hdr"] {
        fs::copy(tests().join("jobs/small").join(file), folder.join(file)).expect("copied");
    }
    folder.join("small.toml")
}

#[test]
fn shards_that_do_not_belong_together_are_not_merged() {
    let place = place();
    let (a, b) = (into(place.path(), "a", &["--shard", "0/2"]), into(place.path(), "b", &["--shard", "1/2"]));
    let other = into(place.path(), "other", &["--shard", "1/2", "--seed", "3"]);
    let tiles = into(place.path(), "tiles", &["--shard", "1/2", "--set", "render.tile_px=8"]);
    let narrowed = into(place.path(), "narrowed", &["--shard", "1/2", "--camera", "front"]);
    let merged = into(place.path(), "whole", &[]);
    let output = place.path().join("out");
    let merge = |folders: &[&str]| etendue(["merge", "-o", &text(&output)].iter().chain(folders));
    merge(&[&a]).refused(&["1 of 2 shards"]);
    merge(&[&b]).refused(&["shard 0 of 2 is missing"]);
    merge(&[&a, &a]).refused(&["twice"]);
    merge(&[&a, &b, &b]).refused(&["twice"]);
    merge(&[&a, &other]).refused(&["other", "another run"]);
    merge(&[&a, &tiles]).refused(&["tiles", "another run"]);
    merge(&[&a, &narrowed]).refused(&["narrowed", "another run"]);
    merge(&[&a, &merged]).refused(&["whole", "shard.json", "render --shard"]);
    fs::write(place.path().join("b/front.film.exr"), b"no film").expect("written");
    merge(&[&a, &b]).refused(&["front.film.exr"]);
    fs::write(place.path().join("b/shard.json"), b"{}").expect("written");
    merge(&[&a, &b]).refused(&["shard.json", "not a shard manifest"]);
    assert!(!output.exists());
}

/// The header of a film states its origin: a film under another manifest, or in place of another, is not merged.
#[test]
fn films_of_another_run_shard_frame_or_capture_are_not_merged() {
    let place = place();
    let folder = |name: &str| into(place.path(), name, &["--spp", "8", "--shard", &name[1..].replace('-', "/")]);
    let (a, b) = (folder("a0-2"), folder("a1-2"));
    let film = |folder: &str| format!("{folder}/front.film.exr");
    let output = place.path().join("out");
    let merge = || etendue(["merge", &a, &b, "-o", &text(&output)]);
    let good = fs::read(film(&b)).expect("a film");
    let other_run = into(place.path(), "foreign", &["--spp", "8", "--shard", "1/2", "--seed", "99"]);
    fs::copy(film(&other_run), film(&b)).expect("copied");
    merge().refused(&["front.film.exr", "another plan", "render the shard again"]);
    fs::copy(film(&a), film(&b)).expect("copied");
    merge().refused(&["front.film.exr", "states the shard 0/2; expected 1/2"]);
    fs::write(film(&b), &good[..good.len() / 2]).expect("written");
    merge().refused(&["front.film.exr"]);
    fs::remove_file(film(&b)).expect("removed");
    merge().refused(&["front.film.exr"]);
    fs::write(film(&b), good).expect("written");
    for (key, value) in [("count", "0"), ("frames", "{ \"start\": 3, \"end\": 3 }"), ("tile_px", "[0]")] {
        let manifest = format!("{b}/shard.json");
        let stated = fs::read_to_string(&manifest).expect("a manifest");
        let mut changed: serde_json::Value = serde_json::from_str(&stated).expect("JSON");
        changed[key] = serde_json::from_str(value).expect("JSON");
        fs::write(&manifest, changed.to_string()).expect("written");
        merge().refused(&["shard.json", "it states"]);
        fs::write(&manifest, stated).expect("written");
    }
    assert!(!output.exists());
    merge().ok();
}

fn layer(channel: &ExrChannel) -> ExrLayer<'_> {
    match &channel.samples {
        ExrSamples::Half(values) | ExrSamples::Float(values) => ExrLayer::Float(values),
        ExrSamples::Uint(values) => ExrLayer::Uint(values),
    }
}

/// A film with other numbers and the same header.
fn with_changed_numbers(film: &str, change: impl Fn(&str, &mut ExrSamples)) {
    let mut file = read_exr(Path::new(film)).expect("a film");
    file.channels.iter_mut().for_each(|channel| change(&channel.name, &mut channel.samples));
    let layers: Vec<_> = file.channels.iter().map(|channel| (channel.name.clone(), layer(channel))).collect();
    let bytes = encode_layers(file.width, file.height, &layers, &file.provenance()).expect("a film");
    fs::write(film, bytes).expect("written");
}

#[test]
fn films_that_are_not_complete_or_not_finite_are_not_merged() {
    let place = place();
    let (a, b) = (into(place.path(), "a", &["--shard", "0/2"]), into(place.path(), "b", &["--shard", "1/2"]));
    let film = format!("{b}/front.film.exr");
    let good = fs::read(&film).expect("a film");
    let output = place.path().join("out");
    let merge = || etendue(["merge", &a, &b, "-o", &text(&output)]);
    let float = |name: &'static str, value: f32| {
        move |channel: &str, samples: &mut ExrSamples| match samples {
            ExrSamples::Float(values) if channel == name => values[3] = value,
            _ => {}
        }
    };
    let count = |name: &'static str, of: fn(u32) -> u32| {
        move |channel: &str, samples: &mut ExrSamples| match samples {
            ExrSamples::Uint(values) if channel == name => values.iter_mut().for_each(|n| *n = of(*n)),
            _ => {}
        }
    };
    let assert_refused = |change: &dyn Fn(&str, &mut ExrSamples), why: &str| {
        with_changed_numbers(&film, change);
        merge().refused(&["front.film.exr", why, "render the shard again"]);
        fs::write(&film, &good).expect("written");
    };
    assert_refused(&float("weight", f32::NAN), "not finite");
    assert_refused(&float("band.0000.mean", f32::INFINITY), "not finite");
    assert_refused(&float("band.0000.variance", -1.0), "variances below 0");
    assert_refused(&count("samples", |_| 0), "it is incomplete");
    assert_refused(&count("samples", |_| 4), "it belongs to another shard");
    assert_refused(&count("not_finite", |_| 1), "not finite");
    with_changed_numbers(&film, |_, _| {});
    assert!(!output.exists());
    merge().ok();
}

#[test]
fn a_job_that_changed_since_its_shards_were_rendered_is_not_merged() {
    let place = place();
    let job = own_job(place.path());
    let folders = ["0", "1"].map(|i| (format!("{i}/2"), text(&place.path().join(i))));
    for (shard, folder) in &folders {
        etendue(["render", &text(&job), "-o", folder, "--shard", shard]).ok();
    }
    let changed = fs::read_to_string(&job).expect("the job").replace("alpha = 0.2", "alpha = 0.3");
    fs::write(&job, changed).expect("written");
    let output = place.path().join("out");
    etendue(["merge", &folders[0].1, &folders[1].1, "-o", &text(&output)]).refused(&["small.toml", "changed since"]);
    assert!(!output.exists());
}

#[test]
fn files_of_unknown_kinds_are_not_inspected() {
    let place = place();
    let file = place.path().join("notes.txt");
    fs::write(&file, "words").expect("written");
    etendue(["inspect", &text(&file)]).refused(&["notes.txt"]);
    etendue(["inspect", "no/such.exr"]).refused(&["no/such.exr"]);
}

#[test]
fn pictures_are_not_lost_to_their_plots_nor_cameras_to_measurements() {
    let place = place();
    let at = |name: &str| text(&place.path().join(name));
    etendue(["measure", "sfr", &at("edge.png"), "--plot", &at("edge.png")]).refused(&["--plot", "ends in .svg"]);
    etendue(["calibrate", &at("a.png"), "--pitch-mm", "9", "--pixel-pitch-um", "3", "-o", &at("camera")])
        .refused(&["--output", "ends in .toml"]);
    etendue(["calibrate", &at("a.png"), "--pitch-mm", "-9"]).refused(&["--pitch-mm", "above 0"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_no_success() {
    let full = std::fs::File::options().write(true).open("/dev/full").expect("Linux has it");
    let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_etendue"));
    let output = program.args(["schema", "job"]).stdout(full).output().expect("it runs");
    assert_eq!(output.status.code(), Some(1));
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(stderr.contains("cannot be written"), "{stderr}");
}
