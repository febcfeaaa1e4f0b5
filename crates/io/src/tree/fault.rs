//! What is wrong in a text of keys and values.

use crate::{Error, ErrorCode, Problem};
use std::path::Path;

/// What is wrong, and in which line (from 1; 0 for the whole file).
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) line: usize,
    pub(crate) what: String,
    code: ErrorCode,
}

pub(crate) type Read<T> = Result<T, Fault>;

impl Fault {
    pub(crate) fn at(line: usize, what: impl Into<Problem>) -> Self {
        let Problem { code, words } = what.into();
        Self { line, what: words, code }
    }

    pub(crate) fn coded(code: ErrorCode, line: usize, what: impl Into<String>) -> Self {
        Self::at(line, Problem::new(code, what))
    }

    pub(crate) fn of(self, file: &Path) -> Error {
        let what = Problem::new(self.code, self.what);
        if self.line == 0 { Error::new(file, what) } else { Error::at(file, self.line, what) }
    }
}

/// A note of keys that say nothing of the camera.
pub(crate) fn passed_over(keys: &[&str]) -> Vec<String> {
    if keys.is_empty() { Vec::new() } else { vec![format!("passed over: {}", keys.join(", "))] }
}
