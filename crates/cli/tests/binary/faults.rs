//! The bench detects seeded defects: a camera with a defect is compared with the file without it, and the defect is flagged by its quantity; the same
//! camera without the defect, with the same seeds, is not flagged. docs/evidence/faults.md is the table, written by `just faults`.

mod geometry;
mod light;
mod sensor;

use crate::support::{bless, etendue, root, text};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

const CAMERA: &str = "charts/faults/camera.toml";
/// The same with colours.
const COLOUR: &str = "charts/faults/colour.toml";
const PAGE: &str = "docs/evidence/faults.md";
/// Tests of one run write the page one after another.
static WRITING: Mutex<()> = Mutex::new(());

/// A quantity or curve of a comparison: its largest E_n, and the threshold for a flag.
#[derive(Clone, Copy, Debug)]
struct ComparedQuantity {
    e_n: f64,
    limit: f64,
}

impl ComparedQuantity {
    fn differs(self) -> bool {
        self.e_n.abs() > self.limit
    }
}

/// A comparison, by quantity and curve.
type ComparedQuantities = BTreeMap<String, ComparedQuantity>;

/// A folder of one test.
struct TestFolder(tempfile::TempDir);

impl TestFolder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A chart for the declared camera.
    fn chart(&self, name: &str, camera: &str, options: &[&str]) -> PathBuf {
        let folder = self.path(name);
        let arguments = ["chart", name, "--camera", camera, "-o"].map(str::to_owned).into_iter().chain([text(&folder)]);
        etendue(arguments.chain(options.iter().map(|o| (*o).to_owned()))).ok();
        folder
    }

    /// A render of a chart's job: the folder of the camera's files.
    fn rendered(&self, chart: &Path, name: &str, options: &[&str]) -> PathBuf {
        let output = self.path(name);
        let arguments = ["render".to_owned(), text(&chart.join("job.toml")), "-o".to_owned(), text(&output)];
        etendue(arguments.into_iter().chain(options.iter().map(|o| (*o).to_owned()))).ok();
        output.join("camera")
    }

    /// Compares the result of a measurement (its arguments) with the declaration of a camera file.
    #[track_caller]
    fn compare_with_declaration(&self, measure: &[&str], camera: &str, options: &[&str]) -> ComparedQuantities {
        let output = etendue(["measure"].iter().chain(measure).chain(&["--json"])).ok().out;
        let file = self.path("measured.json");
        std::fs::write(&file, output).expect("a temporary file");
        let compare = ["measure", "compare", &text(&file), camera, "--json"].map(str::to_owned);
        let run = etendue(compare.into_iter().chain(options.iter().map(|o| (*o).to_owned())));
        let report: Value = serde_json::from_str(&run.out).unwrap_or_else(|_| panic!("{run:?}"));
        let compared = tests(&report);
        assert_eq!(run.status, i32::from(compared.values().any(|t| t.differs())), "{run:?}");
        compared
    }
}

/// The tests of a comparison.
fn tests(report: &Value) -> ComparedQuantities {
    let rows = |table: &str| report["tables"][table].as_array().cloned().unwrap_or_default();
    let test = |row: &Value, name: &str| {
        Some((
            row[name].as_str()?.to_owned(),
            ComparedQuantity { e_n: row["e_n"].as_f64()?, limit: row["limit"].as_f64().unwrap_or(1.0) },
        ))
    };
    let quantities = rows("quantities").into_iter().filter_map(|row| test(&row, "quantity"));
    quantities.chain(rows("curves").into_iter().filter_map(|row| test(&row, "curve"))).collect()
}

/// Asserts that nothing is flagged for a camera without a defect.
#[track_caller]
fn assert_none_flagged(compared: &ComparedQuantities) {
    assert!(!compared.is_empty() && compared.values().all(|t| !t.differs()), "a sound camera is flagged: {compared:?}");
}

/// Asserts that the defect is flagged by its quantity, which the sound camera passes.
#[track_caller]
fn assert_flagged(
    defect: &str,
    seeded: &str,
    quantity: &str,
    defective: &ComparedQuantities,
    healthy: &ComparedQuantities,
) {
    let (with, without) = (defective[quantity], healthy[quantity]);
    assert!(with.differs() && !without.differs(), "{defect}: {quantity} {with:?}, without it {without:?}");
    assert_row(defect, seeded, quantity, with, without);
}

/// Asserts that the page has the defect's row; its numbers are those of the last `just faults`.
#[track_caller]
fn assert_row(defect: &str, seeded: &str, quantity: &str, with: ComparedQuantity, without: ComparedQuantity) {
    let head = format!("| {defect} | {seeded} | `{quantity}` |");
    if bless() {
        assert_in_page(defect, &format!("{head} {:.2} | {:.2} | {:.2} |", with.e_n, without.e_n, with.limit));
        return;
    }
    let _one = WRITING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let page = std::fs::read_to_string(root().join(PAGE)).expect("the page");
    assert!(page.lines().any(|line| line.starts_with(&head)), "{PAGE} lacks {head}: run just faults");
}

/// Asserts that the page has this row of a defect.
#[track_caller]
fn assert_in_page(defect: &str, row: &str) {
    let _one = WRITING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let page = std::fs::read_to_string(root().join(PAGE)).expect("the page");
    if !bless() {
        assert!(page.lines().any(|line| line == row), "{PAGE} lacks {row}: run just faults");
        return;
    }
    let old = format!("| {defect} |");
    let known = page.lines().any(|line| line.starts_with(&old));
    let lines = page.lines().map(|line| if line.starts_with(&old) { row.to_owned() } else { line.to_owned() });
    let further = (!known).then(|| row.to_owned());
    let page: String = lines.chain(further).map(|line| line + "\n").collect();
    std::fs::write(root().join(PAGE), page).expect("the page is written");
}
