//! Views of a chart, of `etendue measure focal` and `etendue calibrate`.

use super::chart_points::ChartPointsArgs;
use crate::args::choice::choice;
use crate::args::words::{length, not_negative, place, positive};
use clap::Args;
use etendue::measure::{CameraModel, StatedLength, ViewsRequest};
use std::path::PathBuf;

/// The pictures, the chart and what is known of the camera.
#[derive(Debug, Args)]
pub struct ViewsArgs {
    /// Pictures of the chart by one camera, or lists of its points (CSV: column, row, x_px, y_px): turned by 20° to 45° about different axes, filling the field together
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub chart: ChartPointsArgs,
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
    #[arg(long, value_name = "MM", value_parser = length, allow_negative_numbers = true)]
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

impl From<&ViewsArgs> for ViewsRequest {
    fn from(a: &ViewsArgs) -> Self {
        Self {
            files: a.files.clone(),
            chart: (&a.chart).into(),
            pitch_mm: a.pitch_mm,
            model: a.model,
            square_pixels: a.square_pixels,
            principal_px: a.principal_px,
            distance_mm: a.distance_mm,
            distance_uncertainty_mm: a.distance_uncertainty_mm,
            pixel_pitch_um: a.pixel_pitch_um,
            robust: a.robust,
        }
    }
}
