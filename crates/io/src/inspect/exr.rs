//! Inspection of EXR files.

use std::path::Path;

use super::{FileReport, Preview, layer, report::ChannelReport};
use crate::exr::{ExrFile, ExrSamples, SpectralImage, decode_exr, linear_srgb, parse_channel_name, spectral_of};
use crate::{Error, ErrorCode};

/// Report with an image of the requested layer.
pub(super) fn report(file: &Path, bytes: &[u8], shown: Option<&str>) -> Result<FileReport, Error> {
    let exr = decode_exr(file, bytes)?;
    let mut report = FileReport::new(file, kind(&exr));
    report.state("size", format!("{} x {} pixels", exr.width, exr.height));
    report.state("compression", &exr.compression);
    for (name, text) in &exr.attributes {
        report.state(name.strip_prefix("etendue:").unwrap_or(name), text);
    }
    report.channels = exr.channels.iter().map(|c| channel(&c.name, &c.samples)).collect();
    report.preview = match shown {
        Some(name) => Some(draw_layer(&exr, name, &mut report).ok_or_else(|| no_layer(file, &exr, name))?),
        None => preview(file, &exr, &mut report),
    };
    Ok(report)
}

fn no_layer(file: &Path, exr: &ExrFile, name: &str) -> Error {
    Error::coded(
        ErrorCode::UnknownName,
        file,
        format!("has no layer \"{name}\"; expected one of {}", layer::names(exr).join(", ")),
    )
}

fn kind(exr: &ExrFile) -> &'static str {
    match exr.attributes.get("etendue:quantity").map(String::as_str) {
        Some("spectral radiance") => "spectral radiance, EXR",
        Some("spectral irradiance") => "spectral irradiance, EXR",
        Some("ground truth") => "ground truth, EXR",
        Some("ground truth of motion") => "ground truth of motion, EXR",
        _ if is_spectral(exr) => "spectral image, EXR",
        _ => "EXR",
    }
}

fn is_spectral(exr: &ExrFile) -> bool {
    exr.channels.iter().any(|c| parse_channel_name(&c.name).is_some())
}

fn channel(name: &str, samples: &ExrSamples) -> ChannelReport {
    match samples {
        ExrSamples::Half(v) => ChannelReport::new(name, "half", v.iter().map(|v| f64::from(*v))),
        ExrSamples::Float(v) => ChannelReport::new(name, "float", v.iter().map(|v| f64::from(*v))),
        ExrSamples::Uint(v) => ChannelReport::new(name, "uint", v.iter().map(|v| f64::from(*v))),
    }
}

/// Preview from R, G, B if present, else the colour of the spectra, else depth, flow or the first channel.
fn preview(file: &Path, exr: &ExrFile, report: &mut FileReport) -> Option<Preview> {
    let pixels = stored_colour(exr).or_else(|| spectral_colour(file, exr, report));
    match pixels {
        Some(pixels) => Some(Preview::from_linear(exr.width, exr.height, &pixels)),
        None => {
            let first = exr.channels.first().map(|channel| channel.name.as_str());
            ["depth.Z", "flow.forward", "flow.backward"]
                .into_iter()
                .chain(first)
                .find_map(|name| draw_layer(exr, name, report))
        }
    }
}

fn draw_layer(exr: &ExrFile, name: &str, report: &mut FileReport) -> Option<Preview> {
    let (preview, note) = layer::layer_preview(exr, name)?;
    report.notes.push(note);
    Some(preview)
}

fn stored_colour(exr: &ExrFile) -> Option<Vec<[f32; 3]>> {
    let plane = |name: &str| exr.channel(name).map(ExrSamples::floats);
    Some(pixels(plane("R")?, plane("G")?, plane("B")?))
}

fn pixels(r: impl Iterator<Item = f32>, g: impl Iterator<Item = f32>, b: impl Iterator<Item = f32>) -> Vec<[f32; 3]> {
    r.zip(g).zip(b).map(|((r, g), b)| [r, g, b]).collect()
}

fn spectral_colour(file: &Path, exr: &ExrFile, report: &mut FileReport) -> Option<Vec<[f32; 3]>> {
    if !is_spectral(exr) {
        return None;
    }
    match spectral_of(file, exr) {
        Ok(spectral) => {
            report.notes.extend(spectral.notes);
            let [r, g, b] = match spectral.image {
                SpectralImage::Radiance(image) => linear_srgb(&image.cube),
                SpectralImage::Irradiance(image) => linear_srgb(&image.cube),
            };
            Some(pixels(r.into_iter(), g.into_iter(), b.into_iter()))
        }
        Err(error) => {
            report.notes.push(format!("not readable as a spectral image: {}", error.what()));
            None
        }
    }
}
