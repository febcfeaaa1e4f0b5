//! Fall-off of light, and tone curves through the lens.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::BoundResult;
use crate::page::Section;
use crate::run::{Warnings, compared, json, keep, number};
use etendue::chart::design::{Backlit, FlatField};
use etendue::chart::{Chart, ChartRequest, ExposureSeries, Exposures, Spacing};
use etendue::measure::{
    CompareRequest, FlatFieldRequest, MeasurementInput, OecfRequest, Selection, SignalLevels, VignettingRequest,
};
use etendue::{Error, ErrorCode, ExistingFiles, ExposeRequest, JobRequest, RenderOptions, expose, measure};
use std::path::{Path, PathBuf};

const EXPOSURES: usize = 15;
/// What white reaches in the shortest and the longest exposure, of saturation.
const WHITE_RANGE: [f64; 2] = [0.003, 1.3];
/// Of the 96 × 72 pixels, where the light is even to 0.1 %.
const CENTRE_REGION: [usize; 4] = [32, 20, 32, 32];

pub(crate) fn sections(bench: &Bench) -> Result<Vec<Section>, Error> {
    Ok(vec![vignetting(bench)?, tone(bench)?])
}

fn vignetting(bench: &Bench) -> Result<Section, Error> {
    let chart = bench.request(Chart::FlatField(FlatField { reflectance: 0.9 }), "camera");
    let field = bench.photographed("flat-field", &chart, 64)?;
    let report = bench.folder.join("vignetting.json");
    let input = MeasurementInput {
        selection: Selection { channel: bench.green(), ..Selection::default() },
        levels: SignalLevels { black: Some(black_dn(bench, &field)?), full_scale: None },
        ..MeasurementInput::default()
    };
    let flat = FlatFieldRequest { input, ..FlatFieldRequest::new(field.join("render/camera/raw.0000.png")) };
    keep(&measure::vignetting(&VignettingRequest::new(flat))?, &report)?;
    let (plot, shown) = bench.plot("vignetting");
    let comparison = compared(&CompareRequest::new(report, bench.file("camera")), Some(&plot))?;
    Ok(Section {
        title: "Vignetting",
        body: comparison.quantities(|_| true)
            + &comparison.result_lines("Illumination relative to the centre")
            + &shown,
        reached: vec![comparison.curve("vignetting", bounds::VIGNETTING, "largest_relative_error_percent", 1.0)?],
    })
}

/// The reading without light at the picture's exposure, dark current in it, by the dark current's series: a tenth of a per cent of the light,
/// which the corner would have three times.
fn black_dn(bench: &Bench, field: &Path) -> Result<f64, Error> {
    let dark = json(&bench.folder.join("dark.json"))?;
    let figure = |key: &str| number(&dark["figures"][key]["value"], key);
    let exposure_s = exposure_s(&field.join("render/camera"))?;
    Ok(figure("dark_level_dn")? + figure("gain_dn_per_e")? * figure(crate::electronics::DARK_CURRENT)? * exposure_s)
}

fn tone(bench: &Bench) -> Result<Section, Error> {
    let [lowest, highest] = WHITE_RANGE;
    let exposures = Exposures::spaced(EXPOSURES as u32, Spacing::Log, lowest, highest)
        .map_err(|error| Error::coded(ErrorCode::NotMeasurable, error.to_string()))?;
    let series = Some(ExposureSeries { exposures, required: true });
    let chart = ChartRequest { series, ..bench.request(Chart::Backlit(Backlit), "tone") };
    let panel = bench.drawn("backlit", &chart)?;
    let cameras: Vec<PathBuf> = (1..=EXPOSURES).map(|i| panel.join(format!("exposure-{i:02}.toml"))).collect();
    let shots = exposed(&panel, &cameras)?;
    let images = |name: &str| shots.iter().map(|shot| shot.join(name)).collect::<Vec<_>>();
    let raw = curve(bench, "raw", bench.green(), OecfRequest::new(images("raw.0000.png")))?;
    let exposures = shots.iter().map(|shot| exposure_s(shot)).collect::<Result<Vec<f64>, _>>()?;
    let request = OecfRequest { exposures, ..OecfRequest::new(images("picture.0000.png")) };
    let developed = curve(bench, "picture", Some("G".to_owned()), request)?;
    Ok(Section {
        title: "Tone curve, fifteen exposures",
        body: raw.1 + &developed.1,
        reached: vec![raw.0, developed.0],
    })
}

/// The light of a panel rendered once, and exposed by each camera: their folders of pictures.
fn exposed(panel: &Path, cameras: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
    let mut job = JobRequest::new(panel.join("job.toml"));
    job.camera = Some("exposure-01".to_owned());
    let settings = ["render.route=\"pupil\"", "output.radiance=true", "render.spp=64"];
    job.set = settings.map(str::to_owned).to_vec();
    job.open()?.save(&RenderOptions::default(), &panel.join("light"), ExistingFiles::Refuse, &Warnings)?;
    let light = panel.join("light/exposure-01/radiance.exr");
    let mut shots = Vec::new();
    // Each frame has noise of its own.
    for (seed, camera) in (1..).zip(cameras) {
        let to = panel.join(format!("shot-{seed}"));
        let request = ExposeRequest { seed: Some(seed), ..ExposeRequest::new(&light, camera) };
        let files = expose(&request, &to, ExistingFiles::Refuse, &Warnings)?;
        let folder = files
            .first()
            .and_then(|file| file.parent())
            .ok_or_else(|| Error::coded(ErrorCode::NotMeasurable, "no results"))?;
        shots.push(folder.to_owned());
    }
    Ok(shots)
}

fn exposure_s(shot: &Path) -> Result<f64, Error> {
    let side_car = json(&shot.join("camera.json"))?;
    number(&side_car["frames"][0]["exposure_s"], &format!("{}: the exposure", shot.display()))
}

/// A tone curve measured and compared.
fn curve(
    bench: &Bench,
    output_name: &str,
    channel: Option<String>,
    request: OecfRequest,
) -> Result<(BoundResult, String), Error> {
    let selection = Selection { channel, region: Some(CENTRE_REGION), ..Selection::default() };
    let measured = measure::oecf(&OecfRequest {
        input: MeasurementInput { selection, ..MeasurementInput::default() },
        ..request
    })?;
    let report = bench.folder.join(format!("tone-{output_name}.json"));
    keep(&measured, &report)?;
    let (plot, shown) = bench.plot(&format!("tone-{output_name}"));
    let comparison = compared(&CompareRequest::new(report, bench.file("tone")), Some(&plot))?;
    let full_scale = measured
        .value("full_scale")
        .ok_or_else(|| Error::coded(ErrorCode::NotMeasurable, "the full scale is not told"))?
        .value;
    let output = if output_name == "picture" { "developed image" } else { output_name };
    let title = format!("tone curve, {output}");
    let result = comparison.curve(&title, bounds::TONE, "largest_difference", 100.0 / full_scale)?;
    Ok((result, comparison.result_lines(&format!("Value over exposure ({title})")) + &shown))
}
