//! Report of `measure sfr`.

use etendue_metrology::Estimate;
use etendue_metrology::sfr::{Orientation, SfrError, SfrPoint, acutance, crossing};

use super::request::{self, MeasuredEdge, SfrRequest, StarPlane, shading_hint};
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};
use crate::{measure::readings::Readings, measure::truth::place::EdgeRegion};

pub(super) fn report(
    request: &SfrRequest,
    measured: &[MeasuredEdge<'_>],
    left_out: &[(&EdgeRegion, SfrError)],
    readings: &Readings,
) -> Report {
    let mut report = Report::new("sfr", "slanted edges after ISO 12233:2023 (± one standard uncertainty)");
    report.encoding(&readings.stated);
    report.setting("readings", readings.kind().to_owned());
    if let Some(channel) = &request.input.selection.channel {
        report.setting("channel", channel.clone());
    }
    report.note(format!(
        "frequencies in cycles per pixel of the image; acutance viewed at {} pixels per degree",
        request.pixels_per_degree
    ));
    shading(&mut report, request, measured);
    report.table(edges(request, measured));
    let planes = request::planes(measured, readings.picture_px.0, readings.picture_px.1);
    if planes.is_empty() {
        report.table(curves(measured, "response", twentieths));
        report.table_if(false, curves(measured, "curve", every));
        report.plot(edge_plot(measured));
    } else {
        report.table(plane_table(request, &planes));
        report.table(plane_curves(&planes, "response", twentieths));
        report.table_if(false, plane_curves(&planes, "curve", every));
        report.plot(plane_plot(&planes));
    }
    report.plot(profile_plot(measured));
    if !left_out.is_empty() {
        report.note(format!("{} of {} edges could not be measured", left_out.len(), left_out.len() + measured.len()));
        report.table(refusals(request, left_out));
    }
    report
}

/// Minimum fraction of the response that is worth reporting.
const MIN_UNEVENNESS: f64 = 0.005;

/// Reports edges whose sides are not uniform.
fn shading(report: &mut Report, request: &SfrRequest, measured: &[MeasuredEdge<'_>]) {
    let max_shading = measured.iter().map(|one| one.sfr.shading).fold(0.0, f64::max);
    if max_shading > MIN_UNEVENNESS {
        let count = measured.iter().filter(|one| one.sfr.shading > MIN_UNEVENNESS).count();
        let next = request.shading_degree + 1;
        report.note(format!(
            "the levels on the sides of {count} of {} edges may not be constant: `shading_degree` {next} changes the response by \
             up to {max_shading:.3}, which the uncertainty includes",
            measured.len()
        ));
    }
}

fn place(edge_region: &EdgeRegion) -> String {
    format!("{},{}", edge_region.at[0], edge_region.at[1])
}

/// The edges of a chart that could not be measured, with the reasons.
fn refusals(request: &SfrRequest, left_out: &[(&EdgeRegion, SfrError)]) -> Table {
    let words = |error: &SfrError| format!("{error}{}", shading_hint(request, error));
    let row =
        |(edge_region, error): &(&EdgeRegion, SfrError)| vec![Cell::Text(place(edge_region)), Cell::Text(words(error))];
    Table {
        key: "refused",
        columns: vec![("at_px", "at px"), ("reason", "not measured because")],
        rows: left_out.iter().map(row).collect(),
    }
}

/// Direction of the response, across the edge.
fn direction(one: &MeasuredEdge<'_>) -> &'static str {
    match one.sfr.orientation {
        Orientation::Vertical => "horizontal",
        Orientation::Horizontal => "vertical",
    }
}

/// Columns of the quantities derived from a response, and their cells.
fn columns(request: &SfrRequest) -> Vec<(&'static str, &'static str)> {
    let mut columns = vec![("mtf50_cycles_per_px", "MTF50 c/px"), ("mtf10_cycles_per_px", "MTF10 c/px")];
    if request.pixel_pitch_um.is_some() {
        columns.extend([("mtf50_lp_per_mm", "MTF50 lp/mm"), ("mtf10_lp_per_mm", "MTF10 lp/mm")]);
    }
    columns.extend([("response_at_half", "at 0.5 c/px"), ("acutance", "acutance")]);
    columns
}

fn cells(request: &SfrRequest, curve: &[SfrPoint]) -> Vec<Cell> {
    let estimate = |e: Option<Estimate>| e.map_or(Cell::Nothing, Cell::Estimate);
    let mtf = [0.5, 0.1].map(|level| crossing(curve, level));
    let mut cells: Vec<Cell> = mtf.map(estimate).to_vec();
    if let Some(pitch_um) = request.pixel_pitch_um {
        cells.extend(mtf.map(|e| estimate(e.map(|e| e.scaled(1000.0 / pitch_um)))));
    }
    let nyquist = curve.iter().find(|p| (p.frequency - 0.5).abs() < 1e-9).map(|p| p.response);
    cells.extend([estimate(nyquist), estimate(acutance(curve, request.pixels_per_degree))]);
    cells
}

fn edges(request: &SfrRequest, measured: &[MeasuredEdge<'_>]) -> Table {
    let row = |one: &MeasuredEdge<'_>| {
        let [dark, bright] = one.sfr.levels;
        let start = [
            Cell::Text(place(one.region)),
            Cell::Number(100.0 * one.field, 1),
            Cell::Text(direction(one).to_owned()),
            Cell::Number(one.sfr.angle_deg, 3),
        ];
        let end = Cell::Number(one.sfr.noise / (bright - dark), 5);
        start.into_iter().chain(cells(request, &one.sfr.curve)).chain([end]).collect()
    };
    let start =
        [("at_px", "at px"), ("field_percent", "field %"), ("direction", "direction"), ("angle_deg", "angle °")];
    let end = ("residual_fraction", "residual");
    Table {
        key: "edges",
        columns: start.into_iter().chain(columns(request)).chain([end]).collect(),
        rows: measured.iter().map(row).collect(),
    }
}

fn plane_table(request: &SfrRequest, planes: &[StarPlane]) -> Table {
    let row = |plane: &StarPlane| {
        let start = [
            Cell::Text(plane.place.clone()),
            Cell::Number(100.0 * plane.field, 1),
            Cell::Text(plane.name.to_owned()),
            Cell::Number(plane.edges as f64, 0),
        ];
        start.into_iter().chain(cells(request, &plane.curve)).collect()
    };
    let start = [("at_px", "star at px"), ("field_percent", "field %"), ("plane", "plane"), ("edges", "edges")];
    Table {
        key: "planes",
        columns: start.into_iter().chain(columns(request)).collect(),
        rows: planes.iter().map(row).collect(),
    }
}

/// True at every twentieth of a cycle per pixel.
fn twentieths(point: &SfrPoint) -> bool {
    (20.0 * point.frequency - (20.0 * point.frequency).round()).abs() < 1e-6
}

/// True at every point: hundredths of a cycle per pixel, or less.
fn every(_: &SfrPoint) -> bool {
    true
}

fn curves(measured: &[MeasuredEdge<'_>], key: &'static str, includes: fn(&SfrPoint) -> bool) -> Table {
    let row = |one: &MeasuredEdge<'_>, point: &SfrPoint| {
        let names = [place(one.region), direction(one).to_owned()].map(Cell::Text);
        names.into_iter().chain([Cell::Number(point.frequency, 2), Cell::Estimate(point.response)]).collect()
    };
    let rows =
        |one: &MeasuredEdge<'_>| one.sfr.curve.iter().filter(|p| includes(p)).map(|p| row(one, p)).collect::<Vec<_>>();
    Table {
        key,
        columns: vec![
            ("at_px", "at px"),
            ("direction", "direction"),
            ("cycles_per_px", "c/px"),
            ("response", "response"),
        ],
        rows: measured.iter().flat_map(rows).collect(),
    }
}

fn plane_curves(planes: &[StarPlane], key: &'static str, includes: fn(&SfrPoint) -> bool) -> Table {
    let row = |plane: &StarPlane, point: &SfrPoint| {
        let names = [Cell::Text(plane.place.clone()), Cell::Text(plane.name.to_owned())];
        names.into_iter().chain([Cell::Number(point.frequency, 2), Cell::Estimate(point.response)]).collect()
    };
    let rows =
        |plane: &StarPlane| plane.curve.iter().filter(|p| includes(p)).map(|p| row(plane, p)).collect::<Vec<_>>();
    Table {
        key,
        columns: vec![("at_px", "star at px"), ("plane", "plane"), ("cycles_per_px", "c/px"), ("response", "response")],
        rows: planes.iter().flat_map(rows).collect(),
    }
}

fn points(curve: &[SfrPoint]) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
    curve.iter().map(|p| (p.frequency, p.response.value, 2.0 * p.response.standard_uncertainty))
}

fn response_plot(series: Vec<Series>) -> Plot {
    Plot {
        title: "spatial frequency response (bars: 95 %)".to_owned(),
        x: Axis::linear("cycles per pixel"),
        y: Axis::linear("response").showing(&[0.0, 1.0]),
        series,
    }
}

/// Maximum number of curves that a legend names.
const MAX_NAMED: usize = 8;

/// Name of an edge in a legend, if there is room.
fn name(one: &MeasuredEdge<'_>, count: usize) -> String {
    if count > MAX_NAMED { String::new() } else { format!("edge at {}", place(one.region)) }
}

fn edge_plot(measured: &[MeasuredEdge<'_>]) -> Plot {
    let edge_series =
        |one: &MeasuredEdge<'_>| Series::with_errors(&name(one, measured.len()), Mark::Line, points(&one.sfr.curve));
    response_plot(measured.iter().map(edge_series).collect())
}

/// Sagittal as lines, tangential dashed.
fn plane_plot(planes: &[StarPlane]) -> Plot {
    let plane_series = |plane: &StarPlane| {
        let mark = if plane.name == request::SAGITTAL { Mark::Line } else { Mark::Broken };
        let named =
            if planes.len() > MAX_NAMED { String::new() } else { format!("star at {}, {}", plane.place, plane.name) };
        Series::with_errors(&named, mark, points(&plane.curve))
    };
    response_plot(planes.iter().map(plane_series).collect())
}

fn profile_plot(measured: &[MeasuredEdge<'_>]) -> Plot {
    let profile_series = |one: &MeasuredEdge<'_>| {
        let profile = one.sfr.profile.iter().copied();
        Series::new(&name(one, measured.len()), Mark::Line, profile)
    };
    Plot {
        title: "edge profile".to_owned(),
        x: Axis::linear("distance from the edge, pixels"),
        y: Axis::linear("reading"),
        series: measured.iter().map(profile_series).collect(),
    }
}
