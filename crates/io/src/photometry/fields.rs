//! Sequential numbers of photometric files, each with its line.
//!
//! Also the decoding of old text files (UTF-8 if valid, else Latin-1, ISO 8859-1), and the factors for tilted lamps (LM-63, TILT=).

use std::{borrow::Cow, ops::RangeInclusive, path::Path};

use etendue_scene::asset::{PhotometryAxes, Tilt};

use crate::named_file::{NamedFile, find_named_file};
use crate::{Error, Problem, Sandbox, source::read_description_bytes};

/// Numbers of a text from some line on.
pub(super) struct FieldReader<'a> {
    file: &'a Path,
    /// Lines, counted from 1, and words.
    words: std::vec::IntoIter<(usize, &'a str)>,
    /// Line of the last word read.
    line: usize,
    decimal_comma: bool,
}

impl<'a> FieldReader<'a> {
    /// Numbers separated by blanks, commas and line ends.
    pub(super) fn divided_by_commas(file: &'a Path, lines: impl Iterator<Item = (usize, &'a str)>) -> Self {
        Self::new(file, lines, false)
    }

    /// Numbers separated by blanks and line ends, whose decimal separator may be a comma.
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

    /// Returns an error at the last number read.
    pub(super) fn error(&self, what: impl Into<Problem>) -> Error {
        Error::at(self.file, self.line, what)
    }

    /// Reads the next number; `what` names it in messages.
    pub(super) fn number(&mut self, what: &str) -> Result<f64, Error> {
        let Some((line, word)) = self.words.next() else {
            return Err(self.error(format!(
                "the file ends here; expected {what}: it is truncated, or its numbers of angles are wrong"
            )));
        };
        self.line = line;
        parse(word, self.decimal_comma)
            .ok_or_else(|| self.error(format!("found \"{}\"; expected {what}: a number", short(word))))
    }

    /// Reads the next number, 0 or more.
    pub(super) fn amount(&mut self, what: &str) -> Result<f64, Error> {
        let value = self.number(what)?;
        if value >= 0.0 { Ok(value) } else { Err(self.error(format!("found {value}; expected {what}: 0 or more"))) }
    }

    /// Reads the next number, above 0.
    pub(super) fn positive(&mut self, what: &str) -> Result<f64, Error> {
        let value = self.number(what)?;
        if value > 0.0 { Ok(value) } else { Err(self.error(format!("found {value}; expected {what}: above 0"))) }
    }

    /// Reads the next number, an integer of `range`.
    pub(super) fn integer(&mut self, what: &str, range: std::ops::RangeInclusive<u32>) -> Result<u32, Error> {
        let value = self.number(what)?;
        let (low, high) = (*range.start(), *range.end());
        if value.fract() == 0.0 && (f64::from(low)..=f64::from(high)).contains(&value) {
            return Ok(value as u32);
        }
        Err(self.error(format!("found {value}; expected {what}: a whole number from {low} to {high}")))
    }

    /// Reads the next `count` numbers; allocates no more than the file holds.
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
                return Err(self.error(wrong));
            }
            values.push(value);
        }
        Ok(values)
    }

    /// Reads the next `count` intensities.
    pub(super) fn intensities(&mut self, count: usize) -> Result<Vec<f64>, Error> {
        self.list(count, "intensity", |_, value| {
            (value < 0.0).then(|| format!("the intensity is {value}; expected 0 or more"))
        })
    }

    /// Refuses any further word.
    pub(super) fn end(&mut self, expected: &str) -> Result<(), Error> {
        let count = self.words.len();
        match self.words.next() {
            None => Ok(()),
            Some((line, word)) => Err(Error::at(
                self.file,
                line,
                format!(
                    "found \"{}\" and {} more values after {expected}; expected the end of the file: correct the numbers of angles",
                    short(word),
                    count - 1
                ),
            )),
        }
    }
}

/// Parses a finite number.
pub(super) fn parse(word: &str, decimal_comma: bool) -> Option<f64> {
    let is_number = |c: char| c.is_ascii_digit() || "+-.eE,".contains(c);
    if !word.chars().all(is_number) {
        return None;
    }
    let value = if decimal_comma { word.replacen(',', ".", 1).parse() } else { word.parse() };
    value.ok().filter(|v: &f64| v.is_finite())
}

/// Start of a word, for a message.
pub(super) fn short(word: &str) -> String {
    const MAX_SHOWN: usize = 24;
    let start: String = word.chars().take(MAX_SHOWN).collect();
    if start.len() < word.len() { format!("{start}…") } else { start }
}

/// Maximum count of angles of one kind: 0.01° over a full turn.
pub(super) const MAX_ANGLES: u32 = 36_001;

/// Legal vertical angles, degrees.
pub(super) fn vertical_range(axes: PhotometryAxes) -> RangeInclusive<f64> {
    match axes {
        PhotometryAxes::A => -90.0..=90.0,
        PhotometryAxes::B => -180.0..=180.0,
        PhotometryAxes::C => 0.0..=180.0,
    }
}

/// Legal horizontal angles, degrees.
pub(super) fn horizontal_range(axes: PhotometryAxes) -> RangeInclusive<f64> {
    match axes {
        PhotometryAxes::A => -180.0..=180.0,
        PhotometryAxes::B => -90.0..=90.0,
        PhotometryAxes::C => 0.0..=360.0,
    }
}

