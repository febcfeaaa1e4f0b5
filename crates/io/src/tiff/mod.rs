//! TIFF files of raw digital numbers, plain and as DNG.
//!
//! | writer | depth | meaning of a value |
//! | --- | --- | --- |
//! | [`encode_raw_tiff`] | 16 or 32 bit grey | digital number as it was delivered, not stretched |
//! | [`encode_dng`] | 16 or 32 bit, colour filter array or linear | the same, with levels, filters and colours for raw readers |
//!
//! Uncompressed, one strip, little-endian (TIFF 6.0, Adobe 1992; Digital Negative 1.4, Adobe 2012). No clock time is written.

mod directory;
mod dng;

pub use dng::{DngFacts, encode_dng};

use crate::exr::EncodeError;
use directory::{Directory, Value};
use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;

/// Digital numbers, in 16 bits where they fit and else in 32.
pub fn encode_raw_tiff(raw: &Plane<DigitalNumber>, bits: u32) -> Result<Vec<u8>, EncodeError> {
    const BLACK_IS_ZERO: u16 = 1;
    let mut directory = Directory::default();
    picture(&mut directory, raw, bits, BLACK_IS_ZERO)?;
    Ok(directory.file(&sample_bytes(raw, bits)))
}

/// What every picture of digital numbers says of itself.
fn picture(
    directory: &mut Directory,
    raw: &Plane<DigitalNumber>,
    bits: u32,
    photometric: u16,
) -> Result<(), EncodeError> {
    let (width, height) = (raw.width(), raw.height());
    if width == 0 || height == 0 {
        return Err(EncodeError::Empty { width, height });
    }
    let length = (width * height) as u64 * u64::from(stored_bits(bits) / 8);
    let (Ok(length), Ok(columns), Ok(rows)) = (u32::try_from(length), u32::try_from(width), u32::try_from(height))
    else {
        return Err(EncodeError::Encoder(format!("{width} × {height} pixels are too many for TIFF")));
    };
    directory.set(254, Value::Long(vec![0])); // the full picture
    directory.set(256, Value::Long(vec![columns]));
    directory.set(257, Value::Long(vec![rows]));
    directory.set(258, Value::Short(vec![stored_bits(bits)]));
    directory.set(259, Value::Short(vec![1])); // not compressed
    directory.set(262, Value::Short(vec![photometric]));
    directory.set(273, Value::StripOffset);
    directory.set(274, Value::Short(vec![1])); // the first row is the top one
    directory.set(277, Value::Short(vec![1])); // one sample a pixel
    directory.set(278, Value::Long(vec![rows]));
    directory.set(279, Value::Long(vec![length]));
    directory.set(284, Value::Short(vec![1])); // samples side by side
    directory.set(339, Value::Short(vec![1])); // unsigned whole numbers
    Ok(())
}

fn stored_bits(bits: u32) -> u16 {
    if bits <= 16 { 16 } else { 32 }
}

fn sample_bytes(raw: &Plane<DigitalNumber>, bits: u32) -> Vec<u8> {
    let samples = raw.samples().iter();
    if bits <= 16 {
        samples.flat_map(|dn| (*dn as u16).to_le_bytes()).collect()
    } else {
        samples.flat_map(|dn| dn.to_le_bytes()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_what_the_format_says() {
        let raw = Plane::from_samples(3, 2, vec![0, 1, 255, 256, 70_000, 16_777_215]).expect("six pixels");
        let file = encode_raw_tiff(&raw, 24).expect("a file");
        assert_eq!(&file[..8], b"II\x2a\0\x08\0\0\0");
        let word = |i: usize| u32::from_le_bytes(file[i..i + 4].try_into().expect("four bytes"));
        let entries = usize::from(u16::from_le_bytes([file[8], file[9]]));
        let entry = |tag: u16| {
            let found = (0..entries).map(|i| 10 + 12 * i).find(|i| file[*i..*i + 2] == tag.to_le_bytes());
            word(found.expect("the tag") + 8)
        };
        assert_eq!((entry(256), entry(257), entry(258), entry(279)), (3, 2, 32, 24));
        let start = entry(273) as usize;
        let numbers: Vec<u32> = (0..6).map(|i| word(start + 4 * i)).collect();
        assert_eq!(numbers, raw.samples());
        assert_eq!(file.len(), start + 24);
    }

    #[test]
    fn sixteen_bits_are_stored_in_sixteen() {
        let raw = Plane::from_samples(2, 1, vec![1, 65_535]).expect("two pixels");
        assert!(encode_raw_tiff(&raw, 12).expect("a file").ends_with(&[1, 0, 255, 255]));
        assert!(encode_raw_tiff(&Plane::new(0, 1), 12).is_err());
    }
}
