//! `etendue calibrate`: a camera file from several views of a chart.

use super::views::ViewsRequest;
use crate::report::Report;
use clap::Args;
use etendue_arguments::positive;
use etendue_core::observer::Observer;
use etendue_io::failure::Error;

/// `etendue calibrate`
#[derive(Args, Clone, Debug)]
pub struct CalibrationRequest {
    /// The pictures, the chart and what is known of the camera.
    #[command(flatten)]
    pub views: ViewsRequest,
    /// Whether the report holds a camera file; needs the pixels' pitch.
    #[arg(skip)]
    pub camera_keys: bool,
    /// The lens's f-number, for the camera file [default: 4, which is marked as a stand-in]
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true, requires = "camera_keys", display_order = 21)]
    pub f_number: Option<f64>,
}

impl CalibrationRequest {
    /// The same as the program without options.
    pub fn new(views: ViewsRequest) -> Self {
        Self { views, camera_keys: false, f_number: None }
    }
}

/// A camera from several views of a plane chart: projection, distortion and, where the pixels' pitch is given, a camera file. Runs on the caller's thread pool.
///
/// # Errors
/// Where views are too few, show no chart or do not determine the model.
pub fn calibrate(request: &CalibrationRequest, observer: &dyn Observer) -> Result<Report, Error> {
    let views = &request.views;
    let found = views.found(views.options(), observer)?;
    let mut report = Report::new("calibrate", "camera from views of a plane chart, least squares of all points");
    found.add_to(&mut report, views);
    if let Some(pitch_um) = views.pixel_pitch_um.filter(|_| request.camera_keys) {
        report.camera(found.camera_file("calibrate", pitch_um, request.f_number)?);
    }
    Ok(report)
}
