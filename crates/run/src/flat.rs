//! Uniform illumination on a camera's bare sensor.

use crate::result_files::ResultFiles;
use crate::results::frames::{FrameProducts, encoded_raw, frames, write_frames};
use crate::results::metadata;
use crate::results::writer::ResultWriter;
use clap::{ArgMatches, Args, Command, FromArgMatches};
use etendue_arguments::{integer, seed};
use etendue_core::observer::{Message, Observer};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::failure::{check_integer, check_number};
use etendue_io::paths::camera_stem;
use etendue_io::{ExistingFiles, OutputFolder, Provenance};
use etendue_pipeline::flat::{self, FlatLight, FrameStack, PhotonTransfer};
use etendue_pipeline::plan::{CameraBody, Products, default_raw_format};
use etendue_plan_report::camera_facts;
use etendue_plan_report::open_camera;
use etendue_sensor::{CaptureLight, FrameAddress, Sensor, SensorState};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

/// Name of the descriptor file that the reference program of EMVA 1288 reads.
const DESCRIPTOR: &str = "emva1288.txt";

/// Index of the camera: the only one.
const CAMERA: u32 = 0;

/// Largest float up to which electrons are whole numbers, 2⁵³.
const MAX_E: f32 = 9_007_199_254_740_992.0;

/// Uniform illumination, or a series of it.
#[derive(Clone, Debug, PartialEq)]
pub enum FlatSource {
    /// Irradiance of the sensor, W/m², 0 or more; 0 is dark.
    Irradiance {
        /// W/m².
        w_m2: f64,
    },
    /// Photons on the full area of a pixel over the exposure, 0 or more; 0 is dark.
    Photons {
        /// Photons per pixel.
        per_pixel: f64,
    },
    /// The series of EMVA 1288: `levels` exposures up to the camera's, at which the light just saturates, with two bright and two dark frames each; then a
    /// stack of `stack` frames at half of saturation and one in the dark.
    PhotonTransfer {
        /// Number of exposures, 3 or more.
        levels: u32,
        /// Frames of each stack, 3 or more.
        stack: u32,
    },
}

/// Wavelengths of the light, nm.
const WAVELENGTHS_NM: RangeInclusive<f64> = 300.0..=1100.0;
/// Range of the number of exposures of a series, and of the frames of each stack.
const LEVELS: RangeInclusive<u32> = 3..=10_000;

/// Arguments of the light: one of three, and the stacks of the third.
#[derive(Args)]
struct FlatArguments {
    #[command(flatten)]
    brightness: Brightness,
    /// With --photon-transfer: frames of the stacks at half of saturation and in the dark
    #[arg(long, value_name = "N", default_value_t = 100, conflicts_with_all = ["irradiance_w_m2", "photons"])]
    #[arg(value_parser = integer(LEVELS))]
    stack: u32,
}

/// Level of the uniform illumination.
#[derive(Args)]
#[group(required = true, multiple = false)]
struct Brightness {
    /// Irradiance of the sensor, W/m²; 0 is dark
    #[arg(long, value_name = "E", value_parser = irradiance_w_m2, allow_negative_numbers = true)]
    irradiance_w_m2: Option<f64>,
    /// Photons of that wavelength on the full area of a pixel over the exposure, instead of the irradiance; 0 is dark
    #[arg(long, value_name = "N", value_parser = photons, allow_negative_numbers = true)]
    photons: Option<f64>,
    /// The series of EMVA 1288 instead: number of exposures up to the camera's exposure_s, at which the light just saturates, with two bright and two dark
    /// frames each; then a stack at half of saturation and one in the dark
    #[arg(long, value_name = "LEVELS", value_parser = integer(LEVELS), allow_negative_numbers = true)]
    photon_transfer: Option<u32>,
}

impl From<FlatArguments> for FlatSource {
    fn from(FlatArguments { brightness, stack }: FlatArguments) -> Self {
        match (brightness.photon_transfer, brightness.photons) {
            (Some(levels), _) => Self::PhotonTransfer { levels, stack },
            (None, Some(per_pixel)) => Self::Photons { per_pixel },
            (None, None) => Self::Irradiance { w_m2: brightness.irradiance_w_m2.unwrap_or(0.0) },
        }
    }
}

