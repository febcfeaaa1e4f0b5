//! Photographs to be measured: channels as stored, and known facts.
//!
//! | file | channels | numbers | default encoding |
//! | --- | --- | --- | --- |
//! | PNG, JPEG, TIFF of 8 bits | Y, or R, G, B; A | 0–255 | sRGB-encoded |
//! | colour PNG, TIFF of 16 bits | R, G, B; A | 0–65 535 | sRGB-encoded |
//! | grey PNG, TIFF, DNG of 16 bits; whole numbers of 32 bits | Y, or R, G, B; A | digital numbers | linear |
//! | TIFF of floats, Radiance HDR, PFM | Y, or R, G, B; A | as stored | linear |
//! | OpenEXR | all, by their full names | as stored | linear |
//!
//! A side-car of this program or a chunk of a PNG takes precedence ([`Encoding`]). A grey image that a side-car `camera.json` next to it lists as digital
//! numbers is raw: linear, with the levels and the colour filters that the side-car states. Numbers are not scaled; whole numbers above 2²⁴ are rounded to the
//! nearest float. The kind is identified by the first bytes, not by the name. Not supported: compressed DNG and other raw files of cameras, TIFF of several
//! images, of separate planes, or in CMYK, Lab or a palette (refused).

mod channels;
mod side_car;
mod tiff;

use std::path::Path;

use crate::{Error, ErrorCode, exr::decode_exr, picture::EXR_MAGIC, source::read_bytes};
use channels::{channel_names, from_floats, guess, separated};

pub use crate::encoding::{Encoding, SourcedEncoding};
pub use channels::{Photograph, PhotographChannel};
pub use side_car::{FilterTile, RawFacts, RawFrame, StatedRows, StatedTiming, stated_timing};

pub(crate) use channels::{KINDS, is_pfm};
pub(crate) use tiff::is_tiff;

/// Reads a photograph and the statements of a side-car next to it.
///
/// # Errors
/// If the file is missing, of another kind, damaged or not finite, or the side-car is unreadable.
pub fn read_photograph(file: &Path) -> Result<Photograph, Error> {
    let mut photograph = decode_photograph(file, &read_bytes(file, "image")?)?;
    let Some(metadata) = side_car::find(file)? else { return Ok(photograph) };
    photograph.correlated_block_px = metadata.correlated_block_px()?;
    let reason = format!("{} next to it", metadata.name());
    if photograph.channels.len() == 1
        && let Some(facts) = side_car::facts(&metadata)?
    {
        photograph.stated = SourcedEncoding::new(Encoding::Linear, reason);
        photograph.raw = Some(facts);
    } else if let Some(encoding) = metadata.encoding()? {
        photograph.stated = SourcedEncoding::new(encoding, reason);
    }
    Ok(photograph)
}

/// Decodes a photograph from the bytes of `file`, without a side-car.
///
/// # Errors
/// As [`read_photograph`].
pub fn decode_photograph(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let photograph = if bytes.starts_with(&EXR_MAGIC) {
        photograph_from_exr(file, bytes)?
    } else if tiff::is_tiff(bytes) {
        tiff::decode(file, bytes)?
    } else if channels::is_pfm(bytes) {
        channels::decode_pfm(file, bytes)?
    } else {
        channels::decode_grid(file, bytes)?
    };
    if photograph.width == 0 || photograph.height == 0 || photograph.channels.is_empty() {
        return Err(Error::coded(
            ErrorCode::Empty,
            file,
            "an image without pixels; expected at least one pixel of one channel",
        ));
    }
    Ok(photograph)
}

/// EXR attribute that states [`Photograph::correlated_block_px`].
const CORRELATED_BLOCK_ATTRIBUTE: &str = "etendue:correlated_block_px";

fn photograph_from_exr(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let exr = decode_exr(file, bytes)?;
    exr.check_is_no_cube_map(file)?;
    let channel = |c: crate::exr::ExrChannel| PhotographChannel { name: c.name, samples: c.samples.into_floats() };
    let stated = exr.attributes.get(CORRELATED_BLOCK_ATTRIBUTE).and_then(|text| text.parse().ok());
    let correlated_block_px = stated.filter(|n| *n > 0).unwrap_or(1);
    let channels = exr.channels.into_iter().map(channel).collect();
    Ok(Photograph {
        width: exr.width,
        height: exr.height,
        channels,
        full_scale: None,
        stated: from_floats(),
        raw: None,
        correlated_block_px,
    })
}

#[cfg(test)]
mod tests;
