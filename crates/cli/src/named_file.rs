//! Files that the user names one by one: plots, previews, camera files.

use crate::failure::Failure;
use etendue_io::{Existing, OutputFolder};
use std::path::{Path, PathBuf};

/// Writes a file and the folders that lead to it; never half of it.
pub fn write(path: &Path, bytes: &[u8], existing: Existing) -> Result<(), Failure> {
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| Failure::input(format!("{}: expected the name of a file", path.display())))?;
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut folder = OutputFolder::open(parent, existing).map_err(Failure::input)?;
    folder.write(name, bytes).map_err(Failure::input)?;
    folder.commit().map_err(|error| Failure::Run(error.to_string())).map(|_| ())
}

/// The name of a plot: nothing but an earlier drawing can be replaced by it.
pub fn svg(text: &str) -> Result<PathBuf, String> {
    ending(text, "svg")
}

/// The name of a picture.
pub fn png(text: &str) -> Result<PathBuf, String> {
    ending(text, "png")
}

/// The name of a camera file.
pub fn toml(text: &str) -> Result<PathBuf, String> {
    ending(text, "toml")
}

fn ending(text: &str, extension: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension)) {
        true => Ok(path),
        false => Err(format!("expected a file name that ends in .{extension}")),
    }
}

/// Whether two names are of one file that is there.
pub fn same(a: &Path, b: &Path) -> bool {
    a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b)
}
