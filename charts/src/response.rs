//! The response of slanted edges over the field.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::{Comparison, Reached};
use crate::page::Section;
use crate::program::{text, words};
use serde_json::Value;

pub(crate) fn sections(bench: &Bench<'_>) -> Result<Vec<Section>, String> {
    Ok(vec![
        section(bench, "quiet", "Response of slanted edges", "response up to 0.5 cycles a pixel")?,
        section(bench, "diffraction", "Response with diffraction", "response with diffraction")?,
    ])
}

fn section(bench: &Bench<'_>, file: &str, title: &'static str, quantity: &str) -> Result<Section, String> {
    let edges = bench.folder.join(format!("edges-{file}"));
    bench.photograph(&edges, "slanted-edges", &bench.file(file), "--columns 3", 96)?;
    let report = bench.folder.join(format!("response-{file}.json"));
    let raw = text(&edges.join("render/camera/raw.0000.png"));
    // Six readings, which lie two pixels apart where pixels have colours.
    let reach_px = if bench.camera.filters.is_some() { 12 } else { 6 };
    let told = words(&format!("--edge-degree 2 --shading-degree 1 --reach-px {reach_px} --truth"));
    let truth = vec![text(&edges.join("truth.json"))];
    let measured = [vec!["sfr".to_owned(), raw], told, truth, bench.green()].concat();
    bench.program.measured(&report, &measured)?;
    let (plot, shown) = bench.plot(&format!("response-{file}"));
    let found = bench.program.compared(&report, &bench.file(file), &["--plot".to_owned(), text(&plot)])?;
    let reached = Reached { quantity: quantity.to_owned(), ..mean_of_edges(&Comparison(found))? };
    Ok(Section { title, body: shown, reached: vec![reached] })
}

/// The largest error of the mean of all edges up to half a cycle a pixel.
fn mean_of_edges(found: &Comparison) -> Result<Reached, String> {
    let points = found.0["tables"]["means"].as_array().into_iter().flatten();
    let pair = |row: &Value| {
        let difference = &row["difference"];
        Some((row["at"].as_f64()?, difference["value"].as_f64()?, difference["standard_uncertainty"].as_f64()?))
    };
    let worst = points.filter_map(pair).filter(|(at, ..)| *at <= 0.5).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let (_, error, u) = worst.ok_or("no response was compared")?;
    Ok(Reached { quantity: String::new(), bound: bounds::RESPONSE, error: Some(error), e_n: Some(0.5 * error / u) })
}
