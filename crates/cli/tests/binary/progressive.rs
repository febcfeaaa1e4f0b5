//! Light in passes: equal bits for any sequence of runs, also after a kill; and as many passes as a time allows.

use crate::support::{CommandOutput, assert_same, contents, etendue, rendered, root, small, tests, text};
use etendue_io::exr::{ExrSamples, read_exr};
use etendue_io::picture::read_image;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

fn moving() -> String {
    text(&tests().join("jobs/moving/moving.toml"))
}

fn render(job: &str, folder: &Path, options: &[&str]) -> CommandOutput {
    etendue(["render", job, "-o", &text(folder)].into_iter().chain(options.iter().copied()))
}

/// Columns and rows of a readable image.
fn image_size(file: &Path) -> (u32, u32) {
    let image = read_image(file).expect("a whole picture");
    (image.width as u32, image.height as u32)
}

/// Floats of the channels of an image, without the facts of the EXR.
fn channels(file: &Path) -> BTreeMap<String, Vec<u32>> {
    let file = read_exr(file).expect("an EXR");
    let bits = |samples: &ExrSamples| samples.to_floats().iter().map(|value| value.to_bits()).collect();
    file.channels.iter().map(|channel| (channel.name.clone(), bits(&channel.samples))).collect()
}

#[test]
fn one_pass_is_the_light_of_as_many_samples() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folders = ["spp", "passes"].map(|name| place.path().join(name));
    for (folder, set) in folders.iter().zip(["render.spp=8", "render.passes=[8]"]) {
        render(&small(), folder, &["--set", set]).ok();
    }
    let [spp, passes] = folders.map(|folder| channels(&folder.join("front/radiance.exr")));
    assert_eq!(spp, passes);
}

#[test]
fn a_progressive_run_leaves_the_files_of_its_passes_and_nothing_else() {
    let progressive = rendered(&small(), &["--progressive", "--spp", "24"]);
    assert_same(&progressive, &rendered(&small(), &["--set", "render.passes=[4, 4, 8, 8]"]), "doubling");
    let facts: Value = serde_json::from_slice(&progressive["front/camera.json"]).expect("a side-car");
    assert_eq!(facts["sampling"]["passes"], serde_json::json!([4.0, 4.0, 8.0, 8.0]));
    assert_ne!(progressive["front/radiance.exr"], rendered(&small(), &["--spp", "24"])["front/radiance.exr"]);
}

#[test]
fn passes_are_the_same_in_shards_and_with_a_part_of_the_pixels() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = |name: &str| place.path().join(name);
    let set = ["--set", "render.replicates=4", "--set", "render.passes=[4, 8, 1.5]"];
    let mut arguments = vec!["merge".to_owned(), "-o".to_owned(), text(&folder("whole"))];
    for shard in ["1/2", "0/2"] {
        let part = folder(&shard[..1]);
        render(&small(), &part, &[&set[..], &["--shard", shard, "--threads", "1"]].concat()).ok();
        arguments.push(text(&part));
    }
    etendue(arguments).ok();
    assert_same(&rendered(&small(), &set), &contents(&folder("whole")), "two shards");
}

/// A run that is killed as soon as its state holds one more pass, or that has ended.
fn kill_after_a_pass(arguments: &[String], output: &Path) {
    let before = state(output);
    kill_when(arguments, || state(output) != before);
}

/// A run that is killed at a moment, or that has ended.
fn kill_when(arguments: &[String], is_time: impl Fn() -> bool) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_etendue"));
    command.current_dir(root()).args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child: Child = command.spawn().expect("the binary starts");
    while child.try_wait().expect("a child").is_none() && !is_time() {
        std::thread::sleep(Duration::from_millis(2));
    }
    // SIGKILL: no code of the program runs after it.
    child.kill().expect("a child can be killed");
    child.wait().expect("a child");
}

/// Films of the state under their final names. The run may be writing: temporary files are not opened, as they vanish.
fn state(output: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![output.join(".progress")];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = std::fs::read_dir(folder) else { continue };
        for path in entries.map(|entry| entry.expect("a readable entry").path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.to_string_lossy().ends_with(".film.exr")
                && let Ok(bytes) = std::fs::read(&path)
            {
                files.insert(path, bytes);
            }
        }
    }
    files
}

#[test]
fn a_killed_run_resumes_to_the_bytes_of_one_that_was_not() {
    for (job, options) in [(small(), &["--spp", "40"][..]), (moving(), &["--spp", "24", "--frames", "0..2"])] {
        let place = tempfile::tempdir().expect("a temporary folder");
        let (uninterrupted, out) = (place.path().join("whole"), place.path().join("out"));
        let options = [options, &["--progressive"]].concat();
        render(&job, &uninterrupted, &options).ok();
        let arguments = ["render", &job, "-o", &text(&out)].map(str::to_owned).into_iter();
        let mut arguments: Vec<String> = arguments.chain(options.iter().map(|option| (*option).to_owned())).collect();
        kill_after_a_pass(&arguments, &out);
        arguments.push("--resume".to_owned());
        (0..3).for_each(|_| kill_after_a_pass(&arguments, &out));
        render(&job, &out, &[&options[..], &["--resume"]].concat()).ok();
        assert_same(&contents(&uninterrupted), &contents(&out), &job);
    }
}

