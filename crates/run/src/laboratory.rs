//! A rendered laboratory folder: the input of the verb `characterise`, captured by a camera with a known file.
//!
//! | folder | images |
//! | --- | --- |
//! | `flat/` | 550 nm, uniform, on the bare sensor: levels in equal steps to just above saturation, two frames each, and a stack at half of it (EMVA 1288) |
//! | `dark/` | the same without light, and three long exposures, the longest with a dark current of 200 e⁻ |
//! | `field/` | a uniform white sheet through the lens |
//! | `chart/` | hand-held views of a checkerboard, the first nearly perpendicular to it, the others tilted |
//! | `edges/` | slanted edges |
//! | `checker/` | a ColorChecker, of colour cameras |
//!
//! The camera is written next to them as `declared.toml`, without keys that change the exposure from frame to frame; `laboratory.toml` states the flat light.
//! Exposures of the flat series are so short that dark current adds less than half an electron to the offsets.

use crate::chart::design::{Checkerboard, ColorChecker, FlatField, GridSize, SlantedEdges};
use crate::chart::{Chart, ChartRequest, make};
use crate::flat::{FlatRequest, FlatSource, flat};
use crate::job_request::JobRequest;
use crate::job_request::RenderOptions;
use crate::result_files::write_file;
use clap::Args;
use etendue_arguments::{integer, seed};
use etendue_core::observer::Observer;
use etendue_io::failure::check_integer;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::read_text;
use etendue_io::{ExistingFiles, load_assets};
use etendue_pipeline::compile_camera;
use etendue_pipeline::flat::{FlatLight, PhotonTransfer, bare, photon_transfer, photons};
use etendue_pipeline::plan::CameraBody;
use etendue_scene::record::Camera;
use etendue_scene::record::laboratory::FlatLight as StatedLight;
use etendue_scene::record::sensor::charge::NonUniformity;
use etendue_scene::written::File;
use etendue_scene::{Overrides, load_camera, named_files, record};
use etendue_sensor::Sensor;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

const WAVELENGTH_NM: f64 = 550.0;
/// Dark-current electrons in the longest exposure of the flat series, and in the longest dark exposure.
const MIN_DARK_E: f64 = 0.25;
const MAX_DARK_E: f64 = 200.0;
/// Long dark exposures as fractions of the longest, and frames of each.
const LONG_EXPOSURE_RATIO: [f64; 3] = [0.25, 0.5, 1.0];
const LONG_FRAMES: u32 = 4;
/// Seed offset between exposures: their frames have independent noise.
const SEED_STRIDE: u64 = 1 << 20;
/// Minimum width of a checkerboard square seen from the front, px.
const SQUARE_PX: u32 = 24;
/// Minimum image width per column of slanted-edge squares, px; twice that for a mosaic.
const EDGES_PX: u32 = 64;
/// Height of a row of slanted-edge squares, in widths of a column.
const SQUARE_AND_MARGIN: f64 = 1.25;
const CAMERA_FILE: &str = "declared.toml";
const JOB: &str = "job.toml";

/// Ranges of levels, frames of a stack and views of a laboratory.
const LEVELS: RangeInclusive<u32> = 5..=1000;
const STACK: RangeInclusive<u32> = 3..=10_000;
const VIEWS: RangeInclusive<u32> = 3..=200;

/// `etendue laboratory`
#[derive(Args, Clone, Debug)]
pub struct LaboratoryRequest {
    /// The camera file (TOML)
    #[arg(value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set sensor.width_px=320
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed of all noise
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed)]
    pub seed: u64,
    /// Levels of uniform illumination on the bare sensor, up to slightly above saturation
    #[arg(long, value_name = "N", default_value_t = 15, value_parser = integer(LEVELS))]
    pub levels: u32,
    /// Frames of the stacks without light and at half of saturation
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = integer(STACK))]
    pub stack: u32,
    /// Views of the checkerboard
    #[arg(long, value_name = "N", default_value_t = 13, value_parser = integer(VIEWS))]
    pub views: u32,
    /// Samples per pixel of the images through the lens
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = integer(1..=65_536))]
    pub spp: u32,
}

impl LaboratoryRequest {
    /// A request with the default options of the program.
    pub fn new(camera: impl Into<PathBuf>) -> Self {
        Self { camera: camera.into(), set: Vec::new(), seed: 0, levels: 15, stack: 32, views: 13, spp: 64 }
    }
}

