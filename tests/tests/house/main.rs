//! Rules of the repository: dependencies, names, sizes, links, and which file may import which.

mod additions;
mod circles;
mod counts;
mod dependencies;
mod links;
mod names;
mod sensor_scale;
mod tidy;

use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the workspace").to_path_buf()
}

/// The files that git tracks, and new ones that it does not ignore, as paths from the folder of the repository; only names that end so.
fn files(suffixes: &[&str]) -> Vec<String> {
    let arguments = ["ls-files", "-z", "--cached", "--others", "--exclude-standard"];
    let output = Command::new("git").args(arguments).current_dir(root()).output().expect("git runs");
    let names = String::from_utf8(output.stdout).expect("names in UTF-8");
    names.split('\0').filter(|name| suffixes.iter().any(|suffix| name.ends_with(suffix))).map(str::to_owned).collect()
}

/// The files whose names end so, with their text; files that are not text are left out.
fn texts(suffixes: &[&str]) -> Vec<(String, String)> {
    let text = |name: String| std::fs::read_to_string(root().join(&name)).ok().map(|text| (name, text));
    files(suffixes).into_iter().filter_map(text).collect()
}
