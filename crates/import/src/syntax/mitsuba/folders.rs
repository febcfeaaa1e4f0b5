//! Folders in which files are sought.
//!
//! As Mitsuba 3.9 has it: later folders of `<path>` before earlier ones, these before the folder of the file that holds them, and that before what held where
//! it was included. A `<path>` is sought beside its file, then in the folders so far. Folders of an included file hold until its end, where Mitsuba forgets
//! them; meshes and pictures are sought there as well, behind all others.

use std::path::{Path, PathBuf};

/// Folders of `<path>` and of files that are included: every file is sought in all of them.
const MAX_FOLDERS: usize = 64;

pub(super) struct Folders {
    /// Those that hold now, the first to be looked at last.
    now: Vec<PathBuf>,
    /// Those of `<path>` of included files that ended.
    ended: Vec<PathBuf>,
}

/// Where an included file begins.
pub(super) struct Mark(usize);

impl Folders {
    /// Of the first file.
    pub(super) fn beside(file: &Path) -> Self {
        Self { now: vec![folder_of(file)], ended: Vec::new() }
    }

    /// From now on files are sought beside `file`, from which another is included, before all others.
    pub(super) fn begin(&mut self, file: &Path) -> Mark {
        let mark = Mark(self.now.len());
        self.now.push(folder_of(file));
        mark
    }

    /// An included file ends.
    pub(super) fn end(&mut self, mark: &Mark) {
        self.ended.extend(self.now.drain(mark.0..).skip(1));
    }

    /// Adds the folder that a `<path>` in `file` leads to, where there is one; whether it is one is what `is_folder` says.
    pub(super) fn add(
        &mut self,
        name: &str,
        file: &Path,
        is_folder: impl Fn(&Path) -> Result<bool, String>,
    ) -> Result<(), String> {
        if self.now.len() + self.ended.len() > MAX_FOLDERS {
            return Err(format!("more than {MAX_FOLDERS} <path>; expected fewer folders"));
        }
        for folder in std::iter::once(folder_of(file)).chain(self.now.iter().rev().cloned()) {
            let path = folder.join(name);
            if is_folder(&path)? {
                self.now.push(path);
                return Ok(());
            }
        }
        Err(format!(
            "<path value=\"{name}\">: there is no such folder beside the file, or in a <path> before; correct it, or remove it"
        ))
    }

    /// The path of a file, beside the first file where it is nowhere.
    pub(super) fn find(&self, name: &str) -> PathBuf {
        let mut paths = self.now.iter().rev().map(|folder| folder.join(name));
        paths.find(|path| path.is_file()).unwrap_or_else(|| self.now[0].join(name))
    }

    /// All of them in the order in which files are sought, behind the end of the first file.
    pub(super) fn all(self) -> Vec<PathBuf> {
        self.now.into_iter().rev().chain(self.ended).collect()
    }
}

fn folder_of(file: &Path) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).to_owned()
}
