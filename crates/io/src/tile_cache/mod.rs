//! Folder of blocks on the disk. Each file is named by the key of its blocks.
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | `ETDTILES` |
//! | 4 | version of this layout |
//! | 4 | number of blocks |
//! | 32 | the key |
//! | 8 | checksum of all of the above and of the checksums of the blocks |
//! | 8 per block | checksum of each block |
//! | the rest | the blocks, one after the other |
//!
//! Integers are little-endian. A file is written under a temporary name and renamed when complete, so concurrent programs see complete files only; if two write
//! the same file, one replaces the other's equal one. A file with a wrong length or header is removed and counts as absent. A block is checked against its
//! checksum whenever it is read. The limit `texture-cache-mib` bounds the bytes of the folder: the least recently used files are removed first.

mod block_file;
mod room;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use etendue_core::storage::{BlockKey, BlockStore, Blocks, Fill};

use crate::{hash::hex, paths};
use block_file::TileFile;
use room::OwnFiles;

/// Permitted use of a folder of blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CacheUse {
    /// Store blocks.
    #[default]
    Keep,
    /// The same in a results folder, in which no link is followed.
    KeepInOutput,
    /// Nothing is written, touched or removed: of missing blocks only the first is made.
    Read,
}

/// Folder of blocks, for one job. It is created when the first blocks are written.
#[derive(Clone, Debug)]
pub struct TileCache {
    folder: PathBuf,
    may: CacheUse,
    own: Arc<OwnFiles>,
}

impl TileCache {
    /// Blocks in `folder`; `None` for that of the user: `etendue` in `$XDG_CACHE_HOME`, else in `~/.cache`, else in the system's folder for
    /// temporary files.
    #[must_use]
    pub fn new(folder: Option<&Path>, may: CacheUse) -> Self {
        Self { folder: folder.map_or_else(folder_of_user, Path::to_path_buf), may, own: Arc::default() }
    }

    /// Creates the folder if it is missing, and makes room in it.
    fn prepare(&self, bytes: u64) -> Result<(), String> {
        let cannot = |cause: String| format!("the cache folder {} cannot be written: {cause}", self.folder.display());
        if self.may == CacheUse::KeepInOutput {
            paths::check_folder(&self.folder).map_err(|error| cannot(error.what().to_owned()))?;
        }
        std::fs::create_dir_all(&self.folder).map_err(|cause| cannot(cause.to_string()))?;
        room::make(&self.folder, bytes, &self.own);
        Ok(())
    }

    /// File of the blocks of a key.
    fn file(&self, key: &BlockKey) -> PathBuf {
        self.folder.join(format!("{}.tiles", hex(key)))
    }
}

impl BlockStore for TileCache {
    fn find(&self, key: &BlockKey, lengths: &[u32]) -> Option<Arc<dyn Blocks>> {
        let file = self.file(key);
        if self.may == CacheUse::KeepInOutput && paths::check_folder(&self.folder).is_err() {
            return None;
        }
        match (TileFile::open(&file, key, lengths), self.may) {
            (Ok(None) | Err(()), CacheUse::Read) | (Ok(None), _) => None,
            (Ok(Some(blocks)), may) => {
                if may != CacheUse::Read {
                    room::touch(&file);
                }
                self.own.add(&file, block_file::bytes(lengths));
                Some(Arc::new(blocks))
            }
            (Err(()), _) => {
                // Removal by another program is equally good.
                let _ = std::fs::remove_file(&file);
                None
            }
        }
    }

    fn check_room(&self, key: &BlockKey, lengths: &[u32]) -> Result<(), String> {
        self.own.check(&self.file(key), block_file::bytes(lengths))
    }

    fn make(&self, key: &BlockKey, lengths: &[u32], fill: Fill<'_>) -> Result<Arc<dyn Blocks>, String> {
        self.own.add(&self.file(key), block_file::bytes(lengths));
        if self.may == CacheUse::Read {
            return block_file::first_block(fill);
        }
        self.prepare(block_file::bytes(lengths))?;
        let (file, checksums) = block_file::write(&self.file(key), key, lengths, fill)?;
        Ok(Arc::new(TileFile::new(self.file(key), file, lengths, checksums)))
    }
}

