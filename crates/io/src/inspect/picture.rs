//! Inspection of image files.

use std::path::Path;

use image::{ColorType, DynamicImage, GenericImageView as _};

use super::{FileReport, Preview, report::ChannelReport};
use crate::Error;
use crate::picture::{PixelStorage, TEXTURES, decode_raster};

pub(super) fn report(file: &Path, bytes: &[u8]) -> Result<FileReport, Error> {
    let (format, image) = decode_raster(file, bytes, TEXTURES, PixelStorage::Floats)?;
    let mut report = FileReport::new(file, format!("image, {}", format!("{format:?}").to_uppercase()));
    let (width, height) = (image.width() as usize, image.height() as usize);
    report.state("size", format!("{width} x {height} pixels"));
    let names = channel_names(image.color());
    let stored = StorageFormat::from_colour(image.color());
    for (i, name) in names.iter().enumerate() {
        let all = image.as_bytes().chunks_exact(stored.bytes);
        let values = all.skip(i).step_by(names.len()).map(|b| f64::from((stored.read)(b)));
        report.channels.push(ChannelReport::new(name, stored.name, values));
    }
    let step = subsampling_step(width, height);
    if step > 1 {
        report.notes.push(format!("the image is subsampled by a factor of {step}"));
    }
    report.preview = Some(preview(&image, &stored, step));
    Ok(report)
}

/// Maximum pixels of a preview: larger images are subsampled, so that memory is bounded by the file's own pixels.
const MAX_PREVIEW_PIXELS: usize = 32 << 20;

/// Subsampling step of pixels and rows of the preview; 1 shows all.
fn subsampling_step(width: usize, height: usize) -> usize {
    (1..).find(|step| width.div_ceil(*step) * height.div_ceil(*step) <= MAX_PREVIEW_PIXELS).unwrap_or(1)
}

fn channel_names(colour: ColorType) -> &'static [&'static str] {
    match colour.channel_count() {
        1 => &["grey"],
        2 => &["grey", "alpha"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    }
}

/// Storage format of samples.
struct StorageFormat {
    name: &'static str,
    bytes: usize,
    read: fn(&[u8]) -> f32,
}

impl StorageFormat {
    fn from_colour(colour: ColorType) -> Self {
        match colour.bytes_per_pixel() / colour.channel_count() {
            1 => Self { name: "8 bit", bytes: 1, read: |b| f32::from(b[0]) },
            2 => Self { name: "16 bit", bytes: 2, read: |b| f32::from(u16::from_ne_bytes([b[0], b[1]])) },
            _ => Self { name: "float", bytes: 4, read: |b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]]) },
        }
    }
}

/// Preview: bytes unchanged; 16-bit grey (raw numbers, depth) and floats are linear and are exposed.
fn preview(image: &DynamicImage, stored: &StorageFormat, step: usize) -> Preview {
    let (columns, rows) = (image.width() as usize, image.height() as usize);
    let (width, height) = (columns.div_ceil(step), rows.div_ceil(step));
    let places = || (0..rows).step_by(step).flat_map(move |y| (0..columns).step_by(step).map(move |x| (x, y)));
    let channels = usize::from(image.color().channel_count());
    let sample = |(x, y): (usize, usize), channel: usize| {
        let at = ((y * columns + x) * channels + channel) * stored.bytes;
        (stored.read)(&image.as_bytes()[at..at + stored.bytes])
    };
    match image {
        DynamicImage::ImageLuma16(_) => {
            let values: Vec<f32> = places().map(|at| sample(at, 0)).collect();
            Preview::from_grey(width, height, &values)
        }
        DynamicImage::ImageRgb32F(_) => {
            let pixels: Vec<[f32; 3]> = places().map(|at| [0, 1, 2].map(|channel| sample(at, channel))).collect();
            Preview::from_linear(width, height, &pixels)
        }
        encoded => {
            let shown = |(x, y): (usize, usize)| {
                let [r, g, b, _] = encoded.get_pixel(x as u32, y as u32).0;
                [r, g, b]
            };
            Preview { width, height, rgb: places().map(shown).collect() }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_image_is_subsampled_and_a_usual_one_is_not() {
        assert_eq!(
            [subsampling_step(4000, 3000), subsampling_step(8192, 4096), subsampling_step(20_000, 20_000)],
            [1, 1, 4]
        );
        let picture =
            DynamicImage::ImageRgb8(image::ImageBuffer::from_fn(5, 3, |x, y| image::Rgb([x as u8, y as u8, 7])));
        let stored = StorageFormat::from_colour(picture.color());
        let full = preview(&picture, &stored, 1);
        assert_eq!((full.width, full.height, full.rgb[8]), (5, 3, [3, 1, 7]));
        let thin = preview(&picture, &stored, 2);
        assert_eq!((thin.width, thin.height), (3, 2));
        assert_eq!(thin.rgb, [[0, 0, 7], [2, 0, 7], [4, 0, 7], [0, 2, 7], [2, 2, 7], [4, 2, 7]]);
    }
}
