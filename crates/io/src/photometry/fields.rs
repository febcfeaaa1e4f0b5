//! Numbers one after the other, each with its line.

use std::path::Path;

use crate::{Error, Problem};

/// The numbers of a text from some line on.
pub(super) struct Fields<'a> {
    file: &'a Path,
    /// Lines, counted from 1, and words.
    words: std::vec::IntoIter<(usize, &'a str)>,
    /// The line of the last word that was taken.
    line: usize,
    decimal_comma: bool,
}

impl<'a> Fields<'a> {
    /// Numbers divided by blanks, commas and line ends.
    pub(super) fn divided_by_commas(file: &'a Path, lines: impl Iterator<Item = (usize, &'a str)>) -> Self {
        Self::new(file, lines, false)
    }

    /// Numbers divided by blanks and line ends, whose decimal sign may be a comma.
    pub(super) fn with_decimal_commas(file: &'a Path, lines: impl Iterator<Item = (usize, &'a str)>) -> Self {
        Self::new(file, lines, true)
    }

    fn new(file: &'a Path, lines: impl Iterator<Item = (usize, &'a str)>, decimal_comma: bool) -> Self {
        let is_gap = move |c: char| c.is_whitespace() || (c == ',' && !decimal_comma);
        let words = lines.flat_map(|(line, text)| text.split(is_gap).filter(|w| !w.is_empty()).map(move |w| (line, w)));
        let words: Vec<_> = words.collect();
        let line = words.first().map_or(1, |(line, _)| *line);
        Self { file, words: words.into_iter(), line, decimal_comma }
    }

    /// A fault at the number that was taken last.
    pub(super) fn fault(&self, what: impl Into<Problem>) -> Error {
        Error::at(self.file, self.line, what)
    }

    /// The next number; `what` says in words what it is.
    pub(super) fn number(&mut self, what: &str) -> Result<f64, Error> {
        let Some((line, word)) = self.words.next() else {
            return Err(self.fault(format!(
                "the file ends here; expected {what}: it is truncated or its counts of angles are wrong"
            )));
        };
        self.line = line;
        parse(word, self.decimal_comma)
            .ok_or_else(|| self.fault(format!("found \"{}\"; expected {what}: a number", short(word))))
    }

    /// The next number, 0 or more.
    pub(super) fn amount(&mut self, what: &str) -> Result<f64, Error> {
        let value = self.number(what)?;
        if value >= 0.0 { Ok(value) } else { Err(self.fault(format!("found {value}; expected {what}: 0 or more"))) }
    }

    /// The next number, above 0.
    pub(super) fn positive(&mut self, what: &str) -> Result<f64, Error> {
        let value = self.number(what)?;
        if value > 0.0 { Ok(value) } else { Err(self.fault(format!("found {value}; expected {what}: above 0"))) }
    }

    /// The next number, whole, of `range`.
    pub(super) fn whole(&mut self, what: &str, range: std::ops::RangeInclusive<u32>) -> Result<u32, Error> {
        let value = self.number(what)?;
        let (low, high) = (*range.start(), *range.end());
        if value.fract() == 0.0 && (f64::from(low)..=f64::from(high)).contains(&value) {
            return Ok(value as u32);
        }
        Err(self.fault(format!("found {value}; expected {what}: a whole number from {low} to {high}")))
    }

    /// The next `count` numbers, which are there: no more is allocated than the file holds.
    pub(super) fn list(
        &mut self,
        count: usize,
        what: &str,
        mut admit: impl FnMut(&[f64], f64) -> Option<String>,
    ) -> Result<Vec<f64>, Error> {
        let mut values = Vec::with_capacity(count.min(self.words.len()));
        for index in 0..count {
            let value = self.number(&format!("{what} {} of {count}", index + 1))?;
            if let Some(wrong) = admit(&values, value) {
                return Err(self.fault(wrong));
            }
            values.push(value);
        }
        Ok(values)
    }

    /// The next `count` intensities.
    pub(super) fn intensities(&mut self, count: usize) -> Result<Vec<f64>, Error> {
        self.list(count, "intensity", |_, value| {
            (value < 0.0)
                .then(|| format!("found the intensity {value}; expected 0 or more: no lamp gives less than nothing"))
        })
    }

    /// Refuses anything more.
    pub(super) fn end(&mut self, expected: &str) -> Result<(), Error> {
        let count = self.words.len();
        match self.words.next() {
            None => Ok(()),
            Some((line, word)) => Err(Error::at(
                self.file,
                line,
                format!(
                    "found \"{}\" and {} more values behind {expected}; expected the end: correct the counts of angles",
                    short(word),
                    count - 1
                ),
            )),
        }
    }
}

/// A finite number.
pub(super) fn parse(word: &str, decimal_comma: bool) -> Option<f64> {
    let is_number = |c: char| c.is_ascii_digit() || "+-.eE,".contains(c);
    if !word.chars().all(is_number) {
        return None;
    }
    let value = if decimal_comma { word.replacen(',', ".", 1).parse() } else { word.parse() };
    value.ok().filter(|v: &f64| v.is_finite())
}

/// The start of a word for a message.
pub(super) fn short(word: &str) -> String {
    const TOLD: usize = 24;
    let start: String = word.chars().take(TOLD).collect();
    if start.len() < word.len() { format!("{start}…") } else { start }
}
