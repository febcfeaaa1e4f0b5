//! Runs that cannot continue.

use super::ended;
use crate::support::{CommandOutput, contents, root, small, text};
use etendue_testkit::page::{Row, check};
use std::path::Path;
use std::process::Command;

/// Runs the program from a shell that first executes `before`.
fn after(before: &str, arguments: &[&str]) -> CommandOutput {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("{before}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_etendue")]).args(arguments);
    let output = shell.current_dir(root()).output().expect("a shell");
    let utf8 = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program writes UTF-8");
    CommandOutput { status: output.status.code().unwrap_or(-1), out: utf8(output.stdout), err: utf8(output.stderr) }
}

/// The row of a run that leaves nothing in its folder.
fn refused_without_files(status: i32, extreme: &str, output: &CommandOutput, place: &Path) -> Row {
    let row = ended(status, extreme, "no file under a final name", output, &[place]);
    let left = contents(place).len();
    Row { actual: format!("{}; {left} files", row.actual), holds: row.holds && left == 0, ..row }
}

#[test]
fn runs_that_cannot_go_on() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    let full = after("trap '' XFSZ; ulimit -f 8", &["render", &small(), "-o", &out, "--spp", "2"]);
    let full = refused_without_files(1, "a disk that is full after 4 kB", &full, place.path());
    let size = ["--set", "cameras.front.sensor.width_px=16000", "--set", "cameras.front.sensor.height_px=16000"];
    let job = small();
    let render = [&["render", &job, "-o", &out, "--threads", "1", "--spp", "2"][..], &size].concat();
    let memory = after("ulimit -c 0; ulimit -v 1500000", &render);
    let memory = refused_without_files(2, "a film for which there is no memory", &memory, place.path());
    // Free memory depends on the addresses given by the system.
    let needed = memory.actual.split(", but ").next().unwrap_or_default().to_owned();
    let memory = Row { actual: format!("{needed}, and less is free"), ..memory };
    let caption = "With real limits of the system. Small failed allocations and panics of workers have their own tests (crates/cli/tests/binary/memory\\_that\\_fails.rs, crates/etendue/tests/library/errors.rs).";
    check("Runs that cannot continue", caption, &[full, memory]);
}
