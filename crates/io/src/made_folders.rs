//! Folders that a run makes for its results: made where they are missing, removed again where nothing came into them.
//!
//! Other runs may make and remove the same folders meanwhile, those of other parts of one output folder above all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::{Error, ErrorCode};

/// Why a folder could not be had.
#[derive(Debug)]
pub(crate) struct Missed {
    /// What the user is told where no other try follows.
    pub(crate) error: Error,
    /// Whether it, or the folder around it, was removed meanwhile: another try may have it.
    pub(crate) is_gone: bool,
}

impl Missed {
    /// A fault of the system over a path.
    pub(crate) fn of(path: &Path, told: &str, cause: &io::Error) -> Self {
        let is_gone = cause.kind() == io::ErrorKind::NotFound;
        Self { error: Error::coded(ErrorCode::UnwritableOutput, path, format!("{told}: {cause}")), is_gone }
    }

    /// A folder that has its name no more.
    pub(crate) fn gone(path: &Path) -> Self {
        let told = "this output folder is removed again and again while it is made; choose another one";
        Self { error: Error::coded(ErrorCode::UnwritableOutput, path, told), is_gone: true }
    }
}

impl From<Error> for Missed {
    fn from(error: Error) -> Self {
        Self { error, is_gone: false }
    }
}

/// Folders that a run made itself.
#[derive(Debug, Default)]
pub(crate) struct MadeFolders(Vec<PathBuf>);

impl MadeFolders {
    /// Makes a folder and those around it, where they are missing.
    pub(crate) fn make(&mut self, folder: &Path) -> Result<(), Missed> {
        let missing: Vec<&Path> = folder.ancestors().take_while(|f| !f.as_os_str().is_empty() && !f.exists()).collect();
        for path in missing.into_iter().rev() {
            match fs::create_dir(path) {
                Ok(()) => self.0.push(path.to_path_buf()),
                // Another run made it at this moment, or it is a link that leads nowhere: seen below.
                Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => {}
                Err(cause) => return Err(Missed::of(path, "this output folder cannot be made", &cause)),
            }
        }
        if folder.as_os_str().is_empty() || folder.is_dir() {
            return Ok(());
        }
        match fs::symlink_metadata(folder) {
            Ok(_) => Err(no_folder(folder).into()),
            Err(_) => Err(Missed::gone(folder)),
        }
    }

    /// They stay: results are in them.
    pub(crate) fn keep(&mut self) {
        self.0.clear();
    }

    /// Removes those in which nothing is.
    pub(crate) fn remove(&mut self) {
        for folder in self.0.drain(..).rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// The error of what is in the place of a folder and is none.
pub(crate) fn no_folder(path: &Path) -> Error {
    Error::coded(
        ErrorCode::UnwritableOutput,
        path,
        "expected a folder for the results, but this is a file; choose another name",
    )
}
