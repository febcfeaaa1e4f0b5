//! Calls of the library: measurements whose reports are kept beside, and comparisons with camera files.

use crate::comparison::Comparison;
use etendue::measure::{CompareRequest, compare};
use etendue::report::Report;
use etendue::{Error, ErrorCode, ExistingFiles, Message, Observer, write_file};
use serde_json::Value;
use std::path::Path;

/// Warnings of what is rendered and exposed go to stderr.
pub(crate) struct Warnings;

impl Observer for Warnings {
    #[expect(clippy::print_stderr, reason = "a program says what is wrong")]
    fn message(&self, message: Message<'_>) {
        if let Message::Warning(text) = message {
            eprintln!("warning: {text}");
        }
    }
}

/// Keeps a measurement's report.
pub(crate) fn keep(report: &Report, file: &Path) -> Result<(), Error> {
    write_file(file, format!("{:#}\n", report.json()).as_bytes(), ExistingFiles::Replace)
}

/// Two sides compared; draws the curves where a plot is wanted.
pub(crate) fn compared(request: &CompareRequest, plot: Option<&Path>) -> Result<Comparison, Error> {
    let report = compare(request)?.report;
    if let Some(file) = plot {
        write_file(file, report.svg()?.as_bytes(), ExistingFiles::Replace)?;
    }
    Ok(Comparison(report.json()))
}

/// A JSON file.
pub(crate) fn json(file: &Path) -> Result<Value, Error> {
    let text = std::fs::read_to_string(file)
        .map_err(|error| Error::coded(ErrorCode::MalformedFile, format!("{}: {error}", file.display())))?;
    serde_json::from_str(&text)
        .map_err(|error| Error::coded(ErrorCode::MalformedFile, format!("{}: {error}", file.display())))
}

/// A number of a JSON file.
pub(crate) fn number(value: &Value, name: &str) -> Result<f64, Error> {
    value.as_f64().ok_or_else(|| Error::coded(ErrorCode::MalformedFile, format!("{name} is not stated")))
}
