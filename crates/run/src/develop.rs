//! Pictures of raws that were taken before, by a camera file's processing.

use crate::raw_file::{Levels, Taken, taken};
use crate::result_files::Files;
use crate::results::frames::encoded;
use crate::results::metadata;
use crate::results::writer::ResultWriter;
use clap::Args;
use etendue_arguments::seed;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::paths::camera_stem;
use etendue_io::{Existing, OutputFolder};
use etendue_pipeline::photograph::{Developed, developed};
use etendue_pipeline::plan::{CameraBody, Development};
use etendue_plan_report::camera_facts;
use etendue_plan_report::open_camera;
use etendue_sensor::Sensor;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// Stored raws and the camera whose processing makes pictures of them.
#[derive(Args, Clone, Debug)]
pub struct DevelopRequest {
    /// Raws (PNG, TIFF, DNG), each with its side-car camera.json beside it
    #[arg(required = true, value_name = "RAW")]
    pub raws: Vec<PathBuf>,
    /// The camera file (TOML) whose sensor took them and whose processing makes the pictures
    #[arg(long, value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set isp.demosaic=malvar
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// For raws without a side-car: digital numbers of no light and of a saturated pixel, e.g. 64..4095
    #[arg(long, value_name = "BLACK..WHITE")]
    pub levels: Option<Levels>,
    /// The seed of the paper's noises [default: that of the side-car, or 0]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
}

impl DevelopRequest {
    /// Raws with their side-cars, by a camera file as it is.
    pub fn new(raws: Vec<PathBuf>, camera: impl Into<PathBuf>) -> Self {
        Self { raws, camera: camera.into(), set: Vec::new(), levels: None, seed: None }
    }
}

/// Makes pictures of raws; writes them into a folder and answers with their paths. Runs on the caller's thread pool.
///
/// # Errors
/// Where camera or raws cannot be used or contradict each other, or the folder cannot be written.
pub fn develop(request: &DevelopRequest, folder: &Path, existing: Existing) -> Result<Vec<PathBuf>, Error> {
    let body = open_camera(&request.camera, &request.set)?;
    let camera = Camera::of(&body).ok_or_else(|| {
        let file = request.camera.display();
        Error::coded(
            ErrorCode::MissingKey,
            format!("{file}: the camera has no [isp], so nothing says how a picture is made: add it"),
        )
    })?;
    let name = camera_stem(&request.camera);
    let mut folder = OutputFolder::open_part(folder, &name, existing).map_err(Error::input)?;
    let mut writer = ResultWriter { prefix: name, folder: &mut folder };
    writer.claim(Files::DEVELOPMENT)?;
    all(&camera, request, &mut writer)?;
    folder.commit().map_err(Error::run)
}

/// A camera that makes pictures.
struct Camera<'a> {
    body: &'a CameraBody,
    sensor: &'a Sensor,
    development: &'a Development,
}

impl<'a> Camera<'a> {
    fn of(body: &'a CameraBody) -> Option<Self> {
        Some(Self { body, sensor: body.sensor.as_ref()?, development: body.development.as_ref()? })
    }
}

fn all(camera: &Camera<'_>, request: &DevelopRequest, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
    let (mut frames, mut files, mut correlated_block_px) = (Vec::new(), Map::new(), 1);
    for (number, file) in request.raws.iter().enumerate() {
        let mut taken = taken(file, request.levels, number as u32, camera.body, camera.sensor)
            .map_err(|words| Error::coded(ErrorCode::UnsuitableFile, words))?;
        correlated_block_px = correlated_block_px.max(taken.correlated_block_px);
        taken.address.seed = request.seed.unwrap_or(taken.address.seed);
        let name = Files::picture(taken.address.frame, camera.development.format);
        if files.contains_key(&name) {
            let told =
                format!("{}: another raw is frame {}, too: develop them apart", file.display(), taken.address.frame);
            return Err(Error::coded(ErrorCode::Duplicate, told));
        }
        writer.claim(&name)?;
        let picture = developed(camera.development, &taken.raw, taken.address)
            .map_err(|error| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {error}", file.display())))?;
        writer.write(&name, encoded(&picture.display, camera.development))?;
        frames.push(frame(file, &taken, &picture));
        files.insert(name, Files::picture_entry(camera.development));
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
    writer.json(Files::DEVELOPMENT, &facts)
}

/// What became of a raw.
fn frame(file: &Path, taken: &Taken, picture: &Developed) -> Value {
    json!({
        "frame": taken.address.frame,
        "raw": file.file_name().map(|name| name.to_string_lossy()),
        "seed": taken.address.seed,
        "black_level_dn": picture.facts.black_level_dn,
        "white_level_dn": taken.raw.linear().white_level_dn,
        "white_balance": picture.facts.white_balance,
        "corrected_pixels": picture.facts.corrected_pixels,
    })
}
