//! TIFF of one image (TIFF 6.0, Adobe 1992), as the tiff crate reads it; a DNG of one plain image, as this program writes it (Digital Negative 1.4, Adobe
//! 2012), is read as a grey TIFF: only its photometric interpretation differs.

use std::{borrow::Cow, io::Cursor, path::Path};

use ::tiff::decoder::{Decoder, DecodingResult, Limits};
use ::tiff::{ColorType, tags::Tag};

use super::{Photograph, channel_names, guess, separated};
use crate::{Error, ErrorCode, error::guarded, texture_memory};

/// Returns true if the bytes begin as a TIFF, of either byte order, plain or BigTIFF.
pub(crate) fn is_tiff(bytes: &[u8]) -> bool {
    let beginnings: [&[u8]; 4] = [b"II\x2a\0", b"MM\0\x2a", b"II\x2b\0", b"MM\0\x2b"];
    beginnings.iter().any(|b| bytes.starts_with(b))
}

pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    guarded(file, || decode_unguarded(file, bytes))
}

fn decode_unguarded(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let damaged = |cause: ::tiff::TiffError| {
        Error::new(
            file,
            format!(
                "not a readable TIFF ({cause}); it may be truncated, or of a kind that is not supported: save it as plain grey or RGB"
            ),
        )
    };
    let bytes = digital_negative_as_grey(bytes);
    let mut decoder = Decoder::new(Cursor::new(&bytes[..])).map_err(damaged)?.with_limits(limits(bytes.len()));
    let (width, height) = decoder.dimensions().map_err(damaged)?;
    let colour = decoder.colortype().map_err(damaged)?;
    let grey = matches!(colour, ColorType::Gray(_) | ColorType::GrayA(_));
    if !(grey || matches!(colour, ColorType::RGB(_) | ColorType::RGBA(_))) {
        return Err(Error::coded(
            ErrorCode::UnsupportedFile,
            file,
            format!("a TIFF in {colour:?}; expected grey or RGB: convert it"),
        ));
    }
    let count = usize::from(colour.num_samples());
    const SEPARATE: u16 = 2;
    let planes = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(damaged)?;
    if count > 1 && planes == Some(SEPARATE) {
        return Err(Error::coded(
            ErrorCode::UnsupportedFile,
            file,
            "a TIFF with separate planes; save it with interleaved samples",
        ));
    }
    let samples = u128::from(width) * u128::from(height) * count as u128;
    texture_memory::check(file, samples, bytes.len())?;
    if decoder.more_images() {
        return Err(Error::coded(
            ErrorCode::UnsupportedFile,
            file,
            "a TIFF with several images; save each as a separate file",
        ));
    }
    let (samples, full_scale) = numbers(file, decoder.read_image().map_err(damaged)?)?;
    let names = channel_names(count).ok_or_else(|| {
        Error::coded(ErrorCode::UnsupportedFile, file, format!("has {count} channels; expected 1 to 4"))
    })?;
    Ok(Photograph {
        width: width as usize,
        height: height as usize,
        channels: separated(names, &samples),
        full_scale,
        stated: guess(full_scale, !grey),
        raw: None,
        correlated_block_px: 1,
    })
}

/// The same file with the photometric interpretation "colour filter array" or "linear raw" replaced by grey, which the tiff crate supports.
fn digital_negative_as_grey(bytes: &[u8]) -> Cow<'_, [u8]> {
    const FILTER_ARRAY: u16 = 32_803;
    const LINEAR_RAW: u16 = 34_892;
    const BLACK_IS_ZERO: u16 = 1;
    let big = bytes.starts_with(b"MM");
    let Some((at, kind)) = photometric_entry(bytes, big) else { return Cow::Borrowed(bytes) };
    if kind != FILTER_ARRAY && kind != LINEAR_RAW {
        return Cow::Borrowed(bytes);
    }
    let mut grey = bytes.to_vec();
    let value = if big { BLACK_IS_ZERO.to_be_bytes() } else { BLACK_IS_ZERO.to_le_bytes() };
    grey[at..at + 2].copy_from_slice(&value);
    Cow::Owned(grey)
}

/// Offset of the photometric interpretation in the first directory of a plain TIFF, and its value.
fn photometric_entry(bytes: &[u8], big: bool) -> Option<(usize, u16)> {
    const KIND: u16 = 262;
    const ENTRY: usize = 12;
    let short = |at: usize| {
        let two: [u8; 2] = bytes.get(at..at.checked_add(2)?)?.try_into().ok()?;
        Some(if big { u16::from_be_bytes(two) } else { u16::from_le_bytes(two) })
    };
    let long: [u8; 4] = bytes.get(4..8)?.try_into().ok()?;
    let directory = if big { u32::from_be_bytes(long) } else { u32::from_le_bytes(long) } as usize;
    let entries = directory + 2..directory + 2 + ENTRY * usize::from(short(directory)?);
    let entry = entries.step_by(ENTRY).find(|at| short(*at) == Some(KIND))?;
    Some((entry + 8, short(entry + 8)?))
}

/// Decoder limits for images that pass [`texture_memory::check`], in numbers of up to 64 bits.
fn limits(packed: usize) -> Limits {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = usize::try_from(2 * texture_memory::max_bytes(packed)).unwrap_or(usize::MAX);
    // Tables of offsets and packed strips are parts of the file.
    limits.ifd_value_size = packed.max(1 << 16);
    limits.intermediate_buffer_size = usize::try_from(texture_memory::max_bytes(packed)).unwrap_or(usize::MAX);
    limits
}

/// Samples, and the largest number of the format.
fn numbers(file: &Path, samples: DecodingResult) -> Result<(Vec<f32>, Option<f64>), Error> {
    let (samples, full_scale): (Vec<f32>, _) = match samples {
        DecodingResult::U8(v) => (v.into_iter().map(f32::from).collect(), Some(f64::from(u8::MAX))),
        DecodingResult::U16(v) => (v.into_iter().map(f32::from).collect(), Some(f64::from(u16::MAX))),
        DecodingResult::U32(v) => (v.into_iter().map(|n| n as f32).collect(), Some(f64::from(u32::MAX))),
        DecodingResult::F16(v) => (v.into_iter().map(f32::from).collect(), None),
        DecodingResult::F32(v) => (v, None),
        DecodingResult::F64(v) => (v.into_iter().map(|n| n as f32).collect(), None),
        _ => {
            return Err(Error::coded(
                ErrorCode::UnsupportedFile,
                file,
                "a TIFF with signed or 64-bit numbers; expected unsigned integers of up to 32 bits, or floats",
            ));
        }
    };
    match samples.iter().position(|v| !v.is_finite()) {
        None => Ok((samples, full_scale)),
        Some(at) => Err(Error::new(file, format!("sample {at} is {}; expected finite numbers", samples[at]))),
    }
}
