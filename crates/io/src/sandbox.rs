//! Folders that the files of a job must lie in, so that a service can run the jobs of others.
//!
//! A path is followed as the system would, part by part, through every symbolic link; where it ends must lie in one of the folders. It is checked before a
//! file is looked for, so that nothing is learnt of what is outside. Who may change the folders while a job is read could still lead out of them.
//!
//! As every file of a job is asked for here, this is also where its files are known.

use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::{collections::BTreeSet, io};

use crate::error::code_of;
use crate::failure::{Error, ErrorCode, Problem};

/// Where files may be read from.
#[derive(Clone, Debug, Default)]
pub struct Sandbox {
    /// Without links; `None`: anywhere.
    folders: Option<Vec<PathBuf>>,
    /// What was looked for, of all clones together; `None`: it is not noted.
    looked_for: Option<Arc<Mutex<BTreeSet<PathBuf>>>>,
}

impl Sandbox {
    /// Files may lie anywhere.
    pub const NONE: Self = Self { folders: None, looked_for: None };

    /// Files lie in the folder of `job`, or in one of `further`.
    ///
    /// # Errors
    /// A folder is not there.
    pub fn about(job: &Path, further: &[PathBuf]) -> Result<Self, Error> {
        let folder = job.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let own = folder
            .canonicalize()
            .map_err(|cause| Error::coded(code_of(&cause), format!("{}: {cause}", job.display())))?;
        let allowed = further.iter().map(|folder| {
            let found = folder.canonicalize().ok().filter(|folder| folder.is_dir());
            found.ok_or_else(|| {
                let message = format!("`allow_outside` {}: there is no such folder", folder.display());
                Error::argument("allow_outside", message).with_code(ErrorCode::MissingFile)
            })
        });
        let folders = std::iter::once(Ok(own)).chain(allowed).collect::<Result<_, _>>()?;
        Ok(Self { folders: Some(folders), looked_for: None })
    }

    /// The same, and from now on it notes which files may be looked for.
    #[must_use]
    pub fn noting(self) -> Self {
        Self { looked_for: Some(Arc::default()), ..self }
    }

    /// Which files were looked for, by the paths that they were looked for by; some need not be there. None unless it [notes](Self::noting) them.
    #[must_use]
    pub fn looked_for(&self) -> Vec<PathBuf> {
        let noted = self.looked_for.as_ref();
        noted.map_or_else(Vec::new, |noted| {
            noted.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
        })
    }

    /// Whether a file may be looked for.
    ///
    /// # Errors
    /// Where its path leads out, in words.
    pub fn check(&self, path: &Path) -> Result<(), Problem> {
        if self.admits(path) {
            self.note(path);
            return Ok(());
        }
        let words = "this path leads out of the job's folder, to which `sandboxed` keeps it; put the file there, or allow its folder with `allow_outside`";
        Err(Problem::new(ErrorCode::OutsideFolder, words))
    }
}

impl Sandbox {
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

/// Where a path ends, without links; its last parts need not be there.
fn end_of(path: &Path) -> io::Result<PathBuf> {
    let mut end = PathBuf::new();
    for part in std::path::absolute(path)?.components() {
        match part {
            Component::ParentDir => drop(end.pop()),
            Component::CurDir => {}
            Component::Normal(_) | Component::RootDir | Component::Prefix(_) => {
                end.push(part);
                if end.symlink_metadata().is_ok_and(|found| found.is_symlink()) {
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
        let sandbox = Sandbox::about(&root.join("job/job.toml"), &[root.join("library")]).expect("there");
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
        let noting = sandbox.noting();
        let copy = noting.clone();
        ["job/a.csv", "job/x/../a.obj"].iter().for_each(|path| drop(copy.check(&root.join(path))));
        assert_eq!(noting.looked_for(), [root.join("job/x/../a.obj")], "what leads out is not looked for");
        assert!(Sandbox::about(&root.join("job/job.toml"), &[root.join("none")]).is_err());
    }
}