#[test]
fn a_killed_run_leaves_whole_pictures_and_a_state_that_is_not_lost_by_accident() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let options = ["--spp", "4000", "--progressive"];
    let (job, output) = (small(), text(&out));
    let arguments = ["render", &job, "-o", &output].into_iter().chain(options).map(str::to_owned);
    let image = out.join("front/picture.0000.png");
    kill_when(&arguments.collect::<Vec<_>>(), || image.exists());
    // The images of an early pass, and no side-car yet.
    let radiance = read_exr(&out.join("front/radiance.exr")).expect("a whole file");
    assert!(radiance.provenance().further["passes"].starts_with("[4, 4, 8,"), "{:?}", radiance.attributes);
    assert!(image_size(&image) == (radiance.width as u32, radiance.height as u32));
    assert!(!out.join("front/camera.json").exists() && !state(&out).is_empty());
    render(&small(), &out, &options).refused(&[".progress", "--resume", "--overwrite"]);
    render(&small(), &out, &["--spp", "4004", "--progressive", "--resume"]).refused(&["another plan", "--overwrite"]);
    render(&small(), &out, &["--spp", "8", "--progressive", "--overwrite"]).ok();
    assert!(state(&out).is_empty() && out.join("front/radiance.exr").exists());
}

/// Seconds and options reported by a timed run: "10.02 s of rendering (--time 10): …; --set … gives the same bytes".
fn time_and_options(run: &CommandOutput) -> (f64, Vec<String>) {
    let line = run.err.lines().find(|line| line.contains("s of rendering (--time")).expect("a note of the time");
    let (seconds, options) =
        line.strip_prefix("note: ").and_then(|line| line.split_once(" s of rendering")).expect("both");
    let options = options.rsplit_once("; ").expect("options").1.strip_suffix(" gives the same bytes").expect("an end");
    let (replicates, passes) = options.split_once(" --set ").expect("replicates and passes");
    let replicates = replicates.strip_prefix("--set ").expect("replicates").to_owned();
    let passes = passes.trim_matches('"').to_owned();
    (seconds.parse().expect("seconds"), vec!["--set".to_owned(), replicates, "--set".to_owned(), passes])
}

/// Cornell's box at 48 × 48 px. A machine that stalls for a second at the end may miss the time, but not three times in a row.
#[test]
fn a_timed_run_keeps_its_time_and_its_passes_give_its_bytes() {
    let job = "scenes/cornell/cornell.toml";
    let size = ["--set", "cameras.front.sensor.width_px=48", "--set", "cameras.front.sensor.height_px=48"];
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let completed = (0..3).find_map(|_| {
        let run = render(job, &out, &[&size[..], &["--time", "10", "--progressive", "--overwrite"]].concat()).ok();
        let (seconds, options) = time_and_options(&run.says(&["--time overrides", "spp"]));
        ((seconds / 10.0 - 1.0).abs() < 0.1).then_some(options)
    });
    let options = completed.expect("10 s within a tenth");
    let options: Vec<&str> = options.iter().map(String::as_str).chain(size).collect();
    assert_same(&contents(&out), &rendered(job, &options), "the passes that were told");
}

/// The same job, killed twice. Guided paths: each pass learns the same wherever the run was interrupted.
#[test]
fn a_timed_run_that_was_killed_takes_the_time_that_was_left() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let (job, output) = ("scenes/cornell/cornell.toml", text(&out));
    let size = ["sensor.width_px=32", "sensor.height_px=32", "render.guiding=true"];
    let size = size.map(|key| format!("cameras.front.{key}"));
    let size: Vec<&str> = size.iter().flat_map(|key| ["--set", key]).collect();
    let arguments =
        ["render", job, "-o", &output, "--time", "10", "--progressive"].into_iter().chain(size.iter().copied());
    let mut arguments: Vec<String> = arguments.map(str::to_owned).collect();
    kill_after_a_pass(&arguments, &out);
    arguments.push("--resume".to_owned());
    kill_after_a_pass(&arguments, &out);
    let begin = std::time::Instant::now();
    let run = etendue(&arguments).ok();
    let took_s = begin.elapsed().as_secs_f64();
    let (seconds, options) = time_and_options(&run);
    // The duration on a loaded machine is tested elsewhere.
    assert!(seconds > 9.0 && took_s < seconds + 5.0, "{took_s} s for {seconds} s");
    let options: Vec<&str> = options.iter().map(String::as_str).chain(size).collect();
    assert_same(&contents(&out), &rendered(job, &options), "the passes that were told");
}

#[test]
fn what_cannot_be_done_is_refused() {
    let assert_refused = |options: &[&str], phrases: &[&str]| {
        let place = tempfile::tempdir().expect("a temporary folder");
        render(&small(), &place.path().join("out"), options).refused(phrases);
    };
    assert_refused(&["--time", "9.9"], &["--time 9.9", "10 s or more"]);
    assert_refused(&["--time", "nan"], &["--time NaN", "10 s or more"]);
    assert_refused(&["--time", "10", "--spp", "8"], &["--time", "cannot be used with"]);
    assert_refused(&["--progressive", "--shard", "0/2"], &["--progressive", "cannot be used with"]);
    assert_refused(
        &["--progressive", "--set", "render.noise_threshold=0.5"],
        &["noise_threshold", "--progressive", "--spp"],
    );
    assert_refused(&["--set", "render.passes=[8, 6]", "--set", "render.replicates=4"], &["6 samples", "4 replicates"]);
    assert_refused(&["--set", "render.passes=[1.5]"], &["no pass samples all pixels"]);
    assert_refused(&["--set", "render.passes=[]"], &["render.passes", "a list of 1 or more"]);
    assert_refused(&["--set", "render.passes=[8]", "--set", "render.spp=8"], &["spp", "passes", "exclude each other"]);
    assert_refused(&["--spp", "8", "--noise", "0.5"], &["cannot be used with"]);
}
