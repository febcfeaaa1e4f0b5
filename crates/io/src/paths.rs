//! Relative paths, paths within an output folder, and folders that a run creates for its results.
//!
//! Within an output folder no symbolic link is followed to write or to delete. Every module that writes or deletes below an output folder uses this one. The
//! output folder itself may be a link, made by its owner. A folder within it may not: the maker of such a link would choose where files go or disappear. A link
//! in the place of a file is replaced or removed itself, never its target.
//!
//! Folders that a run creates for its results are created if missing and removed again if they stay empty. Other runs may create and remove the same folders
//! meanwhile, above all those of other parts of one output folder.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

use crate::{Error, ErrorCode};

/// Relative path from a folder to a file, such as `../models/car.glb`. Both are absolute, without `.` and `..`; links are not followed.
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

/// Refuses a file, or a link, in the place of a folder between `root` and `target`.
pub(crate) fn check_folders(root: &Path, target: &Path) -> Result<(), Error> {
    let folders = target.ancestors().skip(1).take_while(|folder| *folder != root);
    folders.into_iter().try_for_each(check_folder)
}

/// The same for one folder, which need not exist.
pub(crate) fn check_folder(folder: &Path) -> Result<(), Error> {
    if folder.is_symlink() {
        return Err(Error::coded(
            ErrorCode::UnwritableOutput,
            folder,
            "a symbolic link is in the place of a results folder, and results must stay in the output folder; remove it, or choose another output folder",
        ));
    }
    if folder.is_file() {
        return Err(no_folder(folder));
    }
    Ok(())
}

/// Removes a file below `root`, or a link in its place; succeeds if there is none.
pub(crate) fn remove_file(root: &Path, target: &Path) -> Result<(), Error> {
    check_folders(root, target)?;
    match fs::remove_file(target) {
        Err(cause) if cause.kind() != ErrorKind::NotFound => {
            Err(Error::coded(ErrorCode::UnwritableOutput, target, format!("cannot be removed: {cause}")))
        }
        _ => Ok(()),
    }
}

/// Files in a folder below `root`, by name; none if it does not exist. Links, folders and devices are excluded.
pub(crate) fn files_in(root: &Path, folder: &Path) -> Result<Vec<PathBuf>, Error> {
    check_folders(root, folder)?;
    check_folder(folder)?;
    let failed = |cause: io::Error| {
        Error::coded(ErrorCode::UnreadableFile, folder, format!("this folder cannot be read: {cause}"))
    };
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(cause) => return Err(failed(cause)),
    };
    let mut files = Vec::new();
    for entry in entries {
        let entry = entry.map_err(failed)?;
        if entry.file_type().is_ok_and(|kind| kind.is_file()) {
            files.push(entry.path());
        }
    }
    files.sort();
    Ok(files)
}

/// Failure to create a folder.
#[derive(Debug)]
pub(crate) struct FolderError {
    /// Error for the user if there is no other attempt.
    pub(crate) error: Error,
    /// True if the folder, or its parent, was removed meanwhile: another attempt may succeed.
    pub(crate) is_gone: bool,
}

impl FolderError {
    /// Returns the failure of a system call on a path.
    pub(crate) fn from_io(path: &Path, problem: &str, cause: &io::Error) -> Self {
        let is_gone = cause.kind() == io::ErrorKind::NotFound;
        Self { error: Error::coded(ErrorCode::UnwritableOutput, path, format!("{problem}: {cause}")), is_gone }
    }

    /// Returns the failure of a folder that no longer has its name.
    pub(crate) fn removed(path: &Path) -> Self {
        let message = "this output folder is repeatedly removed while it is created; choose another one";
        Self { error: Error::coded(ErrorCode::UnwritableOutput, path, message), is_gone: true }
    }
}

impl From<Error> for FolderError {
    fn from(error: Error) -> Self {
        Self { error, is_gone: false }
    }
}

/// Folders that a run created.
#[derive(Debug, Default)]
pub(crate) struct CreatedFolders(Vec<PathBuf>);

impl CreatedFolders {
    /// Creates a folder and its missing parents.
    pub(crate) fn make(&mut self, folder: &Path) -> Result<(), FolderError> {
        let missing: Vec<&Path> = folder.ancestors().take_while(|f| !f.as_os_str().is_empty() && !f.exists()).collect();
        for path in missing.into_iter().rev() {
            match fs::create_dir(path) {
                Ok(()) => self.0.push(path.to_path_buf()),
                // Another run created it at this moment, or it is a dangling link: distinguished below.
                Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => {}
                Err(cause) => return Err(FolderError::from_io(path, "this output folder cannot be created", &cause)),
            }
        }
        if folder.as_os_str().is_empty() || folder.is_dir() {
            return Ok(());
        }
        match fs::symlink_metadata(folder) {
            Ok(_) => Err(no_folder(folder).into()),
            Err(_) => Err(FolderError::removed(folder)),
        }
    }

    /// Keeps the folders: they contain results.
    pub(crate) fn keep(&mut self) {
        self.0.clear();
    }

    /// Removes the empty folders.
    pub(crate) fn remove(&mut self) {
        for folder in self.0.drain(..).rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Error of a path that is no folder.
fn no_folder(path: &Path) -> Error {
    Error::coded(
        ErrorCode::UnwritableOutput,
        path,
        "expected a folder for the results, but this is a file; choose another name",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lead_from_the_folder_to_the_file() {
        let path = |folder: &str, file: &str| relative_path(Path::new(folder), Path::new(file));
        assert_eq!(path("/a/b/c", "/a/d/e.toml"), Path::new("../../d/e.toml"));
        assert_eq!(path("/a", "/a/e.toml"), Path::new("e.toml"));
    }

    #[cfg(unix)]
    #[test]
    fn nothing_is_listed_or_removed_through_a_link() {
        use std::os::unix::fs::symlink;

        let place = tempfile::tempdir().expect("temporary folder");
        let (root, foreign) = (place.path().join("out"), place.path().join("foreign"));
        [&root, &foreign].iter().for_each(|folder| fs::create_dir(folder).expect("folder"));
        fs::write(foreign.join("x"), b"theirs").expect("write");
        symlink(&foreign, root.join("linked")).expect("link");
        symlink(foreign.join("x"), root.join("x")).expect("link");
        for message in [
            files_in(&root, &root.join("linked")).map(|_| ()),
            remove_file(&root, &root.join("linked/x")),
            check_folders(&root, &root.join("linked/deep/x")),
        ] {
            let message = message.expect_err("a link in the place of a folder").to_string();
            assert!(message.contains("linked: a symbolic link is in the place of a results folder"), "{message}");
        }
        assert_eq!(files_in(&root, &root).expect("readable"), Vec::<PathBuf>::new(), "a link is no file");
        remove_file(&root, &root.join("x")).expect("the link itself");
        assert!(!root.join("x").is_symlink() && foreign.join("x").exists());
        assert_eq!(files_in(&root, &root.join("none")).expect("none"), Vec::<PathBuf>::new());
    }
}
