//! `measure distortion`: from one image of a plane chart.

use std::path::PathBuf;

use clap::Args;
use etendue_arguments::place;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Estimate;
use etendue_metrology::distortion::{Distortion, LineBow, LocalDistortion, RadialFit, distortion as fitted};
use etendue_projection::DistortionDirection;
use glam::DVec2;

use super::point_list::{ChartInput, DetectedChart};
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Covariance, Report, Table, with_uncertainty};

/// `etendue measure distortion`
#[derive(Args, Clone, Debug)]
pub struct DistortionRequest {
    /// Image of a plane chart that fills the field: many dots, or a checkerboard; or a list of its points (CSV: column, row, x_px,
    /// y_px)
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The chart, and the readings that show it.
    #[command(flatten)]
    pub chart: ChartInput,
    /// Centre of the radial distances, raster coordinates, px [default: the image centre]
    #[arg(long, value_name = "X,Y", value_parser = place)]
    pub centre_px: Option<[f64; 2]>,
}

impl DistortionRequest {
    /// Creates a request with the program's defaults.
    pub fn new(file: impl Into<PathBuf>) -> Self {
        Self { file: file.into(), chart: ChartInput::default(), centre_px: None }
    }
}

/// Distortion from one image of a plane chart, without a model (ISO 17850).
///
/// # Errors
/// If the image shows no chart, or too little of one.
pub fn distortion(request: &DistortionRequest) -> Result<Report, Error> {
    let detected = request.chart.detect(&request.file)?;
    let centre = request.centre_px.map(DVec2::from);
    let message = |error| Error::coded(ErrorCode::NotMeasurable, format!("{}: {error}", request.file.display()));
    let measured = fitted(&detected.grid, detected.size_px, centre).map_err(message)?;
    Ok(report(&detected, &measured, request.chart.points))
}

fn report(detected: &DetectedChart, measured: &Distortion, points: bool) -> Report {
    let method =
        "distortion without a model: ideal positions from a map with unit scale and no tilt at the centre (ISO 17850)";
    let mut report = Report::new("distortion", method);
    detected.stated.iter().for_each(|stated| report.encoding(stated));
    report.setting("centre_px", centre_words(measured.centre_px));
    report.fact("points", "points of the chart", "", detected.grid.nodes.len() as f64);
    report.fact("columns", "columns", "", detected.grid.size[0] as f64);
    report.fact("rows", "rows", "", detected.grid.size[1] as f64);
    report.fact("step_px", "step of the chart at the centre", "px", measured.ideal.step_px());
    report.fact("degree", "degree of the map", "", measured.ideal.degree() as f64);
    report.fact("sigma_px", "standard deviation of points from the map", "px", measured.ideal.sigma_px());
    report.fact("beyond_k1_k2_px", "its terms beyond k1 and k2, at the farthest point", "px", measured.ideal.tau_px());
    if let Some(last) = measured.curve.last() {
        let percent = Estimate::new(100.0 * (last.ratio.value - 1.0), 100.0 * last.ratio.standard_uncertainty);
        report.fact("field_reached_percent", "field reached", "% of the half diagonal", 100.0 * last.field);
        report.figure("distortion_there_percent", "distortion there", "%", percent);
    }
    local(&mut report, measured);
    lines(&mut report, &measured.lines);
    if let Some(height) = measured.height {
        report.figure("picture_height_percent", "image height, sides over middle minus 1", "%", percent(height));
    }
    radial(&mut report, "forward", &measured.forward);
    radial(&mut report, "backward", &measured.backward);
    report.note(
        "k1 and k2 in half diagonals, r' = r (1 + k1 r² + k2 r⁴); centres in raster coordinates, pixel centres at +0.5",
    );
    if let Some(note) = disagreement(measured) {
        report.note(note);
    }
    report.table(curve(measured));
    report.table_if(points, every_point(measured));
    report.plot(plot(measured));
    report.camera(camera(&measured.backward));
    report
}

/// Describes where the curve departs from k₁ and k₂ by more than twice their joint standard uncertainty.
fn disagreement(measured: &Distortion) -> Option<String> {
    let (point, by_fit, error) = measured.largest_difference().filter(|(_, _, error)| *error > 1.0)?;
    let less_one = |e: Estimate| with_uncertainty(percent(Estimate::new(e.value - 1.0, e.standard_uncertainty)));
    Some(format!(
        "the curve differs from k1 and k2 by {error:.1} times their joint uncertainty (95 %) at {:.1} % of the field ({} % and \
         {} %): the chart is tilted, the distortion is centred elsewhere (`centre_px`), or k1 and k2 do not describe the \
         distortion",
        100.0 * point.field,
        less_one(point.ratio),
        less_one(by_fit)
    ))
}

/// Label of the curve's centre, by which comparisons distinguish curves.
pub(crate) fn centre_words(centre_px: DVec2) -> String {
    format!("{:.2}, {:.2}", centre_px.x, centre_px.y)
}

