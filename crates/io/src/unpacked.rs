//! How much a compressed picture may unpack to: a small file must not fill the memory.
//!
//! At most 8 times the size of the file, or what the limit `picture-mib` says where that is more (docs/limits.md). Pictures of floats and those that are
//! measured count 4 bytes a sample, others as their file stores them. It is known from the head, before anything is unpacked.

use std::path::Path;

use etendue_scene::limits::PICTURE;

use crate::{Error, ErrorCode};

/// How many times its own size any file may unpack to.
const TIMES_PACKED: u128 = 8;

/// Refuses samples of 32 bits that are too many for a file of `packed` bytes.
pub(crate) fn check(file: &Path, samples: u128, packed: usize) -> Result<(), Error> {
    check_bytes(file, in_bytes(samples), packed)
}

/// Refuses bytes that are too many for a file of `packed` bytes.
pub(crate) fn check_bytes(file: &Path, bytes: u128, packed: usize) -> Result<(), Error> {
    let most = most(packed);
    if bytes <= most {
        return Ok(());
    }
    let told = format!(
        "unpacks to {} MiB, where a file of its size may unpack to {} MiB; make the picture smaller, {}",
        mebibytes(bytes),
        mebibytes(most),
        PICTURE.remedy_bytes(bytes)
    );
    Err(Error::coded(ErrorCode::TooLarge, file, told))
}

/// Bytes that a file of `packed` bytes may unpack to.
pub(crate) fn most(packed: usize) -> u128 {
    u128::from(PICTURE.most_bytes()).max(TIMES_PACKED * packed as u128)
}

/// Refuses samples of 32 bits that are more than `most` bytes, where it is known how many there should be.
pub(crate) fn check_within(file: &Path, samples: u128, most: u128) -> Result<(), Error> {
    let bytes = in_bytes(samples);
    if bytes <= most {
        return Ok(());
    }
    let (found, expected) = (mebibytes(bytes), mebibytes(most));
    Err(Error::coded(
        ErrorCode::TooLarge,
        file,
        format!("unpacks to {found} MiB, where {expected} MiB are expected; render it again"),
    ))
}

fn in_bytes(samples: u128) -> u128 {
    samples.saturating_mul(size_of::<f32>() as u128)
}

fn mebibytes(bytes: u128) -> u128 {
    bytes.div_ceil(1 << 20)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measurement_may_unpack_and_a_bomb_may_not() {
        let file = Path::new("a.exr");
        // Two megapixels of 38 bands with their variance, however well they pack.
        assert!(check(file, 2_000_000 * 76, 500).is_ok());
        // A header of 20 000² pixels; 100 MB that unpack to 100 GB.
        let told = check(file, 400_000_000, 500).expect_err("a bomb").to_string();
        let expected = "a.exr: unpacks to 1526 MiB, where a file of its size may unpack to 1024 MiB; make the picture smaller, or raise the limit: \
                        `limit` picture-mib=1526";
        assert_eq!(told, expected);
        assert!(check(file, 25_000_000_000, 100_000_000).is_err());
        // A measurement of 40 GB that brings 5.
        assert!(check(file, 10_000_000_000, 5_000_000_000).is_ok());
    }
}
