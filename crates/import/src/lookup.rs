//! Search for the files that a scene names: other capitals, backslashes, and absolute paths of another machine.

use std::path::{Path, PathBuf};

/// File that matches a name of the scene.
pub(crate) struct FileMatch {
    pub(crate) path: PathBuf,
    /// True if its name is spelt as in the scene.
    pub(crate) is_exact: bool,
}

/// The stated path; else the longest end of it that lies in or below `folder`, with any capitals. A backslash separates folders too.
pub(crate) fn search(folder: &Path, name: &str) -> Option<FileMatch> {
    let stated = folder.join(name);
    if stated.is_file() {
        return Some(FileMatch { path: stated, is_exact: true });
    }
    let parts: Vec<&str> = name.split(['/', '\\']).filter(|part| !part.is_empty() && *part != ".").collect();
    let ends = (0..parts.len()).map(|first| &parts[first..]);
    let path = ends.filter_map(|end| below(folder, end)).next()?;
    Some(FileMatch { path, is_exact: false })
}

/// File whose path from `folder` is `parts`, with any capitals.
fn below(folder: &Path, parts: &[&str]) -> Option<PathBuf> {
    let mut path = folder.to_owned();
    for part in parts {
        let next = path.join(part);
        path = match *part == ".." || next.exists() {
            true => next,
            false => entry_of_any_capitals(&path, part)?,
        };
    }
    path.is_file().then_some(path)
}

/// Entry of a folder whose name differs only in capitals; the first in order if there are several.
fn entry_of_any_capitals(folder: &Path, name: &str) -> Option<PathBuf> {
    let lower = name.to_lowercase();
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).ok()?.filter_map(Result::ok).map(|entry| entry.path());
    entries.filter(|path| path.file_name().is_some_and(|n| n.to_string_lossy().to_lowercase() == lower)).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_by_other_capitals_and_by_paths_of_another_machine() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path();
        std::fs::create_dir(root.join("Textures")).expect("made");
        std::fs::write(root.join("Textures/Wood.PNG"), "a").expect("written");
        std::fs::write(root.join("sky.pfm"), "b").expect("written");
        let find = |name: &str| {
            search(root, name).map(|result| {
                (result.path.strip_prefix(root).expect("below").to_string_lossy().into_owned(), result.is_exact)
            })
        };
        let wood = |is_exact| Some(("Textures/Wood.PNG".to_owned(), is_exact));
        assert_eq!(find("Textures/Wood.PNG"), wood(true));
        assert_eq!(find("textures\\wood.png"), wood(false));
        assert_eq!(find("C:\\scenes\\house\\textures\\wood.png"), wood(false));
        assert_eq!(find("/mnt/other/Textures/Wood.PNG"), wood(false));
        assert_eq!(find("/mnt/other/sky.pfm"), Some(("sky.pfm".to_owned(), false)));
        assert_eq!(find("../x/SKY.pfm"), Some(("sky.pfm".to_owned(), false)));
        assert_eq!(find("wood.png"), None);
    }
}