fn lines(report: &mut Report, lines: &[LineBow]) {
    for (is_row, key, label) in
        [(true, "row_bow_percent", "largest bow of rows"), (false, "column_bow_percent", "largest bow of columns")]
    {
        let all = lines.iter().filter(|l| l.is_row == is_row).map(|l| l.bow);
        if let Some(bow) = all.reduce(|a, b| if b.abs() > a.abs() { b } else { a }) {
            report.fact(key, label, "% of the image height", 100.0 * bow);
        }
    }
}

fn radial(report: &mut Report, key: &str, fit: &RadialFit) {
    let direction = match fit.sense {
        DistortionDirection::IdealToObserved => "ideal to observed",
        DistortionDirection::ObservedToIdeal => "observed to ideal",
    };
    let mut figure =
        |name: &str, unit, value| report.figure(&format!("{key}_{name}"), &format!("{name}, {direction}"), unit, value);
    figure("k1", "", fit.k1);
    figure("k2", "", fit.k2);
    for (name, centre) in ["centre_x_px", "centre_y_px"].into_iter().zip(fit.centre_px) {
        if centre.standard_uncertainty.is_finite() {
            report.figure(&format!("{key}_{name}"), &format!("{name}, {direction}"), "px", centre);
        } else {
            let label = format!("{name}, {direction}, not determined: the curve's");
            report.fact(&format!("{key}_{name}"), &label, "px", centre.value);
        }
    }
    let keys = ["k1", "k2", "centre_x_px", "centre_y_px"].map(|name| format!("{key}_{name}")).to_vec();
    report.covariance(Covariance { of: keys, rows: fit.covariance.map(|row| row.to_vec()).to_vec() });
    report.fact(&format!("{key}_rms_px"), &format!("rms_px, {direction}"), "px", fit.rms_px);
}

/// The largest local geometric distortion (ISO 17850) and its position.
fn local(report: &mut Report, measured: &Distortion) {
    if let Some(largest) = measured.largest {
        report.figure("local_largest_percent", "largest local geometric distortion", "%", percent(largest.distortion));
        let field = 100.0 * largest.field;
        report.fact("local_largest_at_percent", "at", "% of the half diagonal", field);
    }
}

fn percent(fraction: Estimate) -> Estimate {
    Estimate::new(100.0 * fraction.value, 100.0 * fraction.standard_uncertainty)
}

/// Every point of the chart: observed position, position without distortion, and local geometric distortion.
fn every_point(measured: &Distortion) -> Table {
    let row = |l: &LocalDistortion| {
        let places = [l.at.x, l.at.y, l.ideal.x, l.ideal.y].map(|c| Cell::Number(c, 3));
        let index = l.index.map(|i| Cell::Number(i as f64, 0));
        let values = [
            Cell::Number(l.uncertainty_px, 4),
            Cell::Number(100.0 * l.field, 2),
            Cell::Estimate(percent(l.distortion)),
        ];
        index.into_iter().chain(places).chain(values).collect()
    };
    Table {
        key: "points",
        columns: vec![
            ("column", "column"),
            ("row", "row"),
            ("x_px", "x px"),
            ("y_px", "y px"),
            ("ideal_x_px", "ideal x px"),
            ("ideal_y_px", "ideal y px"),
            ("uncertainty_px", "± px"),
            ("field_percent", "field %"),
            ("distortion_percent", "distortion %"),
        ],
        rows: measured.local.iter().map(row).collect(),
    }
}

fn curve(measured: &Distortion) -> Table {
    let row = |p: &etendue_metrology::distortion::CurvePoint| {
        let percent = Estimate::new(100.0 * (p.ratio.value - 1.0), 100.0 * p.ratio.standard_uncertainty);
        let percent_cell = |x: f64| Cell::Number(100.0 * x, 1);
        vec![
            percent_cell(p.field),
            Cell::Estimate(p.ratio),
            Cell::Estimate(percent),
            Cell::Number(p.spread, 6),
            percent_cell(p.covered),
        ]
    };
    Table {
        key: "curve",
        columns: vec![
            ("field_percent", "field %"),
            ("ratio", "observed/ideal"),
            ("distortion_percent", "distortion %"),
            ("spread", "spread"),
            ("covered_percent", "covered %"),
        ],
        rows: measured.curve.iter().map(row).collect(),
    }
}

fn plot(measured: &Distortion) -> Plot {
    let curve = measured.curve.iter().map(|p| (100.0 * p.field, p.ratio.value, 2.0 * p.ratio.standard_uncertainty));
    let local = measured.local.iter().map(|l| (100.0 * l.field, 1.0 + l.distortion.value));
    Plot {
        title: "Distortion".to_owned(),
        x: Axis::linear("radial field position, % of the half diagonal").showing(&[0.0, 100.0]),
        y: Axis::linear("observed over ideal distance from the centre").showing(&[1.0]),
        series: vec![
            Series::new("points of the chart", Mark::Points, local),
            Series::with_errors("mean over directions", Mark::Line, curve),
        ],
    }
}

fn camera(fit: &RadialFit) -> String {
    format!(
        "# Measured by etendue measure distortion. Further keys of [lens] go above.\n[lens.distortion]\nk1 = {}\nk2 = {}\n\
         direction = \"observed_to_ideal\"\nradius_unit = \"half_diagonals\"\n",
        fit.k1.value, fit.k2.value
    )
}
