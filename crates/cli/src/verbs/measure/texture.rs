//! `etendue measure star` and `etendue measure texture`: fine structure.

use super::readings::{Levels, Selection};
use super::report::{Cell, Report, Table, Telling};
use crate::failure::Failure;
use crate::plot::{Axis, Mark, Plot, Series};
use clap::Args;
use etendue_metrology::Estimate;
use etendue_metrology::texture::leaves::{TexturePoint, measure_texture};
use etendue_metrology::texture::star::{Star, StarPoint, measure_star};
use std::path::PathBuf;

/// `etendue measure star`
#[derive(Debug, Args)]
pub struct StarArguments {
    /// A picture of a Siemens star
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// The star's centre, raster coordinates, within two pixels
    #[arg(long, value_name = "X,Y", value_parser = super::shading::point)]
    pub centre_px: (f64, f64),
    /// Cycles of dark and bright all round
    #[arg(long, value_name = "N")]
    pub cycles: u32,
    /// The smallest circle, px
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub inner_px: f64,
    /// The largest circle, px: the response is 1 there
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub outer_px: f64,
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub levels: Levels,
    #[command(flatten)]
    pub telling: Telling,
}

/// `etendue measure texture`
#[derive(Debug, Args)]
pub struct Texture {
    /// A picture of a texture such as dead leaves
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// The texture itself at the same place, pixel by pixel: a sharp render without noise
    #[arg(value_name = "REFERENCE")]
    pub reference: PathBuf,
    /// A picture of an even surface of the same brightness, for the noise
    #[arg(long, value_name = "PICTURE")]
    pub even: Option<PathBuf>,
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub telling: Telling,
}

pub(super) fn star(arguments: &StarArguments) -> Result<(), Failure> {
    let readings = arguments.selection.linear(&arguments.picture)?;
    let star = Star {
        centre_px: arguments.centre_px,
        cycles: arguments.cycles,
        inner_px: arguments.inner_px,
        outer_px: arguments.outer_px,
        black: arguments.levels.black(&readings),
    };
    let named = |error| Failure::input(format!("{}: {error}", arguments.picture.display()));
    let (points, (x, y)) = measure_star(&readings.image, &star).map_err(named)?;
    let mut report =
        Report::new("star", "Siemens star after ISO 12233, over its outer circle (± one standard uncertainty)");
    report.figure("centre_x_px", "centre, x", "px", Estimate::new(x, 0.01));
    report.figure("centre_y_px", "centre, y", "px", Estimate::new(y, 0.01));
    let row =
        |p: &StarPoint| vec![Cell::Number(p.radius_px, 1), Cell::Number(p.frequency, 4), Cell::Estimate(p.response)];
    report.table(Table {
        key: "circles",
        columns: vec![("radius_px", "radius px"), ("cycles_per_px", "c/px"), ("response", "response")],
        rows: points.iter().map(row).collect(),
    });
    let curve = points.iter().map(|p| (p.frequency, p.response.value, 2.0 * p.response.standard_uncertainty));
    report.plot(response_plot("response of the star (bars: 95 %)", vec![Series::with_errors("", Mark::Line, curve)]));
    report.tell(&arguments.telling)
}

fn response_plot(title: &str, series: Vec<Series>) -> Plot {
    Plot {
        title: title.to_owned(),
        x: Axis::linear("cycles a pixel").showing(&[0.0]),
        y: Axis::linear("response").showing(&[0.0, 1.0]),
        series,
    }
}

pub(super) fn texture(arguments: &Texture) -> Result<(), Failure> {
    let read = |file: &PathBuf| Ok(arguments.selection.linear(file)?.image);
    let (picture, reference) = (read(&arguments.picture)?, read(&arguments.reference)?);
    let even = arguments.even.as_ref().map(read).transpose()?;
    let points = measure_texture(&picture, &reference, even.as_ref()).map_err(Failure::input)?;
    let mut report = Report::new("texture", "response to a texture against its reference (± one standard uncertainty)");
    if even.is_none() {
        report.note("without --even noise counts as structure in 'direct'");
    }
    let row = |p: &TexturePoint| {
        vec![
            Cell::Number(p.frequency, 4),
            Cell::Estimate(p.response),
            Cell::Number(p.direct, 4),
            Cell::Number(p.coherence, 4),
        ]
    };
    report.table(Table {
        key: "bands",
        columns: vec![
            ("cycles_per_px", "c/px"),
            ("response", "response"),
            ("direct", "direct"),
            ("coherence", "coherence"),
        ],
        rows: points.iter().map(row).collect(),
    });
    let kept = points.iter().map(|p| (p.frequency, p.response.value, 2.0 * p.response.standard_uncertainty));
    report.plot(response_plot(
        "response to texture (bars: 95 %)",
        vec![
            Series::with_errors("kept", Mark::Line, kept),
            Series::new("structure of any kind", Mark::Broken, points.iter().map(|p| (p.frequency, p.direct))),
        ],
    ));
    report.tell(&arguments.telling)
}
