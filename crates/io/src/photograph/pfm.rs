//! Portable float maps, as stereo benchmarks keep disparities and depths (Debevec's format; Middlebury 2014).
//!
//! A header of three lines: `Pf` (one channel) or `PF` (three); width and height; a number whose sign tells the byte order
//! (negative: little-endian) and whose size is not used. Then floats of 32 bits, rows from the **bottom** up. Infinite
//! numbers and NaN are kept: they mark what is not known.

use std::path::Path;

use super::{Photograph, channel_names, of_floats, separated};
use crate::Error;

pub(crate) fn is_pfm(bytes: &[u8]) -> bool {
    matches!(bytes, [b'P', b'f' | b'F', next, ..] if next.is_ascii_whitespace())
}

pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<Photograph, Error> {
    let wrong = || Error::new(file, "not a PFM: expected Pf or PF, width, height and a scale other than 0");
    let channels = if bytes[1] == b'F' { 3 } else { 1 };
    let mut rest = &bytes[2..];
    let mut word = || {
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace)?;
        let text = std::str::from_utf8(&rest[start..start + length]).ok()?;
        // One white space ends the header: what follows may look like another.
        rest = &rest[start + length + 1..];
        Some(text)
    };
    let mut size = || word()?.parse::<usize>().ok().filter(|n| (1..=1 << 20).contains(n));
    let (width, height) = size().zip(size()).ok_or_else(wrong)?;
    let scale = word().and_then(|w| w.parse::<f64>().ok()).filter(|s| s.is_finite() && *s != 0.0).ok_or_else(wrong)?;
    let expected = width * height * channels * 4;
    if rest.len() != expected {
        let told =
            format!("{} bytes of pixels, where {width} × {height} × {channels} floats are {expected}", rest.len());
        return Err(Error::new(file, told));
    }
    let float = |b: &[u8]| {
        let bytes = [b[0], b[1], b[2], b[3]];
        if scale < 0.0 { f32::from_le_bytes(bytes) } else { f32::from_be_bytes(bytes) }
    };
    let rows = rest.chunks_exact(4 * width * channels).rev();
    let samples: Vec<f32> = rows.flat_map(|row| row.chunks_exact(4).map(float)).collect();
    let names = channel_names(channels).expect("one or three");
    let channels = separated(names, &samples);
    Ok(Photograph { width, height, channels, full_scale: None, stated: of_floats(), raw: None, correlated_block_px: 1 })
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
            let read = decode(Path::new("a.pfm"), &file).expect("a PFM");
            assert_eq!((read.width, read.height), (2, 2));
            assert_eq!(read.channels[0].samples, [f32::INFINITY, 4.0, 1.0, 2.0]);
            let told = decode(Path::new("a.pfm"), &file[..file.len() - 1]).expect_err("cut").to_string();
            assert!(told.contains("15 bytes of pixels"), "{told}");
        }
        for header in ["Pf\n2 0\n-1\n", "Pf\n2 2\n0\n", "Pf\n2"] {
            assert!(decode(Path::new("a.pfm"), header.as_bytes()).is_err(), "{header}");
        }
    }
}
