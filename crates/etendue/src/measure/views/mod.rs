//! Cameras from views of a chart: what `measure focal` and `calibrate` share.

mod advice;
mod assumed;
mod stated;

use super::chart_points::{ChartInput, Seen, all};
use crate::calibration;
use crate::error::Error;
use crate::observer::Observer;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Covariance, Report, Table, with_uncertainty};
use etendue_core::maths::f64::{acos, atan};
use etendue_metrology::Estimate;
use etendue_metrology::calibrate::{
    CalibrateError, Calibrated, CameraModel, Options, Sightings, calibrate_rejecting_outliers,
};
use etendue_metrology::target::Node;
use etendue_projection::CalibrationError;
use etendue_scene::record::lens::calibrated::View;
use etendue_scene::record::{self, Camera, Lens, Sensor};
use etendue_scene::written::File;
use glam::DVec2;
pub use stated::StatedLength;
use std::fmt::Display;
use std::path::{Path, PathBuf};

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

/// The views and the camera that saw them.
pub(crate) struct Found {
    /// The model's name.
    pub model: String,
    /// Those that are in it.
    pub views: Vec<Seen>,
    pub camera: Calibrated,
    /// What a user should know of the fit.
    pub notes: Vec<String>,
}

/// An error by its picture.
fn of_files(error: &CalibrateError, views: &[Seen]) -> String {
    match error {
        CalibrateError::View { view, .. } | CalibrateError::Sparse { view, .. } => {
            format!("{}: {error}", views[*view].file.display())
        }
        _ => error.to_string(),
    }
}

impl ViewsRequest {
    pub(crate) fn found(&self, options: Options, observer: &dyn Observer) -> Result<Found, Error> {
        self.found_by(|_| options, observer)
    }

    /// The same with the principal point in the picture's middle, which is uncertain.
    pub(crate) fn found_about_middle(&self, options: Options, observer: &dyn Observer) -> Result<Found, Error> {
        let middle = |[width, height]: [usize; 2]| 0.5 * DVec2::new(width as f64, height as f64);
        let about = |size| Options { principal_px: Some(middle(size)), ..options };
        let mut found = self.found_by(about, observer)?;
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> = found.views.iter().map(|v| Sightings::of_grid(&v.grid, pitch_mm)).collect();
        let size = found.camera.calibration.size_px();
        assumed::widen(&mut found, &sightings, self.model.family(), about(size))?;
        let px = assumed::MIDDLE * size[0].max(size[1]) as f64;
        found.notes.push(format!(
            "one picture: the principal point is taken for the picture's middle, ± {px:.1} px in each direction, and the lens for one of this \
             model or nearly so, which is in the ±; pixels are taken for square, which is in no ±"
        ));
        Ok(found)
    }

    /// By options that may follow from the picture's size.
    fn found_by(&self, options: impl Fn([usize; 2]) -> Options, observer: &dyn Observer) -> Result<Found, Error> {
        let (views, without) = all(&self.chart, &self.files, observer)?;
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> = views.iter().map(|v| Sightings::of_grid(&v.grid, pitch_mm)).collect();
        let size = views[0].size_px;
        let options = options(size);
        let spared = calibrate_rejecting_outliers(&sightings, size, self.model.family(), options);
        let spared = spared.map_err(|error| Error::input(of_files(&error, &views)))?;
        let left_out = |file: &Path, why: &dyn Display| format!("warning: {}: left out: {why}", file.display());
        let mut notes: Vec<String> = without.iter().map(|(file, why)| left_out(file, why)).collect();
        notes.extend(spared.left_out.iter().map(|(v, why)| left_out(&views[*v].file, why)));
        let kept: Vec<&Sightings> = spared.kept.iter().map(|v| &sightings[*v]).collect();
        let views: Vec<Seen> = spared.kept.iter().map(|v| views[*v].clone()).collect();
        notes.extend(advice::unsuited(self.model, &spared.camera, &views, &kept, options));
        Ok(Found { model: self.model.name().to_owned(), views, camera: spared.camera, notes })
    }

    /// As stated, or as the truth says.
    fn pitch_mm(&self) -> Result<f64, Error> {
        let told = || Error::input("--pitch-mm: state the distance of neighbouring points, or give --truth");
        Ok(match self.pitch_mm {
            Some(pitch) => pitch,
            None => self.chart.told()?.ok_or_else(told)?.1.pitch_mm,
        })
    }

