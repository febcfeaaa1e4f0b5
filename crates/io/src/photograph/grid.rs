//! PNG, JPEG and Radiance HDR.

use std::path::Path;

use image::DynamicImage;

use super::{Photograph, Stated, channel_names, guess, separated};
use crate::picture::{Kept, decode_raster};
use crate::png_chunks;
use crate::{Error, ErrorCode};

pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let (_, picture) = decode_raster(file, bytes, super::KINDS, Kept::Floats)?;
    let (width, height, colour) = (picture.width() as usize, picture.height() as usize, picture.color());
    let (samples, full_scale) = samples(&picture);
    let channels = usize::from(colour.channel_count());
    let names = channel_names(channels).ok_or_else(|| {
        Error::coded(ErrorCode::UnsupportedFile, file, format!("{channels} channels; expected 1 to 4"))
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

/// What a PNG says of itself, or else the guess, with the name of what it says and is not understood.
fn stated(bytes: &[u8], guess: Stated) -> Stated {
    let said = png_chunks::said(bytes);
    let named = |name| format!("{name} is not understood: {}", guess.reason);
    let reason = said.not_understood.map_or_else(|| guess.reason.clone(), named);
    said.stated.unwrap_or(Stated { reason, ..guess })
}

/// All samples, channels side by side, and the largest number that fits.
fn samples(picture: &DynamicImage) -> (Vec<f32>, Option<f64>) {
    let (bytes, colour) = (picture.as_bytes(), picture.color());
    match colour.bytes_per_pixel() / colour.channel_count() {
        1 => (bytes.iter().map(|b| f32::from(*b)).collect(), Some(255.0)),
        2 => {
            let of = |b: &[u8]| f32::from(u16::from_ne_bytes([b[0], b[1]]));
            (bytes.chunks_exact(2).map(of).collect(), Some(65_535.0))
        }
        _ => (bytes.chunks_exact(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect(), None),
    }
}
