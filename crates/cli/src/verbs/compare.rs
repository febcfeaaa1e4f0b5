//! `etendue compare`: errors with their uncertainty; exit status 1 where two results differ.

use crate::console::Console;
use clap::Args;
use etendue::{ChannelComparison, Error, compare};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;

/// `etendue compare`
#[derive(Debug, Args)]
pub struct Compare {
    /// First result, an EXR or PNG file; errors are A − B
    #[arg(value_name = "A")]
    pub a: PathBuf,
    /// Reference of the same size and channels, which is subtracted from A
    #[arg(value_name = "B")]
    pub b: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Family-wise probability of calling equal images different, for images that carry their variance
    #[arg(long, value_name = "P", default_value_t = 0.001)]
    pub significance: f64,
    /// If they differ, write A, B and |A − B| as images into this folder
    #[arg(long, value_name = "DIR")]
    pub difference: Option<PathBuf>,
}

impl Compare {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let (a, b) = (&self.a, &self.b);
        let comparison = compare(a, b, self.significance)?;
        let (channels, differ) = (&comparison.channels, comparison.differs());
        match self.json {
            true => console.print_json(&as_json(self, channels, differ)),
            false => console.print(&as_table(self, channels, differ)),
        }
        if !differ {
            return Ok(());
        }
        if let Some(folder) = &self.difference {
            comparison.save_pictures(folder)?;
        }
        Err(Error::Run(format!("{} and {} differ", a.display(), b.display())))
    }
}

fn as_table(compare: &Compare, findings: &[ChannelComparison], differ: bool) -> String {
    let widest = findings.iter().map(|f| f.name.len()).max().unwrap_or(0).max("channel".len());
    let mut text = format!(
        "difference = A − B = {} − {}\n{:widest$}  {:>11} {:>11} {:>11} {:>11} {:>9} {:>9}  verdict\n",
        compare.a.display(),
        compare.b.display(),
        "channel",
        "rmse",
        "bias",
        "± (1 σ)",
        "max |error|",
        "max |z|",
        "unequal"
    );
    for f in findings {
        let _ = write!(text, "{:widest$}", f.name);
        let _ = match &f.errors {
            Some(e) => write!(
                text,
                "  {:>11.4e} {:>11.4e} {:>11.4e} {:>11.4e}",
                e.rmse, e.bias, e.bias_standard_error, e.max_abs
            ),
            None => write!(text, "  {:>11} {:>11} {:>11} {:>11}", "-", "-", "-", "-"),
        };
        let _ = match &f.test {
            Some(test) => write!(text, " {:>9.2}", test.max_abs_z),
            None => write!(text, " {:>9}", "-"),
        };
        let verdict = if f.differs() { "differs" } else { "agrees" };
        let _ = write!(text, " {:>9}  {verdict}", f.unequal);
        if f.not_finite > 0 {
            let _ = write!(text, ", {} not finite", f.not_finite);
        }
        text.push('\n');
    }
    text.push_str(if differ { "they differ\n" } else { "no significant difference\n" });
    text
}

fn as_json(compare: &Compare, findings: &[ChannelComparison], differ: bool) -> String {
    let channels: Vec<Value> = findings.iter().map(channel_json).collect();
    let text = json!({
        "difference": "a - b", "a": compare.a.display().to_string(), "b": compare.b.display().to_string(), "differ": differ, "channels": channels,
    })
    .to_string();
    format!("{text}\n")
}

fn channel_json(f: &ChannelComparison) -> Value {
    let errors = f.errors.map(|e| {
        json!({
            "samples": e.samples, "not_finite": e.not_finite, "rmse": e.rmse, "relative_mse": e.relative_mse,
            "trimmed_relative_mse": e.trimmed_relative_mse, "bias": e.bias,
            "bias_standard_error": e.bias_standard_error, "max_abs": e.max_abs,
        })
    });
    let test = f.test.map(|t| {
        json!({
            "max_abs_z": if t.max_abs_z.is_finite() { json!(t.max_abs_z) } else { json!("infinite") },
            "p": t.p, "tests": t.tests, "pooled_pixels": t.pooled_pixels, "exceeding": t.exceeding,
            "not_finite": t.not_finite, "worst_pixel": t.worst_pixel,
        })
    });
    json!({
        "name": f.name, "differs": f.differs(), "unequal": f.unequal, "not_finite": f.not_finite, "errors": errors, "test": test,
    })
}
