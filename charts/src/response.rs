//! The response of slanted edges over the field.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::{Comparison, Reached};
use crate::page::Section;
use crate::program::{text, words};
use serde_json::Value;

pub(crate) fn sections(bench: &Bench<'_>) -> Result<Vec<Section>, String> {
    let edges = bench.photographed("slanted-edges", "quiet", "--columns 3", 96)?;
    let report = bench.folder.join("response.json");
    let raw = text(&edges.join("render/camera/raw.0000.png"));
    let told = words("--edge-degree 2 --shading-degree 1 --reach-px 6 --truth");
    let truth = vec![text(&edges.join("truth.json"))];
    let measured = [vec!["sfr".to_owned(), raw], told, truth, bench.green()].concat();
    bench.program.measured(&report, &measured)?;
    let (plot, shown) = bench.plot("response");
    let found = bench.program.compared(&report, &bench.file("quiet"), &["--plot".to_owned(), text(&plot)])?;
    let found = Comparison(found);
    let reached = mean_of_edges(&found)?;
    Ok(vec![Section { title: "Response of slanted edges", body: shown, reached: vec![reached] }])
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
    Ok(Reached {
        quantity: "response up to 0.5 cycles a pixel".to_owned(),
        bound: bounds::RESPONSE,
        error: Some(error),
        e_n: Some(0.5 * error / u),
    })
}
