//! What `measure sfr` is asked.

use crate::measure::picture_input::PictureInput;
use clap::Args;
use etendue_arguments::{in_range, region};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Degrees of the curve that an edge may follow.
pub(super) const EDGE_DEGREES: RangeInclusive<u8> = 1..=5;
/// Degrees of the surfaces of shading beside an edge.
pub(super) const SHADING_DEGREES: RangeInclusive<u8> = 0..=2;

/// `etendue measure sfr`
#[derive(Args, Clone, Debug)]
pub struct SfrRequest {
    /// A picture of one or more slanted edges
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// A part of the picture that holds one edge: left column, top row, width, height; once an edge [default: all of it]
    #[arg(long = "edge", value_name = "X,Y,W,H", value_parser = region, conflicts_with = "truth")]
    pub edges: Vec<[usize; 4]>,
    /// Degree of the curve that the edges follow: 2 or 3 where the lens bends them
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = in_range(EDGE_DEGREES))]
    pub edge_degree: u8,
    /// How far from the edge its profile has fine detail, pixels [default: 10]
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub reach_px: Option<f64>,
    /// Take off shading by surfaces of this degree, one on either side of the edge: 1 or 2 where the lens's fall-off makes the sides slope
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = in_range(SHADING_DEGREES))]
    pub shading_degree: u8,
    /// The pixels' pitch, µm: tells MTF50 and MTF10 in line pairs a millimetre, too
    #[arg(long, value_name = "UM", allow_negative_numbers = true)]
    pub pixel_pitch_um: Option<f64>,
    /// From where the picture is viewed, for acutance: its pixels a degree at the eye
    #[arg(long, value_name = "N", default_value_t = 60.0, allow_negative_numbers = true)]
    pub pixels_per_degree: f64,
    /// Which readings of the picture, what they mean, and the chart's truth.
    #[command(flatten)]
    pub input: PictureInput,
}

impl SfrRequest {
    /// The same as the program without options.
    pub fn new(picture: impl Into<PathBuf>) -> Self {
        Self {
            picture: picture.into(),
            edges: Vec::new(),
            edge_degree: 1,
            reach_px: None,
            shading_degree: 0,
            pixel_pitch_um: None,
            pixels_per_degree: 60.0,
            input: PictureInput::default(),
        }
    }
}
