//! File of blocks: header, checksums, reading and writing.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use etendue_core::storage::{BlockKey, BlockWriter, Blocks, Fill};

/// Odd, with as many ones as zeros: 2⁶⁴ divided by the golden ratio (Knuth, The Art of Computer Programming, 6.4).
const MULTIPLIER: u64 = 0x9e37_79b9_7f4a_7c15;

/// Checksum of bytes: words of eight bytes, each mixed into the sum by a multiplication. Any change within one word changes it.
pub(super) fn checksum(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mut last = [0; 8];
    last[..rest.len()].copy_from_slice(rest);
    let sum = words.iter().fold(bytes.len() as u64, |sum, word| mixed(sum, *word));
    mixed(sum, last)
}

/// Bijective in the word for a given sum, and in the sum for a given word.
fn mixed(sum: u64, word: [u8; 8]) -> u64 {
    let product = (sum ^ u64::from_le_bytes(word)).wrapping_mul(MULTIPLIER);
    product ^ (product >> 32)
}

/// The first bytes of a file of blocks.
const MAGIC: &[u8; 8] = b"ETDTILES";
/// The version of the layout.
const VERSION: u32 = 1;
/// Bytes before the checksums of the blocks.
pub(super) const HEAD_BYTES: usize = 56;

/// Header of a file with these checksums of blocks.
pub(super) fn head(key: &BlockKey, checksums: &[u64]) -> Vec<u8> {
    let mut head = Vec::with_capacity(HEAD_BYTES + 8 * checksums.len());
    head.extend_from_slice(MAGIC);
    head.extend_from_slice(&VERSION.to_le_bytes());
    head.extend_from_slice(&(checksums.len() as u32).to_le_bytes());
    head.extend_from_slice(key);
    let listed: Vec<u8> = checksums.iter().flat_map(|sum| sum.to_le_bytes()).collect();
    let all = checksum(&[&head[..], &listed].concat());
    head.extend_from_slice(&all.to_le_bytes());
    head.extend_from_slice(&listed);
    head
}

/// Bytes of a file with blocks of these lengths.
pub(super) fn bytes(lengths: &[u32]) -> u64 {
    offsets(lengths).last().copied().unwrap_or_default()
}

/// Offset of each block, and the end of the last.
fn offsets(lengths: &[u32]) -> Vec<u64> {
    let first = (HEAD_BYTES + 8 * lengths.len()) as u64;
    let mut offsets = vec![first];
    offsets.extend(lengths.iter().scan(first, |end, length| {
        *end += u64::from(*length);
        Some(*end)
    }));
    offsets
}

/// Open file of blocks: removal or replacement under its name has no effect here.
#[derive(Debug)]
pub(super) struct TileFile {
    path: PathBuf,
    file: File,
    offsets: Vec<u64>,
    checksums: Vec<u64>,
}

impl TileFile {
    /// The file of a key, if it exists. `Err` if it is incomplete.
    pub(super) fn open(path: &Path, key: &BlockKey, lengths: &[u32]) -> Result<Option<Self>, ()> {
        let file = match File::open(path) {
            Ok(file) => file,
            Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(None),
            Err(_) => return Err(()),
        };
        let end = offsets(lengths).last().copied();
        if file.metadata().ok().map(|metadata| metadata.len()) != end {
            return Err(());
        }
        let mut stored_head = vec![0; HEAD_BYTES + 8 * lengths.len()];
        read_at(&file, &mut stored_head, 0).map_err(|_| ())?;
        let (sums, _) = stored_head[HEAD_BYTES..].as_chunks::<8>();
        let checksums: Vec<u64> = sums.iter().map(|sum| u64::from_le_bytes(*sum)).collect();
        if stored_head != head(key, &checksums) {
            return Err(());
        }
        Ok(Some(Self::new(path.to_path_buf(), file, lengths, checksums)))
    }

    /// Returns a complete file.
    pub(super) fn new(path: PathBuf, file: File, lengths: &[u32], checksums: Vec<u64>) -> Self {
        Self { path, file, offsets: offsets(lengths), checksums }
    }
}

