//! Paths within an output folder: no symbolic link is followed to write or to delete.
//!
//! Every module that writes or deletes below an output folder asks here. The output folder itself may be a link, which its owner made; a folder within it may not,
//! since whoever made that link chose where files go or disappear. A link in the place of a file is that file's name: it is replaced or removed, never what it leads to.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::made_folders::no_folder;
use crate::{Error, ErrorCode};

/// Refuses a file, or a link to elsewhere, in the place of a folder between `root` and `target`.
pub(crate) fn check_folders(root: &Path, target: &Path) -> Result<(), Error> {
    let folders = target.ancestors().skip(1).take_while(|folder| *folder != root);
    folders.into_iter().try_for_each(check_folder)
}

/// The same of one folder, which need not be there.
pub(crate) fn check_folder(folder: &Path) -> Result<(), Error> {
    if folder.is_symlink() {
        return Err(Error::coded(
            ErrorCode::UnwritableOutput,
            folder,
            "a symbolic link is in the place of a folder of results, which stay in the output folder; remove it, or choose another output folder",
        ));
    }
    if folder.is_file() {
        return Err(no_folder(folder));
    }
    Ok(())
}

/// Removes a file below `root`, or a link in its place; what is not there is removed already.
pub(crate) fn remove_file(root: &Path, target: &Path) -> Result<(), Error> {
    check_folders(root, target)?;
    match fs::remove_file(target) {
        Err(cause) if cause.kind() != ErrorKind::NotFound => {
            Err(Error::coded(ErrorCode::UnwritableOutput, target, format!("cannot be removed: {cause}")))
        }
        _ => Ok(()),
    }
}

/// The files in a folder below `root`, by their names; none where it is not there. Links, folders and devices are not among them.
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

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn nothing_is_listed_or_removed_through_a_link() {
        let place = tempfile::tempdir().expect("temporary folder");
        let (root, foreign) = (place.path().join("out"), place.path().join("foreign"));
        [&root, &foreign].iter().for_each(|folder| fs::create_dir(folder).expect("folder"));
        fs::write(foreign.join("x"), b"theirs").expect("write");
        symlink(&foreign, root.join("linked")).expect("link");
        symlink(foreign.join("x"), root.join("x")).expect("link");
        for told in [
            files_in(&root, &root.join("linked")).map(|_| ()),
            remove_file(&root, &root.join("linked/x")),
            check_folders(&root, &root.join("linked/deep/x")),
        ] {
            let told = told.expect_err("a link in the place of a folder").to_string();
            assert!(told.contains("linked: a symbolic link is in the place of a folder of results"), "{told}");
        }
        assert_eq!(files_in(&root, &root).expect("readable"), Vec::<PathBuf>::new(), "a link is no file");
        remove_file(&root, &root.join("x")).expect("the link itself");
        assert!(!root.join("x").is_symlink() && foreign.join("x").exists());
        assert_eq!(files_in(&root, &root.join("none")).expect("none"), Vec::<PathBuf>::new());
    }
}
