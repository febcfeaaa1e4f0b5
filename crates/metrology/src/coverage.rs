//! How often stated intervals cover the truth.
//!
//! A quantity is measured from 200 seeds; its 95 % interval, value ± 1.96 standard uncertainties, must hold the truth in 90 to 99 % of
//! them, 180 to 198: a fair 95 % leaves that range once in 600 tries (binomial; 1.2·10⁻³ below, 0.4·10⁻³ above). docs/coverage.md is the table;
//! `ETENDUE_BLESS=1` writes its rows anew, and a count that has moved by more than three is a fault.

use crate::Estimate;
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::Mutex;

/// Seeds of every quantity.
const SEEDS: u64 = 200;
/// How many of them may be covered.
const FAIR: core::ops::RangeInclusive<usize> = 180..=198;
/// Counts that moved by no more than this are those of the table.
const MOVED: usize = 3;
/// Tests of one run write the table one after another.
static WRITING: Mutex<()> = Mutex::new(());

/// A quantity of one seed: its name, what was measured, the truth.
pub(crate) type Run = Vec<(&'static str, Estimate, f64)>;

/// Measures 200 seeds; the intervals of every quantity must cover.
#[track_caller]
pub(crate) fn covers(measurement: &str, measured: impl Fn(u64) -> Run + Send + Sync) {
    let runs: Vec<Run> = (0..SEEDS).into_par_iter().map(measured).collect();
    let counts: Vec<(&str, usize, f64)> = (0..runs[0].len()).map(|k| count(&runs, k)).collect();
    let unfair: Vec<_> = counts.iter().filter(|(_, covered, _)| !FAIR.contains(covered)).collect();
    let told = |(name, covered, spread): &(&str, usize, f64)| {
        format!("{name}: {covered}, errors {spread:.2} standard uncertainties (rms)")
    };
    let all = counts.iter().map(told).collect::<Vec<_>>().join("\n");
    assert!(unfair.is_empty(), "{measurement}: of {SEEDS} seeds are covered\n{all}");
    table(measurement, &counts);
}

/// Of a quantity: how many seeds are covered, and the root mean square error in standard uncertainties.
fn count<'a>(runs: &[Run], k: usize) -> (&'a str, usize, f64) {
    let stated = runs.iter().filter(|run| run[k].1.standard_uncertainty.is_finite()).count();
    assert_eq!(stated, runs.len(), "{}: seeds with a stated uncertainty", runs[0][k].0);
    let errors = runs.iter().map(|run| (run[k].1.value - run[k].2) / run[k].1.standard_uncertainty);
    let covered = errors.clone().filter(|e| e.abs() <= 1.96).count();
    (runs[0][k].0, covered, (errors.map(|e| e * e).sum::<f64>() / runs.len() as f64).sqrt())
}

/// The table's rows are these.
#[track_caller]
fn table(measurement: &str, counts: &[(&str, usize, f64)]) {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/coverage.md");
    let _one = WRITING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let page = std::fs::read_to_string(&file).expect("the table");
    let head = |name: &str| format!("| {measurement} | {name} | ");
    let stated = |name: &str| {
        let row = page.lines().find_map(|line| line.strip_prefix(&head(name)))?;
        row.split_whitespace().next()?.parse::<usize>().ok()
    };
    if std::env::var_os("ETENDUE_BLESS").is_none_or(|value| value != "1") {
        for (name, covered, _) in counts {
            let near = stated(name).is_some_and(|stated| stated.abs_diff(*covered) <= MOVED);
            assert!(
                near,
                "docs/coverage.md states {:?} for {measurement}, {name}: {covered} now; ETENDUE_BLESS=1 writes it",
                stated(name)
            );
        }
        return;
    }
    let own = format!("| {measurement} | ");
    let mut rows: Vec<String> =
        page.lines().filter(|l| l.starts_with("| ") && !l.starts_with(&own)).map(str::to_owned).collect();
    let heading: Vec<String> = rows.drain(..2).collect();
    rows.extend(counts.iter().map(|(name, covered, _)| format!("{}{covered} |", head(name))));
    rows.sort();
    let text = page.lines().take_while(|l| !l.starts_with("| ")).map(str::to_owned);
    let page: String = text.chain(heading).chain(rows).map(|line| line + "\n").collect();
    std::fs::write(&file, page).expect("the table is written");
}
