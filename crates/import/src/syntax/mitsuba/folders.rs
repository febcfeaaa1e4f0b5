//! Search folders for files.
//!
//! As in Mitsuba 3.9: later folders of `<path>` come before earlier ones, these before the folder of the file that contains them, and that before the folders
//! of the including file. A `<path>` is resolved relative to its file, then to the folders so far. Folders of an included file apply until its end, after which
//! Mitsuba forgets them; meshes and images are also searched there, last of all.

use std::path::{Path, PathBuf};

/// Maximum folders of `<path>` and of included files: every file is searched in all of them.
const MAX_FOLDERS: usize = 64;

pub(super) struct Folders {
    /// Current folders; the first is searched last.
    now: Vec<PathBuf>,
    /// Folders of `<path>` of included files that ended.
    ended: Vec<PathBuf>,
}

/// Start of an included file.
pub(super) struct IncludeMark(usize);

impl Folders {
    /// Returns the folders of the first file.
    pub(super) fn new(file: &Path) -> Self {
        Self { now: vec![folder_of(file)], ended: Vec::new() }
    }

    /// From now on files are searched first next to `file`, which includes another.
    pub(super) fn begin(&mut self, file: &Path) -> IncludeMark {
        let mark = IncludeMark(self.now.len());
        self.now.push(folder_of(file));
        mark
    }

    /// Ends an included file.
    pub(super) fn end(&mut self, mark: &IncludeMark) {
        self.ended.extend(self.now.drain(mark.0..).skip(1));
    }

    /// Adds the folder of a `<path>` in `file`, if it exists according to `is_folder`.
    pub(super) fn add(
        &mut self,
        name: &str,
        file: &Path,
        is_folder: impl Fn(&Path) -> Result<bool, String>,
    ) -> Result<(), String> {
        if self.now.len() + self.ended.len() > MAX_FOLDERS {
            return Err(format!("more than {MAX_FOLDERS} <path> elements; use fewer folders"));
        }
        for folder in std::iter::once(folder_of(file)).chain(self.now.iter().rev().cloned()) {
            let path = folder.join(name);
            if is_folder(&path)? {
                self.now.push(path);
                return Ok(());
            }
        }
        Err(format!(
            "<path value=\"{name}\">: no such folder next to the file or in an earlier <path>; correct it, or remove it"
        ))
    }

    /// Path of a file; next to the first file if it is not found.
    pub(super) fn find(&self, name: &str) -> PathBuf {
        let mut paths = self.now.iter().rev().map(|folder| folder.join(name));
        paths.find(|path| path.is_file()).unwrap_or_else(|| self.now[0].join(name))
    }

    /// All folders in search order, after the end of the first file.
    pub(super) fn all(self) -> Vec<PathBuf> {
        self.now.into_iter().rev().chain(self.ended).collect()
    }
}

fn folder_of(file: &Path) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).to_owned()
}
