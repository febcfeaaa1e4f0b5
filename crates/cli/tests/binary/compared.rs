//! `etendue measure compare`.

use crate::support::{Ran, etendue, root, text};
use serde_json::{Value, json};
use std::path::Path;

/// A measurement of a quantity and of a curve over the field.
fn measurement(folder: &Path, name: &str, [k1, u]: [f64; 2], scale: f64) -> String {
    let row = |i: i32| {
        let field = f64::from(i) / 10.0;
        let ratio = scale * (1.0 + k1 * field * field);
        json!({ "field_percent": 100.0 * field, "ratio": { "value": ratio, "standard_uncertainty": 1e-4 } })
    };
    let report = json!({
        "measurement": "distortion",
        "method": "by hand",
        "settings": {},
        "figures": {
            "forward_k1": { "value": k1, "standard_uncertainty": u, "unit": "" },
            "points": { "value": 100.0 * scale, "standard_uncertainty": null, "unit": "" },
        },
        "tables": { "curve": (1..=10).map(row).collect::<Vec<_>>() },
        "notes": [],
    });
    written(folder, name, &report)
}

fn written(folder: &Path, name: &str, report: &Value) -> String {
    let file = folder.join(name);
    std::fs::write(&file, report.to_string()).expect("a temporary file");
    text(&file)
}

fn compare(a: &str, b: &str) -> Ran {
    etendue(["measure", "compare", a, b, "--json"])
}

fn row<'a>(report: &'a Value, table: &str, key: &str, name: &str) -> &'a Value {
    let rows = report["tables"][table].as_array().expect("rows");
    rows.iter().find(|row| row[key] == name).unwrap_or_else(|| panic!("{name} is missing in {report}"))
}

/// E_n = 0.001 / (2 √2 · 0.0005) = 0.7071 of k1; the curves are apart by 0.001 at the edge of the field, 1e-3/(2 √2 1e-4) = 3.54.
#[test]
fn measurements_are_compared_by_their_uncertainties() {
    let folder = tempfile::tempdir().expect("a folder");
    let a = measurement(folder.path(), "a.json", [0.101, 5e-4], 1.0);
    let b = measurement(folder.path(), "b.json", [0.1, 5e-4], 1.0);
    let ran = compare(&a, &b);
    assert_eq!(ran.status, 1, "{ran:?}");
    assert!(ran.err.contains("differ: curve"), "{ran:?}");
    let report: Value = serde_json::from_str(&ran.out).expect("JSON");
    let k1 = row(&report, "quantities", "quantity", "forward_k1");
    let number = |value: &Value| value.as_f64().expect("a number");
    assert!((number(&k1["e_n"]) - 0.5_f64.sqrt()).abs() < 1e-9, "{k1}");
    assert!((number(&k1["relative_error_percent"]) - 1.0).abs() < 1e-9, "{k1}");
    assert_eq!(k1["verdict"], "agrees");
    // A count is laid beside the other and not tested.
    assert_eq!(row(&report, "quantities", "quantity", "points")["verdict"], Value::Null);
    let curve = row(&report, "curves", "curve", "curve");
    assert!((number(&curve["largest_difference"]) - 1e-3).abs() < 1e-12, "{curve}");
    assert!((number(&curve["e_n"]) - 12.5_f64.sqrt()).abs() < 1e-6, "{curve}");
    assert_eq!(curve["verdict"], "differs");
}

#[test]
fn equal_measurements_agree_and_are_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let a = measurement(folder.path(), "a.json", [0.1, 5e-4], 1.0);
    let plot = text(&folder.path().join("both.svg"));
    let said = etendue(["measure", "compare", &a, &a, "--plot", &plot]).ok().out;
    assert!(said.contains("forward_k1") && !said.contains("differs"), "{said}");
    let drawn = std::fs::read_to_string(&plot).expect("a plot");
    assert!(drawn.contains("relative error"), "both curves and their relative error");
}

/// The forward camera declares k1 = −0.12 in its principal distance: 4.6 mm focused at 10 m, 4.6 · 10/(10 − 0.0046) mm. Within half of
/// the uncertainty of 1e-5, k1 in half diagonals is found again.
#[test]
fn a_camera_file_declares_what_was_measured() {
    let folder = tempfile::tempdir().expect("a folder");
    let camera = text(&root().join("scenes/cameras/automotive.toml"));
    let half_diagonal_mm = 0.006 * 0.5 * (960.0_f64 * 960.0 + 600.0 * 600.0).sqrt();
    let radius = half_diagonal_mm / (4.6 * 10.0 / (10.0 - 0.0046));
    let k1 = -0.12 * radius * radius;
    let measured = |k1: f64| {
        let figures = json!({ "forward_k1": { "value": k1, "standard_uncertainty": 1e-5, "unit": "" } });
        let report = json!({ "measurement": "distortion", "figures": figures, "tables": {} });
        written(folder.path(), "measured.json", &report)
    };
    compare(&measured(k1 + 5e-6), &camera).ok();
    // One part in a hundred is seen.
    assert_eq!(compare(&measured(1.01 * k1), &camera).status, 1);
}

#[test]
fn contradictions_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let a = measurement(folder.path(), "a.json", [0.1, 5e-4], 1.0);
    let figures = |unit: &str| json!({ "forward_k1": { "value": 1.0, "standard_uncertainty": 0.1, "unit": unit } });
    let report = |kind: &str, unit: &str| json!({ "measurement": kind, "figures": figures(unit), "tables": {} });
    let other = written(folder.path(), "kind.json", &report("vignetting", ""));
    compare(&a, &other).refused(&["different kinds", "distortion", "vignetting"]);
    let other = written(folder.path(), "unit.json", &report("distortion", "mm"));
    compare(&a, &other).refused(&["forward_k1", "one unit"]);
    let model = |model: &str| {
        let report =
            json!({ "measurement": "focal", "settings": { "model": model }, "figures": figures(""), "tables": {} });
        written(folder.path(), &format!("{model}.json"), &report)
    };
    compare(&model("opencv"), &model("radial-inverse")).refused(&["model", "opencv", "radial-inverse"]);
    let nothing = json!({ "measurement": "distortion", "figures": {}, "tables": {} });
    compare(&a, &written(folder.path(), "nothing.json", &nothing)).refused(&["no quantity in common"]);
    let camera = text(&root().join("scenes/cameras/automotive.toml"));
    compare(&camera, &camera).refused(&["two camera files"]);
    compare(&a, &written(folder.path(), "other.json", &json!([1]))).refused(&["other.json", "--json"]);
    etendue(["measure", "compare", &a, &a, "--set", "sensor.bits=8"]).refused(&["--set", "neither side"]);
}
