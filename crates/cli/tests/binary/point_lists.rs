//! Charts of points from lists (CSV), from reference data, and views that do not belong together.

use crate::support::{etendue, text};
use etendue_core::maths::f64::sin_cos;
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;

const SIZE: &str = "640x480";

fn json(arguments: &[&str]) -> Value {
    let arguments = arguments.iter().copied().chain(["--json"]);
    serde_json::from_str(&etendue(arguments).ok().out).expect("JSON")
}

fn figure(report: &Value, key: &str) -> [f64; 2] {
    let number = |part: &str| report["figures"][key][part].as_f64();
    [
        number("value").unwrap_or_else(|| panic!("{key} is missing in {report}")),
        number("standard_uncertainty").unwrap_or(0.0),
    ]
}

/// Noise-like displacement of a hundredth of a pixel.
fn jitter(i: usize, k: usize) -> f64 {
    0.02 * (((i * 7919 + k * 104_729) % 1009) as f64 / 1009.0 - 0.5)
}

/// Points of 9 × 7 steps of 30 mm, seen at 600 mm and turned about two axes; by r = f tan θ or, for a fisheye, r = f θ, f = 500 px.
fn list(folder: &Path, name: &str, [about_x, about_y]: [f64; 2], fisheye: bool, skewed: bool) -> String {
    let ((sx, cx), (sy, cy)) = (sin_cos(about_x), sin_cos(about_y));
    let mut lines = "column,row,x_px,y_px,uncertainty_px\n".to_owned();
    for i in 0..63 {
        let (column, row) = (i % 9, i / 9);
        let (u, v) = (30.0 * (column as f64 - 4.0), 30.0 * (row as f64 - 3.0));
        let (x, y, z) = (u * cy, u * sx * sy + v * cx, 600.0 - u * cx * sy + v * sx);
        let r = etendue_core::maths::f64::hypot(x, y);
        let theta = etendue_core::maths::f64::atan2(r, z);
        let scale = if fisheye && r > 0.0 { 500.0 * theta / r } else { 500.0 / z };
        let value = if skewed { column + row } else { column };
        let at = [320.0 + scale * x + jitter(i, 1), 240.0 + scale * y + jitter(i, 2)];
        writeln!(lines, "{value},{row},{},{},0.006", at[0], at[1]).expect("a string");
    }
    let file = folder.join(name);
    std::fs::write(&file, lines).expect("written");
    text(&file)
}

const TURNS: [[f64; 2]; 5] = [[0.0, 0.0], [0.5, 0.0], [-0.5, 0.1], [0.0, 0.5], [0.3, -0.5]];

fn lists(folder: &Path, fisheye: bool) -> Vec<String> {
    TURNS.iter().enumerate().map(|(i, turn)| list(folder, &format!("view{i}.csv"), *turn, fisheye, false)).collect()
}

fn calibrate<'a>(views: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    let start = ["calibrate", "--pitch-mm", "30", "--size-px", SIZE];
    start.into_iter().chain(views.iter().map(String::as_str)).chain(more.iter().copied()).collect()
}

#[test]
fn lists_of_points_give_cameras_and_distortion() {
    let folder = tempfile::tempdir().expect("a folder");
    let views = lists(folder.path(), false);
    let report = json(&calibrate(&views, &[]));
    for (key, want) in [("fx_px", 500.0), ("fy_px", 500.0), ("cx_px", 320.0), ("cy_px", 240.0), ("k1", 0.0)] {
        let [value, u] = figure(&report, key);
        assert!((value - want).abs() < 4.0 * u && u < 1e-2 * (want + 1.0), "{key}: {value} ± {u}");
    }
    let report = json(&["measure", "distortion", &views[0], "--size-px", SIZE]);
    let [largest, u] = figure(&report, "local_largest_percent");
    assert!(largest.abs() < 4.0 * u && u < 0.05, "{largest} ± {u}");
    etendue(["measure", "distortion", &views[0]]).refused(&["view0.csv", "--size-px"]);
    let bad = folder.path().join("bad.csv");
    std::fs::write(&bad, "column,row,x_px,y_px\n0,0,1,2\n0,zero,3,4\n").expect("written");
    etendue(["measure", "distortion", &text(&bad), "--size-px", SIZE])
        .refused(&["bad.csv:3", "row: expected a number"]);
}

#[test]
fn a_wrongly_numbered_view_is_omitted_and_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut views = lists(folder.path(), false);
    views[2] = list(folder.path(), "skewed.csv", [-0.5, 0.1], false, true);
    let report = json(&calibrate(&views, &[]));
    assert!(report["notes"].to_string().contains("skewed.csv: omitted"), "{}", report["notes"]);
    assert_eq!(report["tables"]["views"].as_array().expect("views").len(), 4);
    let [value, u] = figure(&report, "fx_px");
    assert!((value - 500.0).abs() < 4.0 * u && u < 2.0, "{value} ± {u}");
}

#[test]
fn an_unsuitable_model_is_reported_with_a_suitable_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let views = lists(folder.path(), true);
    let report = json(&calibrate(&views, &["--model", "pinhole"]));
    let notes = report["notes"].to_string();
    assert!(
        notes.contains("the model pinhole does not describe this camera") && notes.contains(" leaves 0.0"),
        "{notes}"
    );
    let report = json(&calibrate(&views, &["--model", "kannala-brandt"]));
    assert!(!report["notes"].to_string().contains("warning"), "{report}");
}

/// One frontal view: 500 px at 600 mm, with a last digit of a millimetre.
#[test]
fn a_distance_is_known_to_its_last_digit() {
    let folder = tempfile::tempdir().expect("a folder");
    let view = list(folder.path(), "front.csv", [0.0, 0.0], false, false);
    let focal = |more: &[&str]| {
        let start = ["measure", "focal", &view, "--size-px", SIZE, "--pitch-mm", "30", "--model", "pinhole"];
        let [value, u] = figure(&json(&[&start[..], more].concat()), "fx_px");
        assert!((value - 500.0).abs() < 2.0 * u, "{value} ± {u}");
        u
    };
    // 500/√12 of 1/600; the points' noise adds a few per cent.
    let rounded = focal(&["--distance-mm", "600"]);
    assert!((rounded / 0.2406 - 1.0).abs() < 0.05, "{rounded}");
    let stated = focal(&["--distance-mm", "600", "--distance-uncertainty-mm", "0.6"]);
    assert!((stated / 0.5 - 1.0).abs() < 0.05, "{stated}");
    let exact = focal(&["--distance-mm", "600", "--distance-uncertainty-mm", "0"]);
    assert!(exact < 0.1, "{exact}");
}