/// User's cache folder (XDG Base Directory Specification 0.8: relative paths are ignored).
pub(crate) fn folder_of_user() -> PathBuf {
    let absolute = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let cache = absolute("XDG_CACHE_HOME").or_else(|| absolute("HOME").map(|home| home.join(".cache")));
    cache.unwrap_or_else(std::env::temp_dir).join("etendue")
}

#[cfg(test)]
mod tests {
    use super::block_file::HEAD_BYTES;
    use super::*;
    use std::fs;

    const KEY: BlockKey = [7; 32];
    const LENGTHS: [u32; 3] = [5, 0, 3000];

    fn block(i: usize) -> Vec<u8> {
        (0..LENGTHS[i]).map(|j| (j * 7 + i as u32) as u8).collect()
    }

    fn fill(out: &mut dyn etendue_core::storage::BlockWriter) -> Result<(), String> {
        // In arbitrary order.
        [2, 0, 1].into_iter().try_for_each(|i| out.write(i, &block(i)))
    }

    fn written_cache(folder: &Path) -> (TileCache, PathBuf) {
        let cache = TileCache::new(Some(folder), CacheUse::Keep);
        cache.make(&KEY, &LENGTHS, &mut fill).expect("a folder that can be written");
        let file = cache.file(&KEY);
        (cache, file)
    }

    fn read(blocks: &dyn Blocks, i: usize) -> Result<Vec<u8>, String> {
        let mut bytes = vec![0; LENGTHS[i] as usize];
        blocks.read(i, &mut bytes).map(|()| bytes)
    }

    #[test]
    fn what_is_written_is_read() {
        let place = tempfile::tempdir().expect("temporary folder");
        let folder = place.path().join("a/b");
        let cache = TileCache::new(Some(&folder), CacheUse::Keep);
        assert!(cache.find(&KEY, &LENGTHS).is_none());
        let fresh = cache.make(&KEY, &LENGTHS, &mut fill).expect("a folder that can be made");
        let reopened = cache.find(&KEY, &LENGTHS).expect("just made");
        for i in 0..3 {
            assert_eq!((read(&*fresh, i), read(&*reopened, i)), (Ok(block(i)), Ok(block(i))));
        }
        assert_eq!(fs::read_dir(&folder).expect("folder").count(), 1, "nothing but the file");
        assert!(cache.find(&[8; 32], &LENGTHS).is_none());
    }

    #[test]
    fn an_incomplete_file_counts_as_none_and_is_removed() {
        let place = tempfile::tempdir().expect("temporary folder");
        let (cache, file) = written_cache(place.path());
        let complete = fs::read(&file).expect("file");
        let flipped = |at: usize| {
            let mut bytes = complete.clone();
            bytes[at] ^= 1;
            bytes
        };
        let longer = [&complete[..], &[0]].concat();
        let head = [flipped(0), flipped(8), flipped(12), flipped(20), flipped(50), flipped(HEAD_BYTES + 3)];
        for bytes in
            head.into_iter().chain([complete[..complete.len() - 1].to_vec(), complete[..20].to_vec(), vec![], longer])
        {
            fs::write(&file, bytes).expect("write");
            assert!(cache.find(&KEY, &LENGTHS).is_none());
            assert!(!file.exists());
        }
        fs::write(&file, &complete).expect("write");
        assert!(cache.find(&KEY, &[5, 0, 2999]).is_none(), "other lengths");
    }

    #[test]
    fn a_damaged_block_is_reported_and_its_file_removed() {
        let place = tempfile::tempdir().expect("temporary folder");
        let (cache, file) = written_cache(place.path());
        let mut bytes = fs::read(&file).expect("file");
        *bytes.last_mut().expect("bytes") ^= 1;
        fs::write(&file, bytes).expect("write");
        let cached = cache.find(&KEY, &LENGTHS).expect("head and length are right");
        assert_eq!(read(&*cached, 0), Ok(block(0)));
        let message = read(&*cached, 2).expect_err("one bit is another");
        assert!(
            message.ends_with(".tiles: block 2 is damaged; the file was removed: run again to create it again"),
            "{message}"
        );
        assert!(!file.exists());
    }

