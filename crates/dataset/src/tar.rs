//! Archives of files in memory: POSIX ustar (IEEE 1003.1-1988), without owners and times, so that the same files give the same bytes.

/// Bytes of a block.
const BLOCK: usize = 512;
/// What an archive ends with: two empty blocks.
pub(crate) const END: [u8; 2 * BLOCK] = [0; 2 * BLOCK];
/// Longest name, bytes.
const MAX_NAME: usize = 100;

/// Adds a file; an archive is files and [`END`].
///
/// # Panics
/// Where the name is longer than 100 bytes.
pub(crate) fn add(archive: &mut Vec<u8>, name: &str, bytes: &[u8]) {
    assert!(name.len() <= MAX_NAME, "a name of at most {MAX_NAME} bytes: {name}");
    let mut head = [0; BLOCK];
    put(&mut head, 0, name.as_bytes());
    put(&mut head, 100, b"0000644\0");
    put(&mut head, 108, b"0000000\0");
    put(&mut head, 116, b"0000000\0");
    put(&mut head, 124, format!("{:011o}\0", bytes.len()).as_bytes());
    put(&mut head, 136, b"00000000000\0");
    // The checksum is that of the head with blanks in its place.
    put(&mut head, 148, b"        ");
    put(&mut head, 156, b"0");
    put(&mut head, 257, b"ustar\x0000");
    let sum: u32 = head.iter().map(|byte| u32::from(*byte)).sum();
    put(&mut head, 148, format!("{sum:06o}\0 ").as_bytes());
    archive.extend_from_slice(&head);
    archive.extend_from_slice(bytes);
    archive.resize(archive.len().next_multiple_of(BLOCK), 0);
}

fn put(head: &mut [u8; BLOCK], at: usize, bytes: &[u8]) {
    head[at..at + bytes.len()].copy_from_slice(bytes);
}
