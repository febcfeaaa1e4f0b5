//! Images not held in memory: size from the header, pixels row by row.
//!
//! PNG of 8 bits that is not interlaced is decoded a few rows at a time. Other images are decoded whole, passed on and dropped.

use std::path::{Path, PathBuf};
use std::{fs::File, io::Cursor, sync::Arc};

use etendue_scene::asset::{ColourMatrix, ImagePixels, LargeImage, PixelFormat, PixelRows, RowReceiver};
use image::{ImageDecoder as _, ImageReader};

use super::{EXR_MAGIC, PixelStorage, decode_image, raster::stored_format};
use crate::{Error, ErrorCode, error::guarded, hash, source::read_bytes, texture_memory};

/// Approximate number of pixels passed on at a time.
const STRIP_PIXELS: usize = 1 << 17;

/// Image header: size, px, and pixel format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ImageHead {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) format: PixelFormat,
}

/// Reads the header of an image; `None` if it cannot be read, which the full reader then explains.
pub(crate) fn head(file: &Path) -> Option<ImageHead> {
    if !std::fs::metadata(file).ok()?.is_file() {
        return None;
    }
    guarded(file, || Ok(head_unguarded(file))).ok().flatten()
}

fn head_unguarded(file: &Path) -> Option<ImageHead> {
    let mut magic = [0; EXR_MAGIC.len()];
    std::io::Read::read_exact(&mut File::open(file).ok()?, &mut magic).ok()?;
    let head = if magic == EXR_MAGIC { exr_head(file)? } else { raster_head(file)? };
    (head.width > 0 && head.height > 0).then_some(head)
}

fn exr_head(file: &Path) -> Option<ImageHead> {
    let meta = ::exr::meta::MetaData::read_from_file(file, false).ok()?;
    let [header] = &meta.headers[..] else { return None };
    let has_opacity = header.channels.list.iter().any(|channel| channel.name == *"A");
    let format = if has_opacity { PixelFormat::Rgba32F } else { PixelFormat::Rgb32F };
    let size = header.layer_size;
    Some(ImageHead { width: u32::try_from(size.width()).ok()?, height: u32::try_from(size.height()).ok()?, format })
}

/// Matrix from the colours of an EXR to Rec. 709; `None` if they are in it, and for other images.
fn exr_colours(file: &Path, bytes: &[u8]) -> Result<Option<ColourMatrix>, Error> {
    if !bytes.starts_with(&EXR_MAGIC) {
        return Ok(None);
    }
    let stated = || {
        let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).ok()?;
        let header = meta.headers.first()?;
        let is_colour = header.channels.list.iter().any(|channel| channel.name == *"R");
        header.shared_attributes.chromaticities.filter(|_| is_colour)
    };
    let stated = guarded(file, || Ok(stated()))?;
    stated.map_or(Ok(None), |stated| crate::exr::to_rec_709(file, &stated))
}

fn raster_head(file: &Path) -> Option<ImageHead> {
    let decoder = ImageReader::open(file).ok()?.with_guessed_format().ok()?.into_decoder().ok()?;
    let (width, height) = decoder.dimensions();
    let format = stored_format(decoder.color_type());
    let packed = std::fs::metadata(file).ok()?.len() as usize;
    (PixelStorage::Stored.bytes(&decoder) <= texture_memory::max_bytes(packed)).then_some(ImageHead {
        width,
        height,
        format,
    })
}

/// Large image whose header has been read.
pub(crate) fn large_image(file: &Path, head: ImageHead) -> Result<LargeImage, Error> {
    let ImageHead { width, height, format } = head;
    let bytes = read_bytes(file, "image")?;
    let (hash, to_rec_709) = (hash::hash_bytes(&bytes), exr_colours(file, &bytes)?);
    let size = (width, height);
    let rows = Arc::new(ImageFile { path: file.to_path_buf(), size, format, hash });
    Ok(LargeImage { width, height, format, to_rec_709, hash, rows })
}

/// Image in its file.
#[derive(Debug)]
struct ImageFile {
    path: PathBuf,
    size: (u32, u32),
    format: PixelFormat,
    hash: hash::ContentHash,
}

impl PixelRows for ImageFile {
    fn read(&self, take: RowReceiver<'_>) -> Result<(), String> {
        let bytes = read_bytes(&self.path, "image").map_err(|error| error.to_string())?;
        if hash::hash_bytes(&bytes) != self.hash {
            return Err(Error::coded(
                ErrorCode::OtherRun,
                &self.path,
                "the file was changed while it was read; run again",
            )
            .to_string());
        }
        if let Some(rows) = guarded(&self.path, || Ok(PngRows::new(&bytes, self.size.0, self.size.1))).ok().flatten() {
            match rows.read(&self.path, take) {
                Ok(()) => return Ok(()),
                Err(Stop::Taker(error)) => return Err(error),
                // The error is reported as for any image.
                Err(Stop::Damaged) => {}
            }
        }
        self.read_whole(bytes, take)
    }
}