    #[test]
    fn nothing_is_left_of_what_fails() {
        let place = tempfile::tempdir().expect("temporary folder");
        let cache = TileCache::new(Some(place.path()), CacheUse::Keep);
        let failed = cache.make(&KEY, &LENGTHS, &mut |out| {
            out.write(0, &block(0))?;
            Err("the picture ended".to_owned())
        });
        assert_eq!(failed.err().as_deref(), Some("the picture ended"));
        assert_eq!(fs::read_dir(place.path()).expect("folder").count(), 0);
        fs::write(place.path().join("file"), b"").expect("write");
        let in_file = TileCache::new(Some(&place.path().join("file/folder")), CacheUse::Keep);
        let message = in_file.make(&KEY, &LENGTHS, &mut fill).expect_err("a file is no folder");
        assert!(
            message.starts_with("the cache folder ") && message.contains("file/folder cannot be written: "),
            "{message}"
        );
    }

    /// The test's own limit applies to all tests of the process: it is far above what they write.
    #[test]
    fn what_was_used_longest_ago_goes_first_and_what_the_job_uses_stays() {
        let place = tempfile::tempdir().expect("temporary folder");
        let cache = TileCache::new(Some(place.path()), CacheUse::Keep);
        let keys: [BlockKey; 4] = [1, 2, 3, 4].map(|byte| [byte; 32]);
        // Sparse files: half of the limit each.
        let half = etendue_scene::limits::TEXTURE_CACHE.max_bytes() / 2;
        for (key, s) in keys[..3].iter().zip(1..) {
            let file = fs::File::create(cache.file(key)).expect("a file");
            file.set_len(half).expect("sparse");
            let modified = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(s);
            file.set_modified(modified).expect("set");
        }
        fs::write(place.path().join("theirs.tiles"), b"x").expect("write");
        cache.own.add(&cache.file(&keys[1]), half);
        cache.make(&keys[3], &LENGTHS, &mut fill).expect("room is made");
        let is_there = keys.map(|key| cache.file(&key).exists());
        assert_eq!(is_there, [false, true, false, true], "the oldest, then the next that is not the job's");
        assert!(place.path().join("theirs.tiles").exists());
        let message = cache.check_room(&[9; 32], &[u32::MAX]).expect_err("too large beside the own");
        assert!(
            message.contains("the texture cache is limited to 2048 MiB")
                && message.contains("`limit` texture-cache-mib="),
            "{message}"
        );
        assert_eq!(cache.check_room(&keys[3], &LENGTHS), Ok(()));
    }

    #[test]
    fn a_plan_leaves_the_folder_as_it_is() {
        let place = tempfile::tempdir().expect("temporary folder");
        let folder = place.path().join("cache");
        let cache = TileCache::new(Some(&folder), CacheUse::Read);
        let blocks = cache.make(&KEY, &LENGTHS, &mut fill).expect("made and not kept");
        assert_eq!(read(&*blocks, 0), Ok(block(0)));
        assert!(read(&*blocks, 2).expect_err("not kept").contains("opened only for its plan"));
        assert!(!folder.exists());
        let (owner, file) = written_cache(&folder);
        fs::write(&file, b"damaged").expect("write");
        assert!(cache.find(&KEY, &LENGTHS).is_none() && file.exists());
        drop(owner);
    }

    #[cfg(unix)]
    #[test]
    fn a_cache_in_an_output_folder_is_no_link() {
        let place = tempfile::tempdir().expect("temporary folder");
        let (folder, foreign) = (place.path().join("cache"), place.path().join("foreign"));
        written_cache(&foreign);
        std::os::unix::fs::symlink(&foreign, &folder).expect("link");
        let cache = TileCache::new(Some(&folder), CacheUse::KeepInOutput);
        assert!(cache.find(&KEY, &LENGTHS).is_none());
        let message = cache.make(&[8; 32], &LENGTHS, &mut fill).expect_err("a link");
        assert!(message.contains("a symbolic link is in the place"), "{message}");
        assert_eq!(fs::read_dir(&foreign).expect("folder").count(), 1);
    }
}
