//! Blocks of one file, or those that are not kept.

use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use etendue_core::storage::{BlockKey, BlockWriter, Blocks, Fill};

use super::checksum;
use super::head::{HEAD_BYTES, head, offsets};

/// A file of blocks, open: removing or replacing it under its name changes nothing here.
#[derive(Debug)]
pub(super) struct TileFile {
    path: PathBuf,
    file: File,
    offsets: Vec<u64>,
    checksums: Vec<u64>,
}

impl TileFile {
    /// The file of a key, if it is there. `Err` where it is not whole.
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
        let mut found = vec![0; HEAD_BYTES + 8 * lengths.len()];
        read_at(&file, &mut found, 0).map_err(|_| ())?;
        let (sums, _) = found[HEAD_BYTES..].as_chunks::<8>();
        let checksums: Vec<u64> = sums.iter().map(|sum| u64::from_le_bytes(*sum)).collect();
        if found != head(key, &checksums) {
            return Err(());
        }
        Ok(Some(Self::of(path.to_path_buf(), file, lengths, checksums)))
    }

    /// A file that is whole.
    pub(super) fn of(path: PathBuf, file: File, lengths: &[u32], checksums: Vec<u64>) -> Self {
        Self { path, file, offsets: offsets(lengths), checksums }
    }
}

impl Blocks for TileFile {
    fn read(&self, block: usize, bytes: &mut [u8]) -> Result<(), String> {
        let file = self.path.display();
        read_at(&self.file, bytes, self.offsets[block])
            .map_err(|cause| format!("{file}: block {block} of this cache of textures cannot be read: {cause}"))?;
        if checksum::of(bytes) == self.checksums[block] {
            return Ok(());
        }
        let is_removed = std::fs::remove_file(&self.path).is_ok() || !self.path.exists();
        let remedy =
            if is_removed { "the file was removed: run again, and it is made anew" } else { "remove the file" };
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

/// The first block of a picture.
#[derive(Debug)]
struct FirstBlock(Vec<u8>);

impl Blocks for FirstBlock {
    fn read(&self, block: usize, bytes: &mut [u8]) -> Result<(), String> {
        if block == 0 && bytes.len() == self.0.len() {
            bytes.copy_from_slice(&self.0);
            return Ok(());
        }
        Err(format!("block {block} of this texture was not kept, as its job was opened for its plan alone"))
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
