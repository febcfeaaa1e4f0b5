//! `measure compare`: comparison of the measurements of two cameras.
//!
//! For every quantity that both sides state, and every curve: difference A − B (first less second), relative error against the
//! second side, and normalised error E_n (ISO 13528) from both standard uncertainties. |E_n| > 1 is a difference; for curves the
//! largest |E_n| is compared with a limit that allows for the number of points.

mod declared;
mod mean;
mod response;
mod side;
mod sides;
mod tone;

use std::path::PathBuf;

use clap::Args;
use etendue_arguments::positive;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Estimate;

use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};
use mean::{ComparedCurve, Curve, CurveGap, gaps, limit, means};
use side::{ComparisonSide, Light, Quantity};
use sides::sides;

/// `etendue measure compare`
#[derive(Args, Clone, Debug)]
pub struct CompareRequest {
    /// Measurement (output of --json), or the camera file (TOML) that was measured
    #[arg(value_name = "A")]
    pub a: PathBuf,
    /// The same for the other side; reference of the relative errors
    #[arg(value_name = "B")]
    pub b: PathBuf,
    /// Wavelength of the light for the quantum efficiency, when a camera file is compared with photon transfer
    #[arg(long, value_name = "NM", value_parser = positive)]
    pub wavelength_nm: Option<f64>,
    /// Spectrum of the light, when a camera file is compared with the response of edges or a tone curve [default: D65]
    #[arg(long, value_name = "NAME")]
    pub illuminant: Option<String>,
    /// Change a key of the camera file, e.g. --set sensor.exposure_s=0.002
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl CompareRequest {
    /// Creates a request with the program's defaults.
    pub fn new(a: impl Into<PathBuf>, b: impl Into<PathBuf>) -> Self {
        Self { a: a.into(), b: b.into(), wavelength_nm: None, illuminant: None, set: Vec::new() }
    }
}

/// Comparison of two measurements.
#[derive(Clone, Debug)]
pub struct MeasurementComparison {
    /// Every quantity and curve that both sides state.
    pub report: Report,
    /// The two files.
    pub names: [String; 2],
    /// Quantities and curves that differ; empty if none.
    pub differing: Vec<String>,
}

/// Compares two measurements, or a measurement with the camera file that was measured.
///
/// # Errors
/// If a file cannot be used, or the two have nothing in common.
pub fn compare(request: &CompareRequest) -> Result<MeasurementComparison, Error> {
    let light = Light { wavelength_nm: request.wavelength_nm, illuminant: request.illuminant.clone() };
    let [a, b] = sides(&request.a, &request.b, &light, &request.set)?;
    let names = [&request.a, &request.b].map(|f| f.display().to_string());
    contradictions(&a, &b).map_err(|words| Error::coded(ErrorCode::NotComparable, words))?;
    let mut report =
        Report::new("compare", "comparison of two measurements, E_n after ISO 13528 (± one standard uncertainty)");
    report.setting("a", names[0].clone());
    report.setting("b", names[1].clone());
    report.setting("difference", "a - b".to_owned());
    report.note(format!("differences are A − B: {} − {}", names[0], names[1]));
    report.setting("kind", a.kind.clone());
    let differing = [quantities(&mut report, &a, &b), curves(&mut report, &a, &b)].concat();
    unmatched(&mut report, &a, &b);
    report.fact("differing", "quantities and curves that differ", "", differing.len() as f64);
    Ok(MeasurementComparison { report, names, differing })
}

/// Intrinsics by `focal` and by `calibrate` are the same quantities.
fn family(kind: &str) -> &str {
    if kind == "focal" { "calibrate" } else { kind }
}

fn contradictions(a: &ComparisonSide, b: &ComparisonSide) -> Result<(), String> {
    if family(&a.kind) != family(&b.kind) {
        return Err(format!(
            "measurements of different kinds, {} and {}; expected two of the same kind",
            a.kind, b.kind
        ));
    }
    for (key, value_a) in &a.settings {
        if let Some(value_b) = b.settings.get(key).filter(|value_b| *value_b != value_a) {
            return Err(format!(
                "{key}: {value_a} and {value_b}: the quantities have different meanings; measure both with the same setting"
            ));
        }
    }
    for (key, quantity_a) in &a.quantities {
        if let Some(quantity_b) = b.quantities.get(key).filter(|quantity_b| quantity_b.unit != quantity_a.unit) {
            return Err(format!(
                "{key}: units '{}' and '{}' differ; expected the same unit",
                quantity_a.unit, quantity_b.unit
            ));
        }
    }
    let common = a.quantities.keys().any(|key| b.quantities.contains_key(key));
    let curves = a.curves.iter().any(|x| b.curves.iter().any(|y| x.name == y.name));
    if common || curves { Ok(()) } else { Err("the two measurements have no quantity in common".to_owned()) }
}

fn verdict(differs: Option<bool>) -> Cell {
    differs.map_or(Cell::Nothing, |differs| Cell::Text(if differs { "differs" } else { "agrees" }.to_owned()))
}

fn number(value: Option<f64>, decimals: usize) -> Cell {
    value.map_or(Cell::Nothing, |v| Cell::Number(v, decimals))
}

/// Table of quantities, and those that differ.
fn quantities(report: &mut Report, a: &ComparisonSide, b: &ComparisonSide) -> Vec<String> {
    let common = a.quantities.iter().filter_map(|(key, quantity_a)| Some((key, quantity_a, b.quantities.get(key)?)));
    let mut differing = Vec::new();
    let mut rows = Vec::new();
    for (key, quantity_a, quantity_b) in common {
        let e_n = normalised(quantity_a, quantity_b);
        let differs = e_n.map(|e| e.abs() > 1.0);
        if differs == Some(true) {
            differing.push(key.clone());
        }
        let difference = quantity_a.value - quantity_b.value;
        let relative = (quantity_b.value != 0.0).then(|| 100.0 * difference / quantity_b.value.abs());
        rows.push(vec![
            Cell::Text(key.clone()),
            Cell::Text(quantity_a.unit.clone()),
            cell(quantity_a),
            cell(quantity_b),
            number(relative, 4),
            number(e_n, 2),
            verdict(differs),
        ]);
    }
    let columns = vec![
        ("quantity", "quantity"),
        ("unit", "unit"),
        ("a", "A"),
        ("b", "B"),
        ("relative_error_percent", "(A − B)/|B| %"),
        ("e_n", "E_n"),
        ("verdict", "verdict"),
    ];
    if !rows.is_empty() {
        report.table(Table { key: "quantities", columns, rows });
    }
    differing
}

fn cell(q: &Quantity) -> Cell {
    Cell::Estimate(Estimate::new(q.value, q.standard_uncertainty.unwrap_or(f64::INFINITY)))
}

/// E_n, if both sides state an uncertainty and one of them is above zero.
fn normalised(a: &Quantity, b: &Quantity) -> Option<f64> {
    let (u, v) = (a.standard_uncertainty?, b.standard_uncertainty?);
    (u + v > 0.0).then(|| Estimate::new(a.value, u).normalised_error(Estimate::new(b.value, v)))
}

/// Table of curves with their plots, and those that differ.
fn curves(report: &mut Report, a: &ComparisonSide, b: &ComparisonSide) -> Vec<String> {
    let mut differing = Vec::new();
    let mut rows = Vec::new();
    let pairs = a.curves.iter().filter_map(|x| Some((x, b.curves.iter().find(|y| y.name == x.name)?)));
    let all: Vec<ComparedCurve> = pairs.map(|(curve_a, curve_b)| (curve_a.clone(), gaps(curve_a, curve_b))).collect();
    for (curve, gaps) in &all {
        // All points of curves of one kind form one family.
        let family = all.iter().filter(|(other, _)| other.kind() == curve.kind());
        let tested = family.flat_map(|(_, gaps)| gaps).filter_map(CurveGap::normalised).count();
        let (row, differs) = curve_row(curve, gaps, limit(tested));
        rows.push(row);
        if differs == Some(true) {
            differing.push(curve.name.clone());
        }
    }
    let columns = vec![
        ("curve", "curve"),
        ("points", "points"),
        ("largest_difference", "largest A − B"),
        ("at", "at"),
        ("largest_relative_error_percent", "largest (A − B)/|B| %"),
        ("e_n", "E_n"),
        ("e_n_at", "at"),
        ("limit", "limit"),
        ("verdict", "verdict"),
    ];
    if !rows.is_empty() {
        report.table(Table { key: "curves", columns, rows });
    }
    let means = means(&all);
    means.iter().for_each(|(curve, gaps)| report.table(mean_table(curve, gaps)));
    for (curve, gaps) in if means.is_empty() { &all } else { &means } {
        report.plot(both(curve, gaps));
        report.plot(error(curve, gaps));
    }
    differing
}

/// Mean of many curves, point by point.
fn mean_table(curve: &Curve, gaps: &[CurveGap]) -> Table {
    let row = |gap: &CurveGap| {
        let u = etendue_core::maths::f64::hypot(gap.a.standard_uncertainty, gap.b.standard_uncertainty);
        vec![
            Cell::Text(curve.name.clone()),
            Cell::Number(gap.x, 2),
            Cell::Estimate(gap.a),
            Cell::Estimate(gap.b),
            Cell::Estimate(Estimate::new(gap.difference(), u)),
        ]
    };
    Table {
        key: "means",
        columns: vec![("curve", "curve"), ("at", "at"), ("a", "A"), ("b", "B"), ("difference", "A − B")],
        rows: gaps.iter().map(row).collect(),
    }
}

fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.max_by(|a, b| a.abs().total_cmp(&b.abs()))
}

