//! Frames of a camera, one after the other, as files.

use super::metadata;
use super::writer::{Encoder, ResultWriter};
use crate::result_files::ResultFiles;
use etendue_core::Plane;
use etendue_core::RawFormat;
use etendue_core::observer::{Message, Observer};
use etendue_core::quantity::{DigitalNumber, Display};
use etendue_io::exr::{self, EncodeError};
use etendue_io::failure::Error;
use etendue_io::jpeg::encode_jpeg;
use etendue_io::tiff::{self, DngFacts};
use etendue_io::{Provenance, png};
use etendue_pipeline::photograph::{Frame, capture, capture_with_breakdown};
use etendue_pipeline::plan::{CameraBody, Development, PictureFormat, Products};
use etendue_pipeline::raw_colour::RawColour;
use etendue_pipeline::rectified::RectifiedCamera;
use etendue_plan_report::tone_curve::encoding;
use etendue_sensor::{CaptureLight, FrameAddress, Raw, SensorState, SignalBreakdown, SignalComponent};
use serde_json::Value;
use std::borrow::Cow;
use std::ops::Range;

/// Selection of frame products.
#[derive(Clone, Copy)]
pub(crate) struct FrameProducts<'a> {
    /// Products of each frame.
    pub(crate) products: &'a Products,
    /// The camera's name, for files that state it.
    pub(crate) camera: &'a str,
    /// Facts for files that state them.
    pub(crate) facts: &'a Provenance,
    /// The rectified camera whose images are written as well.
    pub(crate) undistorted: Option<&'a RectifiedCamera>,
    /// If true, files are made one after the other, to save memory.
    pub(crate) one_by_one: bool,
    /// Receives warnings of pixels without valid light.
    pub(crate) observer: &'a dyn Observer,
}

/// Encodes the file of a developed image.
pub(crate) fn encode_picture(image: &Plane<Display>, development: &Development) -> Result<Vec<u8>, EncodeError> {
    let tone = encoding(&development.processing.tone);
    match development.format {
        PictureFormat::Jpeg { quality } => encode_jpeg(image, quality),
        PictureFormat::Png { bits: 8 } => png::encode_display(image, &tone),
        PictureFormat::Png { bits } => png::encode_display16(image, bits, &tone),
    }
}