/// Reads the next `count` angles: increasing, each once, in `range`.
pub(super) fn read(
    fields: &mut FieldReader<'_>,
    count: u32,
    which: &str,
    range: &RangeInclusive<f64>,
) -> Result<Vec<f64>, Error> {
    fields.list(count as usize, &format!("{which} angle"), |before, angle| {
        let (low, high) = (range.start(), range.end());
        if !range.contains(&angle) {
            return Some(format!("the {which} angle is {angle}°; expected {low}° to {high}°"));
        }
        let last = *before.last()?;
        let number = before.len() + 1;
        (angle <= last).then(|| {
            format!(
                "{which} angle {number} of {count} is {angle}° and follows {last}°: sort the angles in increasing order, each once, or correct their number"
            )
        })
    })
}

/// Note on the missing part of a grid that does not end where grids of these axes do.
pub(super) fn dark_beyond(which: &str, grid: &[f64], firsts: &[f64], lasts: &[f64]) -> Option<String> {
    let (first, last) = (*grid.first()?, *grid.last()?);
    let is_complete = firsts.contains(&first) && lasts.contains(&last);
    (!is_complete).then(|| {
        format!("{which} angles from {first}° to {last}° were measured; outside this range the intensity is 0")
    })
}

/// The same for vertical angles. Type C may stop at the horizon: many lamps emit to one side only.
pub(super) fn dark_above_or_below(axes: PhotometryAxes, vertical: &[f64]) -> Option<String> {
    match axes {
        PhotometryAxes::C => dark_beyond("vertical", vertical, &[0.0, 90.0], &[90.0, 180.0]),
        PhotometryAxes::A => dark_beyond("vertical", vertical, &[-90.0], &[90.0]),
        PhotometryAxes::B => dark_beyond("vertical", vertical, &[-90.0, -180.0], &[90.0, 180.0]),
    }
}

/// The end-of-file character of DOS.
const DOS_END: char = '\u{1a}';

/// Decodes `bytes`.
pub(super) fn decode<'a>(file: &Path, bytes: &'a [u8]) -> Result<Cow<'a, str>, Error> {
    if let Some(at) = bytes.iter().position(|b| *b == 0) {
        let line = 1 + bytes[..at].iter().filter(|b| **b == b'\n').count();
        return Err(Error::at(file, line, "not text; expected a photometric file in ASCII, Latin-1 or UTF-8"));
    }
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text.trim_end().trim_end_matches(DOS_END)),
        Err(_) => {
            Cow::Owned(bytes.iter().map(|b| char::from(*b)).collect::<String>().trim_end_matches(DOS_END).to_owned())
        }
    };
    // Carriage returns alone end the lines of old Macintosh files.
    Ok(if text.contains('\n') { text } else { Cow::Owned(text.replace('\r', "\n")) })
}

/// Content of the `TILT=` line.
pub(super) enum TiltStatement<'a> {
    None,
    Include,
    File(&'a str),
}

impl<'a> TiltStatement<'a> {
    pub(super) fn from_word(word: &'a str) -> Self {
        match word {
            _ if word.eq_ignore_ascii_case("none") => Self::None,
            _ if word.eq_ignore_ascii_case("include") => Self::Include,
            other => Self::File(other),
        }
    }
}

/// Reads the next numbers as a table of tilts.
pub(super) fn table(fields: &mut FieldReader<'_>) -> Result<Tilt, Error> {
    let geometry = fields.integer("the lamp-to-luminaire geometry", 1..=3)? as u8;
    let count = fields.integer("the number of tilts", 1..=MAX_ANGLES)?;
    let tilts = read(fields, count, "tilt", &(-180.0..=180.0))?;
    let factors = fields.list(count as usize, "factor of a tilt", |_, factor| {
        (factor < 0.0).then(|| format!("the factor is {factor}; expected 0 or more"))
    })?;
    Ok(Tilt::Table { geometry, factors: tilts.into_iter().zip(factors).collect() })
}

/// Table of a separate file.
pub(super) struct TiltFile {
    pub(super) tilt: Tilt,
    pub(super) bytes: Vec<u8>,
    /// Difference between the name and the file.
    pub(super) note: Option<String>,
}

/// Table in the file of that name next to `file`.
pub(super) fn from_file(file: &Path, line: usize, name: &str, sandbox: &Sandbox) -> Result<TiltFile, Error> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let place = format!("{}:{line}: TILT", file.display());
    let read = || {
        let NamedFile { path, note, .. } = find_named_file(&[folder], name, sandbox)
            .map_err(|problem| Error::new(&folder.join(name.replace('\\', "/")), problem))?;
        let bytes = read_description_bytes(&path, "tilt")?;
        let text = decode(&path, &bytes)?.into_owned();
        let mut fields = FieldReader::divided_by_commas(&path, text.lines().enumerate().map(|(i, line)| (i + 1, line)));
        let tilt = table(&mut fields)?;
        fields.end("the factors of tilts")?;
        Ok(TiltFile { tilt, bytes, note })
    };
    read().map_err(|error: Error| error.named_at(place))
}

/// Note for the user on a table.
pub(super) fn note(tilt: &Tilt) -> Option<String> {
    match tilt {
        Tilt::None => None,
        Tilt::Table { factors, .. } => {
            let (low, high) =
                factors.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), (_, f)| (low.min(*f), high.max(*f)));
            Some(format!(
                "the tilt factors ({low} to {high}) are not applied: the intensities are those of the measured position"
            ))
        }
        Tilt::Measured(degrees) if *degrees == 0.0 => None,
        Tilt::Measured(degrees) => Some(format!(
            "measured at a tilt of {degrees}°; the angles are used as in the file, without correction for the tilt"
        )),
    }
}
