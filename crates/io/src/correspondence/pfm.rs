//! Portable float maps of one channel: `Pf`, width and height, −1 (little-endian), then 32-bit floats, rows from the bottom.

use crate::exr::EncodeError;

/// The bytes of a PFM of `width` numbers a row, given row by row from the top; NaN, not known, is stored as +∞.
///
/// # Errors
/// Where there are no pixels, or not as many as the rows need.
pub fn encode_pfm(width: usize, samples: &[f32]) -> Result<Vec<u8>, EncodeError> {
    let height = samples.len().checked_div(width).unwrap_or(0);
    if height == 0 {
        return Err(EncodeError::Empty { width, height });
    }
    if width * height != samples.len() {
        return Err(EncodeError::Size { name: "PFM".to_owned(), found: samples.len(), expected: width * (height + 1) });
    }
    let mut bytes = format!("Pf\n{width} {height}\n-1.0\n").into_bytes();
    let stored = |v: &f32| if v.is_nan() { f32::INFINITY } else { *v };
    bytes.extend(samples.chunks_exact(width).rev().flatten().map(stored).flat_map(f32::to_le_bytes));
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photograph::decode_photograph;
    use std::path::Path;

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
