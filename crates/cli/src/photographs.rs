//! Photographs of a camera, frame after frame, as files.

use crate::facts;
use crate::failure::Failure;
use crate::files::Files;
use crate::results::Results;
use crate::tell;
use crate::tone_curve::encoding;
use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Display, Electrons};
use etendue_io::exr::{self, EncodeError};
use etendue_io::jpeg::encode_jpeg;
use etendue_io::tiff::{self, DngFacts};
use etendue_io::{Provenance, png};
use etendue_pipeline::photograph::{Frame, take, take_with_causes};
use etendue_pipeline::plan::{CameraBody, Development, PictureFormat, Products, RawFormat};
use etendue_pipeline::raw_colour::RawColour;
use etendue_pipeline::twin::Twin;
use etendue_sensor::{Cause, Causes, FrameAddress, Raw, SensorState};
use serde_json::Value;
use std::ops::Range;

/// Which photographs are wanted.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// What of each frame.
    pub products: &'a Products,
    /// The camera's name, for files that tell it.
    pub camera: &'a str,
    /// The facts of files that tell them.
    pub facts: &'a Provenance,
    /// The twin whose pictures are wanted as well.
    pub undistorted: Option<&'a Twin>,
}

/// The file of a picture that was developed so.
pub fn encoded(picture: &Plane<Display>, development: &Development) -> Result<Vec<u8>, EncodeError> {
    let tone = encoding(&development.processing.tone);
    match development.format {
        PictureFormat::Jpeg { quality } => encode_jpeg(picture, quality),
        PictureFormat::Png { bits: 8 } => png::encode_display(picture, &tone),
        PictureFormat::Png { bits } => png::encode_display16(picture, bits, &tone),
    }
}

/// Takes frame after frame and writes what is wanted of each. Answers with exposure and gain of each frame.
pub fn photographs(
    body: &CameraBody,
    electrons: &Plane<Electrons>,
    frames: &Range<u32>,
    address: impl Fn(u32) -> FrameAddress,
    wanted: Wanted<'_>,
    results: &mut Results<'_>,
) -> Result<Vec<Value>, Failure> {
    let products = wanted.products;
    let mut points = Vec::new();
    if !(products.raw || products.picture || products.causes) {
        return Ok(points);
    }
    let step = if products.causes { take_with_causes } else { take };
    let mut state = SensorState::default();
    for number in frames.clone() {
        let Some((next, frame)) = step(body, state, electrons, address(number)) else { return Ok(points) };
        state = next;
        if !frame.raw.invalid.is_empty() {
            let count = frame.raw.invalid.len();
            tell(&format!("warning: frame {number}: {count} pixels have no valid light; their digital number is 0\n"));
        }
        let file = products.raw.then(|| Files::raw(number, products.raw_format));
        points.push(facts::frame(number, file, &frame.raw));
        self::frame(body, frame, address(number), wanted, results)?;
    }
    Ok(points)
}

/// Writes what is wanted of a frame.
fn frame(
    body: &CameraBody,
    frame: Frame,
    address: FrameAddress,
    wanted: Wanted<'_>,
    results: &mut Results<'_>,
) -> Result<(), Failure> {
    let (products, number) = (wanted.products, address.frame);
    if products.raw {
        let bytes = match products.raw_format {
            RawFormat::Dng => dng(body, &frame.raw, wanted.camera),
            format => encoded_raw(&frame.raw, &frame.raw.plane, format),
        };
        results.write(&Files::raw(number, products.raw_format), bytes)?;
    }
    if let Some(causes) = &frame.causes {
        let facts = Provenance { frame: number.into(), ..wanted.facts.clone() };
        results.write(&Files::causes(number), encode_causes(causes, &facts))?;
    }
    if let Some((picture, development)) = frame.picture.filter(|_| products.picture).zip(body.development.as_ref()) {
        let name = Files::picture(number, development.format);
        results.write(&name, encoded(&picture.display, development))?;
        if let Some(twin) = wanted.undistorted {
            let display = twin.picture(body, &picture.linear, address).expect("a picture was developed");
            results.write(&Files::undistorted(&name), encoded(&display, development))?;
        }
    }
    Ok(())
}

/// Digital numbers of a raw without its facts: TIFF or PNG.
pub fn encoded_raw(raw: &Raw, plane: &Plane<DigitalNumber>, format: RawFormat) -> Result<Vec<u8>, EncodeError> {
    match format {
        RawFormat::Tiff => tiff::encode_raw_tiff(plane, raw.bits),
        RawFormat::Png | RawFormat::Dng if raw.companding.is_some() => png::encode_companded16(plane),
        RawFormat::Png | RawFormat::Dng => png::encode_raw16(plane),
    }
}

fn encode_causes(causes: &Causes, facts: &Provenance) -> Result<Vec<u8>, EncodeError> {
    let layers: Vec<_> = Cause::ALL
        .iter()
        .map(|cause| (cause.name().to_owned(), exr::Layer::Float(causes.layer(*cause).samples())))
        .collect();
    let signal = causes.layer(Cause::Signal);
    exr::encode_layers(signal.width(), signal.height(), &layers, facts)
}

fn dng(body: &CameraBody, raw: &Raw, camera: &str) -> Result<Vec<u8>, EncodeError> {
    let colour = body.sensor.as_ref().and_then(RawColour::of).expect("a compiled plan asks for DNG where it can be");
    let area = raw.picture;
    let facts = DngFacts {
        camera: camera.to_owned(),
        software: format!("etendue {}", facts::VERSION),
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
