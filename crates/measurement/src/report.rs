//! Results of a measurement: numbers with unit and standard uncertainty, tables, curves and notes; as text, JSON and plots.

use std::fmt;

use etendue_core::maths::f64::log10;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::photograph::SourcedEncoding;
use serde_json::{Map, Value, json};

use crate::plot::{Plot, svg};

pub use etendue_metrology::Estimate;

/// One number of a report.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Name in JSON, with its unit.
    pub key: String,
    /// Human-readable name.
    pub label: String,
    /// Unit; empty if dimensionless.
    pub unit: &'static str,
    /// Value with its standard uncertainty.
    pub value: Estimate,
    /// True if the value's uncertainty is known: false for counts and properties of the measurement itself.
    pub stated: bool,
}

/// A cell of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// A number with a number of decimals.
    Number(f64, usize),
    /// A number with its standard uncertainty.
    Estimate(Estimate),
    /// A list of numbers, with a number of decimals.
    List(Vec<f64>, usize),
    Text(String),
    /// Unknown.
    Nothing,
}

/// A table: column keys with headings, and rows of cells.
#[derive(Clone, Debug)]
pub struct Table {
    /// Name in JSON.
    pub key: &'static str,
    /// Name in JSON and heading of each column.
    pub columns: Vec<(&'static str, &'static str)>,
    /// Rows with one cell per column.
    pub rows: Vec<Vec<Cell>>,
}

/// Results of a measurement.
#[derive(Clone, Debug, Default)]
pub struct Report {
    kind: &'static str,
    method: &'static str,
    settings: Vec<(&'static str, String)>,
    figures: Vec<Figure>,
    tables: Vec<Table>,
    notes: Vec<String>,
    plots: Vec<Plot>,
    camera: Option<String>,
    /// Tables that appear in JSON only.
    data: Vec<Table>,
    covariances: Vec<Covariance>,
    /// Conversions from the images' numbers to light, without repetitions.
    encodings: Vec<SourcedEncoding>,
}

/// The covariance of figures: their keys, and the matrix row by row, in the product of their units.
#[derive(Clone, Debug)]
pub struct Covariance {
    /// The keys of the figures.
    pub of: Vec<String>,
    /// Row by row.
    pub rows: Vec<Vec<f64>>,
}

impl Report {
    /// Name of the measurement on the command line.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.kind
    }

