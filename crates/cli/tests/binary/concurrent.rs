//! Several runs at one time: a folder accepts one, and states its owner. A section of docs/evidence/extremes.md.

use crate::support::{assert_same, contents, etendue, rendered, root, small, tests, text};
use etendue_testkit::page::{Row, check};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A run that continues until it is killed.
struct RunningProcess(Child);

impl RunningProcess {
    fn begin(arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_etendue"));
        command.current_dir(root()).args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
        Self(command.spawn().expect("the binary starts"))
    }

    /// A long render, started and active in its folder.
    fn render_into(out: &Path) -> Self {
        let running = Self::begin(&["render", &small(), "-o", &text(out), "--spp", "1000000", "--overwrite"]);
        let mark = out.join(format!(".etendue.{}-0.part", running.0.id()));
        while !mark.exists() {
            std::thread::sleep(Duration::from_millis(2));
        }
        running
    }
}

impl Drop for RunningProcess {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// During an active run in a folder, and after it was killed.
fn a_second_run_is_refused_until_the_first_has_ended_however_it_does() -> Row {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (out, shard) = (place.path().join("out"), text(&place.path().join("shard")));
    let (folder, job, camera) = (text(&out), small(), "scenes/cameras/web.toml");
    let moving = text(&tests().join("jobs/moving/moving.toml"));
    etendue(["render", &job, "-o", &shard, "--spp", "2", "--shard", "0/1"]).ok();
    let first = RunningProcess::render_into(&out);
    let expected_problem = format!("another run (process {}) is writing into this folder", first.0.id());
    let seconds: [&[&str]; 10] = [
        &["render", &job],
        &["render", &job, "--overwrite"],
        &["render", &job, "--resume"],
        &["render", &job, "--progressive", "--overwrite"],
        &["render", &job, "--shard", "0/1"],
        &["render", &moving, "--frames", "0..2", "--overwrite"],
        &["merge", &shard, "--overwrite"],
        &["rig", &job, "--overwrite"],
        &["tradeoff", &job, "--time", "10", "--overwrite"],
        &["flat", camera, "--wavelength-nm", "525", "--irradiance-w-m2", "0.002"],
    ];
    for arguments in seconds {
        let phrases = [&folder, &expected_problem, "choose another output folder"];
        etendue(arguments.iter().copied().chain(["-o", &folder])).refused(&phrases);
    }
    assert!(contents(&out).keys().all(|name| name.starts_with('.')), "nothing but the first one's mark");
    // Killed: the lock disappears with the process, its files with the next run.
    drop(first);
    etendue(["render", &job, "-o", &folder, "--spp", "2"]).ok();
    assert_same(&rendered(&job, &["--spp", "2"]), &contents(&out), "after a kill");
    row(
        "ten kinds of runs into a folder that another run uses",
        "status 2 with the process of that run, nothing written; free once that run is killed",
        &format!("{} refused", seconds.len()),
    )
}

fn runs_that_write_into_folders_of_cameras_go_side_by_side() -> Row {
    let place = tempfile::tempdir().expect("a temporary folder");
    let light = ["--wavelength-nm", "525", "--irradiance-w-m2", "0.002"];
    let names = ["a", "b", "c"];
    let cameras = names.map(|name| {
        let file = place.path().join(format!("{name}.toml"));
        std::fs::copy(root().join("scenes/cameras/web.toml"), &file).expect("copied");
        text(&file)
    });
    let out = text(&place.path().join("out"));
    let runs =
        cameras.each_ref().map(|camera| RunningProcess::begin(&[&["flat", camera, "-o", &out], &light[..]].concat()));
    for mut run in runs {
        assert!(run.0.wait().expect("a child").success());
    }
    for name in names {
        assert!(Path::new(&out).join(name).join("camera.json").exists(), "{name}");
    }
    row(
        "three runs that create one folder, each for another camera",
        "each writes all its files into the folder of its camera",
        &format!("{} did", names.len()),
    )
}

/// Runs that start at one moment: one is admitted, or one after the other, and none mixes its files with another's.
fn concurrent_runs_leave_all_files_or_none() -> Row {
    let expected = rendered(&small(), &["--spp", "2"]);
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let arguments = ["render", &small(), "-o", &text(&out), "--spp", "2"].map(str::to_owned);
    let mut runs: Vec<RunningProcess> =
        (0..6).map(|_| RunningProcess::begin(&arguments.each_ref().map(String::as_str))).collect();
    let ends: Vec<_> = runs.iter_mut().map(|run| run.0.wait().expect("a child").code()).collect();
    let ended = |status| ends.iter().filter(|code| **code == Some(status)).count();
    // The others were refused: by the lock, or by the files of the first.
    assert_eq!((ended(0), ended(2)), (1, 5), "{ends:?}");
    assert_same(&expected, &contents(&out), "of one run");
    row(
        "six runs that start together into one new folder",
        "one writes the bytes of a single run, the others are refused",
        &format!("{} and {}", ended(0), ended(2)),
    )
}

/// A row of asserted results.
fn row(extreme: &str, expected: &str, actual: &str) -> Row {
    Row { extreme: extreme.to_owned(), expected: expected.to_owned(), actual: actual.to_owned(), holds: true }
}

#[test]
fn several_runs_into_one_folder() {
    let rows = [
        a_second_run_is_refused_until_the_first_has_ended_however_it_does(),
        runs_that_write_into_folders_of_cameras_go_side_by_side(),
        concurrent_runs_leave_all_files_or_none(),
    ];
    check(
        "Several runs into one folder",
        "Processes that start together, or while another works (docs/robustness.md).",
        &rows,
    );
}
