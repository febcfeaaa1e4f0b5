//! `cargo run -p etendue-fuzz -- --seconds 600 [--seed 1] [--found DIR] [TARGET …]`: every target in turn, or those that are named.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program that reports to its user")]

use etendue_fuzz::attempt::{attempt, keep_panics};
use etendue_fuzz::targets::{TARGETS, Target, target};
use etendue_fuzz::watch::watch;
use etendue_fuzz::worker::{StopCondition, work};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

const USAGE: &str =
    "usage: etendue-fuzz [--seconds S] [--seed N] [--found DIR] [TARGET …]\n       etendue-fuzz --read TARGET FILE";

struct Request {
    seconds: f64,
    seed: u64,
    findings: PathBuf,
    targets: Vec<&'static Target>,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["--worker", name, milliseconds, seed, folder] => worker(name, milliseconds, seed, Path::new(folder)),
        ["--read", name, file] => read(name, Path::new(file)),
        _ => match request(&words) {
            Some(request) => fuzz(&request),
            None => {
                let names: Vec<_> = TARGETS.iter().map(|target| target.name).collect();
                eprintln!("{USAGE}\ntargets: {}", names.join(", "));
                ExitCode::from(2)
            }
        },
    }
}

fn request(words: &[&str]) -> Option<Request> {
    let mut request = Request { seconds: 10.0, seed: 1, findings: PathBuf::from("target/fuzz"), targets: Vec::new() };
    let mut words = words.iter();
    while let Some(word) = words.next() {
        match *word {
            "--seconds" => request.seconds = words.next()?.parse().ok().filter(|s| (1.0..1e6).contains(s))?,
            "--seed" => request.seed = words.next()?.parse().ok()?,
            "--found" => request.findings = PathBuf::from(words.next()?),
            name => request.targets.push(target(name)?),
        }
    }
    if request.targets.is_empty() {
        request.targets = TARGETS.iter().collect();
    }
    Some(request)
}

fn fuzz(request: &Request) -> ExitCode {
    println!(
        "| target | s | inputs | ways | most MB | longest s | findings |\n| --- | --- | --- | --- | --- | --- | --- |"
    );
    let mut all = 0;
    for target in &request.targets {
        let result = watch(target, Duration::from_secs_f64(request.seconds), request.seed, &request.findings);
        let (name, megabytes) = (target.name, result.peak_bytes as f64 / 1e6);
        let (inputs, paths, time, count) = (result.inputs, result.paths, result.time_s, result.findings.len());
        println!("| {name} | {} | {inputs} | {paths} | {megabytes:.1} | {time:.2} | {count} |", request.seconds);
        for finding in result.findings.values() {
            eprintln!("{name}: {}", finding.chars().take(400).collect::<String>());
        }
        all += count;
    }
    ExitCode::from(u8::from(all > 0))
}

/// Works as told, and leaves the findings in a folder.
fn worker(name: &str, milliseconds: &str, seed: &str, folder: &Path) -> ExitCode {
    keep_panics();
    // What is found does not depend on threads.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
    let (Some(target), Ok(milliseconds), Ok(seed)) = (target(name), milliseconds.parse(), seed.parse()) else {
        return ExitCode::from(2);
    };
    let work = work(target, folder, seed, StopCondition::Time(Duration::from_millis(milliseconds)));
    for (i, (kind, (finding, input))) in work.findings.iter().enumerate() {
        let file = folder.join("findings").join(i.to_string());
        fs::write(file.with_extension("input"), input).expect("written");
        fs::write(file.with_extension("txt"), format!("{kind}\n{finding}\n")).expect("written");
    }
    println!("worked {} {} {} {}", work.inputs, work.paths, work.peak_bytes, work.time_s);
    ExitCode::SUCCESS
}

/// One input, and what comes of it.
fn read(name: &str, file: &Path) -> ExitCode {
    let (Some(target), Ok(input)) = (target(name), fs::read(file)) else { return ExitCode::from(2) };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let _ = (target.prepare)(folder.path());
    let place = folder.path().join(target.file);
    fs::write(&place, &input).expect("written");
    let attempt = attempt(target, &place);
    println!("{attempt:#?}\n{:?}", attempt.finding(target, input.len()));
    ExitCode::SUCCESS
}
