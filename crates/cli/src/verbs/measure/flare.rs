//! `etendue measure flare`: light in traps that send none.

use super::readings::{Levels, Selection, part, region};
use super::report::{Cell, Report, Table, Telling};
use crate::failure::Failure;
use clap::Args;
use etendue_metrology::Estimate;
use etendue_metrology::flare::measure_flare;
use std::path::PathBuf;

/// `etendue measure flare`
#[derive(Debug, Args)]
pub struct Flare {
    /// A picture of light traps in a white field
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// A part of a light trap: left column, top row, width, height; once a trap
    #[arg(long = "trap", value_name = "X,Y,W,H", value_parser = region, required = true)]
    pub traps: Vec<[usize; 4]>,
    /// A part of the white field
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub white: [usize; 4],
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub levels: Levels,
    #[command(flatten)]
    pub telling: Telling,
}

pub(super) fn run(arguments: &Flare) -> Result<(), Failure> {
    let readings = arguments.selection.linear(&arguments.picture)?;
    let traps = arguments.traps.iter().map(|at| part(&readings.image, *at, "--trap")).collect::<Result<Vec<_>, _>>()?;
    let white = part(&readings.image, arguments.white, "--white")?;
    let (black, full_scale) = (arguments.levels.black(&readings), arguments.levels.full_scale(&readings));
    let named = |error| Failure::input(format!("{}: {error}", arguments.picture.display()));
    let flare = measure_flare(&traps, &white, black, full_scale).map_err(named)?;
    let mut report = Report::new("flare", "flare after ISO 18844: light in traps over the white field's");
    let largest = flare.iter().copied().reduce(|a, b| if b.value > a.value { b } else { a });
    report.figure("flare_percent", "largest flare", "%", largest.unwrap_or(Estimate::new(0.0, 0.0)).scaled(100.0));
    let row = |(at, value): (&[usize; 4], &Estimate)| {
        vec![Cell::Text(format!("{},{}", at[0], at[1])), Cell::Estimate(value.scaled(100.0))]
    };
    report.table(Table {
        key: "traps",
        columns: vec![("at_px", "at px"), ("flare_percent", "flare %")],
        rows: arguments.traps.iter().zip(&flare).map(row).collect(),
    });
    report.tell(&arguments.telling)
}
