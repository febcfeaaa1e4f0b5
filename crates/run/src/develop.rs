//! Develops raws captured earlier, with a camera file's processing.

use crate::result_files::ResultFiles;
use crate::results::frames::encode_picture;
use crate::results::metadata;
use crate::results::writer::ResultWriter;
use clap::Args;
use etendue_arguments::seed;
use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::paths::camera_stem;
use etendue_io::photograph::{FilterTile, Photograph, RawFacts, RawFrame, read_photograph};
use etendue_io::{ExistingFiles, OutputFolder};
use etendue_pipeline::photograph::{DevelopmentResult, developed};
use etendue_pipeline::plan::{CameraBody, Development};
use etendue_plan_report::{camera_facts, open_camera};
use etendue_sensor::layout::Region;
use etendue_sensor::{FrameAddress, OperatingPoint, Raw, Sensor};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Stored raws and the camera whose processing develops them.
#[derive(Args, Clone, Debug)]
pub struct DevelopRequest {
    /// Raws (PNG, TIFF, DNG), each with its side-car camera.json in the same folder
    #[arg(required = true, value_name = "RAW")]
    pub raws: Vec<PathBuf>,
    /// The camera file (TOML) with the sensor of the raws and the processing
    #[arg(long, value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set isp.demosaic=malvar
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// For raws without a side-car: black level and saturation level, DN, e.g. 64..4095
    #[arg(long, value_name = "BLACK..WHITE")]
    pub levels: Option<RawLevels>,
    /// Seed of the noise of the image filters [default: that of the side-car, or 0]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
}

impl DevelopRequest {
    /// Raws with their side-cars, and an unchanged camera file.
    pub fn new(raws: Vec<PathBuf>, camera: impl Into<PathBuf>) -> Self {
        Self { raws, camera: camera.into(), set: Vec::new(), levels: None, seed: None }
    }
}

/// Develops raws and writes the images into a folder; returns their paths. Runs on the caller's thread pool.
///
/// # Errors
/// The camera or the raws cannot be used or contradict each other, or the folder cannot be written.
pub fn develop(request: &DevelopRequest, folder: &Path, existing: ExistingFiles) -> Result<Vec<PathBuf>, Error> {
    let body = open_camera(&request.camera, &request.set)?;
    let camera = RawCamera::new(&body).ok_or_else(|| {
        let file = request.camera.display();
        Error::coded(
            ErrorCode::MissingKey,
            format!("{file}: the camera has no [isp], so the image processing is not defined: add it"),
        )
    })?;
    let name = camera_stem(&request.camera);
    let mut folder = OutputFolder::open_part(folder, &name, existing).map_err(Error::input)?;
    let mut writer = ResultWriter { prefix: name, folder: &mut folder };
    writer.check_absent(ResultFiles::DEVELOPMENT)?;
    develop_all(&camera, request, &mut writer)?;
    folder.commit().map_err(Error::run)
}

/// A camera with processing.
struct RawCamera<'a> {
    body: &'a CameraBody,
    sensor: &'a Sensor,
    development: &'a Development,
}

impl<'a> RawCamera<'a> {
    fn new(body: &'a CameraBody) -> Option<Self> {
        Some(Self { body, sensor: body.sensor.as_ref()?, development: body.development.as_ref()? })
    }
}

fn develop_all(camera: &RawCamera<'_>, request: &DevelopRequest, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
    let (mut frames, mut files, mut correlated_block_px) = (Vec::new(), Map::new(), 1);
    for (number, file) in request.raws.iter().enumerate() {
        let mut stored = read_raw(file, request.levels, number as u32, camera.body, camera.sensor)
            .map_err(|words| Error::coded(ErrorCode::UnsuitableFile, words))?;
        correlated_block_px = correlated_block_px.max(stored.correlated_block_px);
        stored.address.seed = request.seed.unwrap_or(stored.address.seed);
        let name = ResultFiles::picture(stored.address.frame, camera.development.format);
        if files.contains_key(&name) {
            let problem = format!(
                "{}: another raw is also frame {}: develop them separately",
                file.display(),
                stored.address.frame
            );
            return Err(Error::coded(ErrorCode::Duplicate, problem));
        }
        writer.check_absent(&name)?;
        let image = developed(camera.development, &stored.raw, stored.address)
            .map_err(|error| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {error}", file.display())))?;
        writer.write(&name, encode_picture(&image.display, camera.development))?;
        frames.push(frame(file, &stored, &image));
        files.insert(name, ResultFiles::picture_entry(camera.development));
    }
    let facts = json!({
        "program": "etendue",
        "version": metadata::VERSION,
        "sensor": camera_facts::sensor(camera.body),
        "isp": camera.development.to_string(),
        "frames": frames,
        "sampling": { "correlated_block_px": correlated_block_px },
        "files": files,
    });
    writer.json(ResultFiles::DEVELOPMENT, &facts)
}

/// Returns the metadata of a developed raw.
fn frame(file: &Path, stored: &StoredRaw, image: &DevelopmentResult) -> Value {
    json!({
        "frame": stored.address.frame,
        "raw": file.file_name().map(|name| name.to_string_lossy()),
        "seed": stored.address.seed,
        "black_level_dn": image.report.black_level_dn,
        "white_level_dn": stored.raw.linear().white_level_dn,
        "white_balance": image.report.white_balance,
        "corrected_pixels": image.report.corrected_pixels,
    })
}

/// Black and white level of a raw without a side-car, DN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RawLevels {
    /// Black level, DN.
    pub black_dn: f64,
    /// Saturation level, DN.
    pub white_dn: f64,
}

