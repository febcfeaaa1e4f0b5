//! Projection and distortion: from views of a chart, by the camera model that fits them best.

use etendue_core::observer::Observer;
use etendue_io::failure::Error;
use etendue_scene::record::laboratory::ChartOfPoints;

use super::folder::Laboratory;
use super::parameter::{Findings, ImageKind};
use crate::measure::readings::BALANCED;
use crate::measure::views::{CalibratedViews, CandidateModel};
use crate::measure::{CameraModel, ChartInput, Target, TruthInput, ViewsRequest};
use crate::report::{Cell, Report, Table};

const QUANTITIES: &str = "focal length, principal point, distortion";

/// Candidate models, the simplest first.
const MODELS: [CameraModel; 5] =
    [CameraModel::Pinhole, CameraModel::Radial, CameraModel::Opencv, CameraModel::Opencv5, CameraModel::KannalaBrandt];

pub(super) fn measure(
    laboratory: &Laboratory,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<Option<CalibratedViews>, Error> {
    let shots = laboratory.shots(ImageKind::Chart);
    if shots.is_empty() {
        findings.missing(QUANTITIES, ImageKind::Chart);
        return Ok(None);
    }
    let stated = laboratory.stated.chart.as_ref();
    let mosaic = shots.iter().all(|shot| shot.is_raw()) && laboratory.camera.is_mosaic();
    let chart = ChartInput {
        target: stated.and_then(|chart| chart.target.as_ref()).map(|target| match target.value {
            ChartOfPoints::Checkerboard => Target::Checkerboard,
            ChartOfPoints::Dots => Target::Dots,
        }),
        grid: stated.and_then(|chart| chart.grid.as_ref()).map(|grid| grid.value.map(|n| n as usize)),
        channel: mosaic.then(|| BALANCED.to_owned()),
        cfa: laboratory.camera.stated_cfa.clone().filter(|_| mosaic),
        truth: TruthInput { truth: laboratory.truth(ImageKind::Chart).filter(|_| stated.is_none()), camera: None },
        ..ChartInput::default()
    };
    if stated.is_none() && chart.truth.truth.is_none() {
        let reason = "the distance between the chart's points is not stated; add [chart] pitch_mm to laboratory.toml, or a truth.json next to the images";
        findings.unknown(QUANTITIES, reason);
        return Ok(None);
    }
    let request = ViewsRequest {
        chart,
        pitch_mm: stated.map(|chart| chart.pitch_mm.value),
        pixel_pitch_um: laboratory.camera.pixel_pitch_um,
        ..ViewsRequest::new(shots.iter().map(|shot| shot.file.clone()).collect())
    };
    let fitted = request.calibrate_best_of(&MODELS, request.options(), observer);
    let Some((calibrated, candidates)) = findings.record(QUANTITIES, fitted)? else { return Ok(None) };
    let mut report =
        Report::new("calibrate", "camera calibration from views of a plane chart, least squares over all points");
    calibrated.add_to(&mut report, &request);
    report.table(models(&candidates));
    findings.part("Projection and distortion", ImageKind::Chart, report);
    report_results(&calibrated, laboratory, findings);
    Ok(Some(calibrated))
}

fn report_results(calibrated: &CalibratedViews, laboratory: &Laboratory, findings: &mut Findings) {
    if laboratory.camera.pixel_pitch_um.is_none() {
        findings.unknown(
            "focal length in millimetres",
            "the pixel pitch is not stated; add pixel_pitch_um to laboratory.toml",
        );
    }
    for parameter in &calibrated.camera.parameters {
        let name = parameter.name;
        let (key, unit) = (format!("lens.projection.{name}"), if name.ends_with("_px") { "px" } else { "" });
        let label = match name {
            "fx_px" => "principal distance, columns".to_owned(),
            "fy_px" => "principal distance, rows".to_owned(),
            "cx_px" => "principal point, column".to_owned(),
            "cy_px" => "principal point, row".to_owned(),
            _ => format!("{name} ({})", calibrated.model),
        };
        findings.add_parameter(ImageKind::Chart, &key, &label, unit, parameter.estimate);
        if let Some(pitch_um) = laboratory.camera.pixel_pitch_um.filter(|_| name == "fx_px") {
            let mm = parameter.estimate.scaled(0.001 * pitch_um);
            findings.add_parameter(ImageKind::Chart, "lens.principal_distance_mm", "principal distance", "mm", mm);
        }
    }
}

/// Goodness of fit of each model.
fn models(candidates: &[CandidateModel]) -> Table {
    let min_information = candidates.iter().filter(|t| t.is_valid).map(|t| t.information).fold(f64::INFINITY, f64::min);
    let row = |t: &CandidateModel| {
        let verdict = match (t.is_valid, t.information == min_information) {
            (false, _) => "folds the image over",
            (true, true) => "selected",
            (true, false) => "",
        };
        let name = Cell::Text(t.model.name().to_owned());
        vec![
            name,
            Cell::Number(t.rms_px, 5),
            Cell::Number(1e3 * (t.information - min_information), 2),
            Cell::Text(verdict.to_owned()),
        ]
    };
    Table {
        key: "models",
        columns: vec![
            ("model", "model"),
            ("rms_px", "rms px"),
            ("criterion_over_least", "criterion above the minimum, 10⁻³"),
            ("verdict", ""),
        ],
        rows: candidates.iter().map(row).collect(),
    }
}
