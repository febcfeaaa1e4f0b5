//! Runs with too little memory from the system: no file under a final name is incomplete, and the next run has the result of a first one.

use crate::support::{assert_same, contents, rendered, root, small, text};
use std::path::Path;
use std::process::Command;

/// Runs the program with this much address space, KiB; returns its status (`None`: ended by a signal) and output.
fn with_address_space(kib: u32, arguments: &[&str]) -> (Option<i32>, String) {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("ulimit -c 0; ulimit -v {kib}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_etendue")]);
    let output = shell.args(arguments).current_dir(root()).output().expect("a shell");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_film_without_enough_memory_is_refused_before_the_render() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (small(), text(&place.path().join("out")));
    let size = ["--set", "cameras.front.sensor.width_px=16000", "--set", "cameras.front.sensor.height_px=16000"];
    let arguments = [&["render", &job, "-o", &out, "--threads", "1", "--spp", "2"][..], &size].concat();
    let (status, stderr) = with_address_space(1_500_000, &arguments);
    assert_eq!(status, Some(2), "{stderr}");
    let parts = [
        "error[not-enough-memory]: the run needs ",
        "within the address space of the process",
        "camera front ",
        "width_px",
        "--film-memory",
    ];
    assert!(parts.iter().all(|part| stderr.contains(part)), "{stderr}");
    assert!(!Path::new(&out).exists(), "{:?}", contents(Path::new(&out)).keys());
}

/// The film fits into memory, and its products do not: ground truth and spectra of 1 million pixels take 112 MB.
#[test]
fn products_made_after_the_render_count_in_the_check_before_it() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (place.path().join("job.toml"), place.path().join("out"));
    std::fs::write(&job, UNIFORM).expect("written");
    let (job, out) = (text(&job), text(&out));
    let (status, stderr) = with_address_space(190_000, &["render", &job, "-o", &out, "--threads", "1"]);
    assert_eq!(status, Some(2), "{stderr}");
    assert!(stderr.contains("output.ground_truth = false") && stderr.contains("render.band_width_nm"), "{stderr}");
    assert!(!Path::new(&out).exists(), "nothing is written");
}

/// The planned memory is at least the peak that the kernel reports, and at most 20 % above it, apart from the bounds of 64 MiB each on rows that wait
/// to be written and on freed blocks that the C library keeps.
#[test]
fn a_plan_states_the_memory_of_the_whole_run() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (place.path().join("job.toml"), place.path().join("out"));
    std::fs::write(&job, UNIFORM).expect("written");
    let plan = crate::support::etendue(["plan", &text(&job), "--json"]).ok().out;
    let plan: serde_json::Value = serde_json::from_str(&plan).expect("JSON");
    let planned = plan["memory"]["bytes"].as_f64().expect("a number");
    let peak = peak_bytes(&["render", &text(&job), "-o", &text(&out), "--threads", "1"]);
    const BOUNDS: f64 = (128 << 20) as f64;
    assert!(planned >= peak && planned < 1.2 * peak + BOUNDS, "{planned:e} planned, {peak:e} used");
}

/// Returns the peak memory of the program, bytes, read while it runs (VmHWM never decreases).
fn peak_bytes(arguments: &[&str]) -> f64 {
    let mut run =
        Command::new(env!("CARGO_BIN_EXE_etendue")).args(arguments).current_dir(root()).spawn().expect("runs");
    let status = format!("/proc/{}/status", run.id());
    let mut peak = 0.0_f64;
    while run.try_wait().expect("a status").is_none() {
        let lines = std::fs::read_to_string(&status).unwrap_or_default();
        let line = lines.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
        peak = peak.max(1024.0 * kib.unwrap_or(0.0));
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    peak
}

/// A plane under uniform illumination, 1000 × 1000 px in 3 bands.
const UNIFORM: &str = r#"
format = 1
[scene]
materials = [{ name = "m", type = "diffuse", reflectance = 0.5 }]
environment = { type = "uniform", radiance_w_m2_sr_nm = 1 }
objects = [{ name = "p", shape = { type = "quad", size_m = [10, 10] }, material = "m" }]
[[cameras]]
name = "c"
position_m = [-4, 0, 3]
look_at_m = [0, 0, 0.5]
lens = { type = "pinhole", focal_length_mm = 5, f_number = 8 }
sensor = { width_px = 1000, height_px = 1000, pixel_pitch_um = 10 }
[render]
spp = 2
replicates = 2
band_width_nm = 100
wavelength_range_nm = [400, 700]
max_bounces = 1
[output]
radiance = true
ground_truth = true
"#;

/// Memory may be exhausted at any point, from the start of the program to the last file.
#[test]
fn no_allocation_that_fails_leaves_half_a_file() {
    let expected = rendered(&small(), &["--spp", "2"]);
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let mut ends = [0; 2];
    for kib in (20..=200).step_by(12).map(|mib| mib * 1024) {
        let (status, stderr) = with_address_space(
            kib,
            &["render", &small(), "-o", &text(&out), "--spp", "2", "--overwrite", "--threads", "1"],
        );
        ends[usize::from(status == Some(0))] += 1;
        // Failed small allocations end the process at once (SIGABRT), as in Rust's standard library; below some limit the system does not even start
        // it.
        let is_reported = status.is_none_or(|status| status == 0) || stderr.contains("error");
        assert!(is_reported, "{kib} KiB: {status:?} {stderr}");
        for (name, bytes) in contents(&out) {
            let is_hidden = Path::new(&name).file_name().is_some_and(|file| file.to_string_lossy().starts_with('.'));
            assert!(is_hidden || expected[&name] == bytes, "{name} at {kib} KiB");
        }
    }
    assert!(ends.iter().all(|count| *count > 0), "limits below and above what is needed: {ends:?}");
    assert_same(&expected, &contents(&out), "after the last");
}