/// `BLACK..WHITE`.
impl FromStr for RawLevels {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("expected BLACK..WHITE with BLACK < WHITE, e.g. 64..4095, not '{text}'");
        let (black, white) = text.split_once("..").ok_or_else(expected)?;
        let number = |s: &str| s.trim().parse::<f64>().map_err(|_| expected());
        let (black_dn, white_dn) = (number(black)?, number(white)?);
        let legal = black_dn >= 0.0 && black_dn < white_dn && white_dn.is_finite();
        legal.then_some(Self { black_dn, white_dn }).ok_or_else(expected)
    }
}

/// A raw read from a file, with the facts of its side-car.
#[derive(Clone, Debug)]
struct StoredRaw {
    /// Digital numbers with their metadata.
    raw: Raw,
    /// Address of the frame (job, camera, frame number).
    address: FrameAddress,
    /// Number of pixels of a block whose errors may be correlated.
    correlated_block_px: u32,
}

/// Reads a raw of a camera. Without a side-car `levels` are required, and the raw is frame `number`.
fn read_raw(
    file: &Path,
    levels: Option<RawLevels>,
    number: u32,
    body: &CameraBody,
    sensor: &Sensor,
) -> Result<StoredRaw, String> {
    let image = read_photograph(file).map_err(|error| error.to_string())?;
    let stored = match (&image.raw, levels) {
        (None, Some(levels)) => from_levels(&image, levels, number, sensor),
        (Some(_), Some(_)) => Err("camera.json next to it states its levels: omit `levels`".to_owned()),
        (Some(facts), None) => from_sidecar(&image, facts, sensor),
        (None, None) => {
            Err("no camera.json next to it lists it as raw, so its levels are unknown: put the side-car next to it, \
                             or give `levels` BLACK..WHITE"
                .to_owned())
        }
    };
    stored.and_then(|stored| check_size(stored, body, sensor)).map_err(|why| format!("{}: {why}", file.display()))
}

fn from_levels(image: &Photograph, levels: RawLevels, number: u32, sensor: &Sensor) -> Result<StoredRaw, String> {
    if sensor.parameters().hdr.companding.is_some() {
        return Err(
            "the camera's digital numbers are companded, but `levels` applies to linear ones: a raw of this camera \
                    needs its side-car"
                .to_owned(),
        );
    }
    let p = sensor.parameters();
    let point = OperatingPoint { exposure_s: p.exposure.exposure_s, analogue_gain: p.read_out.analogue_gain };
    let area_px = [0, 0, image.width, image.height];
    let raw = raw(numbers(image)?, [levels.black_dn, levels.white_dn], area_px, point, sensor);
    Ok(StoredRaw {
        raw,
        address: FrameAddress { seed: 0, camera: 0, frame: number, capture: 0 },
        correlated_block_px: image.correlated_block_px,
    })
}

