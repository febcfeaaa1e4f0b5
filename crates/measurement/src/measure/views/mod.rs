//! Cameras from views of a chart, shared by `measure focal` and `calibrate`: request, results, and stated lengths.

mod fit;
mod report;

use std::{path::PathBuf, str::FromStr};

use clap::Args;
use etendue_arguments::{choice, not_negative, place, positive};
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Estimate;
use etendue_metrology::calibrate::{CalibrationOptions, CalibrationResult, CameraModel};
use glam::DVec2;

use super::point_list::{ChartInput, DetectedChart};

pub(crate) use fit::CandidateModel;

/// The views and the fitted camera.
pub(crate) struct CalibratedViews {
    /// The model's name.
    pub model: String,
    /// Views used in the fit.
    pub views: Vec<DetectedChart>,
    pub camera: CalibrationResult,
    /// Notes on the fit for the user.
    pub notes: Vec<String>,
}

/// The images, the chart and the known properties of the camera.
#[derive(Args, Clone, Debug)]
pub struct ViewsRequest {
    /// Images of the chart by one camera, or lists of its points (CSV: column, row, x_px, y_px): turned by 20° to 45° about
    /// different axes, filling the field together
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// The chart, and the readings that show it.
    #[command(flatten)]
    pub chart: ChartInput,
    /// Distance of neighbouring points of the chart, mm [with --truth: as it states]
    #[arg(long, value_name = "MM", value_parser = positive, allow_negative_numbers = true, required_unless_present = "truth")]
    pub pitch_mm: Option<f64>,
    /// Camera model
    #[arg(long, value_parser = choice(CameraModel::ALL.iter().map(|m| (*m, m.name(), m.about()))), default_value = CameraModel::Opencv.name())]
    pub model: CameraModel,
    /// Assume square pixels: one focal length for columns and rows
    #[arg(long)]
    pub square_pixels: bool,
    /// Known principal point, raster coordinates, px
    #[arg(long, value_name = "X,Y", value_parser = place)]
    pub principal_px: Option<[f64; 2]>,
    /// Distance from the entrance pupil to the chart's plane, mm, the same in every image
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub distance_mm: Option<StatedLength>,
    /// Standard uncertainty of the distance, mm; 0 if exact [default: of rounding to its last digit]
    #[arg(long, value_name = "MM", value_parser = not_negative, allow_negative_numbers = true, requires = "distance_mm")]
    pub distance_uncertainty_mm: Option<f64>,
    /// Pixel pitch of the sensor, µm: adds focal lengths in mm
    #[arg(long, value_name = "UM", value_parser = positive, allow_negative_numbers = true)]
    pub pixel_pitch_um: Option<f64>,
    /// Reduce the weight of points far from the fit (Huber)
    #[arg(long)]
    pub robust: bool,
}

impl ViewsRequest {
    /// Creates a request with the program's defaults.
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
    /// As stated, or from the ground truth.
    fn pitch_mm(&self) -> Result<f64, Error> {
        let missing = || {
            Error::argument(
                "pitch_mm",
                "`pitch_mm`: not given; state the distance between neighbouring points, or give `truth`",
            )
            .with_code(ErrorCode::NotStated)
        };
        Ok(match self.pitch_mm {
            Some(pitch) => pitch,
            None => self.chart.truth_and_chart()?.ok_or_else(missing)?.1.pitch_mm,
        })
    }

    /// The distance with its stated uncertainty, otherwise that of its last digit.
    fn distance(&self) -> Option<Estimate> {
        let rounded = self.distance_mm?.rounded();
        Some(Estimate::new(rounded.value, self.distance_uncertainty_mm.unwrap_or(rounded.standard_uncertainty)))
    }

    /// Known properties of the camera.
    pub(crate) fn options(&self) -> CalibrationOptions {
        CalibrationOptions {
            square_pixels: self.square_pixels,
            principal_px: self.principal_px.map(DVec2::from),
            focal_px: None,
            distance: self.distance(),
            robust: self.robust,
        }
    }
}

/// A length above 0 and the unit of its last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatedLength {
    /// The length.
    pub value: f64,
    /// Value of a unit in its last digit; 0 if exact.
    pub digit: f64,
}

impl StatedLength {
    /// Rounded to its last digit: uniformly distributed within half of it either way (GUM, JCGM 100:2008, F.2.2.1).
    #[must_use]
    pub fn rounded(self) -> Estimate {
        Estimate::new(self.value, self.digit / 12_f64.sqrt())
    }
}

/// Parses a length as typed: the decimals after the point are its digits; for whole numbers the last digit counts, 0 or not.
impl FromStr for StatedLength {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let value = positive(text)?;
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let digit = format!("1e{}", exponent.parse::<i64>().unwrap_or(0) - decimals as i64);
        // 1e3 is short for 1000.
        Ok(Self { value, digit: digit.parse::<f64>().unwrap_or(0.0).min(1.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_digit_tells_how_well_a_length_is_known() {
        let digit = |text: &str| text.parse::<StatedLength>().map(|stated| (stated.value, stated.digit));
        assert_eq!(digit("1000"), Ok((1000.0, 1.0)));
        assert_eq!(digit(" 30.67"), Ok((30.67, 0.01)));
        assert_eq!((digit("1.50e3"), digit("1e3")), (Ok((1500.0, 1.0)), Ok((1000.0, 1.0))));
        assert!(digit("-1").is_err() && digit("one").is_err());
        assert!(
            ("1000".parse::<StatedLength>().map(|s| s.rounded().standard_uncertainty).unwrap_or(0.0) - 0.288_675).abs()
                < 1e-6
        );
    }
}
