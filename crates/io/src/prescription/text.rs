//! Lens files as text, and numbers in them.

use std::borrow::Cow;
use std::path::Path;

use crate::Error;

/// UTF-16 with a byte-order mark (either order), UTF-8, or Latin-1 where it is neither.
pub(super) fn decode<'a>(file: &Path, bytes: &'a [u8]) -> Result<Cow<'a, str>, Error> {
    let wide = |unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
        let text = String::from_utf16(&units);
        text.map(Cow::Owned).map_err(|_| Error::new(file, "begins as UTF-16 text but is none; save the file as UTF-8"))
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => Ok(match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text.trim_start_matches('\u{feff}')),
            Err(_) => Cow::Owned(bytes.iter().map(|&byte| char::from(byte)).collect()),
        }),
    }
}

/// A line's command: where it stands, and its words.
pub(super) struct Words<'a> {
    pub(super) file: &'a Path,
    pub(super) line: usize,
    pub(super) words: Vec<&'a str>,
}

impl Words<'_> {
    pub(super) fn fault(&self, what: impl Into<String>) -> Error {
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
