//! Errors as exceptions: `etendue.InputError` for unusable input, `etendue.RunError` for a failed run.

use etendue::{Error, ErrorCode, InputError, terminal_text};
use pyo3::prelude::*;
use pyo3::types::PyAny;

/// Exception for an error.
pub(crate) fn exception(py: Python<'_>, error: Error) -> PyErr {
    let instance = match error {
        Error::Input(errors) => instance_of(py, "InputError", |class| class.call1((error_fields(errors),))),
        Error::Run(reason) => instance_of(py, "RunError", |class| {
            class.call1((terminal_text(reason.trim_start_matches("error: ").trim_end()),))
        }),
    };
    instance.map_or_else(|failure| failure, PyErr::from_value)
}

fn instance_of<'py>(
    py: Python<'py>,
    class: &str,
    make: impl FnOnce(Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    make(py.import("etendue._errors")?.getattr(class)?)
}

type ErrorFields =
    (String, Option<String>, Option<u32>, Option<u32>, Option<String>, &'static str, String, Option<String>);

/// Fields of `_errors.Fault`.
fn error_fields(errors: Vec<InputError>) -> Vec<ErrorFields> {
    let one = |error: InputError| {
        let file = error.file.map(|file| file.to_string_lossy().into_owned());
        let (message, problem) =
            (terminal_text(&error.message).into_owned(), terminal_text(&error.problem).into_owned());
        let remedy = error.remedy.map(|remedy| terminal_text(&remedy).into_owned());
        let key = error.field.or(error.key);
        (message, file, error.line, error.column, key, error.code.word(), problem, remedy)
    };
    errors.into_iter().map(one).collect()
}

/// Error for unusable input that only Python can give.
pub(crate) fn refused(py: Python<'_>, reason: impl Into<String>) -> PyErr {
    exception(py, Error::coded(ErrorCode::InvalidArgument, reason))
}
