//! What `measure sfr` is asked.

use crate::measure::picture_input::PictureInput;
use std::path::PathBuf;

/// `etendue measure sfr`
#[derive(Clone, Debug)]
pub struct SfrRequest {
    /// A picture of one or more slanted edges
    pub picture: PathBuf,
    /// A part of the picture that holds one edge: left column, top row, width, height; once an edge [default: all of it]
    pub edges: Vec<[usize; 4]>,
    /// Degree of the curve that the edges follow: 2 or 3 where the lens bends them
    pub edge_degree: u8,
    /// How far from the edge its profile has fine detail, pixels [default: 10]
    pub reach_px: Option<f64>,
    /// Take off shading by surfaces of this degree, one on either side of the edge: 1 or 2 where the lens's fall-off makes the sides slope
    pub shading_degree: u8,
    /// The pixels' pitch, µm: tells MTF50 and MTF10 in line pairs a millimetre, too
    pub pixel_pitch_um: Option<f64>,
    /// From where the picture is viewed, for acutance: its pixels a degree at the eye
    pub pixels_per_degree: f64,
    /// Which readings of the picture, what they mean, and the chart's truth.
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
