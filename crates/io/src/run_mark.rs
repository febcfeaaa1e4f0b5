//! Mark of a run in its results folder. It distinguishes leftovers of a killed run from files of a running one.
//!
//! A mark is the hidden file `.etendue.PID-N.part`. It is locked until its run ends, in whatever way, and lists the run's temporary files. A mark that can be
//! locked is a leftover: the next run in that folder removes the listed files and the mark. Without locks of the file system, files of other runs are never
//! touched.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};

use crate::paths;

const HEAD: &str = ".etendue.";
const TAIL: &str = ".part";

/// Mark of a run; removed when dropped.
#[derive(Debug)]
pub(crate) struct RunMark {
    root: PathBuf,
    path: PathBuf,
    /// Identifier of the run's temporary files: `PID-N`.
    run: String,
    list: File,
}

impl RunMark {
    /// Removes leftovers of killed runs in `root`, and marks it.
    pub(crate) fn set(root: &Path) -> io::Result<Self> {
        remove_leftovers(root);
        let process = std::process::id();
        for serial in 0_u64.. {
            let run = format!("{process}-{serial}");
            let path = root.join(format!("{HEAD}{run}{TAIL}"));
            // Processes of several machines or containers may have the same number.
            match File::options().write(true).create_new(true).open(&path) {
                Ok(list) => match list.try_lock() {
                    // Another run took it for a leftover before it was locked.
                    Err(TryLockError::WouldBlock) => {}
                    Ok(()) if !path.exists() => {}
                    // The run works without a lock; only its leftovers would not be recognised.
                    Ok(()) | Err(TryLockError::Error(_)) => {
                        return Ok(Self { root: root.to_path_buf(), path, run, list });
                    }
                },
                Err(cause) if cause.kind() == ErrorKind::AlreadyExists => {}
                Err(cause) => return Err(cause),
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }

    /// Temporary name of a file of the run whose final name is `target` (inside the folder); it is added to the list.
    pub(crate) fn temporary_of(&mut self, target: &Path) -> io::Result<PathBuf> {
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let temporary = target.with_file_name(format!(".{name}.{}{TAIL}", self.run));
        if let Some(inside) = temporary.strip_prefix(&self.root).ok().and_then(Path::to_str) {
            self.list.write_all(format!("{inside}\n").as_bytes())?;
        }
        Ok(temporary)
    }
}

impl Drop for RunMark {
    /// Failures are ignored: the next run tries again.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// Process number of a running process that has marked `root`, if known.
pub(crate) fn running_process(root: &Path) -> Option<u32> {
    marks(root).into_iter().find_map(|(path, run)| {
        let is_held = matches!(File::open(path).ok()?.try_lock(), Err(TryLockError::WouldBlock));
        is_held.then(|| run.split_once('-')?.0.parse().ok()).flatten()
    })
}

/// Marks in a folder, with the identifiers of their runs.
fn marks(root: &Path) -> Vec<(PathBuf, String)> {
    let folder = if root.as_os_str().is_empty() { Path::new(".") } else { root };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    // Excludes links and pipes of such a name.
    let files = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_file()));
    let of_run = |entry: fs::DirEntry| {
        let name = entry.file_name();
        let run = name.to_str()?.strip_prefix(HEAD)?.strip_suffix(TAIL)?.to_owned();
        Some((entry.path(), run))
    };
    files.filter_map(of_run).collect()
}

/// Removes the files that the marks of killed runs list. Failures are ignored: leftovers do no harm.
fn remove_leftovers(root: &Path) {
    for (mark, run) in marks(root) {
        let _ = remove_run(root, &mark, &run);
    }
}

fn remove_run(root: &Path, mark: &Path, run: &str) -> io::Result<()> {
    let mut list = File::options().read(true).write(true).open(mark)?;
    list.try_lock().map_err(|cause| match cause {
        TryLockError::Error(cause) => cause,
        TryLockError::WouldBlock => ErrorKind::WouldBlock.into(),
    })?;
    let mut names = String::new();
    list.read_to_string(&mut names)?;
    for name in names.lines().filter(|name| is_temporary(Path::new(name), run)) {
        let _ = paths::remove_file(root, &root.join(name));
    }
    // Removed while locked, so that no run takes it for its own mark.
    fs::remove_file(mark)
}

/// Returns true if a listed name is one that this program gives: other names are not touched.
fn is_temporary(name: &Path, run: &str) -> bool {
    let inside = name.components().all(|part| matches!(part, Component::Normal(_)));
    let file = name.file_name().and_then(|file| file.to_str()).unwrap_or_default();
    inside && file.starts_with('.') && file.ends_with(&format!(".{run}{TAIL}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listing(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("folder").map(|e| e.expect("entry").file_name());
        let mut names: Vec<String> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// State after a killed run: its lock is released, its files exist.
    fn killed(root: &Path, target: &Path) {
        let mut mark = RunMark::set(root).expect("a mark");
        fs::write(mark.temporary_of(target).expect("a name"), b"half").expect("write");
        mark.list.unlock().expect("locks are known here");
        std::mem::forget(mark);
    }

    #[test]
    fn what_a_killed_run_left_goes_with_the_next() {
        let place = tempfile::tempdir().expect("temporary folder");
        fs::create_dir(place.path().join("deep")).expect("folder");
        killed(place.path(), &place.path().join("deep/x.exr"));
        assert_eq!(listing(&place.path().join("deep")).len(), 1);
        let mark = RunMark::set(place.path()).expect("a mark");
        assert_eq!(listing(&place.path().join("deep")), Vec::<String>::new());
        drop(mark);
        assert_eq!(listing(place.path()), ["deep"]);
    }

    #[test]
    fn files_of_a_running_process_are_left_alone() {
        let place = tempfile::tempdir().expect("temporary folder");
        let mut running = RunMark::set(place.path()).expect("a mark");
        let temporary = running.temporary_of(&place.path().join("x.exr")).expect("a name");
        fs::write(&temporary, b"half").expect("write");
        drop(RunMark::set(place.path()).expect("another mark"));
        assert!(temporary.exists() && running.path.exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_list_removes_nothing_through_a_link() {
        let place = tempfile::tempdir().expect("temporary folder");
        let (root, foreign) = (place.path().join("out"), place.path().join("foreign"));
        [&root, &foreign].iter().for_each(|folder| fs::create_dir(folder).expect("folder"));
        fs::write(foreign.join(".x.1-0.part"), b"theirs").expect("write");
        std::os::unix::fs::symlink(&foreign, root.join("deep")).expect("link");
        fs::write(root.join(".etendue.1-0.part"), "deep/.x.1-0.part\n").expect("write");
        drop(RunMark::set(&root).expect("a mark"));
        assert_eq!(listing(&root), ["deep"], "the mark is gone");
        assert_eq!(listing(&foreign), [".x.1-0.part"]);
    }

    #[test]
    fn a_list_names_nothing_but_temporaries_of_its_run() {
        let place = tempfile::tempdir().expect("temporary folder");
        let root = place.path().join("out");
        fs::create_dir(&root).expect("folder");
        let strange = ["../kept.1-0.part", "kept", ".kept.2-0.part", "/etc/passwd"];
        fs::write(place.path().join("kept.1-0.part"), b"").expect("write");
        ["kept", ".kept.2-0.part"].iter().for_each(|name| fs::write(root.join(name), b"").expect("write"));
        fs::write(root.join(".etendue.1-0.part"), strange.join("\n")).expect("write");
        drop(RunMark::set(&root).expect("a mark"));
        assert_eq!(listing(&root), [".kept.2-0.part", "kept"]);
        assert!(place.path().join("kept.1-0.part").exists());
    }
}
