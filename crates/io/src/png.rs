//! PNG files: raw digital numbers, depth, display images.
//!
//! | writer | depth | meaning of a value |
//! | --- | --- | --- |
//! | [`encode_raw16`] | 16 bit grey | digital number proportional to light, not stretched, with the gAMA chunk of 1; the side-car states its bits |
//! | [`encode_companded16`] | 16 bit grey | companded digital number; the side-car states its bits and lines |
//! | [`encode_grey8`], [`encode_grey16`] | 8 and 16 bit grey | labels, masks and identities, as the caller states them |
//! | [`encode_depth16`] | 16 bit grey | metres × the scale of the convention; 0 is invalid |
//! | [`encode_display`] | 8 bit RGB | encoded for display, with the chunk that states it: sRGB, or gAMA and cHRM |
//! | [`encode_display16`] | 16 bit RGB | the same of 10 to 16 bits, scaled to 16 by repeating the upper bits, with the sBIT chunk |
//!
//! Also reads the chunks that state the encoding of a PNG's numbers (PNG specification, third edition, 4.3 and 11.3.2).

use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Display, Length};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::{encoding::SourcedEncoding, exr::EncodeError, photograph::Encoding};

/// The gAMA chunk of numbers proportional to light.
const GAMMA_1: u32 = 100_000;

/// The stored value of `depth_m` at `per_metre` units per metre (KITTI 256, ROS 1 000, TUM 5 000), rounded to nearest. 0 (invalid) if it is not finite, not
/// positive, or beyond the largest value: a far wall must not appear near.
#[must_use]
pub fn stored_depth(depth_m: f32, per_metre: f64) -> u16 {
    let units = (f64::from(depth_m) * per_metre).round();
    if units >= 1.0 && units <= f64::from(u16::MAX) { units as u16 } else { 0 }
}

/// Encodes raw digital numbers of at most 16 bits, proportional to light; larger ones are refused.
pub fn encode_raw16(raw: &Plane<DigitalNumber>) -> Result<Vec<u8>, EncodeError> {
    Ok(with_chunk(encode_companded16(raw)?, *b"gAMA", &GAMMA_1.to_be_bytes()))
}

/// Encodes raw digital numbers of at most 16 bits that are not proportional to light; larger ones are refused.
pub fn encode_companded16(raw: &Plane<DigitalNumber>) -> Result<Vec<u8>, EncodeError> {
    let narrowed = |dn: &u32| u16::try_from(*dn).map_err(|_| EncodeError::Wide { value: *dn });
    let values = raw.samples().iter().map(narrowed).collect::<Result<Vec<u16>, _>>()?;
    encode_grey16(raw.width(), raw.height(), &values)
}

/// Encodes depth (m, planar or along the ray as the caller states it) at `per_metre` units per metre.
pub fn encode_depth16(depth: &Plane<Length>, per_metre: f64) -> Result<Vec<u8>, EncodeError> {
    let stored: Vec<u16> = depth.samples().iter().map(|&m| stored_depth(m, per_metre)).collect();
    encode_grey16(depth.width(), depth.height(), &stored)
}

/// Encodes a display image, rounded to 8 bits. Values outside 0–1 are clamped, as in a display; NaN is black. The file states the encoding `encoded` as far as
/// a chunk can; for curves that no chunk can state it states sRGB, for the display.
pub fn encode_display(image: &Plane<Display>, encoded: &Encoding) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Vec::with_capacity(3 * image.samples().len());
    bytes.extend(image.samples().iter().flatten().map(|&v| (v * 255.0).round() as u8));
    let file = encode(image.width(), image.height(), &bytes, ExtendedColorType::Rgb8)?;
    Ok(with_statement(file, encoded))
}

