//! Decoder of images, except OpenEXR (`formats.rs` lists them).

use std::io::{BufRead, Cursor, Seek};
use std::path::Path;

use etendue_scene::asset::{ColourMatrix, ImagePixels, PixelFormat};
use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader};

use super::formats::{RasterFormats, TEXTURES, consistent_tga, unread_format};
use super::radiance::RadianceFile;
use crate::{Error, ErrorCode, error::guarded, texture_memory};

/// Decodes `bytes`, identified by their first bytes.
pub(super) fn decode(file: &Path, bytes: &[u8]) -> Result<DecodedImage, Error> {
    let (format, image) = decode_raster(file, bytes, TEXTURES, PixelStorage::Stored)?;
    let size = [image.width(), image.height()];
    if format != ImageFormat::Hdr {
        return Ok((size[0], size[1], as_pixels(image), None));
    }
    let radiance = RadianceFile::new(bytes);
    let ([width, height], pixels) = radiance.upright(size, as_pixels(image));
    Ok((width, height, pixels, radiance.to_rec_709()))
}

/// Decodes `bytes` of a known format.
pub(super) fn decode_as(file: &Path, bytes: &[u8], format: ImageFormat) -> Result<DecodedImage, Error> {
    let (_, image) = guarded(file, || decode_unguarded(file, bytes, format, PixelStorage::Stored))?;
    Ok((image.width(), image.height(), as_pixels(image), None))
}

/// Image as stored, with its format; the error for other files names the supported `formats`.
pub(crate) fn decode_raster(
    file: &Path,
    bytes: &[u8],
    formats: RasterFormats,
    storage: PixelStorage,
) -> Result<(ImageFormat, DynamicImage), Error> {
    let unknown = || {
        let words = unread_format(bytes).map(str::to_owned);
        let words = words.unwrap_or_else(|| format!("not an image of a known format; expected {}", formats.words));
        Error::coded(ErrorCode::UnsupportedFile, file, words)
    };
    let format = formats.recognise(bytes).ok_or_else(unknown)?;
    if format == ImageFormat::Jpeg && !jpeg_is_complete(bytes) {
        return Err(Error::new(file, "the JPEG has no end marker: it is truncated; create or download it again"));
    }
    guarded(file, || match format {
        ImageFormat::Hdr => decode_unguarded(file, &RadianceFile::new(bytes).bytes, format, storage),
        ImageFormat::Tga => decode_unguarded(file, &consistent_tga(bytes), format, storage),
        _ => decode_unguarded(file, bytes, format, storage),
    })
}

fn decode_unguarded(
    file: &Path,
    bytes: &[u8],
    format: ImageFormat,
    storage: PixelStorage,
) -> Result<(ImageFormat, DynamicImage), Error> {
    let explained = |cause: ImageError| Error::new(file, explain(format, &cause));
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(u64::try_from(2 * texture_memory::max_bytes(bytes.len())).unwrap_or(u64::MAX));
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(explained)?;
    texture_memory::check_bytes(file, storage.bytes(&decoder), bytes.len())?;
    let image = DynamicImage::from_decoder(decoder).map_err(explained)?;
    let may_omit_opacity = matches!(format, ImageFormat::Tga | ImageFormat::Bmp);
    Ok((format, if may_omit_opacity { with_opacity(image) } else { image }))
}

/// An image whose pixels all have the opacity 0 is opaque: its writer left these bytes unset.
fn with_opacity(mut image: DynamicImage) -> DynamicImage {
    if let DynamicImage::ImageRgba8(pixels) = &mut image
        && pixels.pixels().all(|pixel| pixel.0[3] == 0)
    {
        pixels.pixels_mut().for_each(|pixel| pixel.0[3] = u8::MAX);
    }
    image
}

/// Storage of an image's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PixelStorage {
    /// As texture pixels: 8 bits, grey of 16 bits, else 32-bit floats.
    Stored,
    /// As 32-bit floats.
    Floats,
}

