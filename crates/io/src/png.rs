//! PNG files: raw digital numbers, depth, display pictures.
//!
//! | writer | depth | meaning of a value |
//! | --- | --- | --- |
//! | [`encode_raw16`] | 16 bit grey | digital number as it left the converter, not stretched; the side-car states its bits |
//! | [`encode_depth16`] | 16 bit grey | metres × the scale of the convention; 0 is invalid |
//! | [`encode_display`] | 8 bit RGB | sRGB-encoded, with the sRGB chunk |

use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Display, Length};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::exr::EncodeError;

/// The stored value of `depth_m` at `per_metre` units a metre (KITTI 256, ROS 1 000, TUM 5 000): rounded to nearest. 0,
/// invalid, where it is not finite, not positive, or beyond the largest value: a wall too far away must not seem near.
#[must_use]
pub fn stored_depth(depth_m: f32, per_metre: f64) -> u16 {
    let units = (f64::from(depth_m) * per_metre).round();
    if units >= 1.0 && units <= f64::from(u16::MAX) { units as u16 } else { 0 }
}

/// Raw digital numbers of at most 16 bits; larger ones are refused.
pub fn encode_raw16(raw: &Plane<DigitalNumber>) -> Result<Vec<u8>, EncodeError> {
    let narrowed = |dn: &u32| u16::try_from(*dn).map_err(|_| EncodeError::Wide { value: *dn });
    let values = raw.samples().iter().map(narrowed).collect::<Result<Vec<u16>, _>>()?;
    encode_grey16(raw.width(), raw.height(), &values)
}

/// Depth (m, planar or along the ray as the caller states it) at `per_metre` units a metre.
pub fn encode_depth16(depth: &Plane<Length>, per_metre: f64) -> Result<Vec<u8>, EncodeError> {
    let stored: Vec<u16> = depth.samples().iter().map(|&m| stored_depth(m, per_metre)).collect();
    encode_grey16(depth.width(), depth.height(), &stored)
}

/// A display picture, rounded to 8 bits. Values outside 0–1 are cut, as a display would; NaN is black.
pub fn encode_display(picture: &Plane<Display>) -> Result<Vec<u8>, EncodeError> {
    let bytes: Vec<u8> = picture.samples().iter().flatten().map(|&v| (v * 255.0).round() as u8).collect();
    encode_rgb8(picture.width(), picture.height(), &bytes)
}

/// sRGB-encoded bytes, three a pixel.
pub(crate) fn encode_rgb8(width: usize, height: usize, rgb: &[u8]) -> Result<Vec<u8>, EncodeError> {
    encode(width, height, rgb, ExtendedColorType::Rgb8).map(with_srgb_chunk)
}

fn encode_grey16(width: usize, height: usize, values: &[u16]) -> Result<Vec<u8>, EncodeError> {
    // The encoder takes 16-bit values in the machine's byte order.
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

/// Puts the sRGB chunk (rendering intent: perceptual; PNG specification, 11.3.2.5) behind the header.
fn with_srgb_chunk(mut file: Vec<u8>) -> Vec<u8> {
    const AFTER_HEADER: usize = 8 + 4 + 4 + 13 + 4; // signature; length, name, data and checksum of IHDR
    const SRGB: [u8; 13] = *b"\0\0\0\x01sRGB\0\xAE\xCE\x1C\xE9";
    file.splice(AFTER_HEADER..AFTER_HEADER, SRGB);
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_conventions_have_their_scale_and_0_is_invalid() {
        assert_eq!(stored_depth(10.0, 256.0), 2560);
        assert_eq!(stored_depth(1.2345, 1000.0), 1235); // 1234.5000… in f32 lies above the half
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
        let file = encode_display(&plane).expect("a picture");
        assert_eq!(&file[37..41], b"sRGB");
        let read = image::load_from_memory(&file).expect("PNG with correct checksums").into_rgb8();
        assert_eq!(read.into_raw(), [0, 128, 255, 0, 255, 0]);
    }

    #[test]
    fn a_picture_without_pixels_is_refused() {
        assert!(matches!(encode_raw16(&Plane::new(0, 4)), Err(EncodeError::Empty { .. })));
    }
}
