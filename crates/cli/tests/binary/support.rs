//! Runs the binary and inspects its results.

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder `crates/cli/tests`.
pub(crate) fn tests() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")
}

/// The repository's root.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("crates/cli lies two folders deep").to_path_buf()
}

/// The job with many features.
pub(crate) fn small() -> String {
    text(&tests().join("jobs/small/small.toml"))
}

/// A ball on a floor under a uniform sky, in front of a small colour camera: a job to which render settings are added.
pub(crate) const BALL: &str = r#"format = 1
[scene]
[scene.environment]
type = "uniform"
luminance_cd_m2 = 30
illuminant = "D65"
[[scene.materials]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[scene.objects]]
name = "floor"
shape = { type = "quad", size_m = [30, 30] }
material = "grey"
[[scene.objects]]
name = "ball"
shape = { type = "sphere", radius_m = 1 }
position_m = [6, 0, 1]
material = "grey"
[[cameras]]
name = "front"
position_m = [0, 0, 1.4]
look_at_m = [6, 0, 0.9]
[cameras.lens]
type = "thin"
focal_length_mm = 6
f_number = 2
focus_distance_m = 5
[cameras.sensor]
width_px = 40
height_px = 28
pixel_pitch_um = 150
exposure_s = 2e-6
cfa = "rggb"
quantum_efficiency = { camera = "nikon-d5100", peak = 0.5 }
full_well_e = 50_000
read_noise_e = 4
dark_current_e_s = 5
gain_dn_per_e = 0.05
black_level_dn = 64
bits = 12
"#;

/// True if stored results are to be rewritten.
pub(crate) fn bless() -> bool {
    std::env::var_os("ETENDUE_BLESS").is_some_and(|value| value == "1")
}

/// True if studies are complete, of which CI runs a part (`just whole`).
pub(crate) fn is_complete_run() -> bool {
    std::env::var_os("ETENDUE_WHOLE").is_some_and(|value| value == "1")
}

/// The message of a line that states an error, without its code; `None` for other lines.
pub(crate) fn error_message(line: &str) -> Option<&str> {
    line.strip_prefix("error: ").or_else(|| Some(line.strip_prefix("error[")?.split_once("]: ")?.1))
}

/// The code of a line that states an error with one.
pub(crate) fn error_code(line: &str) -> Option<&str> {
    Some(line.strip_prefix("error[")?.split_once("]: ")?.0)
}

/// A path as an argument.
pub(crate) fn text(path: &Path) -> String {
    path.to_str().expect("the tests' paths are UTF-8").to_owned()
}

/// Output and status of a run.
#[derive(Debug)]
pub(crate) struct CommandOutput {
    pub(crate) status: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl CommandOutput {
    /// Asserts success.
    #[track_caller]
    pub(crate) fn ok(self) -> Self {
        assert_eq!(self.status, 0, "{}", self.err);
        self
    }

    /// Asserts a refusal: status 2, nothing on stdout, and every one of these phrases on one line of stderr.
    #[track_caller]
    pub(crate) fn refused(self, phrases: &[&str]) -> Self {
        assert_eq!(self.status, 2, "{self:?}");
        assert_eq!(self.out, "", "nothing goes to stdout");
        self.says(phrases)
    }

    /// Asserts that one line of stderr contains all of these.
    #[track_caller]
    pub(crate) fn says(self, phrases: &[&str]) -> Self {
        let is_said = self.err.lines().any(|line| phrases.iter().all(|phrase| line.contains(phrase)));
        assert!(is_said, "no line with all of {phrases:?} in:\n{}", self.err);
        self
    }
}

/// Runs the binary from the repository's root.
pub(crate) fn etendue<S: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = S>) -> CommandOutput {
    etendue_with(arguments, &[])
}

/// Runs the binary with further environment variables.
pub(crate) fn etendue_with<S: AsRef<std::ffi::OsStr>>(
    arguments: impl IntoIterator<Item = S>,
    environment: &[(&str, &str)],
) -> CommandOutput {
    let mut command = Command::cargo_bin("etendue").expect("cargo builds the binary for its tests");
    command.current_dir(root()).env_remove("ETENDUE_SIMD").args(arguments);
    environment.iter().for_each(|(name, value)| {
        command.env(name, value);
    });
    run(command)
}

/// Runs the binary in a folder.
pub(crate) fn etendue_in<S: AsRef<std::ffi::OsStr>>(
    folder: &Path,
    arguments: impl IntoIterator<Item = S>,
) -> CommandOutput {
    let mut command = Command::cargo_bin("etendue").expect("cargo builds the binary for its tests");
    command.current_dir(folder).env_remove("ETENDUE_SIMD").args(arguments);
    run(command)
}

fn run(mut command: Command) -> CommandOutput {
    let output = command.output().expect("the binary starts");
    let utf8 = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program writes UTF-8");
    CommandOutput {
        status: output.status.code().expect("it ends by itself"),
        out: utf8(output.stdout),
        err: utf8(output.stderr),
    }
}

/// Returns all files below a folder with their bytes, by relative name.
pub(crate) fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    collect(folder, folder, &mut files);
    files
}

fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<String, Vec<u8>>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(root, &path, files);
        } else {
            let name = text(path.strip_prefix(root).expect("below the root"));
            files.insert(name, std::fs::read(&path).expect("a readable file"));
        }
    }
}

/// Renders a job into a temporary folder and returns its files.
#[track_caller]
pub(crate) fn rendered(job: &str, options: &[&str]) -> BTreeMap<String, Vec<u8>> {
    rendered_with(job, options, &[])
}

/// [`rendered`] with environment variables.
#[track_caller]
pub(crate) fn rendered_with(job: &str, options: &[&str], environment: &[(&str, &str)]) -> BTreeMap<String, Vec<u8>> {
    let place = tempfile::tempdir().expect("a temporary folder");
    let output = text(&place.path().join("out"));
    let arguments = ["render", job, "-o", &output].into_iter().chain(options.iter().copied());
    etendue_with(arguments, environment).ok();
    contents(Path::new(&output))
}

/// Asserts that both runs left the same files with the same bytes.
#[track_caller]
pub(crate) fn assert_same(a: &BTreeMap<String, Vec<u8>>, b: &BTreeMap<String, Vec<u8>>, what: &str) {
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(a), names(b), "{what}: other files");
    for (name, bytes) in a {
        assert!(*bytes == b[name], "{what}: {name} has other bytes");
    }
}
