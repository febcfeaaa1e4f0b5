//! Images: textures and environments.
//!
//! | file | becomes |
//! | --- | --- |
//! | PNG, JPEG of 8 bits | bytes as stored |
//! | grey PNG of 16 bits | numbers as stored |
//! | other PNG of 16 bits | floats, stored value / 65 535, still encoded as in the file; with opacity if present |
//! | TGA, BMP, WebP, DDS (DXT1, 3, 5), PNM, TIFF | as PNG of their bits; TIFF of floats: floats |
//! | Radiance HDR of any axis order, RGBE or XYZE | floats |
//! | OpenEXR with R, G, B (of its `chromaticities`, Rec. 709 without) or Y, and A if present; cube maps are refused | floats; half floats and every compression of the exr crate (none, RLE, ZIP, PIZ, PXR24, B44, DWA) |
//!
//! The kind is identified by the first bytes, not by the name (TGA, which has no signature, by its header). The description that names the file states the encoding (sRGB or linear). Non-finite numbers are
//! refused with their pixel.

mod exr_colours;
mod foreign;
mod formats;
mod large;
mod pfm;
mod qoi;
mod radiance;
mod raster;

use std::path::Path;

use etendue_scene::asset::ImageAsset;

use crate::{Error, ErrorCode, exr::decode_exr_as_stored, hash, source::read_bytes};

use raster::DecodedImage;

pub use foreign::read_foreign_image;
pub use raster::has_colours_of_8_bits;

pub(crate) use formats::{RasterFormats, TEXTURES};
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
    let decoded = match bytes.starts_with(&EXR_MAGIC) {
        true => exr_colours::from_exr(file, decode_exr_as_stored(file, bytes)?, None)?,
        false => raster::decode(file, bytes)?,
    };
    image(file, bytes, decoded)
}

/// Reads a layer of an EXR file, or one of its channels.
pub(crate) fn read_image_layer(file: &Path, layer: &str) -> Result<ImageAsset, Error> {
    let bytes = read_bytes(file, "image")?;
    if !bytes.starts_with(&EXR_MAGIC) {
        let words = format!("not an EXR file; only EXR files have layers such as \"{layer}\": remove `layer`");
        return Err(Error::coded(ErrorCode::UnsupportedFile, file, words));
    }
    let decoded = exr_colours::from_exr(file, decode_exr_as_stored(file, &bytes)?, Some(layer))?;
    image(file, &bytes, decoded)
}

/// Checks an image.
fn image(file: &Path, bytes: &[u8], decoded: DecodedImage) -> Result<ImageAsset, Error> {
    let (width, height, pixels, to_rec_709) = decoded;
    if width == 0 || height == 0 {
        return Err(Error::new(file, format!("the image has {width} × {height} pixels; expected at least one pixel")));
    }
    raster::check_finite(file, width, &pixels)?;
    Ok(ImageAsset { width, height, pixels, to_rec_709, hash: hash::hash_bytes(bytes) })
}
