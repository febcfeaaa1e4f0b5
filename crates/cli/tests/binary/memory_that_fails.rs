//! Runs to which the system gives too little memory: no file under a final name is half-written, and the next run is as if there had been none.

use crate::support::{assert_same, contents, rendered, root, small, text};
use std::path::Path;
use std::process::Command;

/// Runs the program with so much address space, KiB; its status (`None`: a signal ended it) and what it said.
fn within(kib: u32, arguments: &[&str]) -> (Option<i32>, String) {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("ulimit -c 0; ulimit -v {kib}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_etendue")]);
    let ran = shell.args(arguments).current_dir(root()).output().expect("a shell");
    (ran.status.code(), String::from_utf8_lossy(&ran.stderr).into_owned())
}

#[test]
fn a_film_that_the_system_has_no_memory_for_is_told_before_the_work() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (small(), text(&place.path().join("out")));
    let size = ["--set", "cameras.front.sensor.width_px=16000", "--set", "cameras.front.sensor.height_px=16000"];
    let arguments = [&["render", &job, "-o", &out, "--threads", "1", "--spp", "2"][..], &size].concat();
    let (status, told) = within(1_500_000, &arguments);
    assert_eq!(status, Some(1), "{told}");
    assert!(told.contains("camera front: the system does not give the ") && told.contains("--film-memory"), "{told}");
    assert!(told.contains("nothing of this run was kept"), "{told}");
    assert!(!Path::new(&out).exists(), "{:?}", contents(Path::new(&out)).keys());
}

/// Wherever the memory ends, from the start of the program to the last file.
#[test]
fn no_allocation_that_fails_leaves_half_a_file() {
    let expected = rendered(&small(), &["--spp", "2"]);
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let mut ends = [0; 2];
    for kib in (20..=200).step_by(12).map(|mib| mib * 1024) {
        let (status, told) =
            within(kib, &["render", &small(), "-o", &text(&out), "--spp", "2", "--overwrite", "--threads", "1"]);
        ends[usize::from(status == Some(0))] += 1;
        // Small allocations that fail end the process at once (SIGABRT), as Rust has it; below some limit the system does not even begin it.
        let is_told = status.is_none_or(|status| status == 0) || told.contains("error");
        assert!(is_told, "{kib} KiB: {status:?} {told}");
        for (name, bytes) in contents(&out) {
            let is_hidden = Path::new(&name).file_name().is_some_and(|file| file.to_string_lossy().starts_with('.'));
            assert!(is_hidden || expected[&name] == bytes, "{name} at {kib} KiB");
        }
    }
    assert!(ends.iter().all(|count| *count > 0), "limits below and above what is needed: {ends:?}");
    assert_same(&expected, &contents(&out), "after the last");
}
