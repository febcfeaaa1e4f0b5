//! Correspondence of points in two images: optical flow and disparity, in the file formats of the benchmarks.
//!
//! | file | numbers | not known | holds | after |
//! | --- | --- | --- | --- | --- |
//! | [`encode_flo`], `.flo` | two 32-bit floats a pixel, px | 10¹⁰ | all | Middlebury: Baker et al. 2011, "A database and evaluation methodology for optical flow", IJCV 92 |
//! | [`encode_kitti_flow`], 16-bit RGB PNG | R = 64 u + 2¹⁵, G = 64 v + 2¹⁵, B = 1 | B = 0 | ±512 px in steps of 1/64 | KITTI 2015: Menze, Geiger 2015, "Object scene flow for autonomous vehicles", CVPR |
//! | [`encode_kitti_disparity`], 16-bit grey PNG | 256 d | 0 | 1/256 to 256 px in steps of 1/256 | KITTI 2012 and 2015 |
//! | [`encode_pfm`], `.pfm` | a 32-bit float a pixel | +∞ | all | Debevec's float map, as Middlebury's stereo sets have it (Scharstein et al. 2014, GCPR) |
//!
//! u is to the right and v down, both in pixels. In memory unknown values are NaN. Values outside the range of a KITTI file are marked as unknown, never
//! clamped. Only a disparity below 1/512 px, which would read as unknown, becomes 1/256 px, as KITTI's own program writes it.
//!
//! KITTI's PNGs of 16 bits: optical flow in three channels, disparity in one (format of the development kit of the 2015 benchmark). A tEXt chunk, which KITTI's
//! own readers ignore, states the content: by their pixels alone they could be images.
//!
//! Middlebury's optical flow, `.flo`: the characters PIEH (the float 202 021.25), width and height as 32-bit integers, then u and v of each pixel as 32-bit
//! floats, rows from the top; all little-endian. A vector with a component beyond ±10⁹ is not known.
//!
//! Portable float maps of one channel: `Pf`, width and height, −1 (little-endian), then 32-bit floats, rows from the bottom.

#[cfg(test)]
pub(crate) mod tests_support;

use std::path::Path;

use etendue_core::Plane;
use etendue_core::quantity::{Disparity, OpticalFlow};

use crate::picture::{PixelStorage, RasterFormats, decode_raster};
use crate::png::{encode_grey16, encode_rgb16, title, with_text};
use crate::{Error, exr::EncodeError, source::read_bytes};

/// Optical flow of a `.flo` file or a KITTI PNG, NaN where unknown; `None` if the file is neither.
///
/// # Errors
/// If it is missing or damaged.
pub fn read_flow(file: &Path) -> Result<Option<Plane<OpticalFlow>>, Error> {
    let bytes = read_bytes(file, "flow or image")?;
    match (is_flo(&bytes), is_kitti_flow(&bytes)) {
        (true, _) => decode_flo(file, &bytes).map(Some),
        (_, true) => decode_kitti_flow(file, &bytes).map(Some),
        _ => Ok(None),
    }
}

const FLOW_TITLE: &str = "optical flow, KITTI 2015";
const DISPARITY_TITLE: &str = "disparity, KITTI 2015";
/// Units per pixel of flow; the next constant is the number of zero flow.
const FLOW_UNITS: f64 = 64.0;
const FLOW_ZERO: f64 = 32_768.0;
/// Units per pixel of disparity.
const DISPARITY_UNITS: f64 = 256.0;

/// Optical flow as KITTI's 16-bit PNG.
///
/// # Errors
/// If the plane has no pixels, or more than PNG supports.
pub fn encode_kitti_flow(flow: &Plane<OpticalFlow>) -> Result<Vec<u8>, EncodeError> {
    let values: Vec<u16> = flow.samples().iter().flat_map(|vector| stored_flow(*vector)).collect();
    Ok(with_text(encode_rgb16(flow.width(), flow.height(), &values)?, "Title", FLOW_TITLE))
}

/// Disparity as KITTI's 16-bit PNG.
///
/// # Errors
/// As [`encode_kitti_flow`].
pub fn encode_kitti_disparity(disparity: &Plane<Disparity>) -> Result<Vec<u8>, EncodeError> {
    let values: Vec<u16> = disparity.samples().iter().map(|px| stored_disparity(*px)).collect();
    Ok(with_text(encode_grey16(disparity.width(), disparity.height(), &values)?, "Title", DISPARITY_TITLE))
}

/// Stored numbers of a vector; zeros if it is unknown or too long.
fn stored_flow(vector: [f32; 2]) -> [u16; 3] {
    let [u, v] = vector.map(|px| in_16_bits(f64::from(px) * FLOW_UNITS + FLOW_ZERO));
    u.zip(v).map_or([0; 3], |(u, v)| [u, v, 1])
}

/// Stored number of a disparity; 0 if it is unknown, negative (except for rounding) or too large.
fn stored_disparity(px: f32) -> u16 {
    in_16_bits(f64::from(px) * DISPARITY_UNITS).map_or(0, |units| units.max(1))
}

