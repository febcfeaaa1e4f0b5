//! The lock of a folder for results: one run at a time writes into it.
//!
//! The folder itself is locked, not a file in it, so that nothing stays behind: the system lets go of the lock when its process ends, however that is. Whoever
//! writes into a part of a folder shares the lock of the whole with others that do, and locks that part for itself. A second run is refused and told the number of
//! the first one's process, which stands in the name of its mark ([`crate::run_mark`]). Where a system or a file system knows no locks of folders (Windows, some
//! networks), runs are not told from one another.

use std::fs::{File, TryLockError};
use std::path::Path;

use crate::Error;
use crate::run_mark;

/// A locked folder; free again when it is dropped.
#[derive(Debug)]
pub(crate) struct FolderLock {
    /// `None` where folders cannot be locked.
    _folder: Option<File>,
}

impl FolderLock {
    /// The whole folder, for one run alone.
    pub(crate) fn alone(root: &Path) -> Result<Self, Error> {
        Self::of(root, root, File::try_lock)
    }

    /// The folder together with others that write into parts of it.
    pub(crate) fn shared(root: &Path) -> Result<Self, Error> {
        Self::of(root, root, File::try_lock_shared)
    }

    /// A part of a folder, for one run alone. Marks are in the folder.
    pub(crate) fn part(root: &Path, part: &Path) -> Result<Self, Error> {
        Self::of(root, part, File::try_lock)
    }

    fn of(root: &Path, folder: &Path, lock: fn(&File) -> Result<(), TryLockError>) -> Result<Self, Error> {
        let Ok(opened) = File::open(here(folder)) else { return Ok(Self { _folder: None }) };
        match lock(&opened) {
            Ok(()) => Ok(Self { _folder: Some(opened) }),
            Err(TryLockError::WouldBlock) => Err(Error::new(here(folder), taken(root))),
            Err(TryLockError::Error(_)) => Ok(Self { _folder: None }),
        }
    }
}

/// The folder where the program runs has an empty path.
fn here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

fn taken(root: &Path) -> String {
    let who = match run_mark::running(here(root)) {
        Some(process) if process == std::process::id() => "another run of this process".to_owned(),
        Some(process) => format!("another run (process {process})"),
        None => "another run".to_owned(),
    };
    format!("{who} writes into this folder; wait until it has ended, or choose another output folder")
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn parts_are_locked_beside_each_other_and_not_beside_the_whole() {
        let place = tempfile::tempdir().expect("temporary folder");
        let root = place.path();
        let parts = ["a", "b"].map(|name| root.join(name));
        parts.iter().for_each(|part| std::fs::create_dir(part).expect("folder"));
        let held = parts.each_ref().map(|part| (FolderLock::shared(root), FolderLock::part(root, part)));
        assert!(held.iter().all(|(whole, part)| whole.is_ok() && part.is_ok()));
        let told = FolderLock::part(root, &parts[0]).expect_err("taken").to_string();
        assert!(told.contains("another run writes into this folder"), "{told}");
        FolderLock::alone(root).expect_err("parts are taken");
        drop(held);
        let whole = FolderLock::alone(root).expect("free");
        FolderLock::shared(root).expect_err("the whole is taken");
        drop(whole);
        FolderLock::shared(root).expect("free");
    }
}
