//! Lock of a results folder: only one run at a time writes into it.
//!
//! The folder itself is locked, not a file in it, so that nothing remains: the system releases the lock when its process ends, in whatever way. A run that
//! writes into a part of a folder shares the lock of the whole and holds an exclusive lock of that part. A second run is refused; the message names the process
//! of the first, from the name of its mark ([`crate::run_mark`]). Without locks of folders (Windows, some network file systems) runs are not distinguished.

use std::fs::{File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::{Error, ErrorCode, paths::FolderError, run_mark};

/// A locked folder; free again when it is dropped.
#[derive(Debug)]
pub(crate) struct FolderLock {
    path: PathBuf,
    /// `None` if folders cannot be locked.
    folder: Option<File>,
}

impl FolderLock {
    /// Locks the whole folder exclusively.
    pub(crate) fn exclusive(root: &Path) -> Result<Self, FolderError> {
        Self::new(root, root, File::try_lock)
    }

    /// Locks the folder together with other runs that write into parts of it.
    pub(crate) fn shared(root: &Path) -> Result<Self, FolderError> {
        Self::new(root, root, File::try_lock_shared)
    }

    /// Locks a part of a folder exclusively. Marks are in the folder.
    pub(crate) fn part(root: &Path, part: &Path) -> Result<Self, FolderError> {
        Self::new(root, part, File::try_lock)
    }

    fn new(root: &Path, folder: &Path, lock: fn(&File) -> Result<(), TryLockError>) -> Result<Self, FolderError> {
        let held = |opened| Ok(Self { path: or_current(folder).to_path_buf(), folder: opened });
        let opened = match File::open(or_current(folder)) {
            Ok(opened) => opened,
            Err(cause) if cause.kind() == ErrorKind::NotFound => return Err(FolderError::removed(folder)),
            Err(_) => return held(None),
        };
        match lock(&opened) {
            Ok(()) => held(Some(opened)),
            Err(TryLockError::WouldBlock) => {
                Err(Error::coded(ErrorCode::FolderInUse, or_current(folder), in_use_message(root)).into())
            }
            Err(TryLockError::Error(_)) => held(None),
        }
    }

    /// Returns true if the locked folder still has its name. A run that ends without results removes a folder that it made, and another run may have made it
    /// again before this one locked it.
    pub(crate) fn is_still_named(&self) -> bool {
        self.folder.as_ref().is_none_or(|folder| is_same(folder, &self.path))
    }
}

#[cfg(unix)]
fn is_same(opened: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let (Ok(opened), Ok(named)) = (opened.metadata(), std::fs::metadata(path)) else { return false };
    (opened.dev(), opened.ino()) == (named.dev(), named.ino())
}

/// Folders are not locked on this system.
#[cfg(not(unix))]
fn is_same(_: &File, _: &Path) -> bool {
    true
}

/// The working directory has an empty path.
fn or_current(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

fn in_use_message(root: &Path) -> String {
    let who = match run_mark::running_process(or_current(root)) {
        Some(process) if process == std::process::id() => "another run of this process".to_owned(),
        Some(process) => format!("another run (process {process})"),
        None => "another run".to_owned(),
    };
    format!("{who} is writing into this folder; wait until it has ended, or choose another output folder")
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn parts_can_be_locked_together_but_not_with_the_folder() {
        let place = tempfile::tempdir().expect("temporary folder");
        let root = place.path();
        let parts = ["a", "b"].map(|name| root.join(name));
        parts.iter().for_each(|part| std::fs::create_dir(part).expect("folder"));
        let held = parts.each_ref().map(|part| (FolderLock::shared(root), FolderLock::part(root, part)));
        assert!(held.iter().all(|(root_lock, part)| root_lock.is_ok() && part.is_ok()));
        let message = FolderLock::part(root, &parts[0]).expect_err("taken").error.to_string();
        assert!(message.contains("another run is writing into this folder"), "{message}");
        FolderLock::exclusive(root).expect_err("parts are taken");
        drop(held);
        let exclusive_lock = FolderLock::exclusive(root).expect("free");
        FolderLock::shared(root).expect_err("the whole is taken");
        drop(exclusive_lock);
        FolderLock::shared(root).expect("free");
    }

    #[test]
    fn a_lock_of_a_folder_that_was_recreated_does_not_have_its_name() {
        let place = tempfile::tempdir().expect("temporary folder");
        let root = place.path().join("out");
        std::fs::create_dir(&root).expect("folder");
        let lock = FolderLock::exclusive(&root).expect("free");
        assert!(lock.is_still_named());
        std::fs::remove_dir(&root).expect("removed");
        assert!(!lock.is_still_named());
        std::fs::create_dir(&root).expect("folder");
        assert!(!lock.is_still_named());
        assert!(FolderLock::exclusive(&root).expect("another folder").is_still_named());
    }
}
