//! `etendue measure sfr`: the response of slanted edges.

use super::common::{Common, refused};
use super::readings::{field_position, part, region};
use super::report::{Cell, Report, Table};
use crate::failure::Failure;
use crate::plot::{Axis, Mark, Plot, Series};
use clap::Args;
use etendue_metrology::Estimate;
use etendue_metrology::sfr::{Orientation, Sfr, SfrError, SfrPoint, SfrSettings, measure_edge};
use std::path::PathBuf;

/// `etendue measure sfr`
#[derive(Debug, Args)]
pub struct SfrArguments {
    /// A picture of one or more slanted edges
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// A part of the picture that holds one edge: left column, top row, width, height; once an edge [default: all of it]
    #[arg(long = "edge", value_name = "X,Y,W,H", value_parser = region, conflicts_with = "truth")]
    pub edges: Vec<[usize; 4]>,
    /// Degree of the curve that the edges follow: 2 or 3 where the lens bends them
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=5))]
    pub edge_degree: u8,
    /// How far from the edge its profile has fine detail, pixels [default: 10]
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub reach_px: Option<f64>,
    /// Take off shading by surfaces of this degree, one on either side of the edge: 1 or 2 where the lens's fall-off makes the sides slope
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=2))]
    pub shading_degree: u8,
    #[command(flatten)]
    pub common: Common,
}

pub(super) fn run(arguments: &SfrArguments) -> Result<(), Failure> {
    let readings = arguments.common.linear(&arguments.picture)?;
    let (width, height) = readings.size();
    let truth = arguments.common.truth(&["slanted-edges"], &arguments.picture, &readings)?;
    let regions = match &truth {
        Some(truth) => truth.edges(&readings)?,
        None if arguments.edges.is_empty() => vec![[0, 0, width, height]],
        None => arguments.edges.clone(),
    };
    let settings = SfrSettings {
        edge_degree: arguments.edge_degree.into(),
        reach_px: arguments.reach_px,
        shading_degree: arguments.shading_degree.into(),
        full_scale: arguments.common.levels.full_scale(&readings),
        ..SfrSettings::default()
    };
    let mut found = Vec::new();
    let mut refused = Vec::new();
    for at in &regions {
        match measure_edge(&part(&readings.image, *at, "--edge")?, &settings) {
            Ok(sfr) => found.push((*at, sfr)),
            Err(error) if truth.is_some() => refused.push((*at, error)),
            Err(error) => return Err(failure(arguments, *at, &error)),
        }
    }
    if found.is_empty() {
        let (at, error) = &refused[0];
        return Err(failure(arguments, *at, error));
    }
    let (regions, found): (Vec<[usize; 4]>, Vec<Sfr>) = found.into_iter().unzip();
    let mut report = report(&regions, &found, (width, height));
    report.setting("readings", readings.kind().to_owned());
    if let Some(channel) = &arguments.common.selection.channel {
        report.setting("channel", channel.clone());
    }
    if !refused.is_empty() {
        report.note(format!("{} of {} edges could not be measured", refused.len(), refused.len() + found.len()));
        report.table(refusals(&refused));
    }
    arguments.common.tell(&report)
}

fn failure(arguments: &SfrArguments, at: [usize; 4], error: &SfrError) -> Failure {
    refused(&arguments.picture, format!("edge at {},{}: {error}", at[0], at[1]))
}

/// The edges of a chart that could not be measured, and why.
fn refusals(refused: &[([usize; 4], SfrError)]) -> Table {
    let row = |(at, error): &([usize; 4], SfrError)| {
        vec![Cell::Text(format!("{},{}", at[0], at[1])), Cell::Text(error.to_string())]
    };
    Table {
        key: "refused",
        columns: vec![("at_px", "at px"), ("reason", "not measured because")],
        rows: refused.iter().map(row).collect(),
    }
}