impl FromArgMatches for FlatSource {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        FlatArguments::from_arg_matches(matches).map(Self::from)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for FlatSource {
    fn augment_args(command: Command) -> Command {
        FlatArguments::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        FlatArguments::augment_args_for_update(command)
    }
}

fn wavelength_nm(text: &str) -> Result<f64, String> {
    let nm = text.parse().ok().filter(|nm| WAVELENGTHS_NM.contains(nm));
    nm.ok_or_else(|| format!("expected a wavelength of 300 to 1100 nm, not '{text}'"))
}

fn irradiance_w_m2(text: &str) -> Result<f64, String> {
    let e = text.parse().ok().filter(|e: &f64| e.is_finite() && *e >= 0.0);
    e.ok_or_else(|| format!("expected an irradiance of 0 W/m² or more, not '{text}'"))
}

fn photons(text: &str) -> Result<f64, String> {
    let n = text.parse().ok().filter(|n: &f64| n.is_finite() && *n >= 0.0);
    n.ok_or_else(|| format!("expected 0 photons per pixel or more, not '{text}'"))
}

/// Uniform monochromatic illumination on a camera's bare sensor.
#[derive(Args, Clone, Debug)]
pub struct FlatRequest {
    /// The camera file (TOML); its lens is ignored
    #[arg(value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Wavelength of the light, nm
    #[arg(long, value_name = "NM", value_parser = wavelength_nm, allow_negative_numbers = true)]
    pub wavelength_nm: f64,
    /// Level of the light.
    #[command(flatten)]
    pub source: FlatSource,
    /// Frames to take, first to last (the last excluded); each has its own sensor noise
    #[arg(long, value_name = "A..B", value_parser = etendue_arguments::frames, default_value = "0..1", conflicts_with = "photon_transfer")]
    pub frames: Range<u32>,
    /// Write the components of each pixel's digital number
    #[arg(long, conflicts_with = "photon_transfer")]
    pub signal_breakdown: bool,
    /// Change a key of the camera file, e.g. --set sensor.exposure_s=0.002
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed of the sensor's noise [default: 0]
    #[arg(long, value_name = "N", value_parser = seed, default_value_t = 0, hide_default_value = true)]
    pub seed: u64,
}

impl FlatRequest {
    /// One frame with seed 0.
    pub fn new(camera: impl Into<PathBuf>, wavelength_nm: f64, source: FlatSource) -> Self {
        let camera = camera.into();
        Self { camera, set: Vec::new(), wavelength_nm, source, frames: 0..1, signal_breakdown: false, seed: 0 }
    }
}

impl FlatRequest {
    fn check(&self) -> Result<(), Error> {
        check_number("wavelength_nm", self.wavelength_nm, WAVELENGTHS_NM, "nm")?;
        match self.source {
            FlatSource::Irradiance { w_m2 } => check_number("irradiance_w_m2", w_m2, 0.0..=f64::MAX, "W/m²"),
            FlatSource::Photons { per_pixel } => {
                check_number("photons", per_pixel, 0.0..=f64::MAX, "photons per pixel")
            }
            FlatSource::PhotonTransfer { levels, stack } => {
                check_integer("photon_transfer", levels, LEVELS)?;
                check_integer("stack", stack, LEVELS)
            }
        }
    }
}

/// Captures uniform illumination with a camera's bare sensor, or the measurement series of EMVA 1288. Nothing is traced. Writes into a
/// folder and returns the paths of the files. Runs on the caller's thread pool.
///
/// # Errors
/// The camera has no electronics, the light exceeds the countable range, or the folder cannot be written.
pub fn flat(
    request: &FlatRequest,
    folder: &Path,
    existing: ExistingFiles,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    request.check()?;
    let body = body(request)?;
    let name = camera_stem(&request.camera);
    let mut folder = OutputFolder::open_part(folder, &name, existing).map_err(Error::input)?;
    let task = FlatRun { request, body: &body, sensor: body.sensor.as_ref().expect("checked above"), observer };
    let mut writer = ResultWriter { prefix: name, folder: &mut folder };
    match request.source {
        FlatSource::PhotonTransfer { levels, stack } => {
            let series = flat::photon_transfer(task.sensor, request.wavelength_nm, levels, stack).map_err(|error| {
                Error::coded(ErrorCode::UnsuitableFile, format!("{}: {error}", request.camera.display()))
            })?;
            let frames = series.stacks.iter().flat_map(|stack| stack.frames.clone()).map(|n| task.file(n));
            let mut files = frames.chain([DESCRIPTOR.to_owned(), ResultFiles::SIDECAR.to_owned()]);
            files.try_for_each(|file| writer.check_absent(&file))?;
            task.series(&series, &mut writer)?;
        }
        FlatSource::Irradiance { w_m2 } => {
            let light = FlatLight { wavelength_nm: request.wavelength_nm, irradiance_w_m2: w_m2 };
            task.single(light, &format!("`irradiance_w_m2` {w_m2:e}"), &mut writer)?;
        }
        FlatSource::Photons { per_pixel } => {
            let light = FlatLight::from_photons(task.sensor, request.wavelength_nm, per_pixel).map_err(|error| {
                Error::argument("photons", format!("`photons` {per_pixel}: {error}")).with_code(ErrorCode::OutOfRange)
            })?;
            task.single(light, &format!("`photons` {per_pixel:e}"), &mut writer)?;
        }
    }
    folder.commit().map_err(Error::run)
}

fn body(request: &FlatRequest) -> Result<CameraBody, Error> {
    let body = open_camera(&request.camera, &request.set)?;
    let absent_reason = || {
        Error::coded(
            ErrorCode::MissingKey,
            format!("{}: the sensor has no electronics: add them", request.camera.display()),
        )
    };
    flat::bare(&body).ok_or_else(absent_reason)
}

/// The request with the compiled camera and its output.
struct FlatRun<'a> {
    request: &'a FlatRequest,
    body: &'a CameraBody,
    sensor: &'a Sensor,
    observer: &'a dyn Observer,
}