impl Blocks for TileFile {
    fn read(&self, block: usize, bytes: &mut [u8]) -> Result<(), String> {
        let file = self.path.display();
        read_at(&self.file, bytes, self.offsets[block])
            .map_err(|cause| format!("{file}: block {block} of this texture cache cannot be read: {cause}"))?;
        if checksum(bytes) == self.checksums[block] {
            return Ok(());
        }
        let is_removed = std::fs::remove_file(&self.path).is_ok() || !self.path.exists();
        let remedy = if is_removed { "the file was removed: run again to create it again" } else { "remove the file" };
        Err(format!("{file}: block {block} is damaged; {remedy}"))
    }
}

#[cfg(unix)]
fn read_at(file: &File, bytes: &mut [u8], offset: u64) -> std::io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, offset)
}

#[cfg(windows)]
fn read_at(file: &File, mut bytes: &mut [u8], mut offset: u64) -> std::io::Result<()> {
    while !bytes.is_empty() {
        let count = std::os::windows::fs::FileExt::seek_read(file, bytes, offset)?;
        if count == 0 {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        (bytes, offset) = (&mut bytes[count..], offset + count as u64);
    }
    Ok(())
}

/// First block of an image.
#[derive(Debug)]
struct FirstBlock(Vec<u8>);

impl Blocks for FirstBlock {
    fn read(&self, block: usize, bytes: &mut [u8]) -> Result<(), String> {
        if block == 0 && bytes.len() == self.0.len() {
            bytes.copy_from_slice(&self.0);
            return Ok(());
        }
        Err(format!("block {block} of this texture was not stored, because the job was opened only for its plan"))
    }
}

impl BlockWriter for FirstBlock {
    fn write(&mut self, block: usize, bytes: &[u8]) -> Result<(), String> {
        if block == 0 {
            self.0 = bytes.to_vec();
        }
        Ok(())
    }
}

/// Makes all blocks and keeps the first, which is all that a plan needs.
pub(super) fn first_block(fill: Fill<'_>) -> Result<Arc<dyn Blocks>, String> {
    let mut first = FirstBlock(Vec::new());
    fill(&mut first)?;
    Ok(Arc::new(first))
}

/// Numbers the files that this process writes.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// Writes the file at `path`; returns it, open for reading, with the checksums of its blocks. On failure nothing remains.
pub(super) fn write(path: &Path, key: &BlockKey, lengths: &[u32], fill: Fill<'_>) -> Result<(File, Vec<u64>), String> {
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let unfinished = UnfinishedFile(path.with_extension(format!("{}-{number}.part", std::process::id())));
    let cannot = |cause: std::io::Error| format!("{}: cannot be written: {cause}", unfinished.0.display());
    let file = OpenOptions::new().read(true).write(true).create_new(true).open(&unfinished.0).map_err(cannot)?;
    let mut open = OpenFile { path: &unfinished.0, file, offsets: offsets(lengths), checksums: vec![0; lengths.len()] };
    fill(&mut open)?;
    open.put(0, &head(key, &open.checksums)).map_err(cannot)?;
    std::fs::rename(&unfinished.0, path).map_err(cannot)?;
    Ok((open.file, open.checksums))
}

/// File under its temporary name, removed when dropped unless it was renamed.
struct UnfinishedFile(PathBuf);

impl Drop for UnfinishedFile {
    fn drop(&mut self) {
        // It may have its final name by now.
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
        self.checksums[block] = checksum(bytes);
        let cannot = |cause: std::io::Error| format!("{}: cannot be written: {cause}", self.path.display());
        self.put(self.offsets[block], bytes).map_err(cannot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_and_every_length_counts() {
        let bytes: Vec<u8> = (0..37).collect();
        for bit in 0..37 * 8 {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert_ne!(checksum(&flipped), checksum(&bytes), "{bit}");
        }
        assert_ne!(checksum(&[0; 8]), checksum(&[0; 9]));
        assert_ne!(checksum(&[]), checksum(&[0]));
    }
}
