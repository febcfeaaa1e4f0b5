//! How much a compressed picture may unpack to: a small file must not fill the memory.
//!
//! Decoders of PNG, JPEG and Radiance HDR keep to 512 MiB by themselves. EXR and TIFF may hold large measurements and
//! spectra: above that size, what they unpack to is bounded by what they bring.

use std::path::Path;

use crate::Error;

/// Bytes that any picture may unpack to.
const ALWAYS: u128 = 512 << 20;

/// Above that: how many times its own size a file may unpack to.
const TIMES_PACKED: u128 = 100;

/// Refuses samples that are too many for a file of `packed` bytes, before they are unpacked.
pub(crate) fn check(file: &Path, samples: u128, packed: usize) -> Result<(), Error> {
    check_within(file, samples, ALWAYS.max(TIMES_PACKED * packed as u128))
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
