//! `measure chromatic`: lateral chromatic displacement.

use std::path::PathBuf;

use clap::Args;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Estimate;
use etendue_metrology::chromatic::{Displacement, Ring, displacements, rings, shift};
use glam::DVec2;

use super::point_list::ChartInput;
use crate::plot::{Axis, Colour, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure chromatic`
#[derive(Args, Clone, Debug)]
pub struct ChromaticRequest {
    /// Colour image of a plane chart that fills the field
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The chart, and the readings that show it.
    #[command(flatten)]
    pub chart: ChartInput,
}

impl ChromaticRequest {
    /// Creates a request with the program's defaults.
    pub fn new(file: impl Into<PathBuf>) -> Self {
        Self { file: file.into(), chart: ChartInput::default() }
    }
}

/// Lateral chromatic displacement of red and blue against green (ISO 19084).
///
/// # Errors
/// If the image is not in colour or shows no chart.
pub fn chromatic(request: &ChromaticRequest) -> Result<Report, Error> {
    let file = &request.file;
    if request.chart.channel.is_some() {
        return Err(Error::argument(
            "channel",
            "`channel`: lateral colour is measured in red, green and blue; leave it out",
        )
        .with_code(ErrorCode::NoEffect));
    }
    let photograph = request.chart.encoding.photograph(file)?;
    let selection = request.chart.selection(None);
    if let Some(missing) = ["R", "G", "B"].iter().find(|name| !selection.has(&photograph, name)) {
        return Err(Error::coded(
            ErrorCode::UnknownName,
            format!("{}: no channel {missing}; expected a colour image", file.display()),
        ));
    }
    let detect = |name: &str| request.chart.detect_in_channel(file, &photograph, Some(name));
    let [red, green, blue] = [detect("R")?, detect("G")?, detect("B")?];
    let size = green.size_px;
    let measured =
        [("red", displacements(&green.grid, &red.grid, size)), ("blue", displacements(&green.grid, &blue.grid, size))];
    if let Some((name, _)) = measured.iter().find(|(_, list)| list.is_empty()) {
        let file = file.display();
        return Err(Error::coded(
            ErrorCode::NotMeasurable,
            format!(
                "{file}: the chart's points in {name} have no counterparts in green; expected the colours of one image"
            ),
        ));
    }
    if measured.iter().flat_map(|(_, list)| list).all(|point| point.by == DVec2::ZERO) {
        let file = file.display();
        return Err(Error::coded(
            ErrorCode::NotMeasurable,
            format!("{file}: red, green and blue are the same: expected a colour image"),
        ));
    }
    let mut report = report(&measured);
    report.table_if(request.chart.points, every_point(&measured));
    report.encoding(&photograph.stated);
    Ok(report)
}

fn report(measured: &[(&'static str, Vec<Displacement>)]) -> Report {
    let mut report = Report::new(
        "chromatic",
        "lateral chromatic displacement relative to green, about the image centre (ISO 19084)",
    );
    let mut rows = Vec::new();
    for (name, list) in measured {
        let worst = list.iter().max_by(|a, b| a.by.length().total_cmp(&b.by.length()));
        if let Some(worst) = worst {
            let label = format!("{name}, largest displacement");
            report.fact(&format!("{name}_largest_px"), &label, "px", worst.by.length());
            let (key, label) = (format!("{name}_largest_at_percent"), format!("{name}, at"));
            report.fact(&key, &label, "% of the half diagonal", 100.0 * worst.field);
        }
        for (axis, mean) in ["x", "y"].iter().zip(shift(list).into_iter().flatten()) {
            report.figure(&format!("{name}_shift_{axis}_px"), &format!("{name}, mean along {axis}"), "px", mean);
        }
        for ring in rings(list) {
            rows.push(vec![
                Cell::Text((*name).to_owned()),
                Cell::Number(100.0 * ring.field, 1),
                Cell::Estimate(ring.radial),
                Cell::Estimate(ring.tangential),
                Cell::Number(ring.points as f64, 0),
            ]);
        }
    }
    report.table(Table {
        key: "rings",
        columns: vec![
            ("channel", "channel"),
            ("field_percent", "field %"),
            ("radial_px", "radial px"),
            ("tangential_px", "tangential px"),
            ("points", "points"),
        ],
        rows,
    });
    report.plot(plot("radial", measured, |d| d.radial, |r| r.radial));
    report.plot(plot("tangential", measured, |d| d.tangential, |r| r.tangential));
    report
}

/// Every point of the chart in red and in blue.
fn every_point(measured: &[(&'static str, Vec<Displacement>)]) -> Table {
    let row = |name: &str, point: &Displacement| {
        vec![
            Cell::Text(name.to_owned()),
            Cell::Number(point.at.x, 4),
            Cell::Number(point.at.y, 4),
            Cell::Number(point.by.x, 4),
            Cell::Number(point.by.y, 4),
            Cell::Number(point.radial, 4),
            Cell::Number(point.tangential, 4),
            Cell::Number(point.uncertainty_px, 4),
        ]
    };
    Table {
        key: "points",
        columns: vec![
            ("channel", "channel"),
            ("x_px", "x px"),
            ("y_px", "y px"),
            ("less_green_x_px", "minus green x px"),
            ("less_green_y_px", "y px"),
            ("radial_px", "radial px"),
            ("tangential_px", "tangential px"),
            ("uncertainty_px", "± px"),
        ],
        rows: measured.iter().flat_map(|(name, list)| list.iter().map(|point| row(name, point))).collect(),
    }
}

/// One component of all points, and its means over rings.
fn plot(
    component: &str,
    measured: &[(&'static str, Vec<Displacement>)],
    point_value: fn(&Displacement) -> f64,
    ring_value: fn(&Ring) -> Estimate,
) -> Plot {
    let series = measured.iter().flat_map(|(name, list)| {
        let colour = if *name == "red" { Colour::Red } else { Colour::Blue };
        let points = list.iter().map(|d| (100.0 * d.field, point_value(d)));
        let means = rings(list).into_iter().map(|r| (100.0 * r.field, ring_value(&r)));
        let means = means.map(|(field, mean)| (field, mean.value, 2.0 * mean.standard_uncertainty));
        [
            Series::new(name, Mark::Points, points).coloured(colour),
            Series::with_errors(&format!("{name}, rings"), Mark::Line, means).coloured(colour),
        ]
    });
    Plot {
        title: format!("Lateral colour, {component} (bars: 95 %)"),
        x: Axis::linear("radial field position, % of the half diagonal").showing(&[0.0, 100.0]),
        y: Axis::linear(&format!("{component} displacement relative to green, px")).showing(&[0.0]),
        series: series.collect(),
    }
}
