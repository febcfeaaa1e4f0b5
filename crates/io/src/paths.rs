//! Paths as files name them.

use std::path::{Component, Path, PathBuf};

/// The way from a folder to a file, such as `../models/car.glb`. Both are absolute, without `.` and `..`; links are not followed.
#[must_use]
pub fn relative_path(folder: &Path, file: &Path) -> PathBuf {
    let shared = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(file.components().skip(shared)).collect()
}

/// Returns the stem of a camera file's name, which names the folder of its results; `camera` if there is none.
#[must_use]
pub fn camera_stem(file: &Path) -> String {
    file.file_stem().map_or_else(|| "camera".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lead_from_the_folder_to_the_file() {
        let way = |folder: &str, file: &str| relative_path(Path::new(folder), Path::new(file));
        assert_eq!(way("/a/b/c", "/a/d/e.toml"), Path::new("../../d/e.toml"));
        assert_eq!(way("/a", "/a/e.toml"), Path::new("e.toml"));
    }
}
