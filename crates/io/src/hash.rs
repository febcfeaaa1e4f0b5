//! Content hashes: SHA-256 (FIPS 180-4) of a file's bytes.

use sha2::{Digest, Sha256};

/// A SHA-256 digest.
pub type ContentHash = [u8; 32];

/// The hash of `bytes`.
#[must_use]
pub fn of_bytes(bytes: &[u8]) -> ContentHash {
    Sha256::digest(bytes).into()
}

/// The hash of several files that make one asset (a mesh and its material library), in order: the hash of their
/// hashes, so that moving a byte from one file to the next changes it.
#[must_use]
pub fn of_parts<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> ContentHash {
    let hashes: Vec<u8> = parts.into_iter().flat_map(of_bytes).collect();
    of_bytes(&hashes)
}

/// Bytes in hexadecimal digits, lower case.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_of_abc_is_the_standards_example() {
        // FIPS 180-4, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(hex(&of_bytes(b"abc")), expected);
    }

    #[test]
    fn parts_are_kept_apart() {
        assert_ne!(of_parts([&b"ab"[..], b"c"]), of_parts([&b"a"[..], b"bc"]));
    }
}
