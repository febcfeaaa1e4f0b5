//! Content hashes: SHA-256 (FIPS 180-4) of the bytes of a file, and the digest (hash and size) that a record states of its files.

use std::io::{self, Read};
use std::{fs::File, path::Path};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// A SHA-256 digest.
pub type ContentHash = [u8; 32];

/// The hash of `bytes`.
#[must_use]
pub fn hash_bytes(bytes: &[u8]) -> ContentHash {
    Sha256::digest(bytes).into()
}

/// Hash of several files that make one asset (a mesh and its material library), in order: the hash of their hashes, so moving a byte from one file to the next
/// changes it.
#[must_use]
pub fn hash_parts<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> ContentHash {
    let hashes: Vec<u8> = parts.into_iter().flat_map(hash_bytes).collect();
    hash_bytes(&hashes)
}

/// Bytes in hexadecimal digits, lower case.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Bytes read at a time.
const PIECE: usize = 1 << 20;

/// Size and content hash of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileDigest {
    /// Size, bytes.
    pub bytes: u64,
    /// SHA-256 (FIPS 180-4) of its bytes, hexadecimal.
    pub sha256: String,
}

impl FileDigest {
    /// Digest of a file.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn new(path: &Path) -> io::Result<Self> {
        Self::from_reader(File::open(path)?)
    }

    /// Digest of all bytes of a reader.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn from_reader(mut reader: impl Read) -> io::Result<Self> {
        let (mut hash, mut bytes) = (Sha256::new(), 0);
        let mut piece = vec![0; PIECE];
        loop {
            let count = match reader.read(&mut piece) {
                Ok(0) => break,
                Ok(count) => count,
                Err(cause) if cause.kind() == io::ErrorKind::Interrupted => continue,
                Err(cause) => return Err(cause),
            };
            hash.update(&piece[..count]);
            bytes += count as u64;
        }
        Ok(Self { bytes, sha256: hex(&hash.finalize()) })
    }

    /// The digest of bytes.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Self {
        Self { bytes: bytes.len() as u64, sha256: hex(&hash_bytes(bytes)) }
    }

    /// Returns true if `path` is a regular file of this content; a link is not.
    #[must_use]
    pub fn matches(&self, path: &Path) -> bool {
        let is_of_size =
            path.symlink_metadata().is_ok_and(|metadata| metadata.is_file() && metadata.len() == self.bytes);
        is_of_size && Self::new(path).is_ok_and(|digest| digest == *self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_of_abc_is_the_standards_example() {
        // FIPS 180-4, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(hex(&hash_bytes(b"abc")), expected);
    }

    #[test]
    fn parts_are_kept_apart() {
        assert_ne!(hash_parts([&b"ab"[..], b"c"]), hash_parts([&b"a"[..], b"bc"]));
    }

    #[test]
    fn a_file_that_is_gone_cut_or_changed_does_not_match() {
        let place = tempfile::tempdir().expect("temporary folder");
        let file = place.path().join("x");
        let bytes = vec![7; 3 * PIECE / 2];
        std::fs::write(&file, &bytes).expect("write");
        let digest = FileDigest::new(&file).expect("readable");
        assert_eq!(digest, FileDigest::from_bytes(&bytes));
        assert!(digest.matches(&file));
        let mut changed = bytes.clone();
        changed[PIECE + 5] ^= 1;
        for other in [&bytes[..100], &[], &changed] {
            std::fs::write(&file, other).expect("write");
            assert!(!digest.matches(&file));
        }
        assert!(!digest.matches(&place.path().join("none")) && !digest.matches(place.path()));
    }
}
