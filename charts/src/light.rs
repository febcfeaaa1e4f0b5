//! Fall-off of light, and tone curves through the lens.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::Comparison;
use crate::page::Section;
use crate::program::{json, text, words};
use std::path::{Path, PathBuf};

const EXPOSURES: usize = 15;
/// Of the 96 × 72 pixels, where the light is even to 0.1 %.
const MIDDLE: &str = "--region 32,20,32,32";

pub(crate) fn sections(bench: &Bench<'_>) -> Result<Vec<Section>, String> {
    Ok(vec![vignetting(bench)?, tone(bench)?])
}

fn vignetting(bench: &Bench<'_>) -> Result<Section, String> {
    let field = bench.photographed("flat-field", "camera", "", 64)?;
    let report = bench.folder.join("vignetting.json");
    let raw = text(&field.join("render/camera/raw.0000.png"));
    let black = vec!["--black".to_owned(), black_dn(bench, &field)?.to_string()];
    bench.program.measured(&report, &[vec!["vignetting".to_owned(), raw], bench.green(), black].concat())?;
    let (plot, shown) = bench.plot("vignetting");
    let found = bench.program.compared(&report, &bench.file("camera"), &["--plot".to_owned(), text(&plot)])?;
    let found = Comparison(found);
    Ok(Section {
        title: "Vignetting",
        body: found.quantities(|_| true) + &found.told("Light over that of the centre") + &shown,
        reached: vec![found.curve("vignetting", bounds::VIGNETTING, "largest_relative_error_percent", 1.0)?],
    })
}

/// The reading without light at the picture's exposure, dark current in it, by the dark current's series: a tenth of a per cent of the light,
/// which the corner would have three times.
fn black_dn(bench: &Bench<'_>, field: &Path) -> Result<f64, String> {
    let dark = json(&bench.folder.join("dark.json"))?;
    let figure = |key: &str| dark["figures"][key]["value"].as_f64().ok_or_else(|| format!("{key} is not measured"));
    let exposure_s = exposure_s(&field.join("render/camera"))?;
    Ok(figure("dark_level_dn")? + figure("gain_dn_per_e")? * figure(crate::electronics::DARK_CURRENT)? * exposure_s)
}

fn tone(bench: &Bench<'_>) -> Result<Section, String> {
    let panel = bench.chart("backlit", "tone", &format!("--exposures {EXPOSURES}"))?;
    let cameras: Vec<PathBuf> = (1..=EXPOSURES).map(|i| panel.join(format!("exposure-{i:02}.toml"))).collect();
    let shots = exposed(bench, &panel, &cameras)?;
    let exposures: Vec<String> =
        shots.iter().map(|shot| Ok(exposure_s(shot)?.to_string())).collect::<Result<_, String>>()?;
    let raws: Vec<String> = shots.iter().map(|shot| text(&shot.join("raw.0000.png"))).collect();
    let (raw, body) = curve(bench, "raw", &[raws, bench.green()].concat())?;
    let pictures: Vec<String> = shots.iter().map(|shot| text(&shot.join("picture.0000.png"))).collect();
    let told = [words("--channel G --exposures"), vec![exposures.join(",")]].concat();
    let (picture, more) = curve(bench, "picture", &[pictures, told].concat())?;
    Ok(Section { title: "Tone curve, fifteen exposures", body: body + &more, reached: vec![raw, picture] })
}

/// The light of a panel rendered once, and exposed by each camera: their folders of pictures.
fn exposed(bench: &Bench<'_>, panel: &Path, cameras: &[PathBuf]) -> Result<Vec<PathBuf>, String> {
    let job = vec!["render".to_owned(), text(&panel.join("job.toml")), "-o".to_owned(), text(&panel.join("light"))];
    let settings = "--camera exposure-01 --set render.route=\"pupil\" --set output.radiance=true --set render.spp=64";
    bench.program.run(&[job, words(settings)].concat())?;
    let light = panel.join("light/exposure-01/radiance.exr");
    let mut shots = Vec::new();
    // Each frame has noise of its own.
    for (seed, camera) in (1..).zip(cameras) {
        let to = panel.join(format!("shot-{seed}"));
        let one =
            vec!["expose".to_owned(), text(&light), "--camera".to_owned(), text(camera), "-o".to_owned(), text(&to)];
        bench.program.run(&[one, words(&format!("--seed {seed}"))].concat())?;
        shots.push(only_folder(&to)?);
    }
    Ok(shots)
}

fn only_folder(folder: &Path) -> Result<PathBuf, String> {
    let told = |cause: std::io::Error| format!("{}: {cause}", folder.display());
    let mut entries = std::fs::read_dir(folder).map_err(told)?.filter_map(Result::ok).map(|entry| entry.path());
    entries.find(|path| path.is_dir()).ok_or_else(|| format!("{}: no results", folder.display()))
}

fn exposure_s(shot: &Path) -> Result<f64, String> {
    let side_car = json(&shot.join("camera.json"))?;
    let exposure = side_car["frames"][0]["exposure_s"].as_f64();
    exposure.ok_or_else(|| format!("{}: its exposure is not told", shot.display()))
}

/// A tone curve measured and compared.
fn curve(bench: &Bench<'_>, of: &str, pictures: &[String]) -> Result<(crate::comparison::Reached, String), String> {
    let report = bench.folder.join(format!("tone-{of}.json"));
    bench.program.measured(&report, &[words("oecf"), pictures.to_vec(), words(MIDDLE)].concat())?;
    let (plot, shown) = bench.plot(&format!("tone-{of}"));
    let found = bench.program.compared(&report, &bench.file("tone"), &["--plot".to_owned(), text(&plot)])?;
    let full_scale = json(&report)?["figures"]["full_scale"]["value"].as_f64().ok_or("the full scale is not told")?;
    let found = Comparison(found);
    let of = format!("tone curve, {of}");
    let reached = found.curve(&of, bounds::TONE, "largest_difference", 100.0 / full_scale)?;
    Ok((reached, found.told(&format!("Reading over exposure ({of})")) + &shown))
}
