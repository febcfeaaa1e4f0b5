//! Writing a file of blocks.

use std::fs::{File, OpenOptions};
use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use etendue_core::storage::{BlockKey, BlockWriter, Fill};

use super::checksum;
use super::head::{head, offsets};

/// Numbers the files that this process writes.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// Writes the file at `path`, and answers with it, open for reading, and the checksums of its blocks. Nothing is left where it fails.
pub(super) fn write(path: &Path, key: &BlockKey, lengths: &[u32], fill: Fill<'_>) -> Result<(File, Vec<u64>), String> {
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let unfinished = Unfinished(path.with_extension(format!("{}-{number}.part", std::process::id())));
    let cannot = |cause: std::io::Error| format!("{}: cannot be written: {cause}", unfinished.0.display());
    let file = OpenOptions::new().read(true).write(true).create_new(true).open(&unfinished.0).map_err(cannot)?;
    let mut open = OpenFile { path: &unfinished.0, file, offsets: offsets(lengths), checksums: vec![0; lengths.len()] };
    fill(&mut open)?;
    open.put(0, &head(key, &open.checksums)).map_err(cannot)?;
    std::fs::rename(&unfinished.0, path).map_err(cannot)?;
    Ok((open.file, open.checksums))
}

/// A file under its temporary name, which is removed at the end; it is not there any more where the file was finished.
struct Unfinished(PathBuf);

impl Drop for Unfinished {
    fn drop(&mut self) {
        // It may have its own name by now.
        let _ = std::fs::remove_file(&self.0);
    }
}

struct OpenFile<'a> {
    path: &'a Path,
    file: File,
    offsets: Vec<u64>,
    checksums: Vec<u64>,
}

impl OpenFile<'_> {
    fn put(&self, offset: u64, bytes: &[u8]) -> std::io::Result<()> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(offset))?;
        file.write_all(bytes)
    }
}

impl BlockWriter for OpenFile<'_> {
    fn write(&mut self, block: usize, bytes: &[u8]) -> Result<(), String> {
        debug_assert_eq!(self.offsets[block + 1] - self.offsets[block], bytes.len() as u64, "block {block}");
        self.checksums[block] = checksum::of(bytes);
        let cannot = |cause: std::io::Error| format!("{}: cannot be written: {cause}", self.path.display());
        self.put(self.offsets[block], bytes).map_err(cannot)
    }
}
