//! TIFF files of raw digital numbers, plain and as DNG.
//!
//! | writer | depth | meaning of a value |
//! | --- | --- | --- |
//! | [`encode_raw_tiff`] | 16 or 32 bit grey | digital number of the ADC, not stretched |
//! | [`encode_dng`] | 16 or 32 bit, colour filter array or linear | the same, with levels, filters and colours for raw readers |
//!
//! Uncompressed, one strip, little-endian (TIFF 6.0, Adobe 1992; Digital Negative 1.4, Adobe 2012). No clock time is written.

use std::collections::BTreeMap;

use etendue_core::{Plane, quantity::DigitalNumber};

use crate::exr::EncodeError;

/// Encodes digital numbers, in 16 bits if they fit, else in 32.
pub fn encode_raw_tiff(raw: &Plane<DigitalNumber>, bits: u32) -> Result<Vec<u8>, EncodeError> {
    const BLACK_IS_ZERO: u16 = 1;
    let mut directory = Directory::default();
    set_image_tags(&mut directory, raw, bits, BLACK_IS_ZERO)?;
    Ok(directory.file(&sample_bytes(raw, bits)))
}

/// Directory entries common to all images of digital numbers.
fn set_image_tags(
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
    directory.set(254, TagValue::Long(vec![0])); // the full image
    directory.set(256, TagValue::Long(vec![columns]));
    directory.set(257, TagValue::Long(vec![rows]));
    directory.set(258, TagValue::Short(vec![stored_bits(bits)]));
    directory.set(259, TagValue::Short(vec![1])); // not compressed
    directory.set(262, TagValue::Short(vec![photometric]));
    directory.set(273, TagValue::StripOffset);
    directory.set(274, TagValue::Short(vec![1])); // the first row is the top one
    directory.set(277, TagValue::Short(vec![1])); // one sample per pixel
    directory.set(278, TagValue::Long(vec![rows]));
    directory.set(279, TagValue::Long(vec![length]));
    directory.set(284, TagValue::Short(vec![1])); // interleaved samples
    directory.set(339, TagValue::Short(vec![1])); // unsigned integers
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

/// A tag's value.
#[derive(Clone, Debug)]
enum TagValue {
    Byte(Vec<u8>),
    Text(String),
    Short(Vec<u16>),
    Long(Vec<u32>),
    Rational(Vec<(u32, u32)>),
    SignedRational(Vec<(i32, i32)>),
    /// Offset of the strip.
    StripOffset,
}

/// Tags and their values.
#[derive(Clone, Debug, Default)]
struct Directory {
    tags: BTreeMap<u16, TagValue>,
}

impl Directory {
    fn set(&mut self, tag: u16, value: TagValue) {
        self.tags.insert(tag, value);
    }

    /// The file with its strip.
    fn file(&self, strip: &[u8]) -> Vec<u8> {
        let encoded: Vec<_> = self.tags.iter().map(|(tag, value)| (*tag, value.encoded())).collect();
        let after = 8 + 2 + 12 * encoded.len() + 4;
        let long: usize = encoded.iter().map(|(_, e)| e.stored_apart()).sum();
        let strip_at = (after + long) as u32;
        let mut file = b"II\x2a\0\x08\0\0\0".to_vec();
        file.extend((encoded.len() as u16).to_le_bytes());
        let mut apart = Vec::new();
        for (tag, value) in &encoded {
            file.extend(tag.to_le_bytes());
            file.extend(value.kind.to_le_bytes());
            file.extend(value.count.to_le_bytes());
            match &value.bytes {
                None => file.extend(strip_at.to_le_bytes()),
                Some(bytes) if bytes.len() <= 4 => file.extend(padded(bytes, 4)),
                Some(bytes) => {
                    file.extend(((after + apart.len()) as u32).to_le_bytes());
                    apart.extend(padded(bytes, bytes.len().next_multiple_of(2)));
                }
            }
        }
        file.extend([0; 4]);
        file.extend(apart);
        file.extend(strip);
        file
    }
}

fn padded(bytes: &[u8], length: usize) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes.resize(length, 0);
    bytes
}

/// Encoded value; without bytes for the offset of the strip.
struct EncodedValue {
    kind: u16,
    count: u32,
    bytes: Option<Vec<u8>>,
}

impl EncodedValue {
    fn stored_apart(&self) -> usize {
        self.bytes.as_ref().map_or(0, |bytes| if bytes.len() <= 4 { 0 } else { bytes.len().next_multiple_of(2) })
    }
}

impl TagValue {
    fn encoded(&self) -> EncodedValue {
        let with = |kind, count: usize, bytes| EncodedValue { kind, count: count as u32, bytes: Some(bytes) };
        match self {
            Self::Byte(v) => with(1, v.len(), v.clone()),
            Self::Text(v) => with(2, v.len() + 1, [v.as_bytes(), &[0]].concat()),
            Self::Short(v) => with(3, v.len(), v.iter().flat_map(|v| v.to_le_bytes()).collect()),
            Self::Long(v) => with(4, v.len(), v.iter().flat_map(|v| v.to_le_bytes()).collect()),
            Self::Rational(v) => {
                with(5, v.len(), v.iter().flat_map(|(n, d)| [n.to_le_bytes(), d.to_le_bytes()].concat()).collect())
            }
            Self::SignedRational(v) => {
                with(10, v.len(), v.iter().flat_map(|(n, d)| [n.to_le_bytes(), d.to_le_bytes()].concat()).collect())
            }
            Self::StripOffset => EncodedValue { kind: 4, count: 1, bytes: None },
        }
    }
}