impl PixelStorage {
    /// Bytes of an image before it is decoded.
    pub(crate) fn bytes(self, decoder: &impl ImageDecoder) -> u128 {
        match self {
            Self::Stored => pixels(decoder) * u128::from(stored_format(decoder.color_type()).bytes()),
            Self::Floats => {
                pixels(decoder) * u128::from(decoder.color_type().channel_count()) * size_of::<f32>() as u128
            }
        }
    }
}

fn pixels(decoder: &impl ImageDecoder) -> u128 {
    let (width, height) = decoder.dimensions();
    u128::from(width) * u128::from(height)
}

/// Storage format of an image with this colour type.
pub(super) fn stored_format(colours: ColorType) -> PixelFormat {
    match colours {
        ColorType::L8 => PixelFormat::Gray8,
        ColorType::L16 => PixelFormat::Gray16,
        ColorType::La8 | ColorType::Rgba8 => PixelFormat::Rgba8,
        ColorType::Rgb8 => PixelFormat::Rgb8,
        ColorType::La16 | ColorType::Rgba16 | ColorType::Rgba32F => PixelFormat::Rgba32F,
        _ => PixelFormat::Rgb32F,
    }
}

fn explain(format: ImageFormat, cause: &ImageError) -> String {
    let is_float = matches!(format, ImageFormat::Hdr | ImageFormat::Tiff);
    let other = if is_float { "OpenEXR" } else { "plain PNG" };
    match cause {
        ImageError::Unsupported(what) => {
            format!("uses a feature that is not supported ({what}); save the image as {other}")
        }
        ImageError::Limits(what) => format!("too large to be read ({what}); make the image smaller"),
        other => format!("not a readable image ({other}); it may be truncated or damaged: create or download it again"),
    }
}

/// Returns true if an end marker follows the last scan: the decoder would fill a truncated image with grey.
fn jpeg_is_complete(bytes: &[u8]) -> bool {
    let last = |marker: [u8; 2]| bytes.windows(2).rposition(|pair| pair == marker);
    last([0xff, 0xd9]) > last([0xff, 0xda])
}

fn as_pixels(image: DynamicImage) -> ImagePixels {
    match image {
        DynamicImage::ImageLuma8(p) => ImagePixels::Gray8(p.into_raw()),
        DynamicImage::ImageLuma16(p) => ImagePixels::Gray16(p.into_raw()),
        DynamicImage::ImageLumaA8(_) | DynamicImage::ImageRgba8(_) => {
            ImagePixels::Rgba8(image.into_rgba8().pixels().map(|p| p.0).collect())
        }
        DynamicImage::ImageRgb8(p) => ImagePixels::Rgb8(p.pixels().map(|p| p.0).collect()),
        DynamicImage::ImageRgb32F(p) => ImagePixels::Rgb32F(p.pixels().map(|p| p.0).collect()),
        DynamicImage::ImageRgba32F(p) => ImagePixels::Rgba32F(p.pixels().map(|p| p.0).collect()),
        DynamicImage::ImageLumaA16(_) | DynamicImage::ImageRgba16(_) => {
            ImagePixels::Rgba32F(image.into_rgba16().pixels().map(|p| p.0.map(unit_value)).collect())
        }
        wide => ImagePixels::Rgb32F(wide.into_rgb16().pixels().map(|p| p.0.map(unit_value)).collect()),
    }
}

/// 16-bit number as a fraction of the largest.
fn unit_value(stored: u16) -> f32 {
    f32::from(stored) / 65_535.0
}

/// Returns true if an image has three or four channels of 8 bits each, as images of encoded colours have (for palettes: their colours). `false` if its header
/// cannot be read. `file` names it in messages.
pub fn has_colours_of_8_bits(file: &Path, bytes: impl BufRead + Seek) -> bool {
    let colours = || Some(ImageReader::new(bytes).with_guessed_format().ok()?.into_decoder().ok()?.color_type());
    let colour_type = guarded(file, || Ok(colours())).ok().flatten();
    matches!(colour_type, Some(ColorType::Rgb8 | ColorType::Rgba8))
}