fn in_16_bits(number: f64) -> Option<u16> {
    let rounded = number.round();
    (0.0..=f64::from(u16::MAX)).contains(&rounded).then_some(rounded as u16)
}

/// Returns true if a PNG states that it is optical flow.
pub(crate) fn is_kitti_flow(bytes: &[u8]) -> bool {
    title(bytes) == Some(FLOW_TITLE)
}

/// Flow in the bytes of a KITTI PNG, NaN where unknown.
pub(crate) fn decode_kitti_flow(file: &Path, bytes: &[u8]) -> Result<Plane<OpticalFlow>, Error> {
    let (_, picture) = decode_raster(file, bytes, RasterFormats::measured("KITTI's PNG"), PixelStorage::Floats)?;
    let image::DynamicImage::ImageRgb16(picture) = picture else {
        return Err(Error::new(file, "not KITTI's optical flow: expected a PNG with three 16-bit channels"));
    };
    let px = |number: u16| ((f64::from(number) - FLOW_ZERO) / FLOW_UNITS) as f32;
    let vector = |[u, v, known]: [u16; 3]| if known == 0 { [f32::NAN; 2] } else { [px(u), px(v)] };
    let vectors = picture.pixels().map(|pixel| vector(pixel.0)).collect();
    let plane = Plane::from_samples(picture.width() as usize, picture.height() as usize, vectors);
    plane.ok_or_else(|| Error::new(file, "has fewer pixels than its header states"))
}

const MAGIC: &[u8; 4] = b"PIEH";
const NOT_KNOWN: f32 = 1e10;
const MAX_KNOWN: f32 = 1e9;

/// Bytes of a `.flo` file.
///
/// # Errors
/// If the plane has no pixels, or more than the format supports.
pub fn encode_flo(flow: &Plane<OpticalFlow>) -> Result<Vec<u8>, EncodeError> {
    let (width, height) = (flow.width(), flow.height());
    if width == 0 || height == 0 {
        return Err(EncodeError::Empty { width, height });
    }
    let (Ok(columns), Ok(rows)) = (i32::try_from(width), i32::try_from(height)) else {
        return Err(EncodeError::Encoder(format!("{width} × {height} pixels are too many for .flo")));
    };
    let stored = |vector: &[f32; 2]| if is_known(*vector) { *vector } else { [NOT_KNOWN; 2] };
    let head = [*MAGIC, columns.to_le_bytes(), rows.to_le_bytes()].into_iter().flatten();
    let body = flow.samples().iter().flat_map(stored).flat_map(f32::to_le_bytes);
    Ok(head.chain(body).collect())
}

