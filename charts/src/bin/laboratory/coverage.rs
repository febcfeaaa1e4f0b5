//! Over all seeds: how often intervals hold the truth, as a page.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A parameter over the seeds.
#[derive(Default)]
pub(crate) struct ParameterCoverage {
    /// Value and standard uncertainty.
    estimates: Vec<[f64; 2]>,
    declared: Option<f64>,
}

pub(crate) type Rows = BTreeMap<String, ParameterCoverage>;

/// Takes in what one laboratory told.
pub(crate) fn gather(report: &Value, rows: &mut Rows) {
    for (key, value) in report["found"].as_object().into_iter().flatten() {
        if let (Some(value), Some(uncertainty)) = (value[0].as_f64(), value[1].as_f64()) {
            let row = rows.entry(key.clone()).or_default();
            row.estimates.push([value, uncertainty]);
            row.declared = report["declared"][key].as_f64();
        }
    }
}

impl ParameterCoverage {
    fn mean(&self) -> f64 {
        self.estimates.iter().map(|[v, _]| v).sum::<f64>() / self.estimates.len() as f64
    }

    /// What the intervals should hold: what is declared, or the mean over the seeds.
    fn truth(&self) -> f64 {
        self.declared.unwrap_or_else(|| self.mean())
    }

    fn covered_count(&self) -> usize {
        let truth = self.truth();
        self.estimates.iter().filter(|[v, u]| (v - truth).abs() <= 2.0 * u).count()
    }

    /// Whether the intervals hold the truth in less than 90 % of the seeds, as far as so many seeds tell (binomial, 2 σ). What less than half of the seeds tell is
    /// told by chance (so many hot pixels in the picture that they have a share), and is no sample of what it is.
    pub(crate) fn broken(&self, seeds: u64) -> Option<String> {
        if 2 * (self.estimates.len() as u64) < seeds {
            return None;
        }
        let (count, covered) = (self.estimates.len() as f64, self.covered_count() as f64);
        let margin = 2.0 * (0.9 * 0.1 / count).sqrt();
        (covered / count < 0.9 - margin).then(|| format!("{covered} of {count}"))
    }
}

pub(crate) fn introduction(seeds: u64) -> String {
    INTRODUCTION.replace("SEEDS", &seeds.to_string())
}

const INTRODUCTION: &str = "# Coverage of the intervals of characterise

Written by `just laboratory`. The three reference cameras (`charts/*/camera.toml`, with the same field in fewer, larger pixels) are rendered as laboratory folders with
SEEDS seeds and characterised. Each seed has its own noise, unit and views of the chart. Held: the fraction of seeds whose 95 % interval, value ± 2 standard uncertainties,
contains the declared value. Where the camera file declares no such number, the mean over the seeds replaces it (\"mean\"), which shows scatter and no bias.
Intervals of quantities that cannot be negative and whose true value is 0 are one-sided and hold more often than 95 %.
Of: the seeds that report the parameter. A hot-pixel fraction is reported only where chance puts enough hot pixels into the image, and is then too high.
";

pub(crate) fn table(name: &str, rows: &Rows) -> String {
    let mut text = format!(
        "\n## {name}\n\n| parameter | declared | mean found | mean standard uncertainty | scatter | held | of |\n| --- | --- | --- | --- | --- | --- | --- |\n"
    );
    for (key, row) in rows {
        let count = row.estimates.len() as f64;
        let u = row.estimates.iter().map(|[_, u]| u).sum::<f64>() / count;
        let mean = row.mean();
        let scatter =
            (row.estimates.iter().map(|[v, _]| (v - mean) * (v - mean)).sum::<f64>() / (count - 1.0).max(1.0)).sqrt();
        let declared = row.declared.map_or_else(|| "mean".to_owned(), number);
        let percent = 100.0 * row.covered_count() as f64 / count;
        let _ = writeln!(
            text,
            "| `{key}` | {declared} | {} | {u:.2e} | {scatter:.2e} | {percent:.0} % | {count} |",
            number(mean)
        );
    }
    text
}

/// To five digits.
fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let exponent = format!("{x:e}").split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok()).unwrap_or(0);
    match exponent {
        -3..=5 => format!("{x:.*}", (4 - exponent).max(0) as usize),
        _ => format!("{x:.4e}"),
    }
}
