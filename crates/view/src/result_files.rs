//! The files of a result: by folder, and by frame if their names contain its number.

use std::path::{Path, PathBuf};
use std::{ffi::OsStr, fs, ops::Range};

use etendue::{Error, ErrorCode};

/// A file that may have layers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ResultFile {
    /// Folder within the result, with `/` between folders: usually a camera's name; empty for the result's own folder.
    pub(crate) place: String,
    /// File name.
    pub(crate) name: String,
    /// File name without frame and ending.
    pub(crate) stem: String,
    /// Frame number in the name; `None` if the file applies to all frames.
    pub(crate) frame: Option<u32>,
    pub(crate) path: PathBuf,
}

/// Endings of files with layers.
const ENDINGS: [&str; 9] = ["exr", "png", "tif", "tiff", "dng", "jpg", "jpeg", "pfm", "flo"];
/// Maximum number of files on a page.
const MAX_FILES: usize = 4_000;
/// Maximum depth of nested folders.
const MAX_DEPTH: usize = 8;
/// Order in which files of a folder are listed; others follow by name.
const ORDER: [&str; 10] = [
    "picture",
    "raw",
    "radiance",
    "irradiance",
    "electrons",
    "signal_breakdown",
    "ground_truth",
    "motion",
    "disparity",
    "boxes",
];

/// Returns the files of `folder`, sorted by place, kind and frame, without those of frames outside `frames`.
///
/// # Errors
/// If it is not a folder, cannot be read, or has no file or too many.
pub(crate) fn find(folder: &Path, frames: Option<&Range<u32>>) -> Result<Vec<ResultFile>, Error> {
    let refuse = |reason: String| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {reason}", folder.display()));
    if !folder.is_dir() {
        let problem = if folder.exists() { "not a folder" } else { "does not exist" };
        return Err(refuse(format!("{problem}; expected the folder of a result, as written by etendue render -o")));
    }
    let mut files = Vec::new();
    search(folder, "", 0, &mut files)?;
    if files.is_empty() {
        return Err(refuse(format!(
            "no result: expected files with layers ({}) in it or its subfolders",
            ENDINGS.join(", ")
        )));
    }
    files.retain(|file| file.frame.zip(frames).is_none_or(|(frame, frames)| frames.contains(&frame)));
    if files.is_empty() {
        return Err(refuse("none of its files is of a frame in `frames`".to_owned()));
    }
    if files.len() > MAX_FILES {
        let count = files.len();
        return Err(refuse(format!(
            "{count} files with layers, but a page has at most {MAX_FILES}; give a subfolder, or fewer frames (`frames`)"
        )));
    }
    let rank = |file: &ResultFile| ORDER.iter().position(|stem| *stem == file.stem).unwrap_or(ORDER.len());
    files.sort_by(|a, b| {
        (&a.place, rank(a), &a.stem, a.frame, &a.name).cmp(&(&b.place, rank(b), &b.stem, b.frame, &b.name))
    });
    Ok(files)
}

fn search(folder: &Path, place: &str, depth: usize, files: &mut Vec<ResultFile>) -> Result<(), Error> {
    let unreadable =
        |error| Error::coded(ErrorCode::UnreadableFile, format!("{}: cannot be read: {error}", folder.display()));
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let (path, kind) = (entry.path(), entry.file_type().map_err(unreadable)?);
        // Names that are not UTF-8 are not files of this program.
        let Ok(name) = entry.file_name().into_string() else { continue };
        if name.starts_with('.') {
            continue;
        }
        if kind.is_dir() && depth < MAX_DEPTH {
            let place = if place.is_empty() { name } else { format!("{place}/{name}") };
            search(&path, &place, depth + 1, files)?;
        } else if !kind.is_dir() && path.is_file() {
            files.extend(result_file(place, name, path));
        }
    }
    Ok(())
}

fn result_file(place: &str, name: String, path: PathBuf) -> Option<ResultFile> {
    let ending = path.extension().and_then(OsStr::to_str)?.to_ascii_lowercase();
    let base_name = name.get(..name.len() - ending.len() - 1)?;
    let (stem, frame) = match base_name.rsplit_once('.').map(|(stem, number)| (stem, frame(number))) {
        Some((stem, Some(frame))) => (stem, Some(frame)),
        _ => (base_name, None),
    };
    let has_layers = ENDINGS.contains(&ending.as_str()) || (ending == "json" && stem == "boxes");
    let stem = stem.to_owned();
    has_layers.then_some(ResultFile { place: place.to_owned(), stem, frame, name, path })
}

/// Parses a frame number in a file name.
fn frame(text: &str) -> Option<u32> {
    let is_number = text.len() >= 4 && text.bytes().all(|digit| digit.is_ascii_digit());
    text.parse().ok().filter(|_| is_number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(names: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().expect("temporary folder");
        for name in names {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, b"").expect("written");
        }
        folder
    }

    #[test]
    fn files_stand_by_camera_kind_and_frame() {
        let folder = folder(&[
            "right/picture.0001.png",
            "right/picture.0000.png",
            "left/a.exr",
            "left/ground_truth.exr",
            "left/camera.json",
            "left/.radiance.exr.1-0.part",
            "left/.hidden/picture.0000.png",
            "left/undistorted/rays.exr",
            "left/boxes.0003.json",
            "left/v1.2.exr",
            "tracks.json",
        ]);
        let files = find(folder.path(), None).expect("files");
        let actual: Vec<_> = files.iter().map(|f| (f.place.as_str(), f.stem.as_str(), f.frame)).collect();
        let expected = [
            ("left", "ground_truth", None),
            ("left", "boxes", Some(3)),
            ("left", "a", None),
            ("left", "v1.2", None),
            ("left/undistorted", "rays", None),
            ("right", "picture", Some(0)),
            ("right", "picture", Some(1)),
        ];
        assert_eq!(actual, expected);
        let some = find(folder.path(), Some(&(1..3))).expect("files");
        assert_eq!(some.iter().filter_map(|f| f.frame).collect::<Vec<_>>(), [1]);
    }

    #[test]
    fn what_is_no_result_is_refused() {
        let folder = folder(&["notes.txt", "a/camera.json", "picture.0000.png"]);
        let message = |path: &Path, frames| find(path, frames).expect_err("refused").to_string();
        assert!(message(&folder.path().join("a"), None).contains("no result: expected files with layers (exr, png"));
        assert!(message(&folder.path().join("notes.txt"), None).contains("not a folder"));
        assert!(message(&folder.path().join("none"), None).contains("does not exist; expected the folder of a result"));
        assert!(message(folder.path(), Some(&(5..6))).contains("`frames`"));
    }
}