fn from_sidecar(image: &Photograph, facts: &RawFacts, sensor: &Sensor) -> Result<StoredRaw, String> {
    let former = "camera.json next to it is from an earlier version and does not state the frame number: render again";
    let frame = facts.frame.as_ref().ok_or(former)?;
    check_filters(&facts.filters, sensor)?;
    check_companding(frame, sensor)?;
    let plane = numbers(image)?;
    if let Some(dn) = plane.samples().iter().find(|dn| u64::from(**dn) >> frame.bits.min(63) != 0) {
        return Err(format!(
            "it contains the number {dn}, which exceeds the {} bits that camera.json states",
            frame.bits
        ));
    }
    let point = OperatingPoint { exposure_s: facts.exposure_s, analogue_gain: 1.0 };
    let raw = raw(plane, [facts.black_level_dn, facts.white_level_dn], frame.picture_px, point, sensor);
    let RawFrame { seed, camera_index: camera, number: frame, .. } = *frame;
    Ok(StoredRaw {
        raw,
        address: FrameAddress { seed, camera, frame, capture: 0 },
        correlated_block_px: image.correlated_block_px,
    })
}

fn raw(
    plane: Plane<DigitalNumber>,
    [black_level_dn, white_level_dn]: [f64; 2],
    [x, y, width, height]: [usize; 4],
    operating_point: OperatingPoint,
    sensor: &Sensor,
) -> Raw {
    Raw {
        plane,
        black_level_dn,
        white_level_dn,
        bits: sensor.delivered_bits(),
        companding: sensor.parameters().hdr.companding.clone(),
        image: Region { x, y, width, height },
        operating_point,
        accounts: Vec::new(),
        invalid: Vec::new(),
    }
}

/// Digital numbers of a single-channel image.
fn numbers(image: &Photograph) -> Result<Plane<DigitalNumber>, String> {
    let ([channel], Some(_)) = (&image.channels[..], image.full_scale) else {
        let names = image.names().join(", ");
        return Err(format!("a raw is a greyscale image of whole numbers (PNG, TIFF, DNG); this one has {names}"));
    };
    // Floats represent whole numbers exactly up to here.
    const MAX_SAMPLES: f32 = 16_777_215.0;
    if let Some(beyond) = channel.samples.iter().find(|v| **v > MAX_SAMPLES) {
        return Err(format!("it contains the number {beyond}, which exceeds the 24 bits of raws"));
    }
    let samples = channel.samples.iter().map(|v| *v as u32).collect();
    Ok(Plane::from_samples(image.width, image.height, samples).expect("as many samples as pixels"))
}

fn check_filters(raw_filters: &FilterTile, sensor: &Sensor) -> Result<(), String> {
    let p = sensor.parameters();
    let names = p.cfa.channels().iter().map(|channel| p.channels[*channel].name.clone());
    let own = FilterTile { columns: p.cfa.width(), channels: names.collect() };
    let words = |tile: &FilterTile| format!("{} in {} columns", tile.channels.join(" "), tile.columns);
    if own == *raw_filters {
        return Ok(());
    }
    let (raw_words, own) = (words(raw_filters), words(&own));
    Err(format!(
        "its colour filters are {raw_words} in camera.json, but {own} in the camera file: give the camera that captured it"
    ))
}

fn check_companding(frame: &RawFrame, sensor: &Sensor) -> Result<(), String> {
    let own = sensor.parameters().hdr.companding.as_ref().map(|companding| &companding.knees);
    if own == frame.companding_knees_dn.as_ref() && frame.bits == sensor.delivered_bits() {
        return Ok(());
    }
    Err("bits or companding differ between camera.json next to it and the camera file: give the camera that captured it"
        .to_owned())
}

/// Refuses a raw whose size differs from the camera's.
fn check_size(stored: StoredRaw, body: &CameraBody, sensor: &Sensor) -> Result<StoredRaw, String> {
    let (Region { x, y, width, height }, plane) = (stored.raw.image, &stored.raw.plane);
    let inside = |from: usize, length: usize, all: usize| from.checked_add(length).is_some_and(|end| end <= all);
    if !(inside(x, width, plane.width()) && inside(y, height, plane.height())) {
        return Err(format!(
            "camera.json next to it states an image of {width} × {height} pixels at column {x}, row {y}, but the raw has {} × {}",
            plane.width(),
            plane.height()
        ));
    }
    let own = sensor.image_size(body.raster.width(), body.raster.height());
    if own != (width, height) {
        return Err(format!(
            "its image has {width} × {height} pixels, but that of the camera file {} × {}",
            own.0, own.1
        ));
    }
    Ok(stored)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_a_range() {
        let levels = |text: &str| text.parse::<RawLevels>();
        assert_eq!(levels("63.5..4095"), Ok(RawLevels { black_dn: 63.5, white_dn: 4095.0 }));
        assert!(["64", "5..5", "-1..5", "0..inf", "a..b"].iter().all(|text| levels(text).is_err()));
    }
}