fn curve_row(curve: &Curve, gaps: &[CurveGap], limit: f64) -> (Vec<Cell>, Option<bool>) {
    let worst = gaps.iter().max_by(|a, b| a.difference().abs().total_cmp(&b.difference().abs()));
    let magnitude = |gap: &CurveGap| gap.normalised().map_or(f64::NEG_INFINITY, f64::abs);
    let least_likely = gaps.iter().max_by(|a, b| magnitude(a).total_cmp(&magnitude(b)));
    let e_n = least_likely.and_then(CurveGap::normalised);
    let differs = e_n.map(|e| e.abs() > limit);
    let row = vec![
        Cell::Text(curve.name.clone()),
        Cell::Number(gaps.len() as f64, 0),
        number(worst.map(CurveGap::difference), 6),
        number(worst.map(|gap| gap.x), 2),
        number(largest(gaps.iter().filter_map(CurveGap::relative)).map(|r| 100.0 * r), 4),
        number(e_n, 2),
        number(e_n.and(least_likely).map(|gap| gap.x), 2),
        number(e_n.map(|_| limit), 2),
        verdict(differs),
    ];
    (row, differs)
}

fn x_axis(curve: &Curve) -> Axis {
    Axis::linear(match curve.abscissa {
        "field_percent" => "radial field position, % of the half diagonal",
        "cycles_per_px" => "cycles per pixel",
        "reading_percent" => "reading, %",
        "celsius" => "sensor temperature, °C",
        _ => "exposure",
    })
}

