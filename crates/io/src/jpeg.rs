//! JPEG files: display images, lossy.

use etendue_core::{Plane, quantity::Display};
use image::{ExtendedColorType, ImageEncoder, codecs::jpeg::JpegEncoder};

use crate::exr::EncodeError;

/// Encodes a display image, rounded to 8 bits, at a quality of 1 to 100. Values outside 0–1 are clamped; NaN is black.
pub fn encode_jpeg(image: &Plane<Display>, quality: u8) -> Result<Vec<u8>, EncodeError> {
    let (width, height) = (image.width(), image.height());
    if width == 0 || height == 0 {
        return Err(EncodeError::Empty { width, height });
    }
    let (Ok(columns), Ok(rows)) = (u16::try_from(width), u16::try_from(height)) else {
        return Err(EncodeError::Encoder(format!("{width} × {height} pixels are too many for JPEG")));
    };
    let bytes: Vec<u8> = image.samples().iter().flatten().map(|&v| (v * 255.0).round() as u8).collect();
    let mut file = Vec::new();
    JpegEncoder::new_with_quality(&mut file, quality)
        .write_image(&bytes, columns.into(), rows.into(), ExtendedColorType::Rgb8)
        .map_err(|cause| EncodeError::Encoder(cause.to_string()))?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_comes_back_nearly_and_finer_with_quality() {
        let colour = |i: usize| [0.2 + 0.6 * (i % 32) as f32 / 32.0, 0.5, 0.8 - 0.5 * (i / 32) as f32 / 32.0];
        let picture = Plane::from_samples(32, 32, (0..1024).map(colour).collect()).expect("filled");
        let worst = |quality| {
            let file = encode_jpeg(&picture, quality).expect("a picture");
            let read = image::load_from_memory(&file).expect("JPEG").into_rgb8().into_raw();
            let truth = picture.samples().iter().flatten().map(|v| (v * 255.0).round());
            (read.iter().zip(truth).map(|(a, b)| (f32::from(*a) - b).abs()).fold(0.0, f32::max), file.len())
        };
        let ((fine, large), (coarse, small)) = (worst(95), worst(20));
        // Smooth ramp: a few steps of rounding at the best quality.
        assert!(fine <= 6.0 && coarse > fine && small < large, "{fine} {coarse}, {small} {large} bytes");
    }

    #[test]
    fn sizes_that_jpeg_cannot_hold_are_refused() {
        assert!(matches!(encode_jpeg(&Plane::new(0, 2), 90), Err(EncodeError::Empty { .. })));
        assert!(matches!(encode_jpeg(&Plane::new(65_536, 1), 90), Err(EncodeError::Encoder(_))));
    }
}