/// Facts of a DNG in addition to its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct DngFacts {
    /// Camera name.
    pub camera: String,
    /// The writing program and its version.
    pub software: String,
    /// Bits per number.
    pub bits: u32,
    /// Digital number at zero charge.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// Columns of the filter tile, and its colours row by row: 0 red, 1 green, 2 blue; `None` for a mono image.
    pub tile: Option<(u16, Vec<u8>)>,
    /// Matrix from XYZ (relative to D65) to the camera's colours.
    pub xyz_to_camera: [[f64; 3]; 3],
    /// Neutral colour in the camera's colours, largest 1.
    pub neutral: [f64; 3],
    /// Light-sensitive part: first column, first row, columns, rows.
    pub active: [u32; 4],
}

/// Encodes a DNG; a mono image is stored as linear grey.
pub fn encode_dng(raw: &Plane<DigitalNumber>, facts: &DngFacts) -> Result<Vec<u8>, EncodeError> {
    const FILTER_ARRAY: u16 = 32_803;
    const LINEAR: u16 = 34_892;
    let mut directory = Directory::default();
    let photometric = if facts.tile.is_some() { FILTER_ARRAY } else { LINEAR };
    set_image_tags(&mut directory, raw, facts.bits, photometric)?;
    directory.set(271, TagValue::Text("Etendue".to_owned()));
    directory.set(272, TagValue::Text(ascii(&facts.camera)));
    directory.set(305, TagValue::Text(ascii(&facts.software)));
    directory.set(50_706, TagValue::Byte(vec![1, 4, 0, 0])); // version
    directory.set(50_707, TagValue::Byte(vec![1, 1, 0, 0])); // oldest version that can read it
    directory.set(50_708, TagValue::Text(format!("Etendue {}", ascii(&facts.camera))));
    let [x, y, width, height] = facts.active;
    directory.set(50_829, TagValue::Long(vec![y, x, y + height, x + width]));
    directory.set(50_713, TagValue::Short(vec![1, 1])); // one black level for all
    directory.set(50_714, TagValue::Rational(vec![rational(facts.black_level_dn)]));
    directory.set(50_717, TagValue::Long(vec![facts.white_level_dn.floor() as u32]));
    if let Some((columns, colours)) = &facts.tile {
        colour(&mut directory, *columns, colours, facts);
    }
    Ok(directory.file(&sample_bytes(raw, facts.bits)))
}

fn colour(directory: &mut Directory, columns: u16, colours: &[u8], facts: &DngFacts) {
    const D65: u16 = 21;
    let rows = (colours.len() / usize::from(columns)) as u16;
    directory.set(33_421, TagValue::Short(vec![rows, columns]));
    directory.set(33_422, TagValue::Byte(colours.to_vec()));
    directory.set(50_710, TagValue::Byte(vec![0, 1, 2])); // planes are red, green, blue
    directory.set(50_711, TagValue::Short(vec![1])); // a rectangular layout
    let matrix = facts.xyz_to_camera.as_flattened().iter().map(|v| signed_rational(*v));
    directory.set(50_721, TagValue::SignedRational(matrix.collect()));
    directory.set(50_728, TagValue::Rational(facts.neutral.iter().map(|v| rational(*v)).collect()));
    directory.set(50_778, TagValue::Short(vec![D65]));
}

/// DNG texts are ASCII.
fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii() && !c.is_ascii_control() { c } else { '_' }).collect()
}

/// Rational with four decimals; with two if four overflow, for levels of 20 bits and more.
fn rational(v: f64) -> (u32, u32) {
    let denominator = if v < 400_000.0 { 10_000 } else { 100 };
    ((v * f64::from(denominator)).round() as u32, denominator)
}

fn signed_rational(v: f64) -> (i32, i32) {
    ((v * 10_000.0).round() as i32, 10_000)
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
            let entry_start = (0..entries).map(|i| 10 + 12 * i).find(|i| file[*i..*i + 2] == tag.to_le_bytes());
            word(entry_start.expect("the tag") + 8)
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

    #[test]
    fn levels_of_all_bits_have_their_fraction() {
        for v in [0.0, 64.25, 399_999.5, 400_000.25, 16_777_214.5] {
            let (numerator, denominator) = rational(v);
            assert_eq!(f64::from(numerator) / f64::from(denominator), v);
        }
    }

    #[test]
    fn levels_filters_and_colours_are_in_the_file() {
        let raw = Plane::from_samples(2, 2, vec![64, 100, 100, 4095]).expect("four pixels");
        let facts = DngFacts {
            camera: "front é".into(),
            software: "etendue".into(),
            bits: 12,
            black_level_dn: 64.0,
            white_level_dn: 4000.5,
            tile: Some((2, vec![0, 1, 1, 2])),
            xyz_to_camera: [[0.8, -0.1, 0.0], [-0.5, 1.3, 0.2], [0.0, 0.1, 0.6]],
            neutral: [0.5, 1.0, 0.7],
            active: [0, 0, 2, 2],
        };
        let file = encode_dng(&raw, &facts).expect("a file");
        let has = |bytes: &[u8]| file.windows(bytes.len()).any(|w| w == bytes);
        // The entry of the white level: tag, long, one, 4000; of the tile: tag, bytes, four, RGGB.
        assert!(has(&[0x1d, 0xc6, 4, 0, 1, 0, 0, 0, 0xa0, 0x0f, 0, 0]));
        assert!(has(&[0x8e, 0x82, 1, 0, 4, 0, 0, 0, 0, 1, 1, 2]));
        assert!(has(b"Etendue front _\0"));
        let mono = DngFacts { tile: None, ..facts };
        assert!(encode_dng(&raw, &mono).expect("a file").len() < file.len());
    }
}
