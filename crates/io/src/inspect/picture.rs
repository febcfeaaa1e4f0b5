//! Looking into PNG, JPEG and HDR files.

use std::path::Path;

use image::{ColorType, DynamicImage};

use super::statistics::ChannelReport;
use super::{FileReport, Preview};
use crate::Error;
use crate::photograph::KINDS;
use crate::picture::decode_raster;

pub(super) fn report(file: &Path, bytes: &[u8]) -> Result<FileReport, Error> {
    let (format, picture) = decode_raster(file, bytes, KINDS)?;
    let mut report = FileReport::new(file, format!("picture, {}", format!("{format:?}").to_uppercase()));
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    report.state("size", format!("{width} x {height} pixels"));
    let names = channel_names(picture.color());
    let (stored_as, samples) = samples(&picture);
    for (i, name) in names.iter().enumerate() {
        let values = samples.iter().skip(i).step_by(names.len()).map(|v| f64::from(*v));
        report.channels.push(ChannelReport::of(name, stored_as, values));
    }
    report.preview = Some(preview(&picture, width, height, &samples));
    Ok(report)
}

fn channel_names(colour: ColorType) -> &'static [&'static str] {
    match colour.channel_count() {
        1 => &["grey"],
        2 => &["grey", "alpha"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    }
}

/// How samples are stored, and all of them as floats, channels interleaved.
fn samples(picture: &DynamicImage) -> (&'static str, Vec<f32>) {
    let bytes = picture.as_bytes();
    let colour = picture.color();
    match colour.bytes_per_pixel() / colour.channel_count() {
        1 => ("8 bit", bytes.iter().map(|b| f32::from(*b)).collect()),
        2 => ("16 bit", bytes.chunks_exact(2).map(|b| f32::from(u16::from_ne_bytes([b[0], b[1]]))).collect()),
        _ => ("float", bytes.chunks_exact(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect()),
    }
}

/// Bytes as they are; 16-bit grey (raw numbers, depth) and floats are linear and are exposed.
fn preview(picture: &DynamicImage, width: usize, height: usize, samples: &[f32]) -> Preview {
    match picture {
        DynamicImage::ImageLuma16(_) => Preview::of_grey(width, height, samples),
        DynamicImage::ImageRgb32F(_) => {
            let pixels: Vec<[f32; 3]> = samples.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
            Preview::of_linear(width, height, &pixels)
        }
        encoded => Preview { width, height, rgb: encoded.to_rgb8().pixels().map(|p| p.0).collect() },
    }
}
