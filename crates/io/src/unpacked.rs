//! How much a compressed picture may unpack to: a small file must not fill the memory.
//!
//! Decoders of PNG, JPEG and Radiance HDR keep to 512 MiB by themselves. EXR and TIFF may hold large measurements and
//! spectra: above that size, what they unpack to is bounded by what their bytes can hold. Deflate, with which this program writes, packs at most
//! 1 032 bytes into one, 258 into two bits (RFC 1951, 3.2.5), and a black picture comes near that; 16-bit floats are widened to twice their
//! size. Beyond 32 GiB a file must bring a hundredth of its samples.

use std::path::Path;

use crate::Error;

/// Bytes that any picture may unpack to.
const ALWAYS: u128 = 512 << 20;

/// Above that: how many times its own size a file may unpack to.
const TIMES_PACKED: u128 = 2 * 1032;
/// How far that holds, bytes.
const PLENTY: u128 = 32 << 30;
/// Above that: how many times its own size.
const TIMES_BEYOND: u128 = 100;

/// Refuses samples that are too many for a file of `packed` bytes, before they are unpacked.
pub(crate) fn check(file: &Path, samples: u128, packed: usize) -> Result<(), Error> {
    check_within(file, samples, most(packed as u128))
}

/// Bytes that a file of `packed` bytes may unpack to.
fn most(packed: u128) -> u128 {
    ALWAYS.max(PLENTY.min(TIMES_PACKED * packed)).max(TIMES_BEYOND * packed)
}

/// Refuses samples that are more than `most` bytes.
pub(crate) fn check_within(file: &Path, samples: u128, most: u128) -> Result<(), Error> {
    let bytes = samples.saturating_mul(size_of::<f32>() as u128);
    if bytes <= most {
        return Ok(());
    }
    let megabytes = |bytes: u128| bytes.div_ceil(1_000_000);
    let told = format!(
        "unpacks to {} MB, where a file of its size may hold {} MB; make the picture smaller, or store it with less compression",
        megabytes(bytes),
        megabytes(most)
    );
    Err(Error::new(file, told))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_black_picture_of_our_own_may_unpack_and_a_bomb_may_not() {
        let samples = 12_000 * 8_000 * 22;
        let file = Path::new("a.exr");
        // As deflate packs it at best.
        assert!(check(file, samples, (4 * samples / 1032) as usize).is_ok());
        // A header of 20 000² pixels; 100 MB that unpack to 100 GB.
        assert!(check(file, 400_000_000, 500).is_err());
        assert!(check(file, 25_000_000_000, 100_000_000).is_err());
        // A measurement of 40 GB that brings a gigabyte.
        assert!(check(file, 10_000_000_000, 1_000_000_000).is_ok());
    }
}
