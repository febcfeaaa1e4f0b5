//! Coverage of stated intervals: the fraction that contains the true value.
//!
//! A quantity is measured with 200 seeds. Its 95 % interval, value ± 1.96 standard uncertainties, must contain the true value in
//! 90 to 99 % of them, 180 to 198: a correct 95 % interval leaves that range once in 600 tries (binomial; 1.2·10⁻³ below,
//! 0.4·10⁻³ above). docs/evidence/data/coverage.csv is the table.
//!
//! `ETENDUE_BLESS=1` rewrites the table and `ETENDUE_WHOLE=1` compares it with 200 seeds; a count that differs by more than three
//! is an error. Otherwise only the first 50 seeds are measured, and the root mean square of their errors in standard
//! uncertainties must agree with the table within 3 %. That test is more sensitive: uncertainties that are too small by a tenth
//! change it by a tenth, but the count of 200 by about six.

use std::{path::PathBuf, sync::Mutex};

use rayon::prelude::*;

use crate::Estimate;

/// Seeds per quantity.
const SEEDS: u64 = 200;
/// Allowed number of covered seeds.
const ALLOWED_COUNTS: core::ops::RangeInclusive<usize> = 180..=198;
/// Maximum difference of a count from the table.
const MAX_COUNT_CHANGE: usize = 3;
/// Seeds that every test run measures.
const FEW_SEEDS: usize = 50;
/// Maximum relative difference of their root mean square error from the table's.
const SPREAD_TOLERANCE: f64 = 0.03;
/// Serialises the tests of one run that write the table.
static TABLE_LOCK: Mutex<()> = Mutex::new(());

/// A quantity for one seed: its name, the measured estimate, the true value.
pub(crate) type CoverageRun = Vec<(&'static str, Estimate, f64)>;

/// Coverage of a quantity.
struct Coverage {
    quantity: &'static str,
    /// Seeds whose interval contains the true value.
    covered: usize,
    /// Root mean square of the errors of the first 50 seeds, in standard uncertainties.
    spread: f64,
}

/// Asserts that the intervals of every quantity cover the true value as the table states.
#[track_caller]
pub(crate) fn assert_coverage(measurement: &str, measured: impl Fn(u64) -> CoverageRun + Send + Sync) {
    let is_whole = is_set("ETENDUE_BLESS") || is_set("ETENDUE_WHOLE");
    let seeds = if is_whole { SEEDS } else { FEW_SEEDS as u64 };
    let runs: Vec<CoverageRun> = (0..seeds).into_par_iter().map(measured).collect();
    let quantities: Vec<Coverage> = (0..runs[0].len()).map(|k| coverage(&runs, k)).collect();
    if is_whole {
        let is_fair = |quantity: &&Coverage| !ALLOWED_COUNTS.contains(&quantity.covered);
        let unfair: Vec<_> = quantities
            .iter()
            .filter(is_fair)
            .map(|quantity| (quantity.quantity, quantity.covered, quantity.spread))
            .collect();
        assert!(unfair.is_empty(), "{measurement}: of {SEEDS} seeds are covered {unfair:?}");
    }
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/evidence/data/coverage.csv");
    let _one = TABLE_LOCK.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let table = std::fs::read_to_string(&file).expect("the table");
    if is_set("ETENDUE_BLESS") {
        std::fs::write(&file, with_rows(&table, measurement, &quantities)).expect("the table is written");
    } else {
        compare(&table, measurement, &quantities, is_whole);
    }
}

fn is_set(variable: &str) -> bool {
    std::env::var_os(variable).is_some_and(|value| value == "1")
}

fn coverage(runs: &[CoverageRun], k: usize) -> Coverage {
    let quantity = runs[0][k].0;
    let stated = runs.iter().filter(|run| run[k].1.standard_uncertainty.is_finite()).count();
    assert_eq!(stated, runs.len(), "{quantity}: seeds with a stated uncertainty");
    let errors: Vec<f64> = runs.iter().map(|run| (run[k].1.value - run[k].2) / run[k].1.standard_uncertainty).collect();
    let covered = errors.iter().filter(|error| error.abs() <= 1.96).count();
    let squares: f64 = errors[..FEW_SEEDS].iter().map(|error| error * error).sum();
    Coverage { quantity, covered, spread: (squares / FEW_SEEDS as f64).sqrt() }
}

/// The beginning of a quantity's row.
fn head(measurement: &str, quantity: &str) -> String {
    format!("\"{measurement}\",\"{quantity}\",")
}

#[track_caller]
fn compare(table: &str, measurement: &str, quantities: &[Coverage], is_whole: bool) {
    for Coverage { quantity, covered, spread } in quantities {
        let row = table.lines().find_map(|line| line.strip_prefix(&head(measurement, quantity)));
        let numbers: Vec<f64> = row.into_iter().flat_map(|row| row.split(',')).flat_map(str::parse::<f64>).collect();
        let [stated_count, stated_spread] = numbers[..] else {
            panic!(
                "docs/evidence/data/coverage.csv has no row for {measurement}, {quantity}; ETENDUE_BLESS=1 writes it"
            )
        };
        let is_near = (spread / stated_spread - 1.0).abs() <= SPREAD_TOLERANCE
            && (!is_whole || (*covered as f64 - stated_count).abs() <= MAX_COUNT_CHANGE as f64);
        assert!(
            is_near,
            "docs/evidence/data/coverage.csv states {stated_count} covered and {stated_spread} for {measurement}, {quantity}: {covered} of {} and \
             {spread:.3} now; ETENDUE_BLESS=1 writes it",
            if is_whole { SEEDS } else { FEW_SEEDS as u64 }
        );
    }
}

/// The table with regenerated rows of a measurement.
fn with_rows(table: &str, measurement: &str, quantities: &[Coverage]) -> String {
    let own = format!("\"{measurement}\",");
    let mut lines = table.lines();
    let heading = lines.next().unwrap_or_default().to_owned();
    let mut rows: Vec<String> = lines.filter(|line| !line.starts_with(&own)).map(str::to_owned).collect();
    rows.extend(quantities.iter().map(|quantity| {
        format!("{}{},{:.3}", head(measurement, quantity.quantity), quantity.covered, quantity.spread)
    }));
    rows.sort();
    core::iter::once(heading).chain(rows).map(|line| line + "\n").collect()
}
