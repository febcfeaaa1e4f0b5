//! `etendue flat`: even light on a camera's bare sensor.

use crate::args::folder::Output;
use crate::args::run::{frames, seed, whole};
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, FlatRequest, FlatSource};
use std::path::PathBuf;

/// `etendue flat`
#[derive(Debug, Args)]
pub struct Flat {
    /// The camera file (TOML); its lens is taken off
    #[arg(value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Wavelength of the light, nm
    #[arg(long, value_name = "NM", value_parser = wavelength_nm, allow_negative_numbers = true)]
    pub wavelength_nm: f64,
    #[command(flatten)]
    pub light: FlatLight,
    /// With --photon-transfer: frames of the stacks at half of saturation and in the dark
    #[arg(long, value_name = "N", default_value_t = 100, conflicts_with_all = ["irradiance_w_m2", "photons"])]
    #[arg(value_parser = whole(3, 10_000))]
    pub stack: u32,
    /// Frames to take, first to last (the last excluded); each has its own sensor noise
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1", conflicts_with = "photon_transfer")]
    pub frames: std::ops::Range<u32>,
    /// Write what each pixel's digital number is made of
    #[arg(long, conflicts_with = "photon_transfer")]
    pub signal_breakdown: bool,
    /// Change a key of the camera file, e.g. --set sensor.exposure_s=0.002
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// The seed of the sensor's noise [default: 0]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
    #[command(flatten)]
    pub output: Output,
}

/// How bright even light is.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub struct FlatLight {
    /// Irradiance of the sensor, W/m²; 0 is dark
    #[arg(long, value_name = "E", value_parser = irradiance_w_m2, allow_negative_numbers = true)]
    pub irradiance_w_m2: Option<f64>,
    /// Photons of that wavelength on the whole square of a pixel over the exposure, in place of the irradiance; 0 is dark
    #[arg(long, value_name = "N", value_parser = photons, allow_negative_numbers = true)]
    pub photons: Option<f64>,
    /// The series of EMVA 1288 instead: so many exposures up to the camera's exposure_s, where the light just saturates, two
    /// bright and two dark frames each; then a stack at half of saturation and one in the dark
    #[arg(long, value_name = "LEVELS", value_parser = whole(3, 10_000), allow_negative_numbers = true)]
    pub photon_transfer: Option<u32>,
}

impl From<&Flat> for FlatRequest {
    fn from(a: &Flat) -> Self {
        let source = match (a.light.photon_transfer, a.light.photons) {
            (Some(levels), _) => FlatSource::PhotonTransfer { levels, stack: a.stack },
            (None, Some(per_pixel)) => FlatSource::Photons { per_pixel },
            (None, None) => FlatSource::Irradiance { w_m2: a.light.irradiance_w_m2.unwrap_or(0.0) },
        };
        Self {
            camera: a.camera.clone(),
            set: a.set.clone(),
            wavelength_nm: a.wavelength_nm,
            source,
            frames: a.frames.clone(),
            signal_breakdown: a.signal_breakdown,
            seed: a.seed.unwrap_or(0),
        }
    }
}

impl Flat {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let request = FlatRequest::from(self);
        print_written(console, || etendue::flat(&request, self.output.folder(), console.observer()))
    }
}

fn wavelength_nm(text: &str) -> Result<f64, String> {
    let nm = text.parse().ok().filter(|nm| (300.0..=1100.0).contains(nm));
    nm.ok_or_else(|| format!("expected a wavelength of 300 to 1100 nm, not '{text}'"))
}

fn irradiance_w_m2(text: &str) -> Result<f64, String> {
    let e = text.parse().ok().filter(|e: &f64| e.is_finite() && *e >= 0.0);
    e.ok_or_else(|| format!("expected an irradiance of 0 W/m² or more, not '{text}'"))
}

fn photons(text: &str) -> Result<f64, String> {
    let n = text.parse().ok().filter(|n: &f64| n.is_finite() && *n >= 0.0);
    n.ok_or_else(|| format!("expected 0 photons a pixel or more, not '{text}'"))
}
