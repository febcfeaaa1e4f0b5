//! Photograph in memory, its channels, and its files: PNG, JPEG, Radiance HDR, and portable float maps.
//!
//! Portable float maps, as stereo benchmarks use for disparities and depths (Debevec's format; Middlebury 2014).
//!
//! A header of three lines: `Pf` (one channel) or `PF` (three); width and height; a number whose sign gives the byte order (negative: little-endian) and whose
//! magnitude is not used. Then floats of 32 bits, rows from the **bottom** up. Infinite numbers and NaN are kept: they mark unknown values.

use std::path::Path;

use image::DynamicImage;

use super::side_car::RawFacts;
use crate::encoding::{Encoding, SourcedEncoding};
use crate::picture::{PixelStorage, RasterFormats, decode_raster};
use crate::{Error, ErrorCode, png};

/// Supported kinds of file.
pub(crate) const KINDS: &str = "PNG, JPEG, TIFF, uncompressed DNG, Radiance HDR, PFM or OpenEXR";

/// One channel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotographChannel {
    /// Name: Y, R, G, B, A, or an EXR channel's full name.
    pub name: String,
    /// Numbers as stored.
    pub samples: Vec<f32>,
}

/// Image to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Photograph {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels of equal size, in the order of the file.
    pub channels: Vec<PhotographChannel>,
    /// Largest number that the file can hold; `None` for floats.
    pub full_scale: Option<f64>,
    /// Encoding of the numbers, with its source; a caller with better information changes it.
    pub stated: SourcedEncoding,
    /// Facts that a side-car states of a raw image.
    pub raw: Option<RawFacts>,
    /// Pixels of a rendered image whose errors may be correlated, because their paths shared samples; 1: none.
    pub correlated_block_px: u32,
}

impl Photograph {
    /// Channel of that name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&PhotographChannel> {
        self.channels.iter().find(|c| c.name == name)
    }

    /// The names of all channels.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.channels.iter().map(|c| c.name.as_str()).collect()
    }
}

/// Floats are proportional to light.
pub(super) fn from_floats() -> SourcedEncoding {
    SourcedEncoding::new(Encoding::Linear, "floats")
}

/// Default encoding of numbers up to `full_scale`, if nothing states it.
pub(super) fn guess(full_scale: Option<f64>, colour: bool) -> SourcedEncoding {
    match full_scale {
        None => from_floats(),
        Some(full) if full > 65_535.0 => SourcedEncoding::guessed(Encoding::Linear, "32-bit integers usually are"),
        Some(full) if full > 255.0 && !colour => {
            SourcedEncoding::guessed(Encoding::Linear, "16-bit grey values usually are")
        }
        Some(full) if full > 255.0 => SourcedEncoding::guessed(Encoding::Srgb, "16-bit colours usually are"),
        Some(_) => SourcedEncoding::guessed(Encoding::Srgb, "8-bit values usually are"),
    }
}

/// Y, or R, G, B, each with A if there is one more.
pub(super) fn channel_names(count: usize) -> Option<&'static [&'static str]> {
    match count {
        1 => Some(&["Y"]),
        2 => Some(&["Y", "A"]),
        3 => Some(&["R", "G", "B"]),
        4 => Some(&["R", "G", "B", "A"]),
        _ => None,
    }
}

/// Channels of interleaved samples.
pub(super) fn separated(names: &[&str], samples: &[f32]) -> Vec<PhotographChannel> {
    let channel = |(i, name): (usize, &&str)| PhotographChannel {
        name: (*name).to_owned(),
        samples: samples.iter().skip(i).step_by(names.len()).copied().collect(),
    };
    names.iter().enumerate().map(channel).collect()
}

pub(super) fn decode_grid(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let (_, image) = decode_raster(file, bytes, RasterFormats::measured(super::KINDS), PixelStorage::Floats)?;
    let (width, height, colour) = (image.width() as usize, image.height() as usize, image.color());
    let (samples, full_scale) = samples(&image);
    let channels = usize::from(colour.channel_count());
    let names = channel_names(channels).ok_or_else(|| {
        Error::coded(ErrorCode::UnsupportedFile, file, format!("has {channels} channels; expected 1 to 4"))
    })?;
    let stated = stated(bytes, guess(full_scale, colour.has_color()));
    Ok(Photograph {
        width,
        height,
        channels: separated(names, &samples),
        full_scale,
        stated,
        raw: None,
        correlated_block_px: 1,
    })
}

