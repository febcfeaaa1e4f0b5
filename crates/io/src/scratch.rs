//! Unnamed scratch files, which last until a run ends.
//!
//! A file is removed from its folder as soon as it is open: the system frees its bytes when the last handle is closed, also if the program is killed. (On
//! systems where open files cannot be removed, the file is marked for deletion on close.)

use std::fs::{File, OpenOptions};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{io, sync::Arc};

use etendue_core::storage::{Scratch, ScratchStore};

use crate::tile_cache::folder_of_user;

/// Folder for scratch files. It is created with the first one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScratchFolder {
    folder: PathBuf,
}

impl ScratchFolder {
    /// Files in `folder`; `None` for that of the user, which also holds texture tiles.
    #[must_use]
    pub fn new(folder: Option<&Path>) -> Self {
        Self { folder: folder.map_or_else(folder_of_user, Path::to_path_buf) }
    }

    /// Creates a file with a name that no other run uses.
    fn create(&self) -> io::Result<(File, PathBuf)> {
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let path = self.folder.join(format!(".etendue-scratch.{}-{number}", std::process::id()));
            match removed_when_closed(OpenOptions::new().read(true).write(true).create_new(true)).open(&path) {
                // Leftover of a killed process of the same number between two system calls.
                Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => {}
                opened => return opened.map(|file| (file, path)),
            }
        }
    }
}

impl ScratchStore for ScratchFolder {
    fn room(&self, bytes: u64) -> Result<Arc<dyn Scratch>, String> {
        let folder = self.folder.display();
        let cannot = |cause: io::Error| {
            format!("the scratch folder {folder} cannot be written: {cause}; choose another one with `scratch`")
        };
        std::fs::create_dir_all(&self.folder).map_err(cannot)?;
        let (file, path) = self.create().map_err(cannot)?;
        remove_name(&path).map_err(cannot)?;
        // Sparse: reports early if files of this size are not possible.
        file.set_len(bytes).map_err(cannot)?;
        Ok(Arc::new(ScratchFile { folder: self.folder.clone(), file, bytes }))
    }
}

/// An open file.
#[derive(Debug)]
struct ScratchFile {
    folder: PathBuf,
    file: File,
    bytes: u64,
}

impl Scratch for ScratchFile {
    fn write(&self, offset: u64, bytes: &[u8]) -> Result<(), String> {
        write_at(&self.file, bytes, offset).map_err(|cause| {
            format!(
                "a scratch file of {} MB in {} cannot be written: {cause}; free space there, or choose another folder with `scratch`",
                self.bytes.div_ceil(1_000_000),
                self.folder.display()
            )
        })
    }

    fn read(&self, offset: u64, bytes: &mut [u8]) -> Result<(), String> {
        read_at(&self.file, bytes, offset)
            .map_err(|cause| format!("a scratch file in {} cannot be read: {cause}", self.folder.display()))
    }
}

#[cfg(not(windows))]
fn removed_when_closed(options: &mut OpenOptions) -> &OpenOptions {
    options
}

#[cfg(windows)]
fn removed_when_closed(options: &mut OpenOptions) -> &OpenOptions {
    const FILE_FLAG_DELETE_ON_CLOSE: u32 = 0x0400_0000;
    std::os::windows::fs::OpenOptionsExt::custom_flags(options, FILE_FLAG_DELETE_ON_CLOSE)
}

#[cfg(not(windows))]
fn remove_name(path: &Path) -> io::Result<()> {
    std::fs::remove_file(path)
}

#[cfg(windows)]
fn remove_name(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(unix)]
fn read_at(file: &File, bytes: &mut [u8], offset: u64) -> io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, offset)
}

#[cfg(unix)]
fn write_at(file: &File, bytes: &[u8], offset: u64) -> io::Result<()> {
    std::os::unix::fs::FileExt::write_all_at(file, bytes, offset)
}

#[cfg(windows)]
fn read_at(file: &File, mut bytes: &mut [u8], mut offset: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        let count = std::os::windows::fs::FileExt::seek_read(file, bytes, offset)?;
        if count == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        (bytes, offset) = (&mut bytes[count..], offset + count as u64);
    }
    Ok(())
}

#[cfg(windows)]
fn write_at(file: &File, mut bytes: &[u8], mut offset: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        let count = std::os::windows::fs::FileExt::seek_write(file, bytes, offset)?;
        if count == 0 {
            return Err(io::ErrorKind::WriteZero.into());
        }
        (bytes, offset) = (&bytes[count..], offset + count as u64);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_and_the_folder_stays_empty() {
        let place = tempfile::tempdir().expect("temporary folder");
        let folder = place.path().join("a/b");
        let store = ScratchFolder::new(Some(&folder));
        let [one, other] = [20, 20].map(|bytes| store.room(bytes).expect("a folder that can be made"));
        one.write(5, &[1, 2, 3]).expect("written");
        other.write(5, &[9]).expect("written");
        let mut read = [7; 5];
        one.read(4, &mut read).expect("read");
        assert_eq!(read, [0, 1, 2, 3, 0], "what was never written is 0");
        assert!(one.read(18, &mut read).is_err(), "beyond the end");
        if cfg!(unix) {
            assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 0, "while they are open");
        }
        drop((one, other));
        assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 0);
    }

    #[test]
    fn a_folder_that_cannot_be_is_named() {
        let place = tempfile::tempdir().expect("temporary folder");
        std::fs::write(place.path().join("file"), b"").expect("write");
        let store = ScratchFolder::new(Some(&place.path().join("file/folder")));
        let message = store.room(1).expect_err("a file is no folder");
        assert!(message.starts_with("the scratch folder ") && message.ends_with("with `scratch`"), "{message}");
    }

    /// `/dev/full` answers every write like a full disk.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_named() {
        let file = OpenOptions::new().write(true).open("/dev/full").expect("a device of the system");
        let scratch = ScratchFile { folder: PathBuf::from("/scratch"), file, bytes: 8_800_000_000 };
        let message = scratch.write(0, &[1]).expect_err("full");
        assert!(
            message.starts_with("a scratch file of 8800 MB in /scratch cannot be written: No space left"),
            "{message}"
        );
    }
}
