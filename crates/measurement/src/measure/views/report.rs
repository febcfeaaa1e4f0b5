//! Results as figures, tables and plots.

use etendue_core::maths::f64::{acos, atan};
use etendue_metrology::target::Node;
use etendue_projection::CalibrationError;
use glam::DVec2;

use super::{CalibratedViews, ViewsRequest};
use crate::measure::point_list::DetectedChart;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Covariance, Report, Table, with_uncertainty};

/// Unit of a parameter, from its name.
fn unit(name: &str) -> &'static str {
    match name {
        _ if name.ends_with("_px") => "px",
        _ if name.ends_with("_rad") => "rad",
        _ => "",
    }
}

impl CalibratedViews {
    /// Adds parameters, quality of the fit, and the views.
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
        report.fact("rms_px", "rms distance of points from the fit", "px", self.camera.rms_px());
        report.fact("sigma_px", "standard deviation of a coordinate", "px", self.camera.sigma_px);
        let freedom = self.camera.degrees_of_freedom as f64;
        report.fact("degrees_of_freedom", "degrees of freedom", "", freedom);
        report.note("raster coordinates, pixel centres at +0.5 (OpenCV's and ROS's cx and cy are smaller by 0.5); ± one standard uncertainty");
        if let Some(distance) = request.distance().filter(|_| request.distance_uncertainty_mm.is_none()) {
            report.note(format!(
                "the distance is assumed known to its stated digits, {} mm; otherwise state `distance_uncertainty_mm`",
                with_uncertainty(distance)
            ));
        }
        report.note("the pitch is assumed exact; distances have its relative error");
        self.notes.iter().for_each(|note| report.note(note.clone()));
        if let Err(CalibrationError::Fold { radius_px, .. }) = self.camera.calibration.check() {
            report.note(format!(
                "the fitted model folds the image over {radius_px:.1} px from the principal point, beyond the region that the \
                 views determine, so it is not written as a camera file; add views that fill the image, or fit a model of fewer \
                 coefficients"
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
        let row = |(v, detected): (usize, &DetectedChart)| {
            let pose = &self.camera.poses[v];
            let tilt = acos(pose.rotation.z_axis.z.clamp(-1.0, 1.0)).to_degrees();
            vec![
                Cell::Text(detected.file.display().to_string()),
                Cell::Number(detected.grid.nodes.len() as f64, 0),
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
        let view_rows = |(v, detected): (usize, &DetectedChart)| {
            detected.grid.nodes.iter().enumerate().map(|(p, node)| row(v, p, node)).collect::<Vec<_>>()
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
                ("fitted_less_seen_x_px", "fitted minus observed x px"),
                ("fitted_less_seen_y_px", "y px"),
            ],
            rows: self.views.iter().enumerate().flat_map(view_rows).collect(),
        }
    }

    fn residuals(&self) -> Plot {
        let points = self.camera.residuals_px.iter().flatten().map(|r| (r.x, r.y));
        Plot {
            title: "Fitted minus observed".to_owned(),
            x: Axis::linear("columns, px").showing(&[0.0]),
            y: Axis::linear("rows, px").showing(&[0.0]),
            series: vec![Series::new("points", Mark::Points, points)],
        }
    }

    /// Field angle against distance from the principal point, towards the farthest corner of the image.
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
}
