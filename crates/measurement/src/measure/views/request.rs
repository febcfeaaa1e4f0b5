//! What views of a chart are asked.

use super::stated::StatedLength;
use crate::measure::chart_points::ChartInput;
use clap::Args;
use etendue_arguments::{choice, not_negative, place, positive};
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Estimate;
use etendue_metrology::calibrate::{CameraModel, Options};
use glam::DVec2;
use std::path::PathBuf;

/// The pictures, the chart and what is known of the camera.
#[derive(Args, Clone, Debug)]
pub struct ViewsRequest {
    /// Pictures of the chart by one camera, or lists of its points (CSV: column, row, x_px, y_px): turned by 20° to 45° about different axes, filling the field together
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// The chart, and which readings show it.
    #[command(flatten)]
    pub chart: ChartInput,
    /// The distance of neighbouring points of the chart, mm [with --truth: as it says]
    #[arg(long, value_name = "MM", value_parser = positive, allow_negative_numbers = true, required_unless_present = "truth")]
    pub pitch_mm: Option<f64>,
    /// The camera model
    #[arg(long, value_parser = choice(CameraModel::ALL.iter().map(|m| (*m, m.name(), m.about()))), default_value = CameraModel::Opencv.name())]
    pub model: CameraModel,
    /// Pixels are square: one focal length for columns and rows
    #[arg(long)]
    pub square_pixels: bool,
    /// The principal point is known, raster coordinates, px
    #[arg(long, value_name = "X,Y", value_parser = place)]
    pub principal_px: Option<[f64; 2]>,
    /// The distance from the entrance pupil to the chart's plane, mm, the same in every picture
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub distance_mm: Option<StatedLength>,
    /// Its standard uncertainty, mm; 0 where it is exact [default: of rounding to its last digit]
    #[arg(long, value_name = "MM", value_parser = not_negative, allow_negative_numbers = true, requires = "distance_mm")]
    pub distance_uncertainty_mm: Option<f64>,
    /// The distance of neighbouring pixels of the sensor, µm: then focal lengths are told in mm as well
    #[arg(long, value_name = "UM", value_parser = positive, allow_negative_numbers = true)]
    pub pixel_pitch_um: Option<f64>,
    /// Points far from the fit count less (Huber)
    #[arg(long)]
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
        let told = || {
            Error::argument("pitch_mm", "`pitch_mm`: state the distance of neighbouring points, or give `truth`")
                .with_code(ErrorCode::NotStated)
        };
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
