//! `etendue measure star` and `etendue measure texture`.

use super::picture::PictureArgs;
use crate::args::words::point;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, StarRequest, TextureRequest};
use std::path::PathBuf;

/// `etendue measure star`
#[derive(Debug, Args)]
pub struct StarArgs {
    /// A picture of a Siemens star
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// The star's centre, raster coordinates, within two pixels
    #[arg(long, value_name = "X,Y", value_parser = point, required_unless_present = "truth", conflicts_with = "truth")]
    pub centre_px: Option<(f64, f64)>,
    /// Cycles of dark and bright all round
    #[arg(long, value_name = "N", required_unless_present = "truth", conflicts_with = "truth")]
    pub cycles: Option<u32>,
    /// The smallest circle, px [with --truth: where the star has half a cycle a pixel, or begins]
    #[arg(long, value_name = "PX", required_unless_present = "truth", allow_negative_numbers = true)]
    pub inner_px: Option<f64>,
    /// The largest circle, px: the response is 1 there [with --truth: a little within the star's rim]
    #[arg(long, value_name = "PX", required_unless_present = "truth", allow_negative_numbers = true)]
    pub outer_px: Option<f64>,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl StarArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::star(&self.into())?)
    }
}

impl From<&StarArgs> for StarRequest {
    fn from(a: &StarArgs) -> Self {
        Self {
            picture: a.picture.clone(),
            centre_px: a.centre_px,
            cycles: a.cycles,
            inner_px: a.inner_px,
            outer_px: a.outer_px,
            input: (&a.input).into(),
        }
    }
}

/// `etendue measure texture`
#[derive(Debug, Args)]
pub struct TextureArgs {
    /// A picture of a texture such as dead leaves
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// The texture itself at the same place, pixel by pixel: a sharp render without noise (radiance.exr of --set output.radiance=true)
    #[arg(value_name = "REFERENCE")]
    pub reference: PathBuf,
    /// A picture of an even surface of the same brightness, for the noise
    #[arg(long, value_name = "PICTURE")]
    pub even: Option<PathBuf>,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl TextureArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::texture(&self.into())?)
    }
}

impl From<&TextureArgs> for TextureRequest {
    fn from(a: &TextureArgs) -> Self {
        Self {
            picture: a.picture.clone(),
            reference: a.reference.clone(),
            even: a.even.clone(),
            input: (&a.input).into(),
        }
    }
}
