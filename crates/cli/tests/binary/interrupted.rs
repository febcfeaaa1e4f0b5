//! Runs ended by a full disk or a signal: no incomplete file has a final name, and the next run gives the bytes of an undisturbed one.

use crate::support::{contents, etendue, small, text};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Runs the program from a shell that first executes `before`; returns its exit status and output.
fn after(before: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("{before}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_etendue")]).args(arguments);
    let output = shell.current_dir(crate::support::root()).output().expect("a shell");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_disk_that_fills_leaves_no_file_under_its_final_name() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    // Files of more than 8 blocks of 512 bytes cannot be written, as on a full disk; the signal that reports it first is ignored.
    let (status, stderr) = after("trap '' XFSZ; ulimit -f 8", &["render", &small(), "-o", &out, "--spp", "2"]);
    assert_eq!(status, Some(1), "{stderr}");
    assert!(stderr.contains("error") && stderr.contains(&out), "{stderr}");
    assert!(!Path::new(&out).exists(), "{:?}", contents(Path::new(&out)).keys());
    etendue(["render", &small(), "-o", &out, "--spp", "2"]).ok();
}

#[test]
fn a_run_that_is_killed_at_any_moment_leaves_whole_files_or_none() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let arguments = |out: &str| ["render", &small(), "-o", out, "--spp", "64", "--overwrite"].map(str::to_owned);
    let undisturbed = text(&place.path().join("whole"));
    etendue(arguments(&undisturbed)).ok();
    let expected = contents(Path::new(&undisturbed));
    let out = text(&place.path().join("out"));
    let mut killed = 0;
    for milliseconds in [5, 20, 40, 60, 90, 130, 180] {
        let mut run = Command::new(env!("CARGO_BIN_EXE_etendue"));
        run.args(arguments(&out)).stdout(Stdio::null()).stderr(Stdio::null());
        let mut run = run.spawn().expect("it starts");
        std::thread::sleep(Duration::from_millis(milliseconds));
        // It may have ended before.
        killed += u32::from(run.try_wait().expect("a child").is_none());
        let _ = run.kill();
        run.wait().expect("it ends");
        for (name, bytes) in contents(Path::new(&out)) {
            let is_hidden = Path::new(&name).file_name().is_some_and(|file| file.to_string_lossy().starts_with('.'));
            assert!(is_hidden || expected[&name] == bytes, "{name} after {milliseconds} ms");
        }
    }
    assert!(killed > 0, "no moment was within a run");
    etendue(arguments(&out)).ok();
    assert!(contents(Path::new(&out)) == expected, "leftovers are removed, and the bytes are the same");
}
