//! "Quite OK" images of 8 bits.
//!
//! Source: D. Szablewski, "The Quite OK Image Format Specification", version 1.0, 2022.

use std::path::Path;

use etendue_scene::asset::ImagePixels;

use super::raster::DecodedImage;
use crate::{Error, texture_memory};

const HEADER: usize = 14;

pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<DecodedImage, Error> {
    let truncated = || Error::new(file, "the QOI is truncated; create or download it again");
    let word = |at: usize| bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_be_bytes);
    let (Some(width), Some(height), Some(channels)) = (word(4), word(8), bytes.get(12)) else {
        return Err(truncated());
    };
    let count = u128::from(width) * u128::from(height);
    texture_memory::check_bytes(file, 4 * count, bytes.len())?;
    let pixels =
        Chunks::new(bytes.get(HEADER..).ok_or_else(truncated)?).pixels(count as usize).ok_or_else(truncated)?;
    let pixels = match channels {
        4 => ImagePixels::Rgba8(pixels),
        _ => ImagePixels::Rgb8(pixels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()),
    };
    Ok((width, height, pixels, None))
}

/// Decoder of the chunks behind the header.
struct Chunks<'a> {
    rest: &'a [u8],
    pixel: [u8; 4],
    /// Pixels by their hash.
    index: [[u8; 4]; 64],
}

impl<'a> Chunks<'a> {
    fn new(rest: &'a [u8]) -> Self {
        Self { rest, pixel: [0, 0, 0, 255], index: [[0; 4]; 64] }
    }

    /// `None` if the file ends before its pixels do.
    fn pixels(mut self, count: usize) -> Option<Vec<[u8; 4]>> {
        let mut pixels = Vec::with_capacity(count);
        while pixels.len() < count {
            let run = self.chunk()?;
            let [r, g, b, a] = self.pixel.map(usize::from);
            self.index[(3 * r + 5 * g + 7 * b + 11 * a) % 64] = self.pixel;
            pixels.extend(std::iter::repeat_n(self.pixel, run.min(count - pixels.len())));
        }
        Some(pixels)
    }

    fn byte(&mut self) -> Option<u8> {
        let (byte, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*byte)
    }

    /// Reads a chunk; returns the number of pixels that it stands for.
    fn chunk(&mut self) -> Option<usize> {
        let tag = self.byte()?;
        let low = tag & 0x3f;
        match tag {
            0xfe | 0xff => {
                let stored = if tag == 0xff { 4 } else { 3 };
                for channel in 0..stored {
                    self.pixel[channel] = self.byte()?;
                }
            }
            0..=0x3f => self.pixel = self.index[usize::from(low)],
            0x40..=0x7f => {
                let steps = [low >> 4, (low >> 2) & 3, low & 3].map(|step| step.wrapping_sub(2));
                self.add(steps);
            }
            0x80..=0xbf => {
                let second = self.byte()?;
                let green = low.wrapping_sub(32);
                let (red, blue) = ((second >> 4).wrapping_sub(8), (second & 15).wrapping_sub(8));
                self.add([green.wrapping_add(red), green, green.wrapping_add(blue)]);
            }
            _ => return Some(usize::from(low) + 1),
        }
        Some(1)
    }

    fn add(&mut self, steps: [u8; 3]) {
        for (channel, step) in self.pixel.iter_mut().zip(steps) {
            *channel = channel.wrapping_add(step);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every chunk of the specification by hand.
    #[test]
    fn chunks_give_their_pixels() {
        let header = [&b"qoif"[..], &8_u32.to_be_bytes(), &1_u32.to_be_bytes(), &[4, 0]].concat();
        // RGB (10, 20, 30); difference (+1, −2, 0); luma: green +5, red +5 − 3, blue +5 + 2; run of 2; RGBA; index of the first pixel:
        // (3·10 + 5·20 + 7·30 + 11·255) mod 64 = 9; difference of 0.
        let chunks = [
            &[0xfe, 10, 20, 30][..],
            &[0x40 | (3 << 4) | 2],
            &[0x80 | 37, (5 << 4) | 10],
            &[0xc1],
            &[0xff, 1, 2, 3, 4],
            &[9],
            &[0x6a],
        ];
        let bytes = [&header[..], &chunks.concat(), &[0, 0, 0, 0, 0, 0, 0, 1]].concat();
        let (width, height, pixels, _) = decode(Path::new("a.qoi"), &bytes).expect("readable");
        let (first, luma) = ([10, 20, 30, 255], [13, 23, 37, 255]);
        let expected = vec![first, [11, 18, 30, 255], luma, luma, luma, [1, 2, 3, 4], first, first];
        assert_eq!((width, height, pixels), (8, 1, ImagePixels::Rgba8(expected)));
        let message = decode(Path::new("a.qoi"), &bytes[..20]).expect_err("truncated").to_string();
        assert!(message.contains("the QOI is truncated"), "{message}");
    }
}