/// Captures a laboratory folder with a camera file; returns the paths of the files. Runs on the caller's thread pool.
///
/// # Errors
/// The camera has no electronics or is not linear, or the folder cannot be written.
pub fn laboratory(
    request: &LaboratoryRequest,
    folder: &Path,
    existing: ExistingFiles,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    check_integer("levels", request.levels, LEVELS)?;
    check_integer("stack", request.stack, STACK)?;
    check_integer("views", request.views, VIEWS)?;
    let camera = camera_with_changes(request)?;
    let has_frame_period = camera.sensor.electronics.as_ref().is_some_and(|e| e.frame_period_s.is_some());
    let has_isp = camera.isp.is_some();
    let body = compile_without_series(&camera)?;
    let declared = folder.join(CAMERA_FILE);
    let head = "The camera that captured this laboratory folder; no program reads this copy.";
    write_file(&declared, File::new(camera.to_table()).head(head).to_string().as_bytes(), existing)?;
    let sensor = bare(&body).and_then(|bare| bare.sensor).ok_or_else(|| missing_period(request))?;
    let bench = LaboratoryRun { request, folder, existing, camera_file: declared, has_frame_period, has_isp, observer };
    let mut files = vec![bench.camera_file.clone()];
    let series = bench.uniform_light(&sensor);
    // Without a series there is no laboratory.
    files.extend(series.inspect_err(|_| drop(std::fs::remove_file(&bench.camera_file)))?);
    files.extend(bench.long_exposures(sensor.parameters().charge.dark.mean_e_s())?);
    files.extend(bench.lens(sensor.parameters().channels.len() > 1, body.raster.width(), body.raster.height())?);
    Ok(files)
}

fn missing_period(request: &LaboratoryRequest) -> Error {
    Error::coded(
        ErrorCode::MissingKey,
        format!("{}: the sensor has no electronics: add them", request.camera.display()),
    )
}

/// The camera with the changes, a fixed unit number and a constant exposure. Paths of its files are absolute.
fn camera_with_changes(request: &LaboratoryRequest) -> Result<Camera, Error> {
    let file = request.camera.canonicalize();
    let file = file
        .map_err(|cause| Error::coded(ErrorCode::UnreadableFile, format!("{}: {cause}", request.camera.display())))?;
    let camera = load_camera(&file, &read_text, &Overrides::new(&request.set));
    let mut camera = camera.map_err(|errors| Error::inputs(errors.as_slice()))?;
    let electronics = camera.sensor.electronics.as_mut().ok_or_else(|| missing_period(request))?;
    electronics.auto_exposure = None;
    electronics.non_uniformity.get_or_insert_with(NonUniformity::default).seed.get_or_insert(1.into());
    Ok(camera)
}

fn compile_without_series(camera: &Camera) -> Result<CameraBody, Error> {
    let assets = load_assets(&named_files::camera_files(camera)).map_err(Error::inputs)?;
    compile_camera(camera, &assets).map_err(Error::inputs)
}

/// The laboratory's folder, camera and options.
struct LaboratoryRun<'a> {
    request: &'a LaboratoryRequest,
    folder: &'a Path,
    existing: ExistingFiles,
    camera_file: PathBuf,
    has_frame_period: bool,
    has_isp: bool,
    observer: &'a dyn Observer,
}