    /// Method or standard.
    #[must_use]
    pub fn method(&self) -> &'static str {
        self.method
    }

    /// The measured numbers.
    #[must_use]
    pub fn figures(&self) -> &[Figure] {
        &self.figures
    }

    /// The number of a key; `None` if the measurement does not have it.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<Estimate> {
        self.figures.iter().find(|figure| figure.key == key).map(|figure| figure.value)
    }

    /// The tables, those of many rows included.
    pub fn tables(&self) -> impl Iterator<Item = &Table> {
        self.tables.iter().chain(&self.data)
    }

    /// Notes on the result for the user.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn new(kind: &'static str, method: &'static str) -> Self {
        Self { kind, method, ..Self::default() }
    }

    pub(crate) fn figure(&mut self, key: &str, label: &str, unit: &'static str, value: Estimate) {
        self.push(key, label, unit, value, true);
    }

    /// Adds a number without a stated uncertainty: a count, or a property of the measurement itself.
    pub(crate) fn fact(&mut self, key: &str, label: &str, unit: &'static str, value: f64) {
        self.push(key, label, unit, Estimate::new(value, 0.0), false);
    }

    fn push(&mut self, key: &str, label: &str, unit: &'static str, value: Estimate, stated: bool) {
        self.figures.push(Figure { key: key.to_owned(), label: label.to_owned(), unit, value, stated });
    }

    /// Adds a choice that decides the meaning of figures, such as the camera model.
    pub(crate) fn setting(&mut self, key: &'static str, value: String) {
        self.settings.push((key, value));
    }

    /// Adds the conversion from an image's numbers to light.
    pub(crate) fn encoding(&mut self, stated: &SourcedEncoding) {
        if !self.encodings.contains(stated) {
            self.encodings.push(stated.clone());
        }
    }

    pub(crate) fn table(&mut self, table: Table) {
        self.tables.push(table);
    }

    /// Adds a table of many rows: always in JSON, in the text if requested.
    pub(crate) fn table_if(&mut self, shown: bool, table: Table) {
        if shown { self.tables.push(table) } else { self.data.push(table) }
    }

    pub(crate) fn covariance(&mut self, covariance: Covariance) {
        self.covariances.push(covariance);
    }

    pub(crate) fn note(&mut self, note: impl Into<String>) {
        self.notes.push(note.into());
    }

    /// Results as keys of a camera file; `None` if not requested, or if the measurement has none.
    #[must_use]
    pub fn camera_keys(&self) -> Option<&str> {
        self.camera.as_deref()
    }

    /// Sets the results as keys of a camera file.
    pub(crate) fn camera(&mut self, text: String) {
        self.camera = Some(text);
    }

    pub(crate) fn plot(&mut self, plot: Plot) {
        self.plots.push(plot);
    }

    /// True if there are curves to draw.
    #[must_use]
    pub fn has_plots(&self) -> bool {
        !self.plots.is_empty()
    }

    /// Curves of the report.
    pub(crate) fn plots(&self) -> &[Plot] {
        &self.plots
    }

    /// All plots as one SVG.
    ///
    /// # Errors
    /// If the measurement has no curve to draw.
    pub fn svg(&self) -> Result<String, Error> {
        if self.plots.is_empty() {
            return Err(
                Error::argument("plot", "`plot`: this measurement has no curve to plot").with_code(ErrorCode::NoEffect)
            );
        }
        Ok(svg(&self.plots))
    }

    /// The report as JSON; unknown or non-finite values are null.
    #[must_use]
    pub fn json(&self) -> Value {
        let figure = |f: &Figure| {
            let Value::Object(mut map) = json_estimate(f.value) else { return (f.key.clone(), Value::Null) };
            map.insert("unit".to_owned(), f.unit.into());
            if !f.stated {
                map.insert("standard_uncertainty".to_owned(), Value::Null);
            }
            (f.key.clone(), Value::Object(map))
        };
        let tables = self.tables.iter().chain(&self.data);
        let tables: Map<String, Value> = tables.map(|t| (t.key.to_owned(), t.json())).collect();
        let mut object = json!({
            "measurement": self.kind,
            "method": self.method,
            "settings": self.settings.iter().map(|(key, value)| ((*key).to_owned(), value.as_str().into())).collect::<Map<_, _>>(),
            "figures": self.figures.iter().map(figure).collect::<Map<_, _>>(),
            "tables": tables,
            "notes": self.notes,
        });
        if !self.encodings.is_empty() {
            let one = |s: &SourcedEncoding| json!({ "encoding": s.encoding.name(), "reason": s.reason, "guessed": s.guessed });
            object["encodings"] = self.encodings.iter().map(one).collect();
        }
        if !self.covariances.is_empty() {
            object["covariances"] = self.covariances.iter().map(Covariance::json).collect();
        }
        object
    }
}

impl serde::Serialize for Report {
    /// As [`Report::json`].
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.json().serialize(serializer)
    }
}

impl fmt::Display for Report {
    /// A readable table.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text())
    }
}

impl Report {
    fn text(&self) -> String {
        let width = |f: fn(&Figure) -> usize| self.figures.iter().map(f).max().unwrap_or(0);
        let label = width(|f| f.label.chars().count());
        let mut text = format!("{}\n", self.method);
        self.encodings.iter().for_each(|s| text += &format!("encoding: {} ({})\n", s.encoding.name(), s.reason));
        for figure in &self.figures {
            text += &format!("{:<label$}  {} {}", figure.label, with_uncertainty(figure.value), figure.unit);
            text = text.trim_end().to_owned() + "\n";
        }
        self.tables.iter().for_each(|table| text += &format!("\n{}", table.text()));
        self.notes.iter().for_each(|note| text += &format!("note: {note}\n"));
        text
    }
}

impl Covariance {
    fn json(&self) -> Value {
        let row = |row: &Vec<f64>| row.iter().copied().map(finite).collect::<Value>();
        json!({ "of": self.of, "matrix": self.rows.iter().map(row).collect::<Value>() })
    }
}

