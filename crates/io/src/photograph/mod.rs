//! Photographs to be measured: channels as stored, and what is known of them.
//!
//! | file | channels | numbers | taken for, where nothing says otherwise |
//! | --- | --- | --- | --- |
//! | PNG, JPEG, TIFF of 8 bits | Y, or R, G, B; A | 0–255 | sRGB-encoded |
//! | colour PNG, TIFF of 16 bits | R, G, B; A | 0–65 535 | sRGB-encoded |
//! | grey PNG, TIFF, DNG of 16 bits; whole numbers of 32 bits | Y, or R, G, B; A | digital numbers | linear |
//! | TIFF of floats, Radiance HDR, PFM | Y, or R, G, B; A | as stored | linear |
//! | OpenEXR | all, by their full names | as stored | linear |
//!
//! What a side-car of this program or a chunk of a PNG says goes before ([`Encoding`]).
//! A grey picture that a side-car `camera.json` beside it lists as digital numbers is raw: linear, with the levels and the
//! colour filters that the side-car states. Numbers are not scaled; whole numbers above 2²⁴ are rounded to the nearest float.
//! The kind is told by the first bytes, not by the name. Left out: compressed DNG and other raw
//! files of cameras, TIFF of several pictures, of separate planes, or in CMYK, Lab or a palette (refused).

mod encoding;
mod grid;
mod pfm;
mod raw;
mod side_car;
mod tiff;

use std::path::Path;

pub(crate) use tiff::is_tiff;

pub use encoding::{Encoding, Stated};
pub use raw::{FilterTile, RawFacts, RawFrame};

use crate::Error;
use crate::exr::decode_exr;
use crate::picture::EXR_MAGIC;
use crate::source::read_bytes;

/// All kinds of file that are read.
pub(crate) const KINDS: &str = "PNG, JPEG, TIFF, uncompressed DNG, Radiance HDR, PFM or OpenEXR";

/// One channel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name: Y, R, G, B, A, or an EXR channel's full name.
    pub name: String,
    /// Numbers as stored.
    pub samples: Vec<f32>,
}

/// A picture to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Photograph {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels of equal size, in the order of the file.
    pub channels: Vec<Channel>,
    /// The largest number that the file can hold; `None` for floats.
    pub full_scale: Option<f64>,
    /// What the numbers are taken for, and why; a caller who is told otherwise changes it.
    pub stated: Stated,
    /// What a side-car states of a raw picture.
    pub raw: Option<RawFacts>,
    /// Pixels of a rendered picture whose errors may be equal, because their paths shared what they found; 1: none are.
    pub correlated_block_px: u32,
}

impl Photograph {
    /// The channel of that name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|c| c.name == name)
    }

    /// The names of all channels.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.channels.iter().map(|c| c.name.as_str()).collect()
    }
}

/// Reads a photograph and what a side-car beside it says of it.
///
/// # Errors
/// Where the file is missing, of another kind, damaged or not finite, or the side-car beside it is unreadable.
pub fn read_photograph(file: &Path) -> Result<Photograph, Error> {
    let mut photograph = decode_photograph(file, &read_bytes(file, "picture")?)?;
    let Some(beside) = side_car::beside(file)? else { return Ok(photograph) };
    photograph.correlated_block_px = beside.correlated_block_px();
    let reason = format!("{} beside it", beside.name());
    if photograph.channels.len() == 1
        && let Some(facts) = raw::facts(&beside)?
    {
        photograph.stated = Stated::new(Encoding::Linear, reason);
        photograph.raw = Some(facts);
    } else if let Some(encoding) = beside.encoding()? {
        photograph.stated = Stated::new(encoding, reason);
    }
    Ok(photograph)
}

/// The photograph in the bytes of `file`, without a side-car.
///
/// # Errors
/// As [`read_photograph`].
pub fn decode_photograph(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let photograph = if bytes.starts_with(&EXR_MAGIC) {
        of_exr(file, bytes)?
    } else if tiff::is_tiff(bytes) {
        tiff::decode(file, bytes)?
    } else if pfm::is_pfm(bytes) {
        pfm::decode(file, bytes)?
    } else {
        grid::decode(file, bytes)?
    };
    if photograph.width == 0 || photograph.height == 0 || photograph.channels.is_empty() {
        return Err(Error::new(file, "a picture without pixels; expected at least one pixel of one channel"));
    }
    Ok(photograph)
}

/// The attribute of an EXR that states [`Photograph::correlated_block_px`].
const ALIKE: &str = "etendue:correlated_block_px";

fn of_exr(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let exr = decode_exr(file, bytes)?;
    let channel = |c: crate::exr::ExrChannel| Channel { name: c.name, samples: c.samples.to_floats() };
    let stated = exr.attributes.get(ALIKE).and_then(|text| text.parse().ok());
    let correlated_block_px = stated.filter(|n| *n > 0).unwrap_or(1);
    let channels = exr.channels.into_iter().map(channel).collect();
    Ok(Photograph {
        width: exr.width,
        height: exr.height,
        channels,
        full_scale: None,
        stated: of_floats(),
        raw: None,
        correlated_block_px,
    })
}

/// Floats are in proportion to light.
fn of_floats() -> Stated {
    Stated::new(Encoding::Linear, "floats")
}

/// What numbers up to `full_scale` are taken for where nothing says it.
fn guess(full_scale: Option<f64>, colour: bool) -> Stated {
    match full_scale {
        None => of_floats(),
        Some(full) if full > 65_535.0 => Stated::guessed(Encoding::Linear, "whole numbers of 32 bits mostly are"),
        Some(full) if full > 255.0 && !colour => {
            Stated::guessed(Encoding::Linear, "grey numbers of 16 bits mostly are")
        }
        Some(full) if full > 255.0 => Stated::guessed(Encoding::Srgb, "colours of 16 bits mostly are"),
        Some(_) => Stated::guessed(Encoding::Srgb, "numbers of 8 bits mostly are"),
    }
}

/// Y, or R, G, B, each with A where there is one more.
fn channel_names(count: usize) -> Option<&'static [&'static str]> {
    match count {
        1 => Some(&["Y"]),
        2 => Some(&["Y", "A"]),
        3 => Some(&["R", "G", "B"]),
        4 => Some(&["R", "G", "B", "A"]),
        _ => None,
    }
}

/// Channels of samples that lie side by side.
fn separated(names: &[&str], samples: &[f32]) -> Vec<Channel> {
    let channel = |(i, name): (usize, &&str)| Channel {
        name: (*name).to_owned(),
        samples: samples.iter().skip(i).step_by(names.len()).copied().collect(),
    };
    names.iter().enumerate().map(channel).collect()
}

#[cfg(test)]
mod tests;
