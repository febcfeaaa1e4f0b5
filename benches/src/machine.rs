//! The machine and the build that were measured.

use std::process::Command;

/// Processor, threads, instruction set, compiler and commit in one line.
pub fn line() -> String {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let rustc = answer("rustc", &["--version"]).unwrap_or_else(|| "unknown rustc".to_owned());
    let commit = answer("git", &["describe", "--always", "--dirty"]).unwrap_or_else(|| "unknown".to_owned());
    format!("{}, {threads} hardware threads, {}; {rustc}; commit {commit}", processor(), instructions())
}

/// How busy the machine has been in the last minute.
pub fn load() -> String {
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    format!(
        "Load of the machine in the last minute, this program's included: {}",
        text.split(' ').next().unwrap_or("?")
    )
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|line| line.strip_prefix("model name")?.split(':').nth(1));
    model.map_or_else(|| "unknown processor".to_owned(), |name| name.trim().to_owned())
}

#[cfg(target_arch = "x86_64")]
fn instructions() -> &'static str {
    if is_x86_feature_detected!("avx2") { "AVX2" } else { "no AVX2" }
}

#[cfg(not(target_arch = "x86_64"))]
fn instructions() -> &'static str {
    "no AVX2"
}

/// First line of what a program prints.
fn answer(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    text.lines().next().map(str::to_owned)
}
