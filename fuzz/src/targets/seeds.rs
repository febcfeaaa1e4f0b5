//! Valid inputs: small files of this crate and of the repository.

use std::fs;
use std::path::{Path, PathBuf};

fn crate_folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The files of a folder in `fuzz/seeds`.
pub(super) fn stored(folder: &str) -> Vec<Vec<u8>> {
    let folder = crate_folder().join("seeds").join(folder);
    let mut files: Vec<PathBuf> =
        fs::read_dir(&folder).expect("seeds").map(|entry| entry.expect("a readable entry").path()).collect();
    files.sort();
    files.iter().map(|file| fs::read(file).expect("a seed")).collect()
}

/// Files of the repository.
pub(super) fn repository<const N: usize>(files: [&str; N]) -> Vec<Vec<u8>> {
    let root = crate_folder().parent().expect("fuzz/ lies in the workspace");
    files.iter().map(|file| fs::read(root.join(file)).unwrap_or_else(|_| panic!("{file} is there"))).collect()
}

/// Writes a file that the reader finds beside its input.
pub(super) fn write(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) {
    fs::write(folder.join(name), bytes).expect("the folder of the worker is writable");
}