fn report(regions: &[[usize; 4]], found: &[Sfr], size: (usize, usize)) -> Report {
    let mut report = Report::new("sfr", "slanted edges after ISO 12233:2023 (± one standard uncertainty)");
    let row = |(at, sfr): (&[usize; 4], &Sfr)| {
        let estimate = |e: Option<Estimate>| e.map_or(Cell::Nothing, Cell::Estimate);
        let nyquist = sfr.curve.iter().find(|p| (p.frequency - 0.5).abs() < 1e-9).map(|p| p.response);
        vec![
            Cell::Text(format!("{},{}", at[0], at[1])),
            Cell::Number(100.0 * field_position(at, size), 1),
            Cell::Text(direction(sfr).to_owned()),
            Cell::Number(sfr.angle_deg, 3),
            estimate(sfr.mtf50),
            estimate(sfr.mtf10),
            estimate(nyquist),
            Cell::Number(sfr.noise / (sfr.levels[1] - sfr.levels[0]), 5),
        ]
    };
    report.table(Table {
        key: "edges",
        columns: vec![
            ("at_px", "at px"),
            ("field_percent", "field %"),
            ("direction", "direction"),
            ("angle_deg", "angle °"),
            ("mtf50_cycles_per_px", "MTF50 c/px"),
            ("mtf10_cycles_per_px", "MTF10 c/px"),
            ("response_at_half", "at 0.5 c/px"),
            ("residual_share", "residual"),
        ],
        rows: regions.iter().zip(found).map(row).collect(),
    });
    report.table(curves(regions, found));
    plots(&mut report, regions, found);
    report
}

/// Of the response, across the edge.
fn direction(sfr: &Sfr) -> &'static str {
    match sfr.orientation {
        Orientation::Vertical => "horizontal",
        Orientation::Horizontal => "vertical",
    }
}

/// Every twentieth of a cycle a pixel.
fn curves(regions: &[[usize; 4]], found: &[Sfr]) -> Table {
    let row = |at: &[usize; 4], sfr: &Sfr, point: &SfrPoint| {
        let place = [format!("{},{}", at[0], at[1]), direction(sfr).to_owned()].map(Cell::Text);
        [place.to_vec(), vec![Cell::Number(point.frequency, 2), Cell::Estimate(point.response)]].concat()
    };
    let rows =
        |(at, sfr): (&[usize; 4], &Sfr)| sfr.curve.iter().step_by(5).map(|p| row(at, sfr, p)).collect::<Vec<_>>();
    Table {
        key: "response",
        columns: vec![
            ("at_px", "at px"),
            ("direction", "direction"),
            ("cycles_per_px", "c/px"),
            ("response", "response"),
        ],
        rows: regions.iter().zip(found).flat_map(rows).collect(),
    }
}

fn plots(report: &mut Report, regions: &[[usize; 4]], found: &[Sfr]) {
    let name = |at: &[usize; 4]| format!("edge at {},{}", at[0], at[1]);
    let response = |(at, sfr): (&[usize; 4], &Sfr)| {
        let points = sfr.curve.iter().map(|p| (p.frequency, p.response.value, 2.0 * p.response.standard_uncertainty));
        Series::with_errors(&name(at), Mark::Line, points)
    };
    report.plot(Plot {
        title: "spatial frequency response (bars: 95 %)".to_owned(),
        x: Axis::linear("cycles a pixel"),
        y: Axis::linear("response").showing(&[0.0, 1.0]),
        series: regions.iter().zip(found).map(response).collect(),
    });
    let profile = |(at, sfr): (&[usize; 4], &Sfr)| Series::new(&name(at), Mark::Line, sfr.profile.iter().copied());
    report.plot(Plot {
        title: "edge profile".to_owned(),
        x: Axis::linear("distance from the edge, pixels"),
        y: Axis::linear("reading"),
        series: regions.iter().zip(found).map(profile).collect(),
    });
}
