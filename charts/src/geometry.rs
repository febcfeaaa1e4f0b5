//! Distortion and focal length, from one picture of a chart of dots.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::Comparison;
use crate::page::Section;
use crate::program::{json, text, words};
use std::path::Path;

/// The chart's place is known to so much, mm: as well as a laboratory knows it.
const DISTANCE_UNCERTAINTY_MM: f64 = 1.0;

pub(crate) fn sections(bench: &Bench<'_>) -> Result<Vec<Section>, String> {
    let dots = bench.photographed("dots", "camera", &format!("--columns {}", bench.camera.dot_columns), 16)?;
    Ok(vec![distortion(bench, &dots)?, focal(bench, &dots)?])
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
    let (truth, side_car) = (json(&dots.join("truth.json"))?, json(&dots.join("render/camera/camera.json"))?);
    let number = |value: &serde_json::Value, what: &str| value.as_f64().ok_or_else(|| format!("{what} is not told"));
    let distance_mm = 1e3 * number(&truth["seen"]["distance_m"], "the chart's distance")?;
    let pitch_mm = number(&truth["sizes"]["pitch_mm"], "the chart's pitch")?;
    let pixel_um = number(&side_car["sensor"]["pixel_pitch_um"], "the pixels' pitch")?;
    let told = format!(
        "focal --target dots --model radial --pitch-mm {pitch_mm} --pixel-pitch-um {pixel_um} --distance-mm {distance_mm} \
         --distance-uncertainty-mm {DISTANCE_UNCERTAINTY_MM}"
    );
    let report = bench.folder.join("focal.json");
    bench.program.measured(&report, &[words(&told), vec![picture(dots)]].concat())?;
    let found = Comparison(bench.program.compared(&report, &bench.file("camera"), &[])?);
    let mut reached = found.reached(bounds::FOCAL_LENGTH, |key| key == "fx_mm");
    reached.iter_mut().for_each(|r| r.quantity = "focal length".to_owned());
    Ok(Section { title: "Focal length", body: found.quantities(|_| true), reached })
}