/// Returns true if the bytes begin like a `.flo` file.
pub(crate) fn is_flo(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Flow in the bytes of a `.flo` file, NaN where unknown.
///
/// # Errors
/// If the bytes are no such file, or are truncated.
pub fn decode_flo(file: &Path, bytes: &[u8]) -> Result<Plane<OpticalFlow>, Error> {
    let wrong =
        || Error::new(file, "not a .flo file: expected PIEH, width and height above 0, and two floats per pixel");
    let (head, body) = bytes.split_at_checked(12).filter(|(head, _)| is_flo(head)).ok_or_else(wrong)?;
    let size = |at: usize| i32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    let side = |at: usize| usize::try_from(size(at)).ok().filter(|n| (1..=1 << 20).contains(n));
    let (width, height) = side(4).zip(side(8)).ok_or_else(wrong)?;
    if body.len() != 8 * width * height {
        let expected = 8 * width * height;
        return Err(Error::new(
            file,
            format!("has {} bytes of vectors; expected {expected} for {width} × {height} pixels", body.len()),
        ));
    }
    let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let vector = |b: &[u8]| Some([float(b), float(&b[4..])]).filter(|v| is_known(*v)).unwrap_or([f32::NAN; 2]);
    Plane::from_samples(width, height, body.chunks_exact(8).map(vector).collect()).ok_or_else(wrong)
}

fn is_known(vector: [f32; 2]) -> bool {
    vector.iter().all(|v| v.abs() <= MAX_KNOWN)
}

/// Bytes of a PFM of `width` numbers per row, given row by row from the top; NaN (unknown) is stored as +∞.
///
/// # Errors
/// If there are no pixels, or too few for the rows.
pub fn encode_pfm(width: usize, samples: &[f32]) -> Result<Vec<u8>, EncodeError> {
    let height = samples.len().checked_div(width).unwrap_or(0);
    if height == 0 {
        return Err(EncodeError::Empty { width, height });
    }
    if width * height != samples.len() {
        return Err(EncodeError::Size {
            name: "PFM".to_owned(),
            actual: samples.len(),
            expected: width * (height + 1),
        });
    }
    let mut bytes = format!("Pf\n{width} {height}\n-1.0\n").into_bytes();
    let stored = |v: &f32| if v.is_nan() { f32::INFINITY } else { *v };
    bytes.extend(samples.chunks_exact(width).rev().flatten().map(stored).flat_map(f32::to_le_bytes));
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{tests_support::flow, *};
    use crate::photograph::decode_photograph;

    #[test]
    fn flow_has_the_numbers_of_the_development_kit() {
        assert_eq!(stored_flow([0.0, 0.0]), [32_768, 32_768, 1]);
        assert_eq!(stored_flow([1.0, -2.5]), [32_832, 32_608, 1]);
        assert_eq!(stored_flow([-512.0, 511.984]), [0, 65_535, 1]);
        for lost in [[f32::NAN, 0.0], [0.0, f32::NAN], [-512.01, 0.0], [0.0, 512.0], [f32::INFINITY, 1.0]] {
            assert_eq!(stored_flow(lost), [0; 3], "{lost:?}");
        }
    }

    #[test]
    fn disparity_has_the_numbers_of_the_development_kit() {
        assert_eq!([1.0, 0.0, 1e-4, -1e-12, 255.99, 37.5].map(stored_disparity), [256, 1, 1, 1, 65_533, 9_600]);
        assert_eq!([f32::NAN, -0.1, 256.0, f32::INFINITY].map(stored_disparity), [0; 4]);
    }

    #[test]
    fn flow_comes_back_to_half_a_step() {
        let vectors = [[0.0, 0.0], [12.34, -56.78], [f32::NAN, 1.0], [-511.9, 511.9], [600.0, 0.0], [0.007, -0.009]];
        let bytes = encode_kitti_flow(&flow(2, &vectors)).expect("six pixels");
        assert!(is_kitti_flow(&bytes));
        let read = decode_kitti_flow(Path::new("flow.png"), &bytes).expect("our own");
        assert_eq!((read.width(), read.height()), (2, 3));
        for (read, written) in read.samples().iter().zip(vectors) {
            let known = written.iter().all(|px| px.abs() < 512.0);
            assert_eq!(read.iter().all(|px| px.is_finite()), known, "{written:?}");
            // Numbers are rounded to the nearest step of 1/64 px; 2^-15 of 512 px is the rounding of f32.
            let close = (0..2).all(|i| (read[i] - written[i]).abs() <= 0.5 / 64.0 + 512.0 * f32::EPSILON);
            assert!(close || !known, "{read:?} {written:?}");
        }
    }

    #[test]
    fn vectors_come_back_and_what_is_not_known_stays_so() {
        let vectors = [[1.5, -2.25], [0.0, 0.0], [f32::NAN, 3.0], [-1e6, 1e-20], [f32::INFINITY, 0.0], [7.0, f32::NAN]];
        let bytes = encode_flo(&flow(3, &vectors)).expect("six pixels");
        assert_eq!(&bytes[..12], b"PIEH\x03\0\0\0\x02\0\0\0");
        assert_eq!(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]), 202_021.25);
        assert_eq!(bytes[12..20], [1.5_f32.to_le_bytes(), (-2.25_f32).to_le_bytes()].concat());
        let read = decode_flo(Path::new("a.flo"), &bytes).expect("our own");
        assert_eq!((read.width(), read.height()), (3, 2));
        for (read, written) in read.samples().iter().zip(vectors) {
            let expected = if written.iter().all(|v| v.is_finite()) { Some(written) } else { None };
            assert_eq!(Some(*read).filter(|v| !v[0].is_nan() && !v[1].is_nan()), expected);
        }
    }

    #[test]
    fn damaged_files_and_empty_planes_are_refused() {
        let bytes = encode_flo(&flow(2, &[[1.0; 2]; 4])).expect("four pixels");
        let message = decode_flo(Path::new("a.flo"), &bytes[..bytes.len() - 1]).expect_err("cut").to_string();
        assert!(message.contains("has 31 bytes of vectors; expected 32 for 2 × 2 pixels"), "{message}");
        assert!(decode_flo(Path::new("a.flo"), b"PIEH").is_err());
        let negative = [&bytes[..4], &(-2_i32).to_le_bytes(), &bytes[8..]].concat();
        assert!(decode_flo(Path::new("a.flo"), &negative).is_err());
        assert!(matches!(encode_flo(&Plane::new(0, 2)), Err(EncodeError::Empty { .. })));
    }

    #[test]
    fn rows_are_stored_from_the_bottom_and_come_back() {
        let samples = [1.0, 2.0, f32::NAN, 4.0, -5.5, 6.0];
        let bytes = encode_pfm(3, &samples).expect("six pixels");
        assert!(bytes.starts_with(b"Pf\n3 2\n-1.0\n"));
        assert_eq!(bytes[12..16], 4.0_f32.to_le_bytes());
        let read = decode_photograph(Path::new("d.pfm"), &bytes).expect("our own");
        assert_eq!(read.channels[0].samples, [1.0, 2.0, f32::INFINITY, 4.0, -5.5, 6.0]);
        assert!(matches!(encode_pfm(3, &samples[..5]), Err(EncodeError::Size { .. })));
        assert!(matches!(encode_pfm(0, &[]), Err(EncodeError::Empty { .. })));
    }
}
