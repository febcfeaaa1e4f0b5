//! Several runs at one time: a folder takes one, and says whose it is.

use crate::support::{assert_same, contents, etendue, rendered, root, small, tests, text};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A run that goes on until it is killed.
struct Running(Child);

impl Running {
    fn begin(arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_etendue"));
        command.current_dir(root()).args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
        Self(command.spawn().expect("the binary starts"))
    }

    /// A render that takes long, begun and at work in its folder.
    fn render_into(out: &Path) -> Self {
        let running = Self::begin(&["render", &small(), "-o", &text(out), "--spp", "1000000", "--overwrite"]);
        let mark = out.join(format!(".etendue.{}-0.part", running.0.id()));
        while !mark.exists() {
            std::thread::sleep(Duration::from_millis(2));
        }
        running
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn a_second_run_into_a_folder_is_refused_until_the_first_has_ended_however_it_does() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (out, shard) = (place.path().join("out"), text(&place.path().join("shard")));
    let (folder, job, camera) = (text(&out), small(), "scenes/cameras/web.toml");
    etendue(["render", &job, "-o", &shard, "--spp", "2", "--shard", "0/1"]).ok();
    let first = Running::render_into(&out);
    let taken = format!("another run (process {}) writes into this folder", first.0.id());
    let refused = |arguments: &[&str]| {
        etendue(arguments.iter().copied().chain(["-o", &folder])).refused(&[
            &folder,
            &taken,
            "choose another output folder",
        ]);
    };
    refused(&["render", &job]);
    refused(&["render", &job, "--overwrite"]);
    refused(&["render", &job, "--resume"]);
    refused(&["render", &job, "--progressive", "--overwrite"]);
    refused(&["render", &job, "--shard", "0/1"]);
    refused(&["render", &text(&tests().join("jobs/moving/moving.toml")), "--frames", "0..2", "--overwrite"]);
    refused(&["merge", &shard, "--overwrite"]);
    refused(&["rig", &job, "--overwrite"]);
    refused(&["tradeoff", &job, "--time", "10", "--overwrite"]);
    refused(&["flat", camera, "--wavelength-nm", "525", "--irradiance-w-m2", "0.002"]);
    assert!(contents(&out).keys().all(|name| name.starts_with('.')), "nothing but the first one's mark");
    // Killed: the lock goes with the process, what it left with the next run.
    drop(first);
    etendue(["render", &job, "-o", &folder, "--spp", "2"]).ok();
    assert_same(&rendered(&job, &["--spp", "2"]), &contents(&out), "after a kill");
}

#[test]
fn runs_that_write_into_folders_of_cameras_go_side_by_side() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let light = ["--wavelength-nm", "525", "--irradiance-w-m2", "0.002"];
    let cameras = ["a", "b", "c"].map(|name| {
        let file = place.path().join(format!("{name}.toml"));
        std::fs::copy(root().join("scenes/cameras/web.toml"), &file).expect("copied");
        text(&file)
    });
    let out = text(&place.path().join("out"));
    let runs = cameras.each_ref().map(|camera| Running::begin(&[&["flat", camera, "-o", &out], &light[..]].concat()));
    for mut run in runs {
        assert!(run.0.wait().expect("a child").success());
    }
    for name in ["a", "b", "c"] {
        assert!(Path::new(&out).join(name).join("camera.json").exists(), "{name}");
    }
}

/// Runs that begin at one moment: one is let in, or one after the other, and none mixes its files with another's.
#[test]
fn of_runs_that_begin_together_each_leaves_all_files_or_none() {
    let expected = rendered(&small(), &["--spp", "2"]);
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let arguments = ["render", &small(), "-o", &text(&out), "--spp", "2"].map(str::to_owned);
    let mut runs: Vec<Running> = (0..6).map(|_| Running::begin(&arguments.each_ref().map(String::as_str))).collect();
    let ends: Vec<_> = runs.iter_mut().map(|run| run.0.wait().expect("a child").code()).collect();
    // The others were refused: by the lock, or by the files of the first.
    assert_eq!(ends.iter().filter(|code| **code == Some(0)).count(), 1, "{ends:?}");
    assert_eq!(ends.iter().filter(|code| **code == Some(2)).count(), 5, "{ends:?}");
    assert_same(&expected, &contents(&out), "of one run");
}