/// Encoding that a PNG states, else the guess with the names of unsupported statements.
fn stated(bytes: &[u8], guess: SourcedEncoding) -> SourcedEncoding {
    let statement = png::stated_encoding(bytes);
    let named = |name| format!("{name} is not supported: {}", guess.reason);
    let reason = statement.not_understood.map_or_else(|| guess.reason.clone(), named);
    statement.stated.unwrap_or(SourcedEncoding { reason, ..guess })
}

/// All samples, channels interleaved, and the largest number of the format.
fn samples(image: &DynamicImage) -> (Vec<f32>, Option<f64>) {
    let (bytes, colour) = (image.as_bytes(), image.color());
    match colour.bytes_per_pixel() / colour.channel_count() {
        1 => (bytes.iter().map(|b| f32::from(*b)).collect(), Some(255.0)),
        2 => {
            let word = |b: &[u8]| f32::from(u16::from_ne_bytes([b[0], b[1]]));
            (bytes.chunks_exact(2).map(word).collect(), Some(65_535.0))
        }
        _ => (bytes.chunks_exact(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect(), None),
    }
}

pub(crate) fn is_pfm(bytes: &[u8]) -> bool {
    matches!(bytes, [b'P', b'f' | b'F', next, ..] if next.is_ascii_whitespace())
}

pub(super) fn decode_pfm(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let wrong = || Error::new(file, "not a PFM file: expected Pf or PF, width, height and a scale other than 0");
    let channels = if bytes[1] == b'F' { 3 } else { 1 };
    let mut rest = &bytes[2..];
    let mut word = || {
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace)?;
        let text = std::str::from_utf8(&rest[start..start + length]).ok()?;
        // A single white space ends the header: the data may look like more.
        rest = &rest[start + length + 1..];
        Some(text)
    };
    let mut size = || word()?.parse::<usize>().ok().filter(|n| (1..=1 << 20).contains(n));
    let (width, height) = size().zip(size()).ok_or_else(wrong)?;
    let scale = word().and_then(|w| w.parse::<f64>().ok()).filter(|s| s.is_finite() && *s != 0.0).ok_or_else(wrong)?;
    let expected = width * height * channels * 4;
    if rest.len() != expected {
        let problem = format!(
            "has {} bytes of pixels; expected {expected} for {width} × {height} × {channels} floats",
            rest.len()
        );
        return Err(Error::new(file, problem));
    }
    let float = |b: &[u8]| {
        let bytes = [b[0], b[1], b[2], b[3]];
        if scale < 0.0 { f32::from_le_bytes(bytes) } else { f32::from_be_bytes(bytes) }
    };
    let rows = rest.chunks_exact(4 * width * channels).rev();
    let samples: Vec<f32> = rows.flat_map(|row| row.chunks_exact(4).map(float)).collect();
    let names = channel_names(channels).expect("one or three");
    let channels = separated(names, &samples);
    Ok(Photograph {
        width,
        height,
        channels,
        full_scale: None,
        stated: from_floats(),
        raw: None,
        correlated_block_px: 1,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_from_the_bottom_in_either_byte_order() {
        let numbers = [1.0_f32, 2.0, f32::INFINITY, 4.0];
        for (scale, bytes) in [("-1.0", numbers.map(f32::to_le_bytes)), ("1", numbers.map(f32::to_be_bytes))] {
            let file = [format!("Pf\n2 2\n{scale}\n").as_bytes(), &bytes.concat()].concat();
            assert!(is_pfm(&file));
            let read = decode_pfm(Path::new("a.pfm"), &file).expect("a PFM");
            assert_eq!((read.width, read.height), (2, 2));
            assert_eq!(read.channels[0].samples, [f32::INFINITY, 4.0, 1.0, 2.0]);
            let message = decode_pfm(Path::new("a.pfm"), &file[..file.len() - 1]).expect_err("cut").to_string();
            assert!(message.contains("15 bytes of pixels"), "{message}");
        }
        for header in ["Pf\n2 0\n-1\n", "Pf\n2 2\n0\n", "Pf\n2"] {
            assert!(decode_pfm(Path::new("a.pfm"), header.as_bytes()).is_err(), "{header}");
        }
    }
}
