//! Errors as exceptions: `etendue.InputError` for unusable input, `etendue.RunError` for a failed run.

use etendue::{Error, ErrorCode, Fault, terminal_text};
use pyo3::prelude::*;
use pyo3::types::PyAny;

/// Exception for an error.
pub(crate) fn exception(py: Python<'_>, error: Error) -> PyErr {
    let made = match error {
        Error::Input(faults) => made(py, "InputError", |class| class.call1((told(faults),))),
        Error::Run(reason) => {
            made(py, "RunError", |class| class.call1((terminal_text(reason.trim_start_matches("error: ").trim_end()),)))
        }
    };
    made.map_or_else(|failure| failure, PyErr::from_value)
}

fn made<'py>(
    py: Python<'py>,
    class: &str,
    make: impl FnOnce(Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    make(py.import("etendue._errors")?.getattr(class)?)
}

type Told = (String, Option<String>, Option<u32>, Option<u32>, Option<String>, &'static str, String, Option<String>);

/// Fields of `_errors.Fault`.
fn told(faults: Vec<Fault>) -> Vec<Told> {
    let one = |fault: Fault| {
        let file = fault.file.map(|file| file.to_string_lossy().into_owned());
        let (message, problem) =
            (terminal_text(&fault.message).into_owned(), terminal_text(&fault.problem).into_owned());
        let remedy = fault.remedy.map(|remedy| terminal_text(&remedy).into_owned());
        let key = fault.field.or(fault.key);
        (message, file, fault.line, fault.column, key, fault.code.word(), problem, remedy)
    };
    faults.into_iter().map(one).collect()
}

/// Error for unusable input that only Python can give.
pub(crate) fn refused(py: Python<'_>, why: impl Into<String>) -> PyErr {
    exception(py, Error::coded(ErrorCode::InvalidArgument, why))
}
