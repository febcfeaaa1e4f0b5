//! What views of a chart are asked.

use super::stated::StatedLength;
use crate::measure::chart_points::ChartInput;
use etendue_io::failure::Error;
use etendue_metrology::Estimate;
use etendue_metrology::calibrate::{CameraModel, Options};
use glam::DVec2;
use std::path::PathBuf;

/// The pictures, the chart and what is known of the camera.
#[derive(Clone, Debug)]
pub struct ViewsRequest {
    /// Pictures of the chart by one camera, or lists of its points (CSV: column, row, x_px, y_px): turned by 20° to 45° about different axes, filling the field together
    pub files: Vec<PathBuf>,
    /// The chart, and which readings show it.
    pub chart: ChartInput,
    /// The distance of neighbouring points of the chart, mm [with --truth: as it says]
    pub pitch_mm: Option<f64>,
    /// The camera model
    pub model: CameraModel,
    /// Pixels are square: one focal length for columns and rows
    pub square_pixels: bool,
    /// The principal point is known, raster coordinates, px
    pub principal_px: Option<[f64; 2]>,
    /// The distance from the entrance pupil to the chart's plane, mm, the same in every picture
    pub distance_mm: Option<StatedLength>,
    /// Its standard uncertainty, mm; 0 where it is exact [default: of rounding to its last digit]
    pub distance_uncertainty_mm: Option<f64>,
    /// The distance of neighbouring pixels of the sensor, µm: then focal lengths are told in mm as well
    pub pixel_pitch_um: Option<f64>,
    /// Points far from the fit count less (Huber)
    pub robust: bool,
}

impl ViewsRequest {
    /// The same as the program without options.
    pub fn new(files: Vec<PathBuf>) -> Self {
        Self {
            files,
            chart: ChartInput::default(),
            pitch_mm: None,
            model: CameraModel::Opencv,
            square_pixels: false,
            principal_px: None,
            distance_mm: None,
            distance_uncertainty_mm: None,
            pixel_pitch_um: None,
            robust: false,
        }
    }
}

impl ViewsRequest {
    /// As stated, or as the truth says.
    pub(super) fn pitch_mm(&self) -> Result<f64, Error> {
        let told = || Error::input("--pitch-mm: state the distance of neighbouring points, or give --truth");
        Ok(match self.pitch_mm {
            Some(pitch) => pitch,
            None => self.chart.told()?.ok_or_else(told)?.1.pitch_mm,
        })
    }

    /// The distance: as well known as is stated, or as its last digit tells.
    pub(super) fn distance(&self) -> Option<Estimate> {
        let rounded = self.distance_mm?.rounded();
        Some(Estimate::new(rounded.value, self.distance_uncertainty_mm.unwrap_or(rounded.standard_uncertainty)))
    }

    /// What is told of the camera.
    pub(crate) fn options(&self) -> Options {
        Options {
            square_pixels: self.square_pixels,
            principal_px: self.principal_px.map(DVec2::from),
            focal_px: None,
            distance: self.distance(),
            robust: self.robust,
        }
    }
}
