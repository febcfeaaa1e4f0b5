//! `etendue measure sfr`: the response of slanted edges.

mod planes;
mod told;

use super::inquiry::{Inquiry, refused};
use super::readings::{Readings, field_position, region};
use super::truth::Truth;
use crate::failure::Failure;
use crate::machine;
use clap::Args;
use etendue_metrology::sfr::{Sfr, SfrError, SfrSettings, Strip, measure_edge, measure_strip};
use rayon::prelude::*;
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
    /// The pixels' pitch, µm: tells MTF50 and MTF10 in line pairs a millimetre, too
    #[arg(long, value_name = "UM", allow_negative_numbers = true)]
    pub pixel_pitch_um: Option<f64>,
    /// From where the picture is viewed, for acutance: its pixels a degree at the eye
    #[arg(long, value_name = "N", default_value_t = 60.0, allow_negative_numbers = true)]
    pub pixels_per_degree: f64,
    #[command(flatten)]
    pub inquiry: Inquiry,
}

/// An edge of a star among its others.
pub(super) struct Spoke {
    pub strip: Strip,
    pub star: Star,
}

/// A star: which, and where its centre is in the picture.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Star {
    pub index: [usize; 2],
    pub centre_px: [f64; 2],
}

/// An edge and where it is sought.
pub(super) struct Sought {
    /// Left column, top row, width, height, of the picture.
    pub at: [usize; 4],
    pub spoke: Option<Spoke>,
}

/// An edge that was measured.
struct Found<'a> {
    sought: &'a Sought,
    field: f64,
    sfr: Sfr,
}

pub(super) fn run(arguments: &SfrArguments) -> Result<(), Failure> {
    positive("--pixel-pitch-um", arguments.pixel_pitch_um)?;
    positive("--pixels-per-degree", Some(arguments.pixels_per_degree))?;
    let readings = arguments.inquiry.linear(&arguments.picture)?;
    // Covariances reach four pixels.
    readings.independent(&arguments.picture, 4)?;
    if readings.period.0 != readings.period.1 {
        return Err(refused(
            &arguments.picture,
            "its filters repeat at other steps along rows than along columns: measure the developed picture",
        ));
    }
    let truth = arguments.inquiry.truth(&["slanted-edges", "slanted-star"], &arguments.picture, &readings)?;
    let all = sought(arguments, truth.as_ref(), &readings)?;
    let measured = machine::pool(None)?.install(|| {
        all.par_iter().map(|one| measured(arguments, one, &readings)).collect::<Result<Vec<_>, Failure>>()
    })?;
    let (mut found, mut left_out) = (Vec::new(), Vec::new());
    for (sought, result) in all.iter().zip(measured) {
        match result {
            Ok(sfr) => found.push(Found { sought, field: field_position(&sought.at, readings.picture_px), sfr }),
            Err(error) if truth.is_some() => left_out.push((sought, error)),
            Err(error) => return Err(failure(arguments, sought, &error)),
        }
    }
    if found.is_empty() {
        let (sought, error) = &left_out[0];
        return Err(failure(arguments, sought, error));
    }
    arguments.inquiry.tell(&told::report(arguments, &found, &left_out, &readings))
}

fn positive(option: &str, value: Option<f64>) -> Result<(), Failure> {
    let wrong = value.filter(|v| !(*v > 0.0 && v.is_finite()));
    wrong.map_or(Ok(()), |v| Err(Failure::input(format!("{option}: expected a number above 0, not {v}"))))
}

fn sought(arguments: &SfrArguments, truth: Option<&Truth>, readings: &Readings) -> Result<Vec<Sought>, Failure> {
    let (width, height) = readings.picture_px;
    let regions = |list: Vec<[usize; 4]>| list.into_iter().map(|at| Sought { at, spoke: None }).collect();
    match truth {
        Some(truth) if truth.chart() == "slanted-star" => truth.spokes(readings),
        Some(truth) => Ok(regions(truth.edges(readings)?)),
        None if arguments.edges.is_empty() => Ok(regions(vec![[0, 0, width, height]])),
        None => Ok(regions(arguments.edges.clone())),
    }
}

/// The response in cycles a pixel of the picture, whatever the distance of the readings.
fn measured(arguments: &SfrArguments, sought: &Sought, readings: &Readings) -> Result<Result<Sfr, SfrError>, Failure> {
    let settings = SfrSettings {
        edge_degree: arguments.edge_degree.into(),
        reach_px: arguments.reach_px.map(|px| px / readings.period.0 as f64),
        shading_degree: arguments.shading_degree.into(),
        full_scale: arguments.inquiry.levels.full_scale(readings),
        ..SfrSettings::default()
    };
    let result = match &sought.spoke {
        Some(spoke) => measure_strip(&readings.image, &spoke.strip, &settings),
        None => measure_edge(&readings.part(sought.at, "--edge")?, &settings),
    };
    Ok(result.map(|sfr| sfr.sampled_every(readings.period.0 as f64)))
}

fn failure(arguments: &SfrArguments, sought: &Sought, error: &SfrError) -> Failure {
    let hint = shading_hint(arguments, error);
    refused(&arguments.picture, format!("edge at {},{}: {error}{hint}", sought.at[0], sought.at[1]))
}

/// What else may be tried where sides that are not even are taken for no edge.
fn shading_hint(arguments: &SfrArguments, error: &SfrError) -> &'static str {
    match error {
        SfrError::NoEdge(_) if arguments.shading_degree == 0 => {
            "; where light falls off along the surfaces, --shading-degree 1 takes that off"
        }
        _ => "",
    }
}
