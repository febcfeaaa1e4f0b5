//! Folder for a run's results.
//!
//! Contract: a final name holds a whole file or none. Files are written next to their final name under a temporary one (`.NAME.PID-N.part`), flushed to the
//! disk, and renamed by [`OutputFolder::commit`]. A folder dropped without commit removes its temporary files and the folders it created. A killed run may
//! leave `.part` files, which the next run in the folder removes; it leaves no incomplete file under a final name.
//!
//! One run at a time writes into a folder ([`OutputFolder::open`]), or into a part of it ([`OutputFolder::open_part`]). Symbolic links are not followed: a link
//! in the place of a file is replaced or refused like a file; one in the place of a folder within the output folder is refused. The output folder itself may be
//! one.

#[cfg(test)]
mod tests;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};
use std::{collections::BTreeMap, sync::Arc};

use crate::paths::{self, CreatedFolders, FolderError};
use crate::{Error, ErrorCode, folder_lock::FolderLock, hash::FileDigest, run_mark::RunMark};

/// Maximum attempts to create a folder that another run keeps removing because it is empty.
const TRIES: usize = 100;

/// Treatment of existing files with the names to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExistingFiles {
    /// Refuse: an earlier result is never lost.
    Refuse,
    /// Replace them when the run commits.
    Replace,
    /// Continue an interrupted run: its completed files stay, the rest is replaced.
    Resume,
}

/// Folder for results; see the module for its contract.
#[derive(Debug)]
pub struct OutputFolder {
    root: PathBuf,
    existing: ExistingFiles,
    created: CreatedFolders,
    pending: Vec<PendingFile>,
    /// Mark of the run, from opening to the end.
    mark: Option<RunMark>,
    /// Locks of the folder and its part; several folders of one run share them.
    locks: Arc<Vec<FolderLock>>,
}

#[derive(Debug)]
struct PendingFile {
    temporary: PathBuf,
    name: PathBuf,
}

impl OutputFolder {
    /// Opens `root` exclusively for one run and creates it if missing. Tests that it is writable, so that a long run cannot fail at its end for lack of
    /// permission. Refused while another run writes into it.
    pub fn open(root: &Path, existing: ExistingFiles) -> Result<Self, Error> {
        Self::open_with(root, existing, |_| Ok(vec![FolderLock::exclusive(root)?]))
    }

    /// The same for a run whose files are all in the folder `part` of `root`: other runs may write to other parts.
    pub fn open_part(root: &Path, part: &str, existing: ExistingFiles) -> Result<Self, Error> {
        Self::open_with(root, existing, |folder| {
            let root_lock = FolderLock::shared(root)?;
            let part = folder.resolve(part)?;
            paths::check_folders(root, &part)?;
            paths::check_folder(&part)?;
            folder.created.make(&part)?;
            Ok(vec![root_lock, FolderLock::part(root, &part)?])
        })
    }

    /// The same for single files, each complete by itself, in a folder that another run may use.
    pub fn open_beside(root: &Path, existing: ExistingFiles) -> Result<Self, Error> {
        Self::open_with(root, existing, |_| Ok(Vec::new()))
    }

    /// Returns the same folder again, for files of the same run that are committed at other times.
    pub fn reopened(&self, existing: ExistingFiles) -> Result<Self, Error> {
        let mut folder = Self::open_with(&self.root, existing, |_| Ok(Vec::new()))?;
        folder.locks = Arc::clone(&self.locks);
        Ok(folder)
    }

    /// Creates, locks and marks the folder. Until it is marked, a run that created it and ends without results may remove it; then it is created again.
    fn open_with(
        root: &Path,
        existing: ExistingFiles,
        lock: impl Fn(&mut Self) -> Result<Vec<FolderLock>, FolderError>,
    ) -> Result<Self, Error> {
        let mut opened = Self::try_open(root, existing, &lock);
        for _ in 1..TRIES {
            match opened {
                Err(FolderError { is_gone: true, .. }) => opened = Self::try_open(root, existing, &lock),
                _ => break,
            }
        }
        opened.map_err(|missed| missed.error)
    }

