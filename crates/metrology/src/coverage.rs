//! How often stated intervals cover the truth.
//!
//! A quantity is measured from 200 seeds; its 95 % interval, value ± 1.96 standard uncertainties, must hold the truth in 90 to 99 % of
//! them, 180 to 198: a fair 95 % leaves that range once in 600 tries (binomial; 1.2·10⁻³ below, 0.4·10⁻³ above). docs/coverage.md is the table,
//! which `ETENDUE_BLESS=1` writes of all seeds. Without it the first 40 seeds are measured: their count may be off by one from the table's, and the table's count of 200 must be fair.

use crate::Estimate;
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::Mutex;

/// Seeds of every quantity in the table.
const SEEDS: usize = 200;
/// The first of them, which are measured every time.
const FIRST: usize = 40;
/// How many of them may be covered.
const FAIR: core::ops::RangeInclusive<usize> = 180..=198;
/// Counts of the first seeds that moved by no more than this are those of the table.
const MOVED: usize = 1;
/// Tests of one run write the table one after another.
static WRITING: Mutex<()> = Mutex::new(());

/// A quantity of one seed: its name, what was measured, the truth.
pub(crate) type Run = Vec<(&'static str, Estimate, f64)>;

/// Covered of all seeds, and of the first of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Covered {
    of_all: usize,
    of_first: usize,
}

/// Measures a quantity from its seeds; the intervals must cover.
#[track_caller]
pub(crate) fn covers(measurement: &str, measured: impl Fn(u64) -> Run + Send + Sync) {
    let blesses = std::env::var_os("ETENDUE_BLESS").is_some_and(|value| value == "1");
    let seeds = if blesses { SEEDS } else { FIRST };
    let runs: Vec<Run> = (0..seeds as u64).into_par_iter().map(measured).collect();
    let _one = WRITING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let page = std::fs::read_to_string(table()).expect("the table");
    let rows = (0..runs[0].len()).map(|k| {
        let name = runs[0][k].0;
        let of_first = count(&runs[..FIRST], k);
        let stated = stated(&page, measurement, name);
        assert!(
            blesses || stated.is_some_and(|stated| stated.of_first.abs_diff(of_first) <= MOVED),
            "docs/coverage.md states {stated:?} for {measurement}, {name}: {of_first} of the first now; ETENDUE_BLESS=1 writes it"
        );
        (name, if blesses { Covered { of_all: count(&runs, k), of_first } } else { stated.expect("as just seen") })
    });
    let rows: Vec<(&str, Covered)> = rows.collect();
    for (k, (name, covered)) in rows.iter().enumerate() {
        let spread = spread(&runs, k);
        assert!(
            FAIR.contains(&covered.of_all),
            "{measurement}, {name}: of {SEEDS} seeds {covered:?}, errors {spread:.2} standard uncertainties (rms)"
        );
    }
    if blesses {
        write(&page, measurement, &rows);
    }
}

/// Errors of a quantity in standard uncertainties, all of which must be stated.
fn errors(runs: &[Run], k: usize) -> impl Iterator<Item = f64> {
    runs.iter().map(move |run| {
        let (name, found, truth) = run[k];
        assert!(found.standard_uncertainty.is_finite(), "{name}: no uncertainty");
        (found.value - truth) / found.standard_uncertainty
    })
}

/// How many seeds are covered.
fn count(runs: &[Run], k: usize) -> usize {
    errors(runs, k).filter(|e| e.abs() <= 1.96).count()
}

/// Root mean square error in standard uncertainties.
fn spread(runs: &[Run], k: usize) -> f64 {
    (errors(runs, k).map(|e| e * e).sum::<f64>() / runs.len() as f64).sqrt()
}

fn table() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/coverage.md")
}

fn head(measurement: &str, name: &str) -> String {
    format!("| {measurement} | {name} | ")
}

/// What the table has of a quantity.
fn stated(page: &str, measurement: &str, name: &str) -> Option<Covered> {
    let head = head(measurement, name);
    let row = page.lines().find_map(|line| line.strip_prefix(&head))?;
    let (of_all, of_first) = row.strip_suffix(" |")?.split_once(" | ")?;
    Some(Covered { of_all: of_all.parse().ok()?, of_first: of_first.parse().ok()? })
}

/// Writes the rows of a measurement into the table.
fn write(page: &str, measurement: &str, found: &[(&str, Covered)]) {
    let own = format!("| {measurement} | ");
    let mut rows: Vec<String> =
        page.lines().filter(|l| l.starts_with("| ") && !l.starts_with(&own)).map(str::to_owned).collect();
    let heading: Vec<String> = rows.drain(..2).collect();
    let row = |(name, covered): &(&str, Covered)| {
        format!("{}{} | {} |", head(measurement, name), covered.of_all, covered.of_first)
    };
    rows.extend(found.iter().map(row));
    rows.sort();
    let text = page.lines().take_while(|l| !l.starts_with("| ")).map(str::to_owned);
    let page: String = text.chain(heading).chain(rows).map(|line| line + "\n").collect();
    std::fs::write(table(), page).expect("the table is written");
}
