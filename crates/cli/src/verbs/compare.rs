//! `etendue compare`: errors with their uncertainty; exit status 1 where two results differ.
//!
//! Channels that carry a variance (`variance.NAME` beside `NAME`) are compared by a Z test with a family-wise
//! significance over all channels; identities and everything without variance must be equal.

use crate::args;
use crate::failure::Failure;
use crate::say;
use etendue_io::compare::{Channel, Content, Origin, Pair, read_pair};
use etendue_stats::ErrorSummary;
use etendue_stats::family::sidak_level;
use etendue_stats::planes::{EstimatedPlane, PlaneTest, Verdict, compare};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// What is found of one channel.
struct Finding {
    name: String,
    errors: Option<ErrorSummary>,
    /// Pixels that are not equal, for channels without variance.
    unequal: usize,
    /// The test, for channels with variance.
    test: Option<PlaneTest>,
}

impl Finding {
    fn differs(&self) -> bool {
        self.test.map_or(self.unequal > 0, |test| test.verdict == Verdict::Differ)
    }
}

pub fn run(arguments: &args::Compare) -> Result<(), Failure> {
    if !(arguments.significance > 0.0 && arguments.significance < 1.0) {
        let message = format!("--significance {}: expected a probability between 0 and 1", arguments.significance);
        return Err(Failure::input(message));
    }
    let pair = read_pair(&arguments.a, &arguments.b).map_err(Failure::input)?;
    let findings = findings(&pair, arguments.significance)?;
    let differ = findings.iter().any(Finding::differs);
    say(&if arguments.json { as_json(&findings, differ) } else { as_table(&findings, differ) });
    if !differ {
        return Ok(());
    }
    if let Some(folder) = &arguments.difference {
        super::difference::write(&pair, folder)?;
    }
    Err(Failure::Run(format!("{} and {} differ", arguments.a.display(), arguments.b.display())))
}

fn findings(pair: &Pair, significance: f64) -> Result<Vec<Finding>, Failure> {
    let tested = pair.channels.iter().filter(|c| c.has_variance()).count().max(1);
    let level = sidak_level(significance, tested);
    pair.channels.iter().map(|channel| finding(channel, pair, level)).collect()
}

fn finding(channel: &Channel, pair: &Pair, level: f64) -> Result<Finding, Failure> {
    let name = channel.name.clone();
    match &channel.content {
        Content::Identity { a, b } => {
            let unequal = a.iter().zip(b).filter(|(a, b)| a != b).count();
            Ok(Finding { name, errors: None, unequal, test: None })
        }
        Content::Number { a, b, variance } => {
            let unequal = a.iter().zip(b).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            let test = match variance {
                None => None,
                Some((of_a, of_b)) => {
                    let a = estimated(a, of_a, pair.origin.0);
                    let b = estimated(b, of_b, pair.origin.1);
                    let test = compare(&a, &b, level);
                    Some(test.map_err(|error| Failure::input(format!("channel {name}: {error}")))?)
                }
            };
            let alike = pair.origin.0.alike.max(pair.origin.1.alike);
            let errors = ErrorSummary::of(a, b).map(|errors| errors.shared_by(alike));
            Ok(Finding { name, errors, unequal, test })
        }
    }
}

fn estimated<'a>(mean: &'a [f32], variance_of_mean: &'a [f32], origin: Origin) -> EstimatedPlane<'a> {
    EstimatedPlane { mean, variance_of_mean, replicates: origin.replicates, alike: origin.alike }
}

fn as_table(findings: &[Finding], differ: bool) -> String {
    let widest = findings.iter().map(|f| f.name.len()).max().unwrap_or(0).max("channel".len());
    let mut text = format!(
        "{:widest$}  {:>11} {:>11} {:>11} {:>11} {:>9} {:>9}  verdict\n",
        "channel", "rmse", "bias", "± (1 σ)", "max |error|", "max |z|", "unequal"
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
        let _ = writeln!(text, " {:>9}  {verdict}", f.unequal);
    }
    text.push_str(if differ { "they differ\n" } else { "no difference is proven\n" });
    text
}

fn as_json(findings: &[Finding], differ: bool) -> String {
    let channels: Vec<Value> = findings.iter().map(channel_json).collect();
    let text = json!({ "differ": differ, "channels": channels }).to_string();
    format!("{text}\n")
}

fn channel_json(f: &Finding) -> Value {
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
    json!({ "name": f.name, "differs": f.differs(), "unequal": f.unequal, "errors": errors, "test": test })
}