/// Encodes a display image of 10 to 16 bits in a 16-bit file. Values outside 0–1 are clamped; NaN is black. The number q of b bits is stored as q 2^(16−b) +
/// ⌊q/2^(2b−16)⌋, so that black is 0 and white 65 535, and a reader that keeps the upper b bits (the sBIT chunk states b; PNG specification, 11.3.2.4) recovers
/// q. `encoded` as for [`encode_display`].
pub fn encode_display16(image: &Plane<Display>, bits: u32, encoded: &Encoding) -> Result<Vec<u8>, EncodeError> {
    if !(9..=16).contains(&bits) {
        return Err(EncodeError::Encoder(format!("an image of {bits} bits does not fit into a 16-bit PNG")));
    }
    let largest = ((1_u32 << bits) - 1) as f32;
    let stored = |v: &f32| {
        let q = (v * largest).round() as u32;
        let q = q.min((1 << bits) - 1);
        ((q << (16 - bits)) | (q >> (2 * bits - 16))) as u16
    };
    let bytes: Vec<u8> = image.samples().iter().flatten().flat_map(|v| stored(v).to_ne_bytes()).collect();
    let file = encode(image.width(), image.height(), &bytes, ExtendedColorType::Rgb16)?;
    Ok(with_chunk(with_statement(file, encoded), *b"sBIT", &[bits as u8; 3]))
}

/// sRGB-encoded bytes, three per pixel.
pub(crate) fn encode_rgb8(width: usize, height: usize, rgb: &[u8]) -> Result<Vec<u8>, EncodeError> {
    let file = encode(width, height, rgb, ExtendedColorType::Rgb8)?;
    Ok(with_statement(file, &Encoding::Srgb))
}

/// Three 16-bit numbers per pixel, without a chunk that declares them colours.
pub(crate) fn encode_rgb16(width: usize, height: usize, values: &[u16]) -> Result<Vec<u8>, EncodeError> {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_ne_bytes()).collect();
    encode(width, height, &bytes, ExtendedColorType::Rgb16)
}

/// Inserts a text under a keyword after the header (PNG specification, 11.3.3.2: Latin-1).
pub(crate) fn with_text(file: Vec<u8>, keyword: &str, text: &str) -> Vec<u8> {
    with_chunk(file, *b"tEXt", &[keyword.as_bytes(), b"\0", text.as_bytes()].concat())
}

/// Encodes 8-bit numbers, one per pixel: labels and masks.
pub fn encode_grey8(width: usize, height: usize, values: &[u8]) -> Result<Vec<u8>, EncodeError> {
    encode(width, height, values, ExtendedColorType::L8)
}

/// Encodes 16-bit numbers, one per pixel: identities, lengths.
pub fn encode_grey16(width: usize, height: usize, values: &[u16]) -> Result<Vec<u8>, EncodeError> {
    // The encoder expects 16-bit values in native byte order.
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_ne_bytes()).collect();
    encode(width, height, &bytes, ExtendedColorType::L16)
}

fn encode(width: usize, height: usize, bytes: &[u8], kind: ExtendedColorType) -> Result<Vec<u8>, EncodeError> {
    let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
        return Err(EncodeError::Encoder(format!("{width} × {height} pixels are too many for PNG")));
    };
    if columns == 0 || rows == 0 {
        return Err(EncodeError::Empty { width, height });
    }
    let mut file = Vec::new();
    PngEncoder::new_with_quality(&mut file, CompressionType::Default, FilterType::Adaptive)
        .write_image(bytes, columns, rows, kind)
        .map_err(|cause| EncodeError::Encoder(cause.to_string()))?;
    Ok(file)
}

/// Inserts the chunks that state an encoding after the header.
fn with_statement(file: Vec<u8>, encoded: &Encoding) -> Vec<u8> {
    let chunks = encoding_chunks(encoded);
    chunks.into_iter().rev().fold(file, |file, (name, data)| with_chunk(file, name, &data))
}

/// Inserts a chunk after the header.
fn with_chunk(mut file: Vec<u8>, name: [u8; 4], data: &[u8]) -> Vec<u8> {
    const AFTER_HEADER: usize = 8 + 4 + 4 + 13 + 4; // signature; length, name, data and checksum of IHDR
    let named = [&name[..], data].concat();
    let chunk = [&(data.len() as u32).to_be_bytes()[..], &named, &checksum(&named).to_be_bytes()].concat();
    file.splice(AFTER_HEADER..AFTER_HEADER, chunk);
    file
}

/// CRC-32 of ISO 3309, bit by bit: chunks are short.
fn checksum(bytes: &[u8]) -> u32 {
    let step = |crc: u32| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc)))
}

/// Scale of the gAMA chunk, which stores the exponent p of light^p in units of 1/100 000.
const UNIT: f64 = 100_000.0;

/// Signature of a PNG.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Encoding that a PNG states, and the names of unsupported statements.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct StatedEncoding {
    pub stated: Option<SourcedEncoding>,
    pub not_understood: Option<String>,
}

