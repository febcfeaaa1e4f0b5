//! Distortion and focal length, from one picture of a chart of dots; and the same of the camera that was found, simulated: its file is made
//! of what was measured, photographs the chart anew, and is measured as the first.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::Comparison;
use crate::page::Section;
use crate::program::{json, text, words};
use std::path::{Path, PathBuf};

/// The chart's place is known to so much, mm: as well as a laboratory knows it.
const DISTANCE_UNCERTAINTY_MM: f64 = 1.0;

pub(crate) fn sections(bench: &Bench<'_>) -> Result<Vec<Section>, String> {
    let dots = bench.photographed("dots", "camera", &format!("--columns {}", bench.camera.dot_columns), 16)?;
    Ok(vec![distortion(bench, &dots)?, focal(bench, &dots)?, twin(bench, &dots)?])
}

fn picture(dots: &Path) -> String {
    text(&dots.join("render/camera/picture.0000.png"))
}

fn distortion(bench: &Bench<'_>, dots: &Path) -> Result<Section, String> {
    let report = bench.folder.join("distortion.json");
    bench.program.measured(&report, &[words("distortion --target dots"), vec![picture(dots)]].concat())?;
    let (plot, shown) = bench.plot("distortion");
    let found = bench.program.compared(&report, &bench.file("camera"), &["--plot".to_owned(), text(&plot)])?;
    let found = Comparison(found);
    Ok(Section {
        title: "Distortion",
        body: found.quantities(|_| true) + &found.told("Observed over ideal distance") + &shown,
        // The curve is a ratio of distances: its relative error is one of the field position.
        reached: vec![found.curve("distortion curve", bounds::DISTORTION, "largest_relative_error_percent", 1.0)?],
    })
}

fn focal(bench: &Bench<'_>, dots: &Path) -> Result<Section, String> {
    let found =
        Comparison(bench.program.compared(&measured_focal(bench, dots, "focal")?, &bench.file("camera"), &[])?);
    let mut reached = found.reached(bounds::FOCAL_LENGTH, |key| key == "fx_mm");
    reached.iter_mut().for_each(|r| r.quantity = "focal length".to_owned());
    Ok(Section { title: "Focal length", body: found.quantities(|_| true), reached })
}

/// Focal length, k1 and k2 of a picture of dots: the report.
fn measured_focal(bench: &Bench<'_>, dots: &Path, name: &str) -> Result<PathBuf, String> {
    let (truth, side_car) = (json(&dots.join("truth.json"))?, json(&dots.join("render/camera/camera.json"))?);
    let number = |value: &serde_json::Value, what: &str| value.as_f64().ok_or_else(|| format!("{what} is not told"));
    let distance_mm = 1e3 * number(&truth["seen"]["distance_m"], "the chart's distance")?;
    let pitch_mm = number(&truth["sizes"]["pitch_mm"], "the chart's pitch")?;
    let pixel_um = number(&side_car["sensor"]["pixel_pitch_um"], "the pixels' pitch")?;
    let told = format!(
        "focal --target dots --model radial --pitch-mm {pitch_mm} --pixel-pitch-um {pixel_um} --distance-mm {distance_mm} \
         --distance-uncertainty-mm {DISTANCE_UNCERTAINTY_MM}"
    );
    let report = bench.folder.join(format!("{name}.json"));
    bench.program.measured(&report, &[words(&told), vec![picture(dots)]].concat())?;
    Ok(report)
}

fn twin(bench: &Bench<'_>, dots: &Path) -> Result<Section, String> {
    let first = bench.folder.join("focal.json");
    let (found, declared) = (json(&first)?, bench.program.compared(&first, &bench.file("camera"), &[])?);
    let figure = |key: &str| found["figures"][key]["value"].as_f64().ok_or_else(|| format!("{key} is not measured"));
    let side_car = json(&dots.join("render/camera/camera.json"))?;
    let stated = side_car["optics"]["focal_length_mm"].as_f64().ok_or("the focal length is not told")?;
    // The principal distance is measured, at the focus that is declared: the focal length is in proportion to it.
    let ratio = Comparison(declared).reached(bounds::FOCAL_LENGTH, |key| key == "fx_mm").first().and_then(|r| r.error);
    let focal_length_mm = stated * (1.0 + 0.01 * ratio.ok_or("the focal length is not declared")?);
    let camera = std::path::absolute(bench.file("camera")).map_err(|cause| cause.to_string())?;
    let file = bench.folder.join("twin.toml");
    let text = format!(
        "format = 1\nbase = {:?}\n\n[lens]\nfocal_length_mm = {focal_length_mm}\n\n[lens.distortion]\nk1 = {}\nk2 = {}\n\
         direction = \"ideal_to_observed\"\nradius_unit = \"focal_lengths\"\n",
        camera.display().to_string(),
        figure("k1")?,
        figure("k2")?
    );
    std::fs::write(&file, text).map_err(|cause| format!("{}: {cause}", file.display()))?;
    let options = format!("--columns {}", bench.camera.dot_columns);
    let chart = bench.folder.join("twin");
    bench.photograph(&chart, "dots", &file, &options, 16)?;
    let second = measured_focal(bench, &chart, "twin")?;
    let beside = Comparison(bench.program.compared(&second, &first, &[])?);
    let of = |key: &str| ["fx_mm", "k1", "k2"].contains(&key);
    let found = Comparison(bench.program.compared(&first, &bench.file("camera"), &[])?);
    Ok(Section { title: "Declared, measured and simulated", body: beside.three(&found, of), reached: Vec::new() })
}
