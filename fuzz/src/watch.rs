//! Workers as child processes: what kills one is found, and the next begins.

use crate::targets::Target;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time of an input before its process ends, s, by the clock.
pub const LIMIT_S: f64 = 40.0;
/// Longest time that is no finding, s of processor time.
pub const SLOW_S: f64 = 5.0;
/// Exit status of a process that ended for it.
pub const TOO_LONG: i32 = 77;
/// Memory of a worker, kB: more is not given to it, and it ends.
const MAX_KB: u64 = 6_000_000;

/// What came of a target.
#[derive(Clone, Debug, Default)]
pub struct Watched {
    /// Inputs that were read by workers that lived.
    pub inputs: u64,
    /// Ways of the worker that found most.
    pub ways: usize,
    /// Most memory of an input, bytes.
    pub peak_bytes: u64,
    /// Longest time of an input, s.
    pub time_s: f64,
    /// Findings: their kind, and what is wrong.
    pub findings: BTreeMap<String, String>,
}

/// Runs workers of a target for `time`; findings are stored in `found`.
///
/// # Panics
/// Where no process can be started or no file be written.
#[must_use]
pub fn watch(target: &Target, time: Duration, seed: u64, found: &Path) -> Watched {
    let start = Instant::now();
    let mut watched = Watched::default();
    for serial in 0.. {
        let left = time.saturating_sub(start.elapsed());
        if left < Duration::from_millis(500) {
            break;
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("findings");
        fs::create_dir(&out).expect("a folder");
        let (ended, told) = run(target, left, seed.wrapping_add(serial << 32), folder.path());
        store(&mut watched, target, &out, found);
        match told.split_once("worked ").map(|(_, figures)| figures.split_whitespace().collect::<Vec<_>>()) {
            Some(figures) => add(&mut watched, &figures),
            None => died(&mut watched, target, folder.path(), &format!("{ended}: {told}"), found),
        }
    }
    watched
}

fn run(target: &Target, left: Duration, seed: u64, folder: &Path) -> (String, String) {
    let program = std::env::current_exe().expect("this program");
    let limited = format!("ulimit -v {MAX_KB}; exec \"$0\" \"$@\"");
    let mut command = Command::new("sh");
    command.args(["-c", &limited]).arg(program).args(["--worker", target.name, &left.as_millis().to_string()]);
    let output = command.arg(seed.to_string()).arg(folder).stdin(Stdio::null()).output().expect("a worker starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.to_string(), text(&output.stdout) + &text(&output.stderr))
}

fn add(watched: &mut Watched, figures: &[&str]) {
    let number = |i: usize| figures.get(i).and_then(|word| word.parse::<f64>().ok()).unwrap_or(0.0);
    watched.inputs += number(0) as u64;
    watched.ways = watched.ways.max(number(1) as usize);
    watched.peak_bytes = watched.peak_bytes.max(number(2) as u64);
    watched.time_s = watched.time_s.max(number(3));
}

/// Takes over the findings of a worker.
fn store(watched: &mut Watched, target: &Target, out: &Path, found: &Path) {
    for text in fs::read_dir(out).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if text.extension().is_some_and(|extension| extension == "txt") {
            let told = fs::read_to_string(&text).unwrap_or_default();
            let (kind, fault) = told.split_once('\n').unwrap_or((&told, ""));
            keep(watched, target, (kind, fault), &fs::read(text.with_extension("input")).unwrap_or_default(), found);
        }
    }
}

fn died(watched: &mut Watched, target: &Target, folder: &Path, told: &str, found: &Path) {
    let kind: String = told.chars().filter(|c| !c.is_ascii_digit()).take(160).collect();
    let input = fs::read(folder.join(target.file)).unwrap_or_default();
    keep(watched, target, (&kind.replace('\n', " "), told), &input, found);
}

fn keep(watched: &mut Watched, target: &Target, (kind, fault): (&str, &str), input: &[u8], found: &Path) {
    if watched.findings.contains_key(kind) {
        return;
    }
    let name = format!("{}-{}", target.name, watched.findings.len());
    watched.findings.insert(kind.to_owned(), fault.to_owned());
    fs::create_dir_all(found).expect("a folder");
    fs::write(found.join(format!("{name}.input")), input).expect("written");
    fs::write(found.join(format!("{name}.txt")), format!("{kind}\n{fault}\n")).expect("written");
}
