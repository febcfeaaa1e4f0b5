//! `etendue measure vignetting` and `etendue measure shading`.

use super::picture::PictureArgs;
use super::report::CameraOut;
use crate::args::words::point;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, FlatFieldRequest, ShadingRequest, VignettingRequest};
use std::path::PathBuf;

/// A picture of an evenly lit surface, and about which centre.
#[derive(Debug, Args)]
pub struct FlatFieldArgs {
    /// A picture of an evenly lit surface
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// Centre of the fall-off, raster coordinates [default: the picture's]
    #[arg(long, value_name = "X,Y", value_parser = point)]
    pub centre_px: Option<(f64, f64)>,
    /// Rings of the profile over the radial field position
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(4..=1000))]
    pub rings: u32,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl From<&FlatFieldArgs> for FlatFieldRequest {
    fn from(a: &FlatFieldArgs) -> Self {
        Self { picture: a.picture.clone(), centre_px: a.centre_px, rings: a.rings, input: (&a.input).into() }
    }
}

/// `etendue measure vignetting`
#[derive(Debug, Args)]
pub struct VignettingArgs {
    #[command(flatten)]
    pub flat: FlatFieldArgs,
    #[command(flatten)]
    pub out: CameraOut,
    /// The pixels' pitch, µm, for --camera-out
    #[arg(long, value_name = "UM", allow_negative_numbers = true, requires = "camera_out")]
    pub pixel_pitch_um: Option<f64>,
}

impl VignettingArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let report = measure::vignetting(&self.into())?;
        self.out.write(&report)?;
        self.flat.input.report.show(console, &report)
    }
}

impl From<&VignettingArgs> for VignettingRequest {
    fn from(a: &VignettingArgs) -> Self {
        Self { flat: (&a.flat).into(), camera_keys: a.out.camera_out.is_some(), pixel_pitch_um: a.pixel_pitch_um }
    }
}

/// `etendue measure shading`
#[derive(Debug, Args)]
pub struct ShadingArgs {
    #[command(flatten)]
    pub flat: FlatFieldArgs,
    /// Blocks of the map along each side, an odd number
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u32).range(1..=501))]
    pub blocks: u32,
}

impl ShadingArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.flat.input.report.show(console, &measure::shading(&self.into())?)
    }
}

impl From<&ShadingArgs> for ShadingRequest {
    fn from(a: &ShadingArgs) -> Self {
        Self { flat: (&a.flat).into(), blocks: a.blocks }
    }
}