    /// The distance: as well known as is stated, or as its last digit tells.
    fn distance(&self) -> Option<Estimate> {
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

/// Unit of a parameter, by its name.
fn unit(name: &str) -> &'static str {
    match name {
        _ if name.ends_with("_px") => "px",
        _ if name.ends_with("_rad") => "rad",
        _ => "",
    }
}

impl Found {
    /// Parameters, how well the views fit, and the views.
    pub(crate) fn add_to(&self, report: &mut Report, request: &ViewsRequest) {
        let (pixel_pitch_um, points) = (request.pixel_pitch_um, request.chart.points);
        self.views.iter().filter_map(|view| view.stated.as_ref()).for_each(|stated| report.encoding(stated));
        report.setting("model", self.model.clone());
        for p in &self.camera.parameters {
            report.figure(p.name, p.name.trim_end_matches("_px"), unit(p.name), p.estimate);
            if let Some(pitch_um) = pixel_pitch_um.filter(|_| p.name.starts_with('f')) {
                let mm = p.estimate.scaled(0.001 * pitch_um);
                report.figure(&p.name.replace("_px", "_mm"), p.name.trim_end_matches("_px"), "mm", mm);
            }
        }
        report.fact("rms_px", "distance of points from the fit, rms", "px", self.camera.rms_px());
        report.fact("sigma_px", "standard deviation of a coordinate", "px", self.camera.sigma_px);
        let freedom = self.camera.degrees_of_freedom as f64;
        report.fact("degrees_of_freedom", "degrees of freedom", "", freedom);
        report.note("raster coordinates, pixel centres at +0.5 (OpenCV's and ROS's cx and cy are less by 0.5); ± one standard uncertainty");
        if let Some(distance) = request.distance().filter(|_| request.distance_uncertainty_mm.is_none()) {
            report.note(format!(
                "the distance is taken as known to the digits that are stated, {} mm: state --distance-uncertainty-mm",
                with_uncertainty(distance)
            ));
        }
        report.note("the pitch is taken as exact: its relative error is that of distances");
        self.notes.iter().for_each(|note| report.note(note.clone()));
        if let Err(CalibrationError::Fold { radius_px, .. }) = self.camera.calibration.check() {
            report.note(format!(
                "the fitted model folds the picture over {radius_px:.1} px from the principal point, farther out than the views \
                 determine it: it is no camera file; add views that fill the picture, or fit a model of fewer coefficients"
            ));
        }
        report.table(self.table());
        report.table_if(points, self.points());
        report.covariance(Covariance {
            of: self.camera.parameters.iter().map(|p| p.name.to_owned()).collect(),
            rows: (0..self.camera.parameters.len()).map(|i| self.row(i)).collect(),
        });
        report.plot(self.residuals());
        report.plot(self.projection());
    }

    fn table(&self) -> Table {
        let row = |(v, seen): (usize, &Seen)| {
            let pose = &self.camera.poses[v];
            let tilt = acos(pose.turn.z_axis.z.clamp(-1.0, 1.0)).to_degrees();
            vec![
                Cell::Text(seen.file.display().to_string()),
                Cell::Number(seen.grid.nodes.len() as f64, 0),
                Cell::Number(self.camera.view_rms_px(v), 4),
                Cell::Number(pose.distance(), 2),
                Cell::Number(tilt, 2),
            ]
        };
        Table {
            key: "views",
            columns: vec![
                ("file", "file"),
                ("points", "points"),
                ("rms_px", "rms px"),
                ("distance_mm", "distance mm"),
                ("tilt_deg", "tilt °"),
            ],
            rows: self.views.iter().enumerate().map(row).collect(),
        }
    }

    /// A row of the covariance.
    fn row(&self, i: usize) -> Vec<f64> {
        (0..self.camera.parameters.len()).map(|j| self.camera.covariance.at(i, j)).collect()
    }