impl LaboratoryRun<'_> {
    /// Frames of uniform illumination, or dark frames.
    fn flat(
        &self,
        part: &str,
        exposure_s: f64,
        irradiance_w_m2: f64,
        frames: Range<u32>,
        seed: u64,
    ) -> Result<Vec<PathBuf>, Error> {
        let mut set = vec![format!("sensor.exposure_s={exposure_s:e}")];
        if self.has_isp {
            set.push("isp=null".to_owned());
        }
        if self.has_frame_period {
            set.push(format!("sensor.frame_period_s={:e}", 2.0 * exposure_s));
        }
        let source = FlatSource::Irradiance { w_m2: irradiance_w_m2 };
        let request = FlatRequest { set, frames, seed, ..FlatRequest::new(&self.camera_file, WAVELENGTH_NM, source) };
        flat(&request, &self.folder.join(part), self.existing, self.observer)
    }

    /// `flat/`, and the frames of `dark/` with the same exposures.
    fn uniform_light(&self, sensor: &Sensor) -> Result<Vec<PathBuf>, Error> {
        let PhotonTransfer { light, stacks } = self.series(sensor)?;
        let mut files = Vec::new();
        for (i, stack) in stacks.iter().enumerate() {
            let is_lit = stack.photons > 0.0;
            let part = format!("{}/{:02}", if is_lit { "flat" } else { "dark" }, i + 1);
            let irradiance_w_m2 = if is_lit { light.irradiance_w_m2 } else { 0.0 };
            files.extend(self.flat(
                &part,
                stack.exposure_s,
                irradiance_w_m2,
                stack.frames.clone(),
                self.request.seed,
            )?);
        }
        let photons_per_s = photons(sensor, light, 1.0);
        let flat_light = StatedLight::new(photons_per_s, WAVELENGTH_NM);
        let laboratory = record::Laboratory { flat: Some(flat_light), ..record::Laboratory::default() };
        let file = self.folder.join("laboratory.toml");
        write_file(&file, File::new(laboratory.to_table()).to_string().as_bytes(), self.existing)?;
        files.push(file);
        Ok(files)
    }

    /// The series of EMVA 1288, with exposures as short as the dark current requires.
    fn series(&self, sensor: &Sensor) -> Result<PhotonTransfer, Error> {
        let parameters = sensor.parameters();
        let longest_s = parameters.exposure.exposure_s.min(MIN_DARK_E / parameters.charge.dark.mean_e_s().max(1e-9));
        let scale = longest_s / parameters.exposure.exposure_s;
        let message = |error: etendue_pipeline::flat::FlatError| {
            Error::coded(ErrorCode::UnsuitableFile, format!("{}: {error}", self.request.camera.display()))
        };
        let series =
            photon_transfer(sensor, WAVELENGTH_NM, self.request.levels, self.request.stack).map_err(message)?;
        let light = FlatLight { irradiance_w_m2: series.light.irradiance_w_m2 / scale, ..series.light };
        let shorter = |stack: etendue_pipeline::flat::FrameStack| etendue_pipeline::flat::FrameStack {
            exposure_s: scale * stack.exposure_s,
            ..stack
        };
        Ok(PhotonTransfer { light, stacks: series.stacks.into_iter().map(shorter).collect() })
    }

    fn long_exposures(&self, dark_current_e_s: f64) -> Result<Vec<PathBuf>, Error> {
        let longest_s = MAX_DARK_E / dark_current_e_s.max(MAX_DARK_E);
        let longest_s = if dark_current_e_s > 0.0 { MAX_DARK_E / dark_current_e_s } else { longest_s };
        let mut files = Vec::new();
        for (i, fraction) in LONG_EXPOSURE_RATIO.iter().enumerate() {
            let first = i as u32 * LONG_FRAMES;
            let (part, frames) = (format!("dark/long-{}", i + 1), first..first + LONG_FRAMES);
            files.extend(self.flat(&part, fraction * longest_s, 0.0, frames, self.request.seed ^ SEED_STRIDE)?);
        }
        Ok(files)
    }

    /// Images through the lens.
    fn lens(&self, in_colour: bool, width_px: usize, height_px: usize) -> Result<Vec<PathBuf>, Error> {
        let open = GridSize { columns: None, rows: None, pitch_mm: None };
        // Regions around the edges of squares need 16 samples of a colour in each direction.
        let wide = (width_px as u32 / if in_colour { 2 * EDGES_PX } else { EDGES_PX }).clamp(1, 3);
        let squares = wide.max((SQUARE_AND_MARGIN * width_px as f64 / height_px as f64).ceil() as u32);
        let edges = SlantedEdges { size: GridSize { columns: Some(squares), ..open }, angle_deg: 5.0, contrast: 4.0 };
        // Tilted views are farther away: their squares are two thirds as large, and corners need 10 px between them.
        let columns = (width_px as u32 / SQUARE_PX).clamp(6, 12);
        let board = GridSize { columns: Some(columns), ..open };
        let mut charts: Vec<(&str, Chart, u32)> = vec![
            ("field", Chart::FlatField(FlatField { reflectance: 0.9 }), 1),
            ("chart", Chart::Checkerboard(Checkerboard { size: board }), self.request.views),
            ("edges", Chart::SlantedEdges(edges), 1),
        ];
        if in_colour {
            charts.push(("checker", ColorChecker.into(), 1));
        }
        let mut files = Vec::new();
        for (i, (name, chart, views)) in (2..).zip(charts) {
            files.extend(self.capture_chart(name, chart, views, self.request.seed ^ (i * SEED_STRIDE))?);
        }
        Ok(files)
    }

    fn capture_chart(&self, name: &str, chart: Chart, views: u32, seed: u64) -> Result<Vec<PathBuf>, Error> {
        let folder = self.folder.join(name);
        let camera = self.camera_file.display().to_string();
        let request = ChartRequest { views, hand_held: views > 1, seed, ..ChartRequest::new(chart, camera) };
        let mut files = make(&request, &folder, self.existing)?;
        let mut job = JobRequest::new(folder.join(JOB));
        job.set = vec![format!("render.spp={}", self.request.spp), "output.ground_truth=false".to_owned()];
        let render = folder.join("render");
        files.extend(job.open()?.save(&RenderOptions::default(), &render, self.existing, self.observer)?);
        Ok(files)
    }
}
