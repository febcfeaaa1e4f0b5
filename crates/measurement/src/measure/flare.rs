//! `measure flare`: veiling light in light traps.

use std::path::PathBuf;

use clap::Args;
use etendue_arguments::region;
use etendue_charts::design::Flare;
use etendue_io::failure::Error;
use etendue_metrology::{Estimate, flare::measure_flare};

use super::pictures::{MeasurementInput, refused, region_label};
use super::readings::{Readings, field_position};
use super::truth::place::TrapPlace;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure flare`
#[derive(Args, Clone, Debug)]
pub struct FlareRequest {
    /// Image of light traps in a white field
    #[arg(value_name = "IMAGE")]
    pub picture: PathBuf,
    /// Part of a light trap: left column, top row, width, height; once per trap
    #[arg(long = "trap", value_name = "X,Y,W,H", value_parser = region, required_unless_present = "truth", conflicts_with = "truth")]
    pub traps: Vec<[usize; 4]>,
    /// Part of the white field
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, required_unless_present = "truth", conflicts_with = "truth")]
    pub white: Option<[usize; 4]>,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

impl FlareRequest {
    /// Creates a request with the program's defaults.
    pub fn new(image: impl Into<PathBuf>) -> Self {
        Self { picture: image.into(), traps: Vec::new(), white: None, input: MeasurementInput::default() }
    }
}

const CHARTS: [&str; 1] = [Flare::NAME];

/// Veiling light in light traps, which emit none (ISO 18844).
///
/// # Errors
/// If the image or its traps cannot be used.
pub fn flare(request: &FlareRequest) -> Result<Report, Error> {
    let readings = request.input.linear(&request.picture)?;
    let traps = traps(request, &readings)?;
    let levels = &request.input.levels;
    let (black, full_scale) = (levels.black(&readings), levels.full_scale(&readings));
    let measured = |place: &TrapPlace| {
        let trap = readings.part_of("traps", place.trap)?;
        let whites = place.whites.iter().map(|at| readings.part_of("white", *at));
        let whites = whites.collect::<Result<Vec<_>, _>>()?;
        measure_flare(&trap, &whites, black, full_scale, readings.shared_px)
            .map_err(|error| refused(&request.picture, error))
    };
    let estimates = traps.iter().map(measured).collect::<Result<Vec<_>, Error>>()?;
    let places: Vec<[usize; 4]> = traps.iter().map(|t| t.trap).collect();
    let mut report = report(&places, &estimates, readings.picture_px.0, readings.picture_px.1);
    report.encoding(&readings.stated);
    for place in &traps {
        report.note_cut(&region_label("trap", place.trap), &readings.part_of("traps", place.trap)?, full_scale);
        for white in &place.whites {
            report.note_cut(&region_label("white", *white), &readings.part_of("white", *white)?, full_scale);
        }
    }
    if let Some(truth) = request.input.truth.read(&CHARTS)?
        && let Some(own) = truth.light_of_traps()
    {
        report.fact("traps_own_percent", "of which emitted by the traps, about", "%", 100.0 * own);
    }
    Ok(report)
}

fn traps(request: &FlareRequest, readings: &Readings) -> Result<Vec<TrapPlace>, Error> {
    match request.input.truth(&CHARTS, &request.picture, readings)? {
        Some(truth) => truth.traps(readings),
        None => {
            let whites: Vec<[usize; 4]> = request.white.into_iter().collect();
            Ok(request.traps.iter().map(|trap| TrapPlace { trap: *trap, whites: whites.clone() }).collect())
        }
    }
}

fn report(traps: &[[usize; 4]], measured: &[Estimate], width_px: usize, height_px: usize) -> Report {
    let mut report = Report::new("flare", "flare after ISO 18844: light in traps relative to the white field");
    let largest = measured.iter().copied().reduce(|a, b| if b.value > a.value { b } else { a });
    let mean = measured.iter().map(|f| f.value).sum::<f64>() / measured.len() as f64;
    let squares = measured.iter().map(|f| f.standard_uncertainty * f.standard_uncertainty).sum::<f64>();
    let mean = Estimate::new(mean, squares.sqrt() / measured.len() as f64);
    report.figure("mean_flare_percent", "mean flare", "%", mean.scaled(100.0));
    report.figure("flare_percent", "largest flare", "%", largest.unwrap_or(Estimate::new(0.0, 0.0)).scaled(100.0));
    let row = |(at, value): (&[usize; 4], &Estimate)| {
        vec![
            Cell::Text(format!("{},{}", at[0], at[1])),
            Cell::Number(100.0 * field_position(at, width_px, height_px), 1),
            Cell::Estimate(value.scaled(100.0)),
        ]
    };
    report.table(Table {
        key: "traps",
        columns: vec![("at_px", "at px"), ("field_percent", "field %"), ("flare_percent", "flare %")],
        rows: traps.iter().zip(measured).map(row).collect(),
    });
    let points = traps.iter().zip(measured).map(|(at, flare)| {
        (100.0 * field_position(at, width_px, height_px), 100.0 * flare.value, 200.0 * flare.standard_uncertainty)
    });
    report.plot(Plot {
        title: "flare (bars: 95 %)".to_owned(),
        x: Axis::linear("radial field position, % of the half diagonal").showing(&[0.0, 100.0]),
        y: Axis::linear("flare, %").showing(&[0.0]),
        series: vec![Series::with_errors("", Mark::Points, points)],
    });
    report
}
