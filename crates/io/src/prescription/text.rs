//! Lines of lens files, and their numbers.

use std::path::Path;

use crate::{Error, Problem};

/// Command of a line: place and words.
pub(super) struct Words<'a> {
    pub(super) file: &'a Path,
    pub(super) line: usize,
    pub(super) words: Vec<&'a str>,
}

impl Words<'_> {
    pub(super) fn error(&self, what: impl Into<Problem>) -> Error {
        Error::at(self.file, self.line, what)
    }

    /// Word at an index, from 0; empty if there is none.
    pub(super) fn word(&self, place: usize) -> &str {
        self.words.get(place).copied().unwrap_or("")
    }

    /// Finite number at an index.
    pub(super) fn number(&self, place: usize) -> Result<f64, Error> {
        let number = self.word(place).parse::<f64>().ok().filter(|n| n.is_finite());
        number.ok_or_else(|| {
            let (key, actual) = (self.word(0), self.word(place));
            self.error(format!("{key}: found `{actual}`; expected a number"))
        })
    }

    /// All numbers from an index on.
    pub(super) fn numbers(&self, from: usize) -> Result<Vec<f64>, Error> {
        (from..self.words.len()).map(|place| self.number(place)).collect()
    }
}