/// Frames with their numbers, with the state of the sensor carried on from `before`; with the components of each digital number if `signal_breakdown` is set.
/// Empty for a camera without electronics.
pub(crate) fn frames<'a>(
    body: &'a CameraBody,
    light: CaptureLight<'a>,
    frames: Range<u32>,
    before: SensorState,
    address: impl Fn(u32) -> FrameAddress + 'a,
    signal_breakdown: bool,
) -> impl Iterator<Item = (u32, Cow<'a, Frame>)> + 'a {
    let step = if signal_breakdown { capture_with_breakdown } else { capture };
    frames.scan(before, move |state, number| {
        let (next, frame) = step(body, std::mem::take(state), light, address(number))?;
        *state = next;
        Some((number, Cow::Owned(frame)))
    })
}

/// Writes the requested products of each frame; computes none if nothing is requested. Returns exposure and gain of each frame.
pub(crate) fn write_frames<'a>(
    body: &CameraBody,
    frames: impl Iterator<Item = (u32, Cow<'a, Frame>)>,
    address: impl Fn(u32) -> FrameAddress,
    frame_products: FrameProducts<'_>,
    writer: &mut ResultWriter<'_>,
) -> Result<Vec<Value>, Error> {
    let products = frame_products.products;
    let mut points = Vec::new();
    if !(products.raw || products.picture || products.signal_breakdown) {
        return Ok(points);
    }
    for (number, mut frame) in frames {
        // Frees the parts of a large image that are not written, before files are made.
        if let (None, Cow::Owned(Frame { picture: Some(image), .. })) = (frame_products.undistorted, &mut frame) {
            image.linear = Plane::new(0, 0);
        }
        if !frame.raw.invalid.is_empty() {
            let count = frame.raw.invalid.len();
            let sentence = format!("frame {number}: pixels without valid light, whose digital number is 0: {count}");
            frame_products.observer.message(Message::Warning(&sentence));
        }
        let file = products.raw.then(|| ResultFiles::raw(number, products.raw_format));
        points.push(metadata::raw_frame(number, file, &frame.raw));
        write_frame(body, &frame, address(number), frame_products, writer)?;
    }
    Ok(points)
}

/// Writes the requested products of a frame.
fn write_frame(
    body: &CameraBody,
    frame: &Frame,
    address: FrameAddress,
    frame_products: FrameProducts<'_>,
    writer: &mut ResultWriter<'_>,
) -> Result<(), Error> {
    let (products, number) = (frame_products.products, address.frame);
    let Frame { raw, signal_breakdown, picture: image } = frame;
    let mut files: Vec<(String, Encoder<'_>)> = Vec::new();
    if products.raw {
        let name = ResultFiles::raw(number, products.raw_format);
        let encode = || match products.raw_format {
            RawFormat::Dng => dng(body, raw, frame_products.camera),
            format => encoded_raw(raw, &raw.plane, format),
        };
        files.push((name, Box::new(encode)));
    }
    if let Some(signal_breakdown) = signal_breakdown {
        let facts = Provenance { frame: number.into(), ..frame_products.facts.clone() };
        let encode = move || encode_breakdown(signal_breakdown, &facts);
        files.push((ResultFiles::signal_breakdown(number), Box::new(encode)));
    }
    if let Some((image, development)) = image.as_ref().filter(|_| products.picture).zip(body.development.as_ref()) {
        let name = ResultFiles::picture(number, development.format);
        files.push((name.clone(), Box::new(|| encode_picture(&image.display, development))));
        if let Some(rectified) = frame_products.undistorted {
            let encode = move || {
                let display = rectified.picture(body, &image.linear, address).expect("a picture was developed");
                encode_picture(&display, development)
            };
            files.push((ResultFiles::undistorted(&name), Box::new(encode)));
        }
    }
    match frame_products.one_by_one {
        true => files.into_iter().try_for_each(|(name, encode)| writer.write(&name, encode())),
        false => writer.write_all(files),
    }
}

/// Digital numbers of a raw without its facts: TIFF or PNG.
pub(crate) fn encoded_raw(raw: &Raw, plane: &Plane<DigitalNumber>, format: RawFormat) -> Result<Vec<u8>, EncodeError> {
    match format {
        RawFormat::Tiff => tiff::encode_raw_tiff(plane, raw.bits),
        RawFormat::Png | RawFormat::Dng if raw.companding.is_some() => png::encode_companded16(plane),
        RawFormat::Png | RawFormat::Dng => png::encode_raw16(plane),
    }
}

fn encode_breakdown(signal_breakdown: &SignalBreakdown, facts: &Provenance) -> Result<Vec<u8>, EncodeError> {
    let layers: Vec<_> = SignalComponent::ALL
        .iter()
        .map(|cause| (cause.name().to_owned(), exr::ExrLayer::Float(signal_breakdown.layer(*cause).samples())))
        .collect();
    let signal = signal_breakdown.layer(SignalComponent::Signal);
    exr::encode_layers(signal.width(), signal.height(), &layers, facts)
}

fn dng(body: &CameraBody, raw: &Raw, camera: &str) -> Result<Vec<u8>, EncodeError> {
    let colour = body.sensor.as_ref().and_then(RawColour::new).expect("a compiled plan asks for DNG where it can be");
    let area = raw.image;
    let facts = DngFacts {
        camera: camera.to_owned(),
        software: format!("etendue {}", metadata::VERSION),
        bits: raw.bits,
        black_level_dn: raw.black_level_dn,
        white_level_dn: raw.white_level_dn,
        tile: colour.tile.map(|(columns, tile)| (columns as u16, tile.into_iter().map(|c| c as u8).collect())),
        xyz_to_camera: colour.xyz_to_camera,
        neutral: colour.neutral,
        active: [area.x, area.y, area.width, area.height].map(|v| v as u32),
    };
    tiff::encode_dng(&raw.plane, &facts)
}
