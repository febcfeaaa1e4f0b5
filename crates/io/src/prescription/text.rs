//! Lines of lens files, and numbers in them.

use std::path::Path;

use crate::{Error, Problem};

/// A line's command: where it stands, and its words.
pub(super) struct Words<'a> {
    pub(super) file: &'a Path,
    pub(super) line: usize,
    pub(super) words: Vec<&'a str>,
}

impl Words<'_> {
    pub(super) fn fault(&self, what: impl Into<Problem>) -> Error {
        Error::at(self.file, self.line, what)
    }

    /// The word at a place, from 0; empty where there is none.
    pub(super) fn word(&self, place: usize) -> &str {
        self.words.get(place).copied().unwrap_or("")
    }

    /// The finite number at a place.
    pub(super) fn number(&self, place: usize) -> Result<f64, Error> {
        let number = self.word(place).parse::<f64>().ok().filter(|n| n.is_finite());
        number.ok_or_else(|| {
            let (key, found) = (self.word(0), self.word(place));
            self.fault(format!("{key}: found `{found}`, expected a number"))
        })
    }

    /// All numbers from a place on.
    pub(super) fn numbers(&self, from: usize) -> Result<Vec<f64>, Error> {
        (from..self.words.len()).map(|place| self.number(place)).collect()
    }
}