    /// Every point of every view.
    fn points(&self) -> Table {
        let row = |v: usize, p: usize, node: &Node| {
            let off = self.camera.residuals_px[v][p];
            vec![
                Cell::Number(v as f64 + 1.0, 0),
                Cell::Number(node.index[0] as f64, 0),
                Cell::Number(node.index[1] as f64, 0),
                Cell::Number(node.at.x, 4),
                Cell::Number(node.at.y, 4),
                Cell::Number(node.uncertainty_px, 4),
                Cell::Number(off.x, 4),
                Cell::Number(off.y, 4),
            ]
        };
        let of_view = |(v, seen): (usize, &Seen)| {
            seen.grid.nodes.iter().enumerate().map(|(p, node)| row(v, p, node)).collect::<Vec<_>>()
        };
        Table {
            key: "points",
            columns: vec![
                ("view", "view"),
                ("column", "column"),
                ("row", "row"),
                ("x_px", "x px"),
                ("y_px", "y px"),
                ("uncertainty_px", "± px"),
                ("fitted_less_seen_x_px", "fitted less seen x px"),
                ("fitted_less_seen_y_px", "y px"),
            ],
            rows: self.views.iter().enumerate().flat_map(of_view).collect(),
        }
    }

    fn residuals(&self) -> Plot {
        let points = self.camera.residuals_px.iter().flatten().map(|r| (r.x, r.y));
        Plot {
            title: "Fitted less seen".to_owned(),
            x: Axis::linear("columns, px").showing(&[0.0]),
            y: Axis::linear("rows, px").showing(&[0.0]),
            series: vec![Series::new("points", Mark::Points, points)],
        }
    }

    /// Field angle against distance from the principal point, towards the picture's farthest corner.
    fn projection(&self) -> Plot {
        const STEPS: i32 = 60;
        let camera = &self.camera.calibration;
        let (matrix, [width, height]) = (camera.matrix(), camera.size_px().map(|n| n as f64));
        let principal = DVec2::new(matrix.cx, matrix.cy);
        let corner = |x: f64, y: f64| DVec2::new(x, y) - principal;
        let corners = [corner(0.0, 0.0), corner(width, 0.0), corner(0.0, height), corner(width, height)];
        let farthest = corners.into_iter().fold(DVec2::ZERO, |a, b| if b.length() > a.length() { b } else { a });
        let at = |i: i32| farthest * (f64::from(i) / f64::from(STEPS));
        let angle =
            |v: DVec2| Some((v.length(), acos(camera.unproject(principal + v)?.z.clamp(-1.0, 1.0)).to_degrees()));
        let pinhole = |v: DVec2| (v.length(), atan(DVec2::new(v.x / matrix.fx, v.y / matrix.fy).length()).to_degrees());
        Plot {
            title: "Projection".to_owned(),
            x: Axis::linear("distance from the principal point, px").showing(&[0.0]),
            y: Axis::linear("field angle, °").showing(&[0.0]),
            series: vec![
                Series::new("camera", Mark::Line, (0..=STEPS).filter_map(|i| angle(at(i)))),
                Series::new("without distortion, same focal length", Mark::Broken, (0..=STEPS).map(|i| pinhole(at(i)))),
            ],
        }
    }

    /// A camera file by a verb; the f-number cannot be told from these pictures.
    ///
    /// # Errors
    /// Where the camera folds over inside its picture.
    pub(crate) fn camera_file(&self, verb: &str, pixel_pitch_um: f64, f_number: Option<f64>) -> Result<String, Error> {
        let refused = |folds| Error::input(format!("no camera file of this, figures only: {folds}"));
        self.camera.calibration.check().map_err(refused)?;
        let [width, height] = self.camera.calibration.size_px().map(|n| n as u64);
        let view = View::Projection(Box::new(calibration::projection(&self.camera.calibration)));
        let lens = Lens::Calibrated(Box::new(record::lens::Calibrated::new(view, f_number.unwrap_or(4.0))));
        let camera = Camera::new(lens, Sensor::new(width, height, pixel_pitch_um));
        let count = self.views.len();
        let views = if count == 1 { "view" } else { "views" };
        let rms_px = self.camera.rms_px();
        let about =
            format!("Found by etendue {verb} from {count} {views}; points lie {rms_px:.4} px (rms) from the fit.");
        let file = File::new(camera.to_table()).head(about);
        Ok(match f_number {
            Some(_) => file,
            None => file.beside("lens.f_number", "a stand-in: not measured"),
        }
        .to_string())
    }
}
