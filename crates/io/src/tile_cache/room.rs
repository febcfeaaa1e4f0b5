//! Room in the folder: the least recently used files are removed first; those of the current job stay.
//!
//! The time of last use is the modification time, which each use updates: the system writes it, no clock is read here. Concurrent programs may remove each
//! other's oldest files; an open file stays readable until it is closed.

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use etendue_scene::limits::TEXTURE_CACHE;

/// Files of one job, with their bytes.
#[derive(Debug, Default)]
pub(super) struct OwnFiles(Mutex<BTreeMap<PathBuf, u64>>);

impl OwnFiles {
    /// Records a file that the job uses.
    pub(super) fn add(&self, file: &Path, bytes: u64) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(file.to_path_buf(), bytes);
    }

    /// Refuses a file of this size that does not fit together with the job's others.
    pub(super) fn check(&self, file: &Path, bytes: u64) -> Result<(), String> {
        let own = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let others: u64 = own.iter().filter(|(other, _)| *other != file).map(|(_, bytes)| bytes).sum();
        let needed = others + bytes;
        if needed <= TEXTURE_CACHE.max_bytes() {
            return Ok(());
        }
        let (mib, max_bytes) = (needed.div_ceil(1 << 20), TEXTURE_CACHE.current());
        Err(format!(
            "the tiles of the job's textures need {mib} MiB, but the texture cache is limited to {max_bytes} MiB; use smaller images, give textures more \
             memory, {}",
            TEXTURE_CACHE.remedy_bytes(needed.into())
        ))
    }

    fn has(&self, file: &Path) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).contains_key(file)
    }
}

/// Removes the least recently used files until `bytes` more fit into the folder. Failures are ignored: another program may have removed them.
pub(super) fn make(folder: &Path, bytes: u64, own: &OwnFiles) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries
        .filter(|entry| is_ours(&entry.file_name().to_string_lossy()))
        .filter_map(|entry| {
            let info = entry.metadata().ok().filter(fs::Metadata::is_file)?;
            Some((info.modified().ok()?, entry.path(), info.len()))
        })
        .collect();
    files.sort();
    let mut sum: u64 = files.iter().map(|(_, _, bytes)| bytes).sum();
    for (_, file, length) in files {
        if sum + bytes <= TEXTURE_CACHE.max_bytes() {
            return;
        }
        if !own.has(&file) && fs::remove_file(&file).is_ok() {
            sum -= length;
        }
    }
}

/// Updates the time of last use: writes the first byte again.
pub(super) fn touch(file: &Path) {
    let _ = OpenOptions::new().read(true).write(true).open(file).and_then(|mut file| {
        let mut first = [0];
        file.read_exact(&mut first)?;
        file.seek(SeekFrom::Start(0))?;
        file.write_all(&first)
    });
}

/// Returns true if a name is one that this cache gives: the digits of a key, and the suffix.
fn is_ours(name: &str) -> bool {
    let Some((key, rest)) = name.split_once('.') else { return false };
    key.len() == 64 && key.bytes().all(|byte| byte.is_ascii_hexdigit()) && (rest == "tiles" || rest.ends_with(".part"))
}