    fn try_open(
        root: &Path,
        existing: ExistingFiles,
        lock: impl Fn(&mut Self) -> Result<Vec<FolderLock>, FolderError>,
    ) -> Result<Self, FolderError> {
        let (created, pending, locks) = (CreatedFolders::default(), Vec::new(), Arc::default());
        let mut folder = Self { root: root.to_path_buf(), existing, created, pending, mark: None, locks };
        folder.created.make(root)?;
        folder.locks = Arc::new(lock(&mut folder)?);
        let mark = RunMark::set(root)
            .map_err(|cause| FolderError::from_io(root, "this output folder cannot be written to", &cause))?;
        folder.mark = Some(mark);
        // With the mark in it, the folder stays: the locked folder must still have the name.
        match folder.locks.iter().all(FolderLock::is_still_named) {
            true => Ok(folder),
            false => Err(FolderError::removed(root)),
        }
    }

    /// Path of the folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.root
    }

    /// Refuses immediately, before any rendering, if a file of these names exists and may not be replaced.
    pub fn claim<'a>(&self, names: impl IntoIterator<Item = &'a str>) -> Result<(), Error> {
        names.into_iter().try_for_each(|name| self.check_free(&self.resolve(name)?))
    }

    /// From now on, existing files of these names belong to the run, which replaces them.
    #[must_use]
    pub fn replacing_own(mut self) -> Self {
        self.existing = ExistingFiles::Replace;
        self
    }

    /// Removes the files of these names if they exist, and their folder if it is then empty.
    pub fn remove<'a>(&self, names: impl IntoIterator<Item = &'a str>) -> Result<(), Error> {
        for name in names {
            let path = self.resolve(name)?;
            paths::remove_file(&self.root, &path)?;
            // Remains if it is not empty.
            let _ = path.parent().filter(|folder| *folder != self.root).map(fs::remove_dir);
        }
        Ok(())
    }

    /// Names of the files in a subfolder, sorted; none if it does not exist. A link in its place is refused; links in it are ignored.
    pub fn files_in(&self, folder: &str) -> Result<Vec<String>, Error> {
        let files = paths::files_in(&self.root, &self.resolve(folder)?)?;
        let name = |path: PathBuf| Some(format!("{folder}/{}", path.file_name()?.to_str()?));
        Ok(files.into_iter().filter_map(name).collect())
    }

    /// Writes `bytes` for `name` (relative, `/` between folders) under a temporary name.
    pub fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        self.write_with(name, |file| file.write_all(bytes))
    }

    /// The same for data that `write` supplies piece by piece, for files too large to hold in memory.
    pub fn write_with(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), Error> {
        let target = self.resolve(name)?;
        self.check_free(&target)?;
        if self.pending.iter().any(|p| p.name == target) {
            return Err(Error::coded(
                ErrorCode::Duplicate,
                &target,
                "written twice in one run; each result needs a different name",
            ));
        }
        if let Some(parent) = target.parent() {
            self.created.make(parent).map_err(|missed| missed.error)?;
        }
        let unwritten = |cause: io::Error| {
            Error::coded(ErrorCode::UnwritableOutput, &target, format!("cannot be written: {cause}"))
        };
        let mark = self.mark.as_mut().expect("a folder is marked until it is dropped");
        let temporary = mark.temporary_of(&target).map_err(unwritten)?;
        self.pending.push(PendingFile { temporary: temporary.clone(), name: target.clone() });
        write_flushed(&temporary, write).map_err(unwritten)
    }

    /// Path at which a file of the run can be read once it is written: the temporary name before the final one.
    pub fn readable_path(&self, name: &str) -> Result<PathBuf, Error> {
        let target = self.resolve(name)?;
        let pending = self.pending.iter().find(|file| file.name == target);
        Ok(pending.map_or(target, |file| file.temporary.clone()))
    }

    /// Digests of the `wanted` files that are written but have no final name yet, by their names within the folder.
    pub fn pending_digests(&self, wanted: impl Fn(&str) -> bool) -> Result<BTreeMap<String, FileDigest>, Error> {
        let named = self.pending.iter().map(|file| {
            let inside = file.name.strip_prefix(&self.root).unwrap_or(&file.name);
            let parts: Vec<_> = inside.components().map(|part| part.as_os_str().to_string_lossy()).collect();
            (parts.join("/"), &file.temporary)
        });
        let digest = |(name, temporary): (String, &PathBuf)| {
            let unread = |cause: io::Error| {
                Error::coded(ErrorCode::UnreadableFile, temporary, format!("cannot be read back: {cause}"))
            };
            Ok((name, FileDigest::new(temporary).map_err(unread)?))
        };
        named.filter(|(name, _)| wanted(name)).map(digest).collect()
    }

    /// Gives every file its final name and returns the names, in the order of writing.
    pub fn commit(mut self) -> Result<Vec<PathBuf>, Error> {
        self.publish()
    }

    /// The same for the files written so far; the run continues.
    pub fn publish(&mut self) -> Result<Vec<PathBuf>, Error> {
        for file in &self.pending {
            self.check_free(&file.name)?;
        }
        let mut names = Vec::with_capacity(self.pending.len());
        while !self.pending.is_empty() {
            let file = &self.pending[0];
            fs::rename(&file.temporary, &file.name).map_err(|cause| {
                let note = match names.len() {
                    0 => String::new(),
                    n => format!(" (the {n} files before it have their final names and are complete)"),
                };
                Error::coded(
                    ErrorCode::UnwritableOutput,
                    &file.name,
                    format!("cannot be renamed to its final name: {cause}{note}"),
                )
            })?;
            names.push(self.pending.remove(0).name);
        }
        self.created.keep();
        Ok(names)
    }

    fn resolve(&self, name: &str) -> Result<PathBuf, Error> {
        let relative = Path::new(name);
        let plain = relative.components().all(|part| matches!(part, Component::Normal(_)));
        if name.is_empty() || !plain {
            return Err(Error::coded(
                ErrorCode::UnwritableOutput,
                relative,
                "not a name inside the output folder; expected a plain relative path",
            ));
        }
        Ok(self.root.join(relative))
    }

    fn check_free(&self, target: &Path) -> Result<(), Error> {
        paths::check_folders(&self.root, target)?;
        // Metadata of a link itself, not of its target.
        let there = match fs::symlink_metadata(target) {
            Ok(there) => there,
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => return Ok(()),
            Err(cause) => {
                return Err(Error::coded(ErrorCode::UnwritableOutput, target, format!("cannot be written: {cause}")));
            }
        };
        if there.is_dir() {
            return Err(Error::coded(
                ErrorCode::UnwritableOutput,
                target,
                "a folder has the name of a result; remove it or choose another output folder",
            ));
        }
        if self.existing == ExistingFiles::Refuse {
            return Err(Error::coded(
                ErrorCode::OutputExists,
                target,
                "already exists; choose another folder, or allow overwriting with `overwrite`",
            ));
        }
        Ok(())
    }
}

impl Drop for OutputFolder {
    /// Removes uncommitted files. Failures are ignored: there is no one left to report to.
    fn drop(&mut self) {
        for file in &self.pending {
            let _ = paths::remove_file(&self.root, &file.temporary);
        }
        self.mark = None;
        self.created.remove();
    }
}

fn write_flushed(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    // The name belongs to the run. A leftover of a killed process with the same number, or a link, is not written into.
    let _ = fs::remove_file(path);
    let mut file = BufWriter::new(File::create_new(path)?);
    write(&mut file)?;
    file.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}
