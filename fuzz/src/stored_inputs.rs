//! Inputs that were found, to be read again: `fuzz/found/<target>/<name>`.

use std::path::{Path, PathBuf};

/// The folder of the crate.
#[must_use]
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("found")
}

/// The stored inputs of a target, by name.
#[must_use]
pub fn findings(target: &str) -> Vec<(String, Vec<u8>)> {
    let files = std::fs::read_dir(folder().join(target)).into_iter().flatten().flatten().map(|entry| entry.path());
    let read = |path: PathBuf| {
        let name = path.file_name()?.to_str()?.to_owned();
        Some((name, std::fs::read(&path).ok()?))
    };
    let mut inputs: Vec<_> = files.filter_map(read).collect();
    inputs.sort();
    inputs
}
