//! Portable float maps: `PF` (colour) or `Pf` (grey), width and height, a scale whose sign gives the byte order, and 32-bit floats from the bottom row upwards.
//!
//! Source: P. Debevec, "PFM Portable FloatMap Image Format". A negative scale is little endian; as in pbrt and Mitsuba its size multiplies the values.

use std::path::Path;

use etendue_scene::asset::ImagePixels;

use super::raster::DecodedImage;
use crate::{Error, texture_memory};

pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<DecodedImage, Error> {
    let (words, data) =
        header(bytes).ok_or_else(|| Error::new(file, "the header of the PFM is damaged or truncated"))?;
    let channels: usize = if words[0] == "PF" { 3 } else { 1 };
    let side = |word: &str| word.parse::<u32>().ok().filter(|n| *n > 0);
    let (Some(width), Some(height)) = (side(words[1]), side(words[2])) else {
        return Err(Error::new(
            file,
            format!("the PFM is {} by {} pixels; expected whole numbers above 0", words[1], words[2]),
        ));
    };
    let scale = words[3].parse::<f32>().ok().filter(|scale| scale.is_finite() && *scale != 0.0);
    let scale = scale.ok_or_else(|| {
        Error::new(file, format!("the scale of the PFM is `{}`; expected a number other than 0", words[3]))
    })?;
    let count = u128::from(width) * u128::from(height) * channels as u128;
    texture_memory::check_bytes(file, count * size_of::<f32>() as u128, bytes.len())?;
    let (numbers, _) = data.as_chunks::<4>();
    if (numbers.len() as u128) < count {
        let message = format!("the PFM has {} numbers; expected {count}: it is truncated", numbers.len());
        return Err(Error::new(file, message));
    }
    let number = |i: usize| {
        scale.abs() * if scale < 0.0 { f32::from_le_bytes(numbers[i]) } else { f32::from_be_bytes(numbers[i]) }
    };
    let columns = width as usize;
    let places =
        (0..height as usize).rev().flat_map(|row| (0..columns).map(move |column| channels * (row * columns + column)));
    let colour = |i: usize| if channels == 3 { [number(i), number(i + 1), number(i + 2)] } else { [number(i); 3] };
    Ok((width, height, ImagePixels::Rgb32F(places.map(colour).collect()), None))
}

/// Four words, each followed by one blank, and the bytes behind them.
fn header(bytes: &[u8]) -> Option<([&str; 4], &[u8])> {
    let mut rest = bytes;
    let mut words = [""; 4];
    for (i, word) in words.iter_mut().enumerate() {
        if i > 0 && i < 3 {
            rest = rest.trim_ascii_start();
        }
        let end = rest.iter().take(64).position(u8::is_ascii_whitespace)?;
        *word = std::str::from_utf8(&rest[..end]).ok()?;
        // The data follow a single line feed, which may have a carriage return before it.
        let blanks = if rest[end..].starts_with(b"\r\n") { 2 } else { 1 };
        rest = &rest[end + blanks..];
    }
    Some((words, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<ImagePixels, String> {
        decode(Path::new("a.pfm"), bytes).map(|image| image.2).map_err(|e| e.to_string())
    }

    #[test]
    fn either_byte_order_begins_with_the_bottom_row() {
        let numbers = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0];
        let little = [&b"PF\n1 2\n-1.0\n"[..], &numbers.map(f32::to_le_bytes).concat()].concat();
        let big = [&b"PF\r\n1\t2\r\n2\r\n"[..], &numbers.map(f32::to_be_bytes).concat()].concat();
        assert_eq!(read(&little), Ok(ImagePixels::Rgb32F(vec![[4.0, 5.0, 6.0], [1.0, 2.0, 3.0]])));
        assert_eq!(read(&big), Ok(ImagePixels::Rgb32F(vec![[8.0, 10.0, 12.0], [2.0, 4.0, 6.0]])));
        let grey = [&b"Pf\n3 2\n-1\n"[..], &numbers.map(f32::to_le_bytes).concat()].concat();
        assert_eq!(read(&grey), Ok(ImagePixels::Rgb32F([4.0, 5.0, 6.0, 1.0, 2.0, 3.0].map(|v| [v; 3]).to_vec())));
    }

    #[test]
    fn damaged_headers_are_refused() {
        for (bytes, expected) in [
            (&b"PF\n1 2\n"[..], "damaged or truncated"),
            (b"PF\n0 2\n-1\n", "the PFM is 0 by 2 pixels"),
            (b"PF\n1 2\nx\n", "the scale of the PFM is `x`"),
            (b"Pf\n1 2\n-1\n\0\0\0\0", "1 numbers; expected 2"),
        ] {
            let message = read(bytes).expect_err("damaged");
            assert!(message.starts_with("a.pfm: ") && message.contains(expected), "{message}");
        }
    }
}