/// Reader of a chunk's data; the error names unsupported content.
type ChunkReader = fn(&[u8]) -> Result<SourcedEncoding, String>;

/// The supported chunk of highest precedence; nothing for files that are no PNG.
pub(crate) fn stated_encoding(file: &[u8]) -> StatedEncoding {
    let chunks = chunks(file);
    let data = |name: &[u8; 4]| chunks.iter().find(|(chunk_name, _)| chunk_name == name).map(|(_, data)| *data);
    let readers: [(&[u8; 4], ChunkReader); 4] =
        [(b"cICP", from_cicp), (b"iCCP", from_profile), (b"sRGB", |_| Ok(from_srgb())), (b"gAMA", from_gamma)];
    let mut result = StatedEncoding::default();
    for (name, reader) in readers {
        match data(name).map(reader) {
            None => {}
            Some(Ok(stated)) => return StatedEncoding { stated: Some(stated), ..result },
            Some(Err(name)) => result.not_understood = result.not_understood.or(Some(name)),
        }
    }
    result
}

/// Text under the keyword Title, if a PNG has one before its image data.
pub(crate) fn title(file: &[u8]) -> Option<&str> {
    let texts = chunks(file).into_iter().filter(|(name, _)| name == b"tEXt");
    let titles = texts.filter_map(|(_, data)| data.strip_prefix(b"Title\0"));
    titles.filter_map(|text| std::str::from_utf8(text).ok()).next()
}

/// EXIF data, if a PNG has them before its image data.
pub(crate) fn exif(file: &[u8]) -> Option<&[u8]> {
    chunks(file).into_iter().find(|(name, _)| name == b"eXIf").map(|(_, data)| data)
}

/// Names and data of the chunks before the image data.
fn chunks(file: &[u8]) -> Vec<([u8; 4], &[u8])> {
    let mut parsed = Vec::new();
    let Some(mut rest) = file.strip_prefix(SIGNATURE) else { return parsed };
    while let Some((head, after)) = rest.split_first_chunk::<8>() {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let name = [head[4], head[5], head[6], head[7]];
        let Some(data) = after.get(..length).filter(|_| &name != b"IDAT") else { break };
        parsed.push((name, data));
        rest = after.get(length + 4..).unwrap_or_default();
    }
    parsed
}

/// Coding-independent code points (ITU-T H.273, table 3): transfer characteristics used for images.
fn from_cicp(data: &[u8]) -> Result<SourcedEncoding, String> {
    if data.get(3) == Some(&0) {
        return Err("its narrow-range cICP chunk".to_owned());
    }
    let (encoding, name) = match data.get(1) {
        Some(1 | 6 | 14 | 15) => (Encoding::bt709(), "BT.709"),
        Some(4) => (Encoding::Gamma(2.2), "gamma 2.2"),
        Some(5) => (Encoding::Gamma(2.8), "gamma 2.8"),
        Some(8) => (Encoding::Linear, "linear"),
        Some(13) => (Encoding::Srgb, "sRGB"),
        other => return Err(format!("its cICP chunk of transfer characteristics {}", other.copied().unwrap_or(0))),
    };
    Ok(SourcedEncoding::new(encoding, format!("its cICP chunk states {name}")))
}

/// An embedded profile, by its name.
fn from_profile(data: &[u8]) -> Result<SourcedEncoding, String> {
    let name: String = data.iter().take_while(|b| **b != 0).map(|b| char::from(*b)).collect();
    let message = format!("its colour profile \"{name}\"");
    let plain = name.to_ascii_lowercase();
    let other = ["lin", "g10", "g18", "g22"].iter().any(|word| plain.contains(word));
    if plain.contains("srgb") && !other { Ok(SourcedEncoding::new(Encoding::Srgb, message)) } else { Err(message) }
}

fn from_srgb() -> SourcedEncoding {
    SourcedEncoding::new(Encoding::Srgb, "its sRGB chunk")
}

fn from_gamma(data: &[u8]) -> Result<SourcedEncoding, String> {
    let stored = data.first_chunk::<4>().map_or(0, |bytes| u32::from_be_bytes(*bytes));
    let encoding = match stored {
        0 => return Err("its gAMA chunk of 0".to_owned()),
        100_000 => Encoding::Linear,
        other => Encoding::Gamma(UNIT / f64::from(other)),
    };
    Ok(SourcedEncoding::new(encoding, format!("its gAMA chunk states {}", f64::from(stored) / UNIT)))
}

