//! Middlebury's optical flow, `.flo`: the characters PIEH (the float 202 021.25), width and height as 32-bit integers, then u and v of each
//! pixel as 32-bit floats, rows from the top; all little-endian. A vector with a component beyond ±10⁹ is not known.

use crate::Error;
use crate::exr::EncodeError;
use etendue_core::Plane;
use etendue_core::quantity::OpticalFlow;
use std::path::Path;

const MAGIC: &[u8; 4] = b"PIEH";
const NOT_KNOWN: f32 = 1e10;
const GREATEST_KNOWN: f32 = 1e9;

/// The bytes of a `.flo` file.
///
/// # Errors
/// Of a plane without pixels, or of more than the format counts.
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

/// Whether the bytes begin as those of a `.flo` file.
pub(crate) fn is_flo(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// The flow in the bytes of a `.flo` file, NaN where it is not known.
///
/// # Errors
/// Where the bytes are no such file, or are cut off.
pub fn decode_flo(file: &Path, bytes: &[u8]) -> Result<Plane<OpticalFlow>, Error> {
    let wrong = || Error::new(file, "not a .flo file: expected PIEH, width and height above 0, and two floats a pixel");
    let (head, body) = bytes.split_at_checked(12).filter(|(head, _)| is_flo(head)).ok_or_else(wrong)?;
    let size = |at: usize| i32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    let side = |at: usize| usize::try_from(size(at)).ok().filter(|n| (1..=1 << 20).contains(n));
    let (width, height) = side(4).zip(side(8)).ok_or_else(wrong)?;
    if body.len() != 8 * width * height {
        let expected = 8 * width * height;
        return Err(Error::new(
            file,
            format!("{} bytes of vectors, where {width} × {height} are {expected}", body.len()),
        ));
    }
    let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let vector = |b: &[u8]| Some([float(b), float(&b[4..])]).filter(|v| is_known(*v)).unwrap_or([f32::NAN; 2]);
    Plane::from_samples(width, height, body.chunks_exact(8).map(vector).collect()).ok_or_else(wrong)
}

fn is_known(vector: [f32; 2]) -> bool {
    vector.iter().all(|v| v.abs() <= GREATEST_KNOWN)
}

#[cfg(test)]
mod tests {
    use super::super::tests_support::flow;
    use super::*;

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
        let told = decode_flo(Path::new("a.flo"), &bytes[..bytes.len() - 1]).expect_err("cut").to_string();
        assert!(told.contains("31 bytes of vectors, where 2 × 2 are 32"), "{told}");
        assert!(decode_flo(Path::new("a.flo"), b"PIEH").is_err());
        let negative = [&bytes[..4], &(-2_i32).to_le_bytes(), &bytes[8..]].concat();
        assert!(decode_flo(Path::new("a.flo"), &negative).is_err());
        assert!(matches!(encode_flo(&Plane::new(0, 2)), Err(EncodeError::Empty { .. })));
    }
}
