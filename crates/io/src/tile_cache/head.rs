//! The head of a file of blocks, and where its blocks are.

use etendue_core::storage::BlockKey;

use super::checksum;

/// The first bytes of a file of blocks.
const MAGIC: &[u8; 8] = b"ETDTILES";
/// The version of the layout.
const VERSION: u32 = 1;
/// Bytes before the checksums of the blocks.
pub(super) const HEAD_BYTES: usize = 56;

/// The head of a file, whose blocks have these checksums.
pub(super) fn head(key: &BlockKey, checksums: &[u64]) -> Vec<u8> {
    let mut head = Vec::with_capacity(HEAD_BYTES + 8 * checksums.len());
    head.extend_from_slice(MAGIC);
    head.extend_from_slice(&VERSION.to_le_bytes());
    head.extend_from_slice(&(checksums.len() as u32).to_le_bytes());
    head.extend_from_slice(key);
    let listed: Vec<u8> = checksums.iter().flat_map(|sum| sum.to_le_bytes()).collect();
    let all = checksum::of(&[&head[..], &listed].concat());
    head.extend_from_slice(&all.to_le_bytes());
    head.extend_from_slice(&listed);
    head
}

/// Bytes of a file of blocks of these lengths.
pub(super) fn bytes(lengths: &[u32]) -> u64 {
    offsets(lengths).last().copied().unwrap_or_default()
}

/// Where each block begins, and where the last ends.
pub(super) fn offsets(lengths: &[u32]) -> Vec<u64> {
    let first = (HEAD_BYTES + 8 * lengths.len()) as u64;
    let mut offsets = vec![first];
    offsets.extend(lengths.iter().scan(first, |end, length| {
        *end += u64::from(*length);
        Some(*end)
    }));
    offsets
}