/// Chunks that state an encoding: sRGB, or gAMA with the primaries of sRGB (cHRM). No chunk can state a curve of points or an S-curve: such an image is meant
/// for an sRGB display and states that; its side-car states the curve.
fn encoding_chunks(encoding: &Encoding) -> Vec<([u8; 4], Vec<u8>)> {
    let power = match encoding {
        Encoding::Linear => 1.0,
        Encoding::Gamma(gamma) => 1.0 / gamma,
        _ => return vec![(*b"sRGB", vec![0])], // rendering intent: perceptual
    };
    let stored = (UNIT * power).round().clamp(1.0, f64::from(i32::MAX)) as u32;
    // White, red, green and blue of IEC 61966-2-1: x and y of each.
    let primaries: [u32; 8] = [31_270, 32_900, 64_000, 33_000, 30_000, 60_000, 15_000, 6_000];
    vec![
        (*b"gAMA", stored.to_be_bytes().to_vec()),
        (*b"cHRM", primaries.iter().flat_map(|v| v.to_be_bytes()).collect()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_conventions_have_their_scale_and_0_is_invalid() {
        assert_eq!(stored_depth(10.0, 256.0), 2560);
        assert_eq!(stored_depth(1.2345, 1000.0), 1235); // 1234.5000… in f32 is above the half
        assert_eq!(stored_depth(2.0, 5000.0), 10_000);
        for invalid in [f32::INFINITY, f32::NAN, -1.0, 0.0, 300.0, 1e-5] {
            assert_eq!(stored_depth(invalid, 256.0), 0, "{invalid}");
        }
        assert_eq!(stored_depth(255.996, 256.0), 65_535);
    }

    #[test]
    fn raw_numbers_come_back_as_they_are() {
        let numbers: Vec<u32> = vec![0, 1, 255, 256, 4095, 65_535];
        let plane = Plane::from_samples(3, 2, numbers.clone()).expect("six pixels");
        let file = encode_raw16(&plane).expect("a picture");
        let read = image::load_from_memory(&file).expect("PNG").into_luma16();
        assert_eq!((read.width(), read.height()), (3, 2));
        assert!(read.into_raw().into_iter().map(u32::from).eq(numbers));
        let wide = Plane::from_samples(2, 1, vec![7, 65_536]).expect("two pixels");
        assert!(matches!(encode_raw16(&wide), Err(EncodeError::Wide { value: 65_536 })));
    }

    #[test]
    fn a_display_picture_says_that_it_is_srgb() {
        let plane = Plane::from_samples(2, 1, vec![[0.0, 0.5, 1.0], [-1.0, 2.0, f32::NAN]]).expect("two pixels");
        let file = encode_display(&plane, &Encoding::Srgb).expect("a picture");
        assert_eq!(&file[37..41], b"sRGB");
        let read = image::load_from_memory(&file).expect("PNG with correct checksums").into_rgb8();
        assert_eq!(read.into_raw(), [0, 128, 255, 0, 255, 0]);
    }

    #[test]
    fn a_picture_without_pixels_is_refused() {
        assert!(matches!(encode_raw16(&Plane::new(0, 4)), Err(EncodeError::Empty { .. })));
    }

    #[test]
    fn pictures_of_more_than_8_bits_keep_them() {
        let values = [0.0, 0.25, 0.5, 1.0, -1.0, 2.0, f32::NAN, 0.1, 0.9];
        let rgb = values.chunks(3).map(|v| [v[0], v[1], v[2]]).collect();
        let plane = Plane::from_samples(3, 1, rgb).expect("three pixels");
        for bits in [10, 12, 16] {
            let file = encode_display16(&plane, bits, &Encoding::Srgb).expect("a picture");
            assert_eq!((&file[37..41], &file[41..44]), (&b"sBIT"[..], &[bits as u8; 3][..]));
            let read = image::load_from_memory(&file).expect("PNG with correct checksums").into_rgb16();
            let white = ((1_u32 << bits) - 1) as f32;
            let actual: Vec<u16> = read.into_raw().iter().map(|v| v >> (16 - bits)).collect();
            let expected: Vec<u16> = values.iter().map(|v| (v.clamp(0.0, 1.0) * white).round() as u16).collect();
            assert_eq!(actual, expected, "{bits}");
        }
        assert!([8, 17].iter().all(|bits| encode_display16(&plane, *bits, &Encoding::Srgb).is_err()));
    }

    #[test]
    fn checksums_are_those_of_png() {
        // CRC of an empty IEND chunk, and of the sRGB chunk of rendering intent 0, as in every PNG.
        assert_eq!((checksum(b"IEND"), checksum(b"sRGB\0")), (0xae42_6082, 0xaece_1ce9));
    }

    /// File of chunks; its checksums are not read here.
    fn png(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let one =
            |(name, data): &(&[u8; 4], &[u8])| [&(data.len() as u32).to_be_bytes()[..], *name, data, &[0; 4]].concat();
        let chunks: Vec<u8> = chunks.iter().flat_map(one).collect();
        [SIGNATURE, &chunks].concat()
    }

    fn encoding(chunks: &[(&[u8; 4], &[u8])]) -> Option<Encoding> {
        stated_encoding(&png(chunks)).stated.map(|stated| stated.encoding)
    }

    #[test]
    fn each_chunk_is_read_and_the_higher_one_wins() {
        let gamma = 45_455_u32.to_be_bytes();
        assert_eq!(encoding(&[(b"gAMA", &gamma)]), Some(Encoding::Gamma(100_000.0 / 45_455.0)));
        assert_eq!(encoding(&[(b"gAMA", &100_000_u32.to_be_bytes())]), Some(Encoding::Linear));
        assert_eq!(encoding(&[(b"gAMA", &gamma), (b"sRGB", &[0])]), Some(Encoding::Srgb));
        assert_eq!(encoding(&[(b"sRGB", &[0]), (b"cICP", &[1, 8, 0, 1])]), Some(Encoding::Linear));
        assert_eq!(encoding(&[(b"cICP", &[1, 13, 0, 1])]), Some(Encoding::Srgb));
        assert_eq!(encoding(&[(b"cICP", &[1, 1, 0, 1])]), Some(Encoding::bt709()));
        assert_eq!(encoding(&[(b"iCCP", b"sRGB IEC61966-2.1\0\0"), (b"gAMA", &gamma)]), Some(Encoding::Srgb));
        assert_eq!(encoding(&[]), None);
        // Chunks after the image data are ignored.
        assert_eq!(encoding(&[(b"IDAT", &[1]), (b"sRGB", &[0])]), None);
    }

    #[test]
    fn what_is_not_understood_is_named_and_the_next_is_taken() {
        let profile: (&[u8; 4], &[u8]) = (b"iCCP", b"Adobe RGB (1998)\0\0");
        let actual = stated_encoding(&png(&[profile]));
        assert_eq!(actual.not_understood.as_deref(), Some("its colour profile \"Adobe RGB (1998)\""));
        assert_eq!(actual.stated, None);
        assert_eq!(
            encoding(&[profile, (b"gAMA", &45_455_u32.to_be_bytes())]),
            Some(Encoding::Gamma(100_000.0 / 45_455.0))
        );
        assert!(
            stated_encoding(&png(&[(b"cICP", &[9, 16, 0, 1])]))
                .not_understood
                .is_some_and(|name| name.ends_with(" 16"))
        );
        assert!(stated_encoding(&png(&[(b"gAMA", &[0; 4])])).not_understood.is_some());
    }

    #[test]
    fn strange_files_say_nothing() {
        assert_eq!(stated_encoding(b"II\x2a\0"), StatedEncoding::default());
        let complete = png(&[(b"sRGB", &[0])]);
        assert!((0..complete.len()).all(|length| stated_encoding(&complete[..length]).not_understood.is_none()));
    }

    #[test]
    fn what_is_written_is_read() {
        for (encoding, read) in [
            (Encoding::Linear, Encoding::Linear),
            (Encoding::Srgb, Encoding::Srgb),
            (Encoding::Gamma(2.5), Encoding::Gamma(2.5)),
            (Encoding::Contrast { contrast: 2.0, midpoint: 0.5 }, Encoding::Srgb),
        ] {
            let chunks = encoding_chunks(&encoding);
            let chunks: Vec<(&[u8; 4], &[u8])> = chunks.iter().map(|(name, data)| (name, &data[..])).collect();
            assert_eq!(super::stated_encoding(&png(&chunks)).stated.map(|s| s.encoding), Some(read));
        }
    }
}
