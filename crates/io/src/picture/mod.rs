//! Images: textures and environments.
//!
//! | file | becomes |
//! | --- | --- |
//! | PNG, JPEG of 8 bits | bytes as stored |
//! | grey PNG of 16 bits | numbers as stored |
//! | other PNG of 16 bits | floats, stored value / 65 535, still encoded as in the file; with opacity if present |
//! | Radiance HDR | floats |
//! | OpenEXR with R, G, B (of its `chromaticities`, Rec. 709 without) or Y, and A if present; cube maps are refused | floats; half floats and every compression of the exr crate (none, RLE, ZIP, PIZ, PXR24, B44, DWA) |
//!
//! The kind is identified by the first bytes, not by the name. The description that names the file states the encoding (sRGB or linear). Non-finite numbers are
//! refused with their pixel.

mod foreign;
mod large;
mod pfm;
mod qoi;
mod raster;

use std::path::Path;

use etendue_scene::asset::ImageAsset;

use crate::{Error, exr::decode_exr_as_stored, hash, source::read_bytes};

pub use foreign::read_foreign_image;
pub use raster::has_colours_of_8_bits;

pub(crate) use large::{ImageHead, head, large_image};
pub(crate) use raster::{PixelStorage, decode_raster};

/// The first bytes of every OpenEXR file.
pub(crate) const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

pub fn read_image(file: &Path) -> Result<ImageAsset, Error> {
    decode_image(file, &read_bytes(file, "image")?)
}

/// Decodes the bytes of `file`.
///
/// # Errors
/// As [`read_image`].
pub fn decode_image(file: &Path, bytes: &[u8]) -> Result<ImageAsset, Error> {
    let (width, height, pixels, to_rec_709) = if bytes.starts_with(&EXR_MAGIC) {
        raster::from_exr(file, decode_exr_as_stored(file, bytes)?)?
    } else {
        raster::decode(file, bytes)?
    };
    if width == 0 || height == 0 {
        return Err(Error::new(file, format!("the image has {width} × {height} pixels; expected at least one pixel")));
    }
    raster::check_finite(file, width, &pixels)?;
    Ok(ImageAsset { width, height, pixels, to_rec_709, hash: hash::hash_bytes(bytes) })
}