impl ImageFile {
    fn read_whole(&self, bytes: Vec<u8>, take: RowReceiver<'_>) -> Result<(), String> {
        let image = decode_image(&self.path, &bytes).map_err(|error| error.to_string())?;
        drop(bytes);
        if (image.width, image.height, format(&image.pixels)) != (self.size.0, self.size.1, self.format) {
            return Err(Error::new(&self.path, "its header and its pixels do not match; save it again").to_string());
        }
        take(&image.pixels)
    }
}

fn format(pixels: &ImagePixels) -> PixelFormat {
    match pixels {
        ImagePixels::Gray8(_) => PixelFormat::Gray8,
        ImagePixels::Gray16(_) => PixelFormat::Gray16,
        ImagePixels::Rgb8(_) => PixelFormat::Rgb8,
        ImagePixels::Rgba8(_) => PixelFormat::Rgba8,
        ImagePixels::Rgb32F(_) => PixelFormat::Rgb32F,
        ImagePixels::Rgba32F(_) => PixelFormat::Rgba32F,
    }
}

/// Reason for an early end of row reading.
enum Stop {
    Damaged,
    Taker(String),
}

/// PNG that can be decoded by rows.
struct PngRows<'a> {
    reader: png::Reader<Cursor<&'a [u8]>>,
    colours: png::ColorType,
    size: (u32, u32),
}

impl<'a> PngRows<'a> {
    /// `None` if it is no such PNG.
    fn new(bytes: &'a [u8], width: u32, height: u32) -> Option<Self> {
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        // As in the decoder of small images: palettes as colours, less than 8 bits as 8.
        decoder.set_transformations(png::Transformations::EXPAND);
        let reader = decoder.read_info().ok()?;
        let (colours, bits) = reader.output_color_type();
        let info = reader.info();
        let is_plain = bits == png::BitDepth::Eight && !info.interlaced && info.animation_control.is_none();
        let colours = Some(colours).filter(|colours| *colours != png::ColorType::Indexed)?;
        (is_plain && (info.width, info.height) == (width, height)).then_some(Self {
            reader,
            colours,
            size: (width, height),
        })
    }

    fn read(mut self, file: &Path, take: RowReceiver<'_>) -> Result<(), Stop> {
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        let strip_rows = (STRIP_PIXELS / width).clamp(1, height);
        let mut strip = Vec::with_capacity(strip_rows * width * self.colours.samples());
        for y in 0..height {
            self.append_row(file, &mut strip)?;
            if (y + 1) % strip_rows == 0 || y + 1 == height {
                take(&pixels(self.colours, &strip)).map_err(Stop::Taker)?;
                strip.clear();
            }
        }
        let finished = guarded(file, || Ok(self.reader.finish().is_ok()));
        if finished == Ok(true) { Ok(()) } else { Err(Stop::Damaged) }
    }

    /// Decodes the next row to the end of `strip`.
    fn append_row(&mut self, file: &Path, strip: &mut Vec<u8>) -> Result<(), Stop> {
        let appended = guarded(file, || {
            let row = self.reader.next_row().ok().flatten();
            Ok(row.map(|row| strip.extend_from_slice(row.data())).is_some())
        });
        if appended == Ok(true) { Ok(()) } else { Err(Stop::Damaged) }
    }
}