impl FlatRun<'_> {
    fn products(&self) -> Products {
        Products {
            raw: true,
            raw_format: default_raw_format(Some(self.sensor)),
            signal_breakdown: self.request.signal_breakdown,
            picture: self.body.development.is_some(),
            ..Products::default()
        }
    }

    fn file(&self, frame: u32) -> String {
        ResultFiles::raw(frame, self.products().raw_format)
    }

    fn seed(&self) -> u64 {
        self.request.seed
    }

    fn address(&self, frame: u32) -> FrameAddress {
        FrameAddress { seed: self.seed(), camera: CAMERA, frame, capture: 0 }
    }

    /// Single frames of one light; `given` is its description in the facts.
    fn single(&self, light: FlatLight, key: &str, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let files = ResultFiles::for_products(&self.products(), self.body, &self.request.frames);
        files
            .keys()
            .map(String::as_str)
            .chain([ResultFiles::SIDECAR])
            .try_for_each(|file| writer.check_absent(file))?;
        let electrons = flat::electrons(self.body, light).expect("it has electronics");
        if let Some(electrons_e) = electrons.samples().iter().find(|e| **e > MAX_E) {
            let why = format!(
                "gives {electrons_e:.1e} electrons per pixel, but at most {MAX_E:.0e} can be counted: give less light"
            );
            return Err(Error::coded(ErrorCode::OutOfRange, format!("{key}: {why}")));
        }
        let (products, facts, camera) = (self.products(), self.provenance(writer), writer.prefix.clone());
        let frame_products = FrameProducts {
            products: &products,
            camera: &camera,
            facts: &facts,
            undistorted: None,
            one_by_one: false,
            observer: self.observer,
        };
        let steady = CaptureLight::steady(&electrons);
        let (numbers, before) = (self.request.frames.clone(), SensorState::default());
        let captured = frames(self.body, steady, numbers, before, |n| self.address(n), products.signal_breakdown);
        let points = write_frames(self.body, captured, |n| self.address(n), frame_products, writer)?;
        let mut facts = self.sidecar(light);
        facts["light"]["photons_per_pixel"] =
            flat::photons(self.sensor, light, self.sensor.parameters().exposure.exposure_s).into();
        facts["files"] = json!(files);
        facts["frames"] = points.into();
        writer.json(ResultFiles::SIDECAR, &facts)
    }

    /// The series of EMVA 1288.
    fn series(&self, series: &PhotonTransfer, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let channels = self.sensor.parameters().channels.len();
        if channels > 1 {
            let sentence = format!("the sensor has {channels} channels: measure each separately");
            self.observer.message(Message::Warning(&sentence));
        }
        let (mut columns, mut rows) = (0, 0);
        for stack in &series.stacks {
            (columns, rows) = self.stack(stack, series.light, writer)?;
        }
        writer.write(DESCRIPTOR, Ok(self.descriptor(series, columns, rows).into_bytes()))?;
        let mut facts = self.sidecar(series.light);
        let stack = |s: &FrameStack| json!({ "exposure_s": s.exposure_s, "photons_per_pixel": s.photons, "frames": [s.frames.start, s.frames.end] });
        facts["stacks"] = series.stacks.iter().map(stack).collect();
        writer.json(ResultFiles::SIDECAR, &facts)
    }

    /// Writes the frames of a stack; returns their size.
    fn stack(
        &self,
        stack: &FrameStack,
        light: FlatLight,
        writer: &mut ResultWriter<'_>,
    ) -> Result<(usize, usize), Error> {
        let light_factor = f64::from(u8::from(stack.photons > 0.0));
        let light = FlatLight { irradiance_w_m2: light_factor * light.irradiance_w_m2, ..light };
        let electrons = flat::electrons(self.body, light).expect("it has electronics");
        let (mut state, mut size) = (SensorState::default(), (0, 0));
        for number in stack.frames.clone() {
            let begun = stack.state(self.sensor, state);
            let (next, raw) = self.sensor.step(begun, &electrons, self.address(number));
            state = next;
            let plane = raw.linear().plane;
            size = (plane.width(), plane.height());
            let products = self.products();
            writer.write(&self.file(number), encoded_raw(&raw, &plane, products.raw_format))?;
        }
        Ok(size)
    }

    /// The series in the format of the reference program: `n` bits, columns, rows; `b` exposure in ns, photons per pixel; `d` exposure in the dark; `i` a
    /// file.
    fn descriptor(&self, series: &PhotonTransfer, columns: usize, rows: usize) -> String {
        let mut text = format!("v 4.0\nn {} {columns} {rows}\n", self.sensor.delivered_bits());
        for stack in &series.stacks {
            let exposure_ns = 1e9 * stack.exposure_s;
            let head = match stack.photons {
                0.0 => format!("d {exposure_ns:.3}"),
                photons => format!("b {exposure_ns:.3} {photons:.6}"),
            };
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{head}");
            stack.frames.clone().for_each(|n| text += &format!("i {}\n", self.file(n)));
        }
        text
    }

    fn provenance(&self, writer: &ResultWriter<'_>) -> Provenance {
        Provenance {
            plan_hash: String::new(),
            seed: self.seed(),
            version: metadata::VERSION.to_owned(),
            camera: writer.prefix.clone(),
            frame: 0,
            time_s: 0.0,
            geometry: "uniform illumination of the bare sensor, pixel centres at +0.5, x right, y down".to_owned(),
            camera_to_world: None,
            further: BTreeMap::new(),
        }
    }

    fn sidecar(&self, light: FlatLight) -> Value {
        json!({
            "program": "etendue",
            "version": metadata::VERSION,
            "seed": self.seed(),
            "camera_index": CAMERA,
            "light": {
                "wavelength_nm": light.wavelength_nm,
                "irradiance_w_m2": light.irradiance_w_m2,
                "convention": "uniform monochromatic illumination of the bare sensor, along its normal; photons on the full area of a pixel",
            },
            "sensor": camera_facts::sensor(self.body),
        })
    }
}