impl Table {
    fn json(&self) -> Value {
        let row = |cells: &Vec<Cell>| {
            let pairs = self.columns.iter().zip(cells).map(|((key, _), cell)| ((*key).to_owned(), cell.json()));
            Value::Object(pairs.collect())
        };
        self.rows.iter().map(row).collect()
    }

    fn text(&self) -> String {
        let headings = self.columns.iter().map(|(_, heading)| (*heading).to_owned()).collect::<Vec<_>>();
        let rows = self.rows.iter().map(|row| row.iter().map(Cell::text).collect::<Vec<_>>());
        let lines: Vec<Vec<String>> = std::iter::once(headings).chain(rows).collect();
        let width = |i: usize| lines.iter().map(|line| line[i].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let line = |cells: &Vec<String>| {
            let padded: Vec<String> = cells.iter().zip(&widths).map(|(cell, w)| format!("{cell:<w$}")).collect();
            padded.join("  ").trim_end().to_owned() + "\n"
        };
        lines.iter().map(line).collect()
    }
}

impl Cell {
    fn json(&self) -> Value {
        match self {
            Self::Number(x, _) => finite(*x),
            Self::Estimate(e) => json_estimate(*e),
            Self::List(list, _) => list.iter().copied().map(finite).collect(),
            Self::Text(text) => text.as_str().into(),
            Self::Nothing => Value::Null,
        }
    }

    /// The cell as text, with the significant digits of its numbers.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::Number(x, _) if !x.is_finite() => "–".to_owned(),
            Self::Number(x, decimals) => fixed(*x, *decimals),
            Self::Estimate(e) => with_uncertainty(*e),
            Self::List(list, decimals) => {
                let texts: Vec<String> =
                    list.iter().map(|x| format!("{:>1$}", fixed(*x, *decimals), 4 + decimals)).collect();
                texts.join(" ")
            }
            Self::Text(text) => text.clone(),
            Self::Nothing => "–".to_owned(),
        }
    }
}

/// JSON cannot express infinity.
pub(crate) fn finite(x: f64) -> Value {
    if x.is_finite() { (x + 0.0).into() } else { Value::Null }
}

pub(crate) fn json_estimate(e: Estimate) -> Value {
    json!({ "value": finite(e.value), "standard_uncertainty": finite(e.standard_uncertainty) })
}

/// Value ± standard uncertainty, to two digits of the uncertainty (GUM 7.2.6).
pub(crate) fn with_uncertainty(e: Estimate) -> String {
    let (value, u) = (e.value, e.standard_uncertainty);
    if !value.is_finite() {
        return "unknown".to_owned();
    }
    if !u.is_finite() {
        return format!("{} ± unknown", digits(value, 4));
    }
    if u <= 0.0 {
        return if value.fract() == 0.0 && value.abs() < 1e9 { fixed(value, 0) } else { digits(value, 6) };
    }
    let place = log10(u).floor();
    if place > 4.0 || value.abs() >= 1e9 || place < -7.0 {
        return format!("{value:.4e} ± {u:.1e}");
    }
    let decimals = (1.0 - place).max(0.0) as usize;
    format!("{} ± {}", fixed(value, decimals), fixed(u, decimals))
}

/// A number with this many decimals; a value that rounds to zero has no sign.
pub(crate) fn fixed(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_owned(),
        _ => text,
    }
}

/// A number with this many digits.
fn digits(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let place = log10(value.abs()).floor();
    if !(-5.0..9.0).contains(&place) {
        return format!("{value:.0$e}", digits - 1);
    }
    fixed(value, (digits as f64 - 1.0 - place).max(0.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_two_digits_of_their_uncertainty() {
        let text = |value, u| with_uncertainty(Estimate::new(value, u));
        assert_eq!(text(0.196_482, 0.000_913), "0.19648 ± 0.00091");
        assert_eq!(text(12_903.2, 230.0), "12903 ± 230");
        assert_eq!(text(0.0, 0.0), "0");
        assert_eq!(text(1288.0, 0.0), "1288");
        assert_eq!(text(1.0, f64::INFINITY), "1.000 ± unknown");
        assert_eq!(text(f64::NAN, 1.0), "unknown");
    }
}
