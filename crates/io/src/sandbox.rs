//! Folders that the files of a job must lie in, so that a service can run the jobs of others.
//!
//! A path is followed as the system would, part by part, through every symbolic link; the final target must lie in one of the folders. The check precedes any
//! access to the file, so nothing is revealed about files outside. A user who can change the folders while a job is read could still escape them.
//!
//! Every file access of a job passes through here, so the list of its files is also kept here.

use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::{collections::BTreeSet, io};

use crate::error::code_of;
use crate::failure::{Error, ErrorCode, Problem};

/// Folders that files may be read from.
#[derive(Clone, Debug, Default)]
pub struct Sandbox {
    /// Resolved folders, without links; `None`: anywhere.
    folders: Option<Vec<PathBuf>>,
    /// Requested files, shared by all clones; `None`: not recorded.
    looked_for: Option<Arc<Mutex<BTreeSet<PathBuf>>>>,
}

impl Sandbox {
    /// No restriction.
    pub const NONE: Self = Self { folders: None, looked_for: None };

    /// Allows the folder of `job` and those of `further`.
    ///
    /// # Errors
    /// A folder does not exist.
    pub fn for_job(job: &Path, further: &[PathBuf]) -> Result<Self, Error> {
        let folder = job.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let own = folder
            .canonicalize()
            .map_err(|cause| Error::coded(code_of(&cause), format!("{}: {cause}", job.display())))?;
        let allowed = further.iter().map(|folder| {
            let canonical = folder.canonicalize().ok().filter(|folder| folder.is_dir());
            canonical.ok_or_else(|| {
                let message = format!("`allow_outside` {}: no such folder", folder.display());
                Error::argument("allow_outside", message).with_code(ErrorCode::MissingFile)
            })
        });
        let folders = std::iter::once(Ok(own)).chain(allowed).collect::<Result<_, _>>()?;
        Ok(Self { folders: Some(folders), looked_for: None })
    }

    /// Returns the same sandbox, which also records the requested files.
    #[must_use]
    pub fn recording(self) -> Self {
        Self { looked_for: Some(Arc::default()), ..self }
    }

    /// Requested files, by the requested paths; some need not exist. Empty unless the sandbox [records](Self::recording) them.
    #[must_use]
    pub fn requested_files(&self) -> Vec<PathBuf> {
        let noted = self.looked_for.as_ref();
        noted.map_or_else(Vec::new, |noted| {
            noted.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
        })
    }

    /// Checks that a file may be read.
    ///
    /// # Errors
    /// If its path leads outside, in words.
    pub fn check(&self, path: &Path) -> Result<(), Problem> {
        if self.admits(path) {
            self.note(path);
            return Ok(());
        }
        let words = "this path is outside the job's folder, to which `sandboxed` restricts access; move the file there, or allow its folder with \
            `allow_outside`";
        Err(Problem::new(ErrorCode::OutsideFolder, words))
    }
}

impl Sandbox {
    /// Returns true if a folder may be listed.
    pub(crate) fn allows(&self, folder: &Path) -> bool {
        self.admits(folder)
    }

    fn admits(&self, path: &Path) -> bool {
        let Some(folders) = &self.folders else { return true };
        end_of(path).is_ok_and(|end| folders.iter().any(|folder| end.starts_with(folder)))
    }

    fn note(&self, path: &Path) {
        if let Some(noted) = &self.looked_for {
            noted.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_path_buf());
        }
    }
}

/// Target of a path, without links; its last parts need not exist.
fn end_of(path: &Path) -> io::Result<PathBuf> {
    let mut end = PathBuf::new();
    for part in std::path::absolute(path)?.components() {
        match part {
            Component::ParentDir => drop(end.pop()),
            Component::CurDir => {}
            Component::Normal(_) | Component::RootDir | Component::Prefix(_) => {
                end.push(part);
                if end.symlink_metadata().is_ok_and(|metadata| metadata.is_symlink()) {
                    end = end.canonicalize()?;
                }
            }
        }
    }
    Ok(end)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn a_path_is_judged_by_where_it_ends() {
        let place = tempfile::tempdir().expect("temporary folder");
        let root = place.path();
        ["job/meshes", "job-other", "library", "linked"]
            .iter()
            .for_each(|f| std::fs::create_dir_all(root.join(f)).expect("made"));
        std::fs::write(root.join("secret.csv"), "1").expect("written");
        symlink(root.join("secret.csv"), root.join("job/a.csv")).expect("link");
        symlink("../linked", root.join("job/folder")).expect("link");
        symlink("meshes", root.join("job/inner")).expect("link");
        symlink(root.join("nowhere"), root.join("job/dangling")).expect("link");
        let sandbox = Sandbox::for_job(&root.join("job/job.toml"), &[root.join("library")]).expect("there");
        for inside in [
            "job/a.obj",
            "job/meshes/../a.obj",
            "job/inner/b.obj",
            "library/c.obj",
            "job/../job/x/y/z.obj",
            "job/folder/../job/x",
            "job/./a",
        ] {
            assert_eq!(sandbox.check(&root.join(inside)), Ok(()), "{inside}");
        }
        let outside = [
            "secret.csv",
            "job/../secret.csv",
            "job/a.csv",
            "job/folder/x",
            "job-other/x",
            "job/dangling",
            "job/dangling/../a.obj",
            "job/x/../../secret.csv",
            "library/../secret.csv",
        ];
        for path in outside {
            sandbox.check(&root.join(path)).expect_err(path);
        }
        sandbox.check(Path::new("/etc/passwd")).expect_err("absolute");
        sandbox.check(Path::new("a.obj")).expect_err("relative to where the program runs");
        assert_eq!(Sandbox::NONE.check(Path::new("/etc/passwd")), Ok(()));
        let noting = sandbox.recording();
        let copy = noting.clone();
        ["job/a.csv", "job/x/../a.obj"].iter().for_each(|path| drop(copy.check(&root.join(path))));
        assert_eq!(noting.requested_files(), [root.join("job/x/../a.obj")], "what leads out is not looked for");
        assert!(Sandbox::for_job(&root.join("job/job.toml"), &[root.join("none")]).is_err());
    }
}
