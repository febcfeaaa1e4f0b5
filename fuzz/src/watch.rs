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
pub const TIMEOUT_STATUS: i32 = 77;
/// Memory of a worker, kB: more is not given to it, and it ends.
const MAX_KB: u64 = 6_000_000;

/// What came of a target.
#[derive(Clone, Debug, Default)]
pub struct TargetResult {
    /// Inputs that were read by workers that lived.
    pub inputs: u64,
    /// Ways of the worker that found most.
    pub paths: usize,
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
pub fn watch(target: &Target, time: Duration, seed: u64, findings_folder: &Path) -> TargetResult {
    let start = Instant::now();
    let mut result = TargetResult::default();
    for serial in 0.. {
        let left = time.saturating_sub(start.elapsed());
        if left < Duration::from_millis(500) {
            break;
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("findings");
        fs::create_dir(&out).expect("a folder");
        let (ended, message) = run(target, left, seed.wrapping_add(serial << 32), folder.path());
        store(&mut result, target, &out, findings_folder);
        match message.split_once("worked ").map(|(_, figures)| figures.split_whitespace().collect::<Vec<_>>()) {
            Some(figures) => add(&mut result, &figures),
            None => record_death(&mut result, target, folder.path(), &format!("{ended}: {message}"), findings_folder),
        }
    }
    result
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

fn add(result: &mut TargetResult, figures: &[&str]) {
    let number = |i: usize| figures.get(i).and_then(|word| word.parse::<f64>().ok()).unwrap_or(0.0);
    result.inputs += number(0) as u64;
    result.paths = result.paths.max(number(1) as usize);
    result.peak_bytes = result.peak_bytes.max(number(2) as u64);
    result.time_s = result.time_s.max(number(3));
}

/// Takes over the findings of a worker.
fn store(result: &mut TargetResult, target: &Target, out: &Path, findings_folder: &Path) {
    for text in fs::read_dir(out).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if text.extension().is_some_and(|extension| extension == "txt") {
            let finding_text = fs::read_to_string(&text).unwrap_or_default();
            let (kind, finding) = finding_text.split_once('\n').unwrap_or((&finding_text, ""));
            keep_finding(
                result,
                target,
                (kind, finding),
                &fs::read(text.with_extension("input")).unwrap_or_default(),
                findings_folder,
            );
        }
    }
}

fn record_death(result: &mut TargetResult, target: &Target, folder: &Path, message: &str, findings_folder: &Path) {
    let kind: String = message.chars().filter(|c| !c.is_ascii_digit()).take(160).collect();
    let input = fs::read(folder.join(target.file)).unwrap_or_default();
    keep_finding(result, target, (&kind.replace('\n', " "), message), &input, findings_folder);
}

fn keep_finding(
    result: &mut TargetResult,
    target: &Target,
    (kind, finding): (&str, &str),
    input: &[u8],
    findings_folder: &Path,
) {
    if result.findings.contains_key(kind) {
        return;
    }
    let name = format!("{}-{}", target.name, result.findings.len());
    result.findings.insert(kind.to_owned(), finding.to_owned());
    fs::create_dir_all(findings_folder).expect("a folder");
    fs::write(findings_folder.join(format!("{name}.input")), input).expect("written");
    fs::write(findings_folder.join(format!("{name}.txt")), format!("{kind}\n{finding}\n")).expect("written");
}
