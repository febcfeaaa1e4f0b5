//! `etendue measure sfr`.

use super::picture::PictureArgs;
use crate::args::words::region;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, SfrRequest};
use std::path::PathBuf;

/// `etendue measure sfr`
#[derive(Debug, Args)]
pub struct SfrArgs {
    /// A picture of one or more slanted edges
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// A part of the picture that holds one edge: left column, top row, width, height; once an edge [default: all of it]
    #[arg(long = "edge", value_name = "X,Y,W,H", value_parser = region, conflicts_with = "truth")]
    pub edges: Vec<[usize; 4]>,
    /// Degree of the curve that the edges follow: 2 or 3 where the lens bends them
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=5))]
    pub edge_degree: u8,
    /// How far from the edge its profile has fine detail, pixels [default: 10]
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub reach_px: Option<f64>,
    /// Take off shading by surfaces of this degree, one on either side of the edge: 1 or 2 where the lens's fall-off makes the sides slope
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=2))]
    pub shading_degree: u8,
    /// The pixels' pitch, µm: tells MTF50 and MTF10 in line pairs a millimetre, too
    #[arg(long, value_name = "UM", allow_negative_numbers = true)]
    pub pixel_pitch_um: Option<f64>,
    /// From where the picture is viewed, for acutance: its pixels a degree at the eye
    #[arg(long, value_name = "N", default_value_t = 60.0, allow_negative_numbers = true)]
    pub pixels_per_degree: f64,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl SfrArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::sfr(&self.into())?)
    }
}

impl From<&SfrArgs> for SfrRequest {
    fn from(a: &SfrArgs) -> Self {
        Self {
            picture: a.picture.clone(),
            edges: a.edges.clone(),
            edge_degree: a.edge_degree,
            reach_px: a.reach_px,
            shading_degree: a.shading_degree,
            pixel_pitch_um: a.pixel_pitch_um,
            pixels_per_degree: a.pixels_per_degree,
            input: (&a.input).into(),
        }
    }
}