fn both(curve: &Curve, gaps: &[CurveGap]) -> Plot {
    let bars = |side: fn(&CurveGap) -> Estimate| {
        gaps.iter().map(move |gap| (gap.x, side(gap).value, 2.0 * side(gap).standard_uncertainty))
    };
    Plot {
        title: format!("{} (bars: 95 %)", curve.name),
        x: x_axis(curve),
        y: Axis::linear(curve.ordinate),
        series: vec![
            Series::with_errors("A", Mark::Points, bars(|gap| gap.a)),
            Series::with_errors("B", Mark::Line, bars(|gap| gap.b)),
        ],
    }
}

fn error(a: &Curve, gaps: &[CurveGap]) -> Plot {
    let points = gaps.iter().filter_map(|gap| {
        let u = etendue_core::maths::f64::hypot(gap.a.standard_uncertainty, gap.b.standard_uncertainty);
        Some((gap.x, 100.0 * gap.relative()?, 200.0 * u / gap.b.value.abs()))
    });
    Plot {
        title: format!("{}: relative difference of A from B (bars: 95 %)", a.name),
        x: x_axis(a),
        y: Axis::linear("(A − B)/|B|, %").showing(&[0.0]),
        series: vec![Series::with_errors("", Mark::Points, points)],
    }
}

/// Quantities that only one side states.
fn unmatched(report: &mut Report, a: &ComparisonSide, b: &ComparisonSide) {
    for (name, this, other) in [("A", a, b), ("B", b, a)] {
        let quantities = this.quantities.keys().filter(|key| !other.quantities.contains_key(*key));
        let curves = this.curves.iter().map(|c| &c.name).filter(|name| other.curves.iter().all(|c| c.name != **name));
        let alone: Vec<&str> = quantities.chain(curves).map(String::as_str).collect();
        if !alone.is_empty() {
            report.note(format!("only {name} has {}", alone.join(", ")));
        }
    }
}
