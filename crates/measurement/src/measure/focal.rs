//! `measure focal`, focal length and principal point, and `etendue calibrate`, a camera file from several views of a chart.

use clap::Args;
use etendue_arguments::positive;
use etendue_core::{maths::f64::acos, observer::Observer};
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::{Estimate, calibrate::CalibrationOptions};
use etendue_projection::Calibration;

use super::views::{CalibratedViews, ViewsRequest};
use crate::report::Report;

/// `etendue measure focal`
#[derive(Args, Clone, Debug)]
pub struct FocalRequest {
    /// The images, the chart and the known properties of the camera.
    #[command(flatten)]
    pub views: ViewsRequest,
    /// True if the report includes the results as keys of a camera file.
    #[arg(skip)]
    pub camera_keys: bool,
}

impl FocalRequest {
    /// Creates a request with the program's defaults.
    pub fn new(views: ViewsRequest) -> Self {
        Self { views, camera_keys: false }
    }
}

/// Focal length and principal point, from one image of a chart at a known distance or from several. Runs on the caller's thread
/// pool.
///
/// # Errors
/// If the views do not determine them.
pub fn focal(request: &FocalRequest, observer: &dyn Observer) -> Result<Report, Error> {
    let views = &request.views;
    let mut options = views.options();
    let one = views.files.len() == 1;
    if let (true, None, Some((_, point_chart))) = (one, options.distance, views.chart.truth_and_chart()?) {
        options.distance = point_chart.distance_mm.map(|mm| Estimate::new(mm, 0.0));
    }
    if request.camera_keys && views.pixel_pitch_um.is_none() {
        return Err(Error::argument(
            "camera_keys",
            "`camera_keys`: a camera file needs the pixel pitch; add `pixel_pitch_um`",
        )
        .with_code(ErrorCode::NotStated));
    }
    if one && options.distance.is_none() {
        let problem = "a single image does not distinguish the focal length from the distance; add `distance_mm`, or more images with the chart turned";
        return Err(Error::coded(ErrorCode::NotStated, problem));
    }
    let about_middle = one && options.principal_px.is_none();
    let calibrated = match about_middle {
        true => views.calibrate_centred(CalibrationOptions { square_pixels: true, ..options }, observer)?,
        false => views.calibrate(options, observer)?,
    };
    let mut report = Report::new("focal", "focal length from views of a plane chart");
    calibrated.add_to(&mut report, views);
    field_of_view(&mut report, &calibrated);
    if let Some(pitch_um) = views.pixel_pitch_um.filter(|_| request.camera_keys) {
        report.camera(calibrated.camera_file("measure focal", pitch_um, None)?);
    }
    Ok(report)
}

/// Angles between the middles of opposite sides, and between opposite corners.
fn field_of_view(report: &mut Report, calibrated: &CalibratedViews) {
    let [w, h] = calibrated.camera.calibration.size_px().map(|n| n as f64);
    let mut line = |key: &str, label: &str, a: [f64; 2], b: [f64; 2]| {
        let between = |camera: &Calibration| {
            let (a, b) = (camera.unproject(a.into())?, camera.unproject(b.into())?);
            Some(acos(a.dot(b).clamp(-1.0, 1.0)).to_degrees())
        };
        if let Some(angle) = calibrated.camera.follows(between) {
            report.figure(key, label, "°", angle);
        }
    };
    line("field_of_view_horizontal_deg", "field of view, horizontal", [0.0, 0.5 * h], [w, 0.5 * h]);
    line("field_of_view_vertical_deg", "field of view, vertical", [0.5 * w, 0.0], [0.5 * w, h]);
    line("field_of_view_diagonal_deg", "field of view, diagonal", [0.0, 0.0], [w, h]);
}

/// `etendue calibrate`
#[derive(Args, Clone, Debug)]
pub struct CalibrationRequest {
    /// The images, the chart and the known properties of the camera.
    #[command(flatten)]
    pub views: ViewsRequest,
    /// True if the report includes a camera file; needs the pixel pitch.
    #[arg(skip)]
    pub camera_keys: bool,
    /// F-number of the lens, for the camera file [default: 4, marked as a stand-in]
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true, requires = "camera_keys", display_order = 21)]
    pub f_number: Option<f64>,
}

impl CalibrationRequest {
    /// Creates a request with the program's defaults.
    pub fn new(views: ViewsRequest) -> Self {
        Self { views, camera_keys: false, f_number: None }
    }
}

/// A camera from several views of a plane chart: projection, distortion and, if the pixel pitch is given, a camera file. Runs on
/// the caller's thread pool.
///
/// # Errors
/// If the views are too few, show no chart or do not determine the model.
pub fn calibrate(request: &CalibrationRequest, observer: &dyn Observer) -> Result<Report, Error> {
    let views = &request.views;
    let calibrated = views.calibrate(views.options(), observer)?;
    let mut report =
        Report::new("calibrate", "camera calibration from views of a plane chart, least squares over all points");
    calibrated.add_to(&mut report, views);
    if let Some(pitch_um) = views.pixel_pitch_um.filter(|_| request.camera_keys) {
        report.camera(calibrated.camera_file("calibrate", pitch_um, request.f_number)?);
    }
    Ok(report)
}
