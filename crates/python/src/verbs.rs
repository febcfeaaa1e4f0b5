//! Verbs of the command line, for the functions that `python/etendue/_verbs.py` creates from their list.

use crate::error::exception;
use crate::watch::run;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs a verb: its result, and the error if the run failed after giving one.
#[pyfunction]
#[pyo3(signature = (arguments, progress = None))]
pub(crate) fn call(
    py: Python<'_>,
    arguments: Vec<OsString>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Option<String>)> {
    let answered = run(py, None, progress.as_ref(), |watch| {
        let ended = etendue_cli::call(&arguments, watch);
        Ok((watch.set_result(), ended))
    })?;
    match answered {
        (answer, Ok(())) => Ok((answer, None)),
        (answer, Err(etendue::Error::Run(reason))) if !answer.is_empty() => Ok((answer, Some(reason))),
        (_, Err(error)) => Err(exception(py, error)),
    }
}

/// Changes a limit on the cost of files for the whole process, as `--limit NAME=N`, which error messages suggest (docs/limits.md).
///
/// name: as on the command line, such as "picture-mib".
#[pyfunction]
pub(crate) fn set_limit(py: Python<'_>, name: &str, number: u64) -> PyResult<()> {
    etendue_cli::set_limit(&format!("{name}={number}")).map_err(|error| exception(py, error))
}

/// The list of verbs with their arguments, as JSON.
#[pyfunction]
pub(crate) fn catalogue() -> PyResult<String> {
    serde_json::to_string(&etendue_cli::catalogue()).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Runs the program and returns its exit status. Arguments begin with the program's name.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| etendue_cli::main(arguments))
}
