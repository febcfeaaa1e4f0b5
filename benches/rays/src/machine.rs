//! The machine and the build that were measured.

use std::process::Command;

/// Processor, threads, instruction sets, compiler and commit in one line.
pub fn line() -> String {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let rustc = answer("rustc", &["--version"]).unwrap_or_else(|| "unknown rustc".to_owned());
    let commit = answer("git", &["describe", "--always", "--dirty"]).unwrap_or_else(|| "unknown".to_owned());
    let (sets, own_set) = (processor_sets(), our_set());
    format!("{}, {threads} hardware threads ({sets}; Étendue uses {own_set}); {rustc}; commit {commit}", processor())
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

/// The instruction sets of the processor that matter to rays, as the kernel tells them (Linux), the largest last.
#[must_use]
pub fn processor_sets() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let flags = text.lines().find_map(|line| line.strip_prefix("flags")?.split(':').nth(1)).unwrap_or_default();
    let known = |(flag, name): &(&str, &'static str)| flags.split(' ').any(|f| f == *flag).then_some(*name);
    let sets: Vec<&str> = INSTRUCTION_SETS.iter().filter_map(known).collect();
    if sets.is_empty() { "unknown".to_owned() } else { sets.join(", ") }
}

/// Flags of /proc/cpuinfo, and the names of what they stand for.
const INSTRUCTION_SETS: [(&str, &str); 6] = [
    ("sse4_2", "SSE4.2"),
    ("avx", "AVX"),
    ("fma", "FMA"),
    ("avx2", "AVX2"),
    ("avx512f", "AVX-512F"),
    ("avx512vl", "AVX-512VL"),
];

/// What Étendue's kernels use of them.
#[must_use]
pub fn our_set() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        return "AVX2, 8 lanes";
    }
    "scalar"
}

/// First line of what a program prints.
fn answer(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    text.lines().next().map(str::to_owned)
}
