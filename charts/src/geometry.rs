//! Distortion and focal length, from one picture of a chart of dots; and the same of the camera that was found, simulated: its file is made
//! of what was measured, photographs the chart anew, and is measured as the first.

use crate::bounds;
use crate::cameras::Bench;
use crate::page::Section;
use crate::run::{Warnings, compared, json, keep, number};
use etendue::chart::design::{Dots, GridSize};
use etendue::chart::{Chart, ChartRequest};
use etendue::measure::{
    CameraModel, ChartInput, CompareRequest, DistortionRequest, FocalRequest, StatedLength, Target, ViewsRequest,
};
use etendue::{Error, ErrorCode, ExistingFiles, measure, write_file};
use std::path::{Path, PathBuf};

/// The chart's place is known to so much, mm: as well as a laboratory knows it.
const DISTANCE_UNCERTAINTY_MM: f64 = 1.0;

pub(crate) fn sections(bench: &Bench) -> Result<Vec<Section>, Error> {
    let dots = bench.photographed("dots", &bench.request(dots(bench), "camera"), 16)?;
    Ok(vec![distortion(bench, &dots)?, focal(bench, &dots)?, simulated(bench, &dots)?])
}

/// The chart of dots.
fn dots(bench: &Bench) -> Chart {
    let size = GridSize { columns: Some(bench.camera.dot_columns), rows: None, pitch_mm: None };
    Chart::Dots(Dots { size, dot_ratio: 0.5 })
}

fn chart_image(dots: &Path) -> PathBuf {
    dots.join("render/camera/picture.0000.png")
}

fn dots_input() -> ChartInput {
    ChartInput { target: Some(Target::Dots), ..ChartInput::default() }
}

fn distortion(bench: &Bench, dots: &Path) -> Result<Section, Error> {
    let report = bench.folder.join("distortion.json");
    let request = DistortionRequest { chart: dots_input(), ..DistortionRequest::new(chart_image(dots)) };
    keep(&measure::distortion(&request)?, &report)?;
    let (plot, shown) = bench.plot("distortion");
    let comparison = compared(&CompareRequest::new(report, bench.file("camera")), Some(&plot))?;
    Ok(Section {
        title: "Distortion",
        body: comparison.quantities(|_| true) + &comparison.result_lines("Observed over ideal distance") + &shown,
        // The curve is a ratio of distances: its relative error is one of the field position.
        reached: vec![comparison.curve(
            "distortion curve",
            bounds::DISTORTION,
            "largest_relative_error_percent",
            1.0,
        )?],
    })
}

fn focal(bench: &Bench, dots: &Path) -> Result<Section, Error> {
    let report = measured_focal(bench, dots, "focal")?;
    let comparison = compared(&CompareRequest::new(report, bench.file("camera")), None)?;
    let mut results = comparison.reached(bounds::FOCAL_LENGTH, |key| key == "fx_mm");
    results.iter_mut().for_each(|r| r.quantity = "focal length".to_owned());
    Ok(Section { title: "Focal length", body: comparison.quantities(|_| true), reached: results })
}

/// Focal length, k1 and k2 of a picture of dots: the report.
fn measured_focal(bench: &Bench, dots: &Path, name: &str) -> Result<PathBuf, Error> {
    let (truth, side_car) = (json(&dots.join("truth.json"))?, json(&dots.join("render/camera/camera.json"))?);
    let distance_mm = 1e3 * number(&truth["seen"]["distance_m"], "the chart's distance")?;
    let views = ViewsRequest {
        chart: dots_input(),
        pitch_mm: Some(number(&truth["sizes"]["pitch_mm"], "the chart's pitch")?),
        model: CameraModel::Radial,
        distance_mm: Some(StatedLength { value: distance_mm, digit: 0.0 }),
        distance_uncertainty_mm: Some(DISTANCE_UNCERTAINTY_MM),
        pixel_pitch_um: Some(number(&side_car["sensor"]["pixel_pitch_um"], "the pixels' pitch")?),
        ..ViewsRequest::new(vec![chart_image(dots)])
    };
    let report = bench.folder.join(format!("{name}.json"));
    keep(&measure::focal(&FocalRequest::new(views), &Warnings)?, &report)?;
    Ok(report)
}

/// The camera that was found, simulated, and measured as the first.
fn simulated(bench: &Bench, measured_report: &Path) -> Result<Section, Error> {
    let first = bench.folder.join("focal.json");
    let declared = compared(&CompareRequest::new(&first, bench.file("camera")), None)?;
    let file = bench.folder.join("twin.toml");
    // The principal distance is measured, at the focus that is declared: the focal length is in proportion to it.
    let ratio = declared.reached(bounds::FOCAL_LENGTH, |key| key == "fx_mm").first().and_then(|r| r.error);
    let ratio =
        1.0 + 0.01 * ratio.ok_or_else(|| Error::coded(ErrorCode::NotMeasurable, "the focal length is not declared"))?;
    let text = camera_of(bench, &first, measured_report, ratio)?;
    write_file(&file, text.as_bytes(), ExistingFiles::Replace)?;
    let request = ChartRequest::new(dots(bench), file.display().to_string());
    let chart = bench.photographed("twin", &request, 16)?;
    let second = measured_focal(bench, &chart, "twin-focal")?;
    let simulated_comparison = compared(&CompareRequest::new(second, &first), None)?;
    let is_compared = |key: &str| ["fx_mm", "k1", "k2"].contains(&key);
    Ok(Section {
        title: "Declared, measured and simulated",
        body: simulated_comparison.three_columns(&declared, is_compared),
        reached: Vec::new(),
    })
}

/// The reference camera with the focal length and the distortion that were found.
fn camera_of(bench: &Bench, report: &Path, dots: &Path, ratio: f64) -> Result<String, Error> {
    let report_json = json(report)?;
    let figure = |key: &str| number(&report_json["figures"][key]["value"], key);
    let side_car = json(&dots.join("render/camera/camera.json"))?;
    let focal_length_mm = ratio * number(&side_car["optics"]["focal_length_mm"], "the focal length")?;
    let base = std::path::absolute(bench.file("camera")).map_err(Error::input)?;
    Ok(format!(
        "format = 1\nbase = {:?}\n\n[lens]\nfocal_length_mm = {focal_length_mm}\n\n[lens.distortion]\nk1 = {}\nk2 = {}\n\
         direction = \"ideal_to_observed\"\nradius_unit = \"focal_lengths\"\n",
        base.display().to_string(),
        figure("k1")?,
        figure("k2")?
    ))
}
