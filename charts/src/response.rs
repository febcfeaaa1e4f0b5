//! The response of slanted edges over the field.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::{BoundResult, Comparison};
use crate::page::Section;
use crate::run::{compared, keep};
use etendue::chart::Chart;
use etendue::chart::design::{GridSize, SlantedEdges};
use etendue::measure::{CompareRequest, MeasurementInput, Selection, SfrRequest, TruthInput, sfr};
use etendue::{Error, ErrorCode};
use serde_json::Value;

pub(crate) fn sections(bench: &Bench) -> Result<Vec<Section>, Error> {
    Ok(vec![
        section(bench, "quiet", "Response of slanted edges", "response up to 0.5 cycles/px")?,
        section(bench, "diffraction", "Response with diffraction", "response with diffraction")?,
    ])
}

fn section(bench: &Bench, file: &str, title: &'static str, quantity: &str) -> Result<Section, Error> {
    let size = GridSize { columns: Some(3), rows: None, pitch_mm: None };
    let chart = Chart::SlantedEdges(SlantedEdges { size, angle_deg: 5.0, contrast: 4.0 });
    let edges = bench.photographed(&format!("edges-{file}"), &bench.request(chart, file), 96)?;
    let report = bench.folder.join(format!("response-{file}.json"));
    // Six readings, which lie two pixels apart where pixels have colours.
    let reach_px = if bench.camera.filters.is_some() { 12.0 } else { 6.0 };
    let input = MeasurementInput {
        selection: Selection { channel: bench.green(), ..Selection::default() },
        truth: TruthInput { truth: Some(edges.join("truth.json")), camera: None },
        ..MeasurementInput::default()
    };
    let raw = edges.join("render/camera/raw.0000.png");
    let request =
        SfrRequest { edge_degree: 2, shading_degree: 1, reach_px: Some(reach_px), input, ..SfrRequest::new(raw) };
    keep(&sfr(&request)?, &report)?;
    let (plot, shown) = bench.plot(&format!("response-{file}"));
    let comparison = compared(&CompareRequest::new(report, bench.file(file)), Some(&plot))?;
    let result = BoundResult { quantity: quantity.to_owned(), ..mean_of_edges(&comparison)? };
    Ok(Section { title, body: shown, reached: vec![result] })
}

/// The largest error of the mean of all edges up to half a cycle a pixel.
fn mean_of_edges(comparison: &Comparison) -> Result<BoundResult, Error> {
    let points = comparison.0["tables"]["means"].as_array().into_iter().flatten();
    let pair = |row: &Value| {
        let difference = &row["difference"];
        Some((row["at"].as_f64()?, difference["value"].as_f64()?, difference["standard_uncertainty"].as_f64()?))
    };
    let worst = points.filter_map(pair).filter(|(at, ..)| *at <= 0.5).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let (_, error, u) = worst.ok_or_else(|| Error::coded(ErrorCode::NotMeasurable, "no response was compared"))?;
    Ok(BoundResult { quantity: String::new(), bound: bounds::RESPONSE, error: Some(error), e_n: Some(0.5 * error / u) })
}
