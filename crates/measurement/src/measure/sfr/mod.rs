//! `measure sfr`: the response of slanted edges, detected in an image.

mod report;
mod request;

use etendue_charts::design::{SlantedEdges, SlantedStar};
use etendue_io::failure::{Error, ErrorCode, check_integer};
use etendue_metrology::sfr::{Sfr, SfrError, SfrSettings, measure_edge, measure_strip};
use rayon::prelude::*;

use super::pictures::{refused, region_label};
use super::readings::{Readings, field_position};
use super::{truth::Truth, truth::place::EdgeRegion};
use crate::report::Report;
use report::report;
use request::{EDGE_DEGREES, MeasuredEdge, SHADING_DEGREES, failure};

pub use request::SfrRequest;

const CHARTS: [&str; 2] = [SlantedEdges::NAME, SlantedStar::NAME];

/// The spatial frequency response of slanted edges (ISO 12233:2023). Runs on the caller's thread pool.
///
/// # Errors
/// If the image contains no measurable edge.
pub fn sfr(request: &SfrRequest) -> Result<Report, Error> {
    Ok(responses(request)?.0)
}

/// The same with the responses themselves.
pub(crate) fn responses(request: &SfrRequest) -> Result<(Report, Vec<Sfr>), Error> {
    request.input.check_without_black()?;
    check_integer("edge_degree", request.edge_degree, EDGE_DEGREES)?;
    check_integer("shading_degree", request.shading_degree, SHADING_DEGREES)?;
    positive("pixel_pitch_um", request.pixel_pitch_um)?;
    positive("pixels_per_degree", Some(request.pixels_per_degree))?;
    let readings = request.input.linear(&request.picture)?;
    // Covariances reach four pixels.
    readings.independent(&request.picture, 4)?;
    if readings.period.0 != readings.period.1 {
        return Err(refused(
            &request.picture,
            "its filters repeat at different steps along rows and columns; measure the developed image",
        ));
    }
    let truth = request.input.truth(&CHARTS, &request.picture, &readings)?;
    let all = edge_regions(request, truth.as_ref(), &readings)?;
    let measured = all.par_iter().map(|one| measured(request, one, &readings)).collect::<Result<Vec<_>, Error>>()?;
    let (mut measured_edges, mut left_out) = (Vec::new(), Vec::new());
    for (edge_region, result) in all.iter().zip(measured) {
        match result {
            Ok(sfr) => measured_edges.push(MeasuredEdge {
                region: edge_region,
                field: field_position(&edge_region.at, readings.picture_px.0, readings.picture_px.1),
                sfr,
            }),
            Err(error) if truth.is_some() => left_out.push((edge_region, error)),
            Err(error) => return Err(failure(request, edge_region, &error)),
        }
    }
    if measured_edges.is_empty() {
        let (edge_region, error) = &left_out[0];
        return Err(failure(request, edge_region, error));
    }
    let mut report = report(request, &measured_edges, &left_out, &readings);
    let full_scale = request.input.levels.full_scale(&readings);
    for one in measured_edges.iter().filter(|one| one.region.spoke.is_none()) {
        report.note_cut(&region_label("edge", one.region.at), &readings.part_of("edges", one.region.at)?, full_scale);
    }
    Ok((report, measured_edges.into_iter().map(|one| one.sfr).collect()))
}

fn positive(field: &str, value: Option<f64>) -> Result<(), Error> {
    let wrong = value.filter(|v| !(*v > 0.0 && v.is_finite()));
    wrong.map_or(Ok(()), |v| {
        Err(Error::argument(field, format!("`{field}`: expected a number above 0, not {v}"))
            .with_code(ErrorCode::OutOfRange))
    })
}

fn edge_regions(request: &SfrRequest, truth: Option<&Truth>, readings: &Readings) -> Result<Vec<EdgeRegion>, Error> {
    let (width, height) = readings.picture_px;
    let regions = |list: Vec<[usize; 4]>| list.into_iter().map(|at| EdgeRegion { at, spoke: None }).collect();
    match truth {
        Some(truth) if truth.chart() == SlantedStar::NAME => truth.spokes(readings),
        Some(truth) => Ok(regions(truth.edges(readings)?)),
        None if request.edges.is_empty() => Ok(regions(vec![[0, 0, width, height]])),
        None => Ok(regions(request.edges.clone())),
    }
}

/// The response in cycles per pixel of the image, whatever the distance of the readings.
fn measured(
    request: &SfrRequest,
    edge_region: &EdgeRegion,
    readings: &Readings,
) -> Result<Result<Sfr, SfrError>, Error> {
    let settings = SfrSettings {
        edge_degree: request.edge_degree.into(),
        reach_px: request.reach_px.map(|px| px / readings.period.0 as f64),
        shading_degree: request.shading_degree.into(),
        full_scale: request.input.levels.full_scale(readings),
        ..SfrSettings::default()
    };
    let result = match &edge_region.spoke {
        Some(spoke) => measure_strip(&readings.image, &spoke.strip, &settings),
        None => measure_edge(&readings.part_of("edges", edge_region.at)?, &settings),
    };
    Ok(result.map(|sfr| sfr.sampled_every(readings.period.0 as f64)))
}