/// Width, height, pixels, and the matrix from their colours to Rec. 709.
pub(super) type DecodedImage = (u32, u32, ImagePixels, Option<ColourMatrix>);

/// Refuses the first non-finite pixel.
pub(super) fn check_finite(file: &Path, width: u32, pixels: &ImagePixels) -> Result<(), Error> {
    match pixels {
        ImagePixels::Rgb32F(values) => check(file, width, values),
        ImagePixels::Rgba32F(values) => check(file, width, values),
        ImagePixels::Gray8(_) | ImagePixels::Gray16(_) | ImagePixels::Rgb8(_) | ImagePixels::Rgba8(_) => Ok(()),
    }
}

fn check<const N: usize>(file: &Path, width: u32, pixels: &[[f32; N]]) -> Result<(), Error> {
    let Some(at) = pixels.iter().position(|p| !p.iter().all(|v| v.is_finite())) else { return Ok(()) };
    let (x, y) = (at % width as usize, at / width as usize);
    let message = format!(
        "pixel ({x}, {y}) is {:?}; expected finite numbers: clip the image to the range of its format",
        pixels[at]
    );
    Err(Error::new(file, message))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{DynamicImage, ImageFormat};

    use super::super::decode_image;
    use super::*;

    fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).expect("encodable");
        bytes.into_inner()
    }

    fn read(bytes: &[u8]) -> Result<ImagePixels, String> {
        decode_image(Path::new("t.png"), bytes).map(|p| p.pixels).map_err(|e| e.to_string())
    }

    #[test]
    fn sixteen_bits_keep_their_precision() {
        let picture = image::ImageBuffer::from_pixel(1, 1, image::Rgb([1_u16, 32_768, 65_535]));
        let pixels = read(&encoded(&DynamicImage::ImageRgb16(picture), ImageFormat::Png)).expect("readable");
        assert_eq!(pixels, ImagePixels::Rgb32F(vec![[1.0 / 65_535.0, 32_768.0 / 65_535.0, 1.0]]));
        let grey = image::ImageBuffer::from_raw(2, 1, vec![1_u16, 65_535]).expect("two pixels");
        let pixels = read(&encoded(&DynamicImage::ImageLuma16(grey), ImageFormat::Png)).expect("readable");
        assert_eq!(pixels, ImagePixels::Gray16(vec![1, 65_535]));
    }

    #[test]
    fn opacity_is_kept() {
        let picture = image::ImageBuffer::from_pixel(1, 1, image::Rgba([1_u16, 2, 3, 32_768]));
        let pixels = read(&encoded(&DynamicImage::ImageRgba16(picture), ImageFormat::Png)).expect("readable");
        assert_eq!(pixels, ImagePixels::Rgba32F(vec![[1.0, 2.0, 3.0, 32_768.0].map(|v| v / 65_535.0)]));
        let picture = image::ImageBuffer::from_pixel(1, 1, image::LumaA([9_u8, 8]));
        let pixels = read(&encoded(&DynamicImage::ImageLumaA8(picture), ImageFormat::Png)).expect("readable");
        assert_eq!(pixels, ImagePixels::Rgba8(vec![[9, 9, 9, 8]]));
        let exr = crate::exr::tests_support::small_exr(1, 1, &["R", "G", "B", "A"], 0.25);
        assert_eq!(read(&exr).expect("readable"), ImagePixels::Rgba32F(vec![[0.25; 4]]));
        let exr = crate::exr::tests_support::small_exr(1, 1, &["Y", "A"], 0.5);
        assert_eq!(read(&exr).expect("readable"), ImagePixels::Rgba32F(vec![[0.5; 4]]));
        let message = read(&crate::exr::tests_support::small_exr(1, 1, &["Y", "A"], f32::NAN)).expect_err("no number");
        assert!(
            message.starts_with("t.png: pixel (0, 0) is [NaN, NaN, NaN, NaN]; expected finite numbers"),
            "{message}"
        );
    }

    #[test]
    fn half_floats_are_widened() {
        use ::exr::prelude::{Image, SpecificChannels, WritableImage as _, f16};
        let pixels = |_| (f16::from_f32(0.5), f16::from_f32(2.0), f16::from_f32(65_504.0));
        let mut bytes = std::io::Cursor::new(Vec::new());
        let image = Image::from_channels((2, 1), SpecificChannels::rgb(pixels));
        image.write().non_parallel().to_buffered(&mut bytes).expect("writable");
        assert_eq!(read(bytes.get_ref()), Ok(ImagePixels::Rgb32F(vec![[0.5, 2.0, 65_504.0]; 2])));
    }

    #[test]
    fn eight_bits_stay_bytes() {
        let picture = image::ImageBuffer::from_pixel(2, 1, image::Rgb([1_u8, 2, 3]));
        assert_eq!(
            read(&encoded(&DynamicImage::ImageRgb8(picture), ImageFormat::Png)),
            Ok(ImagePixels::Rgb8(vec![[1, 2, 3]; 2]))
        );
        let grey = image::ImageBuffer::from_pixel(1, 1, image::Luma([7_u8]));
        assert_eq!(read(&encoded(&DynamicImage::ImageLuma8(grey), ImageFormat::Png)), Ok(ImagePixels::Gray8(vec![7])));
    }

    #[test]
    fn a_truncated_or_strange_picture_is_refused_by_name() {
        let picture =
            DynamicImage::ImageRgb8(image::ImageBuffer::from_fn(32, 32, |x, y| image::Rgb([(x * y) as u8, 2, 3])));
        for format in [ImageFormat::Png, ImageFormat::Jpeg] {
            let bytes = encoded(&picture, format);
            read(&bytes).expect("whole");
            let message = read(&bytes[..bytes.len() * 2 / 3]).expect_err("truncated");
            assert!(message.starts_with("t.png: ") && message.contains("truncated"), "{message}");
        }
        let message = read(b"#!/bin/sh\n").expect_err("a script");
        let kinds = "PNG, JPEG, TGA, BMP, TIFF, WebP, DDS, PNM, Radiance HDR or OpenEXR";
        assert_eq!(message, format!("t.png: not an image of a known format; expected {kinds}"));
    }

    #[test]
    fn an_infinite_pixel_is_named() {
        let mut exr = crate::exr::tests_support::small_exr(2, 2, &["R", "G", "B"], 1.0);
        assert!(matches!(read(&exr), Ok(ImagePixels::Rgb32F(_))));
        exr = crate::exr::tests_support::small_exr(2, 2, &["R", "G", "B"], f32::INFINITY);
        let message = read(&exr).expect_err("infinite");
        assert!(message.starts_with("t.png: pixel (0, 0) is [inf, inf, inf]; expected finite numbers"), "{message}");
        let message = read(&crate::exr::tests_support::small_exr(2, 2, &["depth.Z"], 1.0)).expect_err("no colours");
        assert_eq!(message, "t.png: not an image of R, G, B or Y; its channels are depth.Z");
    }

    #[test]
    fn only_colours_of_8_bits_are_those() {
        let detected = |image: DynamicImage, format: ImageFormat| {
            let mut bytes = Cursor::new(Vec::new());
            image.write_to(&mut bytes, format).expect("encodable");
            bytes.set_position(0);
            has_colours_of_8_bits(Path::new("a"), bytes)
        };
        assert!(detected(DynamicImage::new_rgb8(2, 2), ImageFormat::Png));
        assert!(detected(DynamicImage::new_rgba8(2, 2), ImageFormat::Png));
        assert!(detected(DynamicImage::new_rgb8(2, 2), ImageFormat::Jpeg));
        assert!(!detected(DynamicImage::new_luma8(2, 2), ImageFormat::Png));
        assert!(!detected(DynamicImage::new_luma_a8(2, 2), ImageFormat::Png));
        assert!(!detected(DynamicImage::new_rgb16(2, 2), ImageFormat::Png));
        assert!(!detected(DynamicImage::new_rgb32f(2, 2), ImageFormat::Hdr));
        assert!(!has_colours_of_8_bits(Path::new("a"), Cursor::new(b"\x76\x2f\x31\x01".as_slice())));
    }
}