/// 8-bit samples as pixels; grey with opacity as colours.
fn pixels(colours: png::ColorType, samples: &[u8]) -> ImagePixels {
    match colours {
        png::ColorType::Rgb => ImagePixels::Rgb8(samples.as_chunks().0.to_vec()),
        png::ColorType::Rgba => ImagePixels::Rgba8(samples.as_chunks().0.to_vec()),
        png::ColorType::GrayscaleAlpha => {
            ImagePixels::Rgba8(samples.as_chunks().0.iter().map(|[g, a]| [*g, *g, *g, *a]).collect())
        }
        png::ColorType::Grayscale | png::ColorType::Indexed => ImagePixels::Gray8(samples.to_vec()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::read_image;
    use image::{DynamicImage, ImageBuffer, ImageFormat};

    fn rows(file: &Path) -> Result<Vec<ImagePixels>, String> {
        let large = large_image(file, head(file).expect("a head")).map_err(|error| error.to_string())?;
        let mut all = Vec::new();
        large.rows.read(&mut |rows| {
            all.push(rows.clone());
            Ok(())
        })?;
        Ok(all)
    }

    /// Pixels of all strips.
    fn joined(strips: &[ImagePixels]) -> ImagePixels {
        let mut all = strips[0].clone();
        for strip in &strips[1..] {
            match (&mut all, strip) {
                (ImagePixels::Gray8(all), ImagePixels::Gray8(more)) => all.extend(more),
                (ImagePixels::Rgb8(all), ImagePixels::Rgb8(more)) => all.extend(more),
                (ImagePixels::Rgba8(all), ImagePixels::Rgba8(more)) => all.extend(more),
                other => panic!("{other:?}"),
            }
        }
        all
    }

    #[test]
    fn rows_are_those_of_the_picture_read_whole() {
        let place = tempfile::tempdir().expect("temporary folder");
        let byte = |x: u32, y: u32, i: u32| (x * 3 + y * 5 + i * 7 + x * y) as u8;
        let (w, h) = (700, 431);
        let images = [
            DynamicImage::ImageLuma8(ImageBuffer::from_fn(w, h, |x, y| image::Luma([byte(x, y, 0)]))),
            DynamicImage::ImageLumaA8(ImageBuffer::from_fn(w, h, |x, y| image::LumaA([byte(x, y, 0), byte(x, y, 1)]))),
            DynamicImage::ImageRgb8(ImageBuffer::from_fn(w, h, |x, y| image::Rgb([0, 1, 2].map(|i| byte(x, y, i))))),
            DynamicImage::ImageRgba8(ImageBuffer::from_fn(w, h, |x, y| {
                image::Rgba([0, 1, 2, 3].map(|i| byte(x, y, i)))
            })),
            DynamicImage::ImageLuma16(ImageBuffer::from_fn(w, h, |x, y| image::Luma([u16::from(byte(x, y, 0)) * 257]))),
            DynamicImage::ImageRgb16(ImageBuffer::from_fn(w, h, |x, y| {
                image::Rgb([0, 1, 2].map(|i| byte(x, y, i).into()))
            })),
        ];
        for picture in images {
            let file = place.path().join("t.png");
            picture.save_with_format(&file, ImageFormat::Png).expect("writable");
            let (full, strips) = (read_image(&file).expect("readable"), rows(&file).expect("readable"));
            assert_eq!(head(&file), Some(ImageHead { width: w, height: h, format: format(&full.pixels) }));
            assert_eq!(
                strips.len() > 1,
                picture.color().bits_per_pixel() / u16::from(picture.color().channel_count()) == 8
            );
            assert!(joined(&strips) == full.pixels, "{:?}", picture.color());
        }
        let file = place.path().join("t.jpg");
        let grey = DynamicImage::ImageLuma8(ImageBuffer::from_fn(w, h, |x, y| image::Luma([byte(x, y, 0)])));
        grey.save_with_format(&file, ImageFormat::Jpeg).expect("writable");
        assert!(rows(&file).expect("readable") == [read_image(&file).expect("readable").pixels]);
    }

    #[test]
    fn a_damaged_image_is_reported_as_a_small_one_is() {
        let place = tempfile::tempdir().expect("temporary folder");
        let file = place.path().join("t.png");
        let picture = DynamicImage::ImageRgb8(ImageBuffer::from_fn(300, 300, |x, y| image::Rgb([(x * y) as u8, 2, 3])));
        picture.save_with_format(&file, ImageFormat::Png).expect("writable");
        let complete = std::fs::read(&file).expect("file");
        std::fs::write(&file, &complete[..complete.len() / 2]).expect("write");
        let message = rows(&file).expect_err("half of it");
        assert_eq!(message, read_image(&file).expect_err("half of it").to_string());
        assert!(message.contains("it may be truncated or damaged"), "{message}");
        std::fs::write(&file, &complete).expect("write");
        let large = large_image(&file, head(&file).expect("a head")).expect("readable");
        std::fs::write(&file, &complete[..complete.len() / 2]).expect("write");
        let message = large.rows.read(&mut |_| Ok(())).expect_err("another file");
        assert!(message.ends_with("t.png: the file was changed while it was read; run again"), "{message}");
        std::fs::remove_file(&file).expect("remove");
        let message = large.rows.read(&mut |_| Ok(())).expect_err("no file");
        assert!(message.ends_with("t.png: no such image file; check the path"), "{message}");
    }

    #[test]
    fn exr_heads_are_read() {
        let place = tempfile::tempdir().expect("temporary folder");
        let file = place.path().join("t.exr");
        for (channels, format) in [(&["R", "G", "B"][..], PixelFormat::Rgb32F), (&["Y", "A"], PixelFormat::Rgba32F)] {
            std::fs::write(&file, crate::exr::tests_support::small_exr(3, 2, channels, 0.5)).expect("write");
            assert_eq!(head(&file), Some(ImageHead { width: 3, height: 2, format }));
            assert_eq!(rows(&file).expect("readable"), [read_image(&file).expect("readable").pixels]);
        }
    }
}
