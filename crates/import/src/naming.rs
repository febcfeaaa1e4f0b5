//! Names, paths and angles in the form of the format.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use etendue_core::maths::f64 as maths;
use etendue_io::paths::relative_path;
use glam::DVec3;

/// Names in use, each with the number of the next similar one.
#[derive(Debug, Default)]
pub(super) struct UniqueNames(HashMap<String, u64>);

impl UniqueNames {
    /// Returns a unique name similar to `wish`: only its letters, digits, `-` and `_`, or `fallback` if it has none.
    pub(super) fn take(&mut self, preferred: &str, fallback: &str) -> String {
        const MAX: usize = 60;
        let plain: String =
            preferred.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' }).collect();
        let plain: String = plain.trim_matches('-').chars().take(MAX).collect();
        let stem = if plain.is_empty() { fallback.to_owned() } else { plain };
        let mut name = stem.clone();
        while self.0.contains_key(&name.to_lowercase()) {
            let next = self.0.entry(stem.to_lowercase()).or_insert(2);
            name = format!("{stem}-{next}");
            *next += 1;
        }
        self.0.insert(name.to_lowercase(), 2);
        name
    }
}

/// Rounds angles, degrees, so that a quarter turn of the file is exact again.
pub(super) fn rounded(degrees: [f64; 3]) -> [f64; 3] {
    degrees.map(|angle| (1e9 * angle).round() / 1e9)
}

/// Azimuth from +x towards +y and elevation of a direction, degrees.
pub(super) fn azimuth_elevation_deg(v: DVec3) -> [f64; 2] {
    let level = (v.x * v.x + v.y * v.y).sqrt();
    [maths::atan2(v.y, v.x).to_degrees(), maths::atan2(v.z, level).to_degrees()]
}

/// Path from a folder to a file, with `/`; the file's own path if there is none. `folder` is absolute and need not exist.
pub(super) fn path_between(folder: &Path, file: &Path) -> PathBuf {
    let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    // Links in the existing part are followed, as `..` after a link leads elsewhere.
    let (from, to) = (real(folder), real(&file));
    // Another drive: there is no relative path.
    if from.components().next() == to.components().next() { relative_path(&from, &to) } else { file }
}

/// Path whose existing part has no links.
fn real(path: &Path) -> PathBuf {
    let mut ancestors = path.ancestors();
    let ancestor = ancestors.find_map(|part| part.canonicalize().ok().map(|real| (part, real)));
    match ancestor {
        Some((part, real)) => path.strip_prefix(part).map_or_else(|_| path.to_owned(), |rest| real.join(rest)),
        None => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_each_once() {
        let mut names = UniqueNames::default();
        let unique = ["Key Light", "key-light", "ü", "", "a/b"].map(|preferred| names.take(preferred, "light"));
        assert_eq!(unique, ["Key-Light", "key-light-2", "light", "light-2", "a-b"]);
    }

    #[test]
    fn paths_lead_from_folder_to_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path();
        std::fs::create_dir_all(root.join("models")).expect("made");
        std::fs::write(root.join("models/car.glb"), "").expect("written");
        let relative = path_between(&root.join("out/new"), &root.join("models/car.glb"));
        assert_eq!(relative, Path::new("../../models/car.glb"));
        assert_eq!(path_between(root, &root.join("models/car.glb")), Path::new("models/car.glb"));
    }
}
