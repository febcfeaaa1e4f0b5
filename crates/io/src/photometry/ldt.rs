//! EULUMDAT (A. W. Stockmar, "EULUMDAT, ein Leuchtendatenformat für den europäischen Beleuchtungsplaner", 1990): lines of fixed meaning, then numbers.
//!
//! Intensities are cd per 1 000 lm of the lamps: cd = number × conversion factor × total lumens / 1 000. A negative count of lamps means absolute photometry:
//! the lumens are then the luminaire's own; the rule is the same. Of several sets of lamps (equipment options of a luminaire) the first is used. Sizes are in
//! mm. The length of a luminaire lies across its C0 plane. Data that depend on the room (direct ratios) are ignored.

use std::path::Path;

use etendue_scene::asset::{Opening, OpeningShape, PhotometryAsset, PhotometryAxes, Tilt};

use super::fields::{self, FieldReader};
use super::symmetry::{self, Symmetry};
use crate::Error;

/// Lines before the sets of lamps, and lines per set.
const HEAD_LINES: usize = 26;
const SET_LINES: usize = 6;

/// Lines of fixed meaning, by their number in the standard.
struct Lines<'a> {
    file: &'a Path,
    lines: Vec<&'a str>,
}

impl<'a> Lines<'a> {
    fn text(&self, line: usize, what: &str) -> Result<&'a str, Error> {
        let line_text = self.lines.get(line - 1).map(|text| text.trim());
        line_text.ok_or_else(|| {
            let count = self.lines.len();
            Error::at(self.file, count, format!("the file ends here; expected {what} in line {line}: it is truncated"))
        })
    }

    fn number(&self, line: usize, what: &str) -> Result<f64, Error> {
        let text = self.text(line, what)?;
        fields::parse(text, true).ok_or_else(|| {
            Error::at(self.file, line, format!("found \"{}\"; expected {what}: a number", fields::short(text)))
        })
    }

    /// Optional number; 0 if absent.
    fn optional(&self, line: usize, what: &str) -> Result<f64, Error> {
        if self.text(line, what)?.is_empty() { Ok(0.0) } else { self.number(line, what) }
    }

    fn integer(&self, line: usize, what: &str, low: i32, high: i32) -> Result<i32, Error> {
        let value = self.number(line, what)?;
        if value.fract() == 0.0 && (f64::from(low)..=f64::from(high)).contains(&value) {
            return Ok(value as i32);
        }
        Err(Error::at(self.file, line, format!("found {value}; expected {what}: a whole number from {low} to {high}")))
    }

    fn above_0(&self, line: usize, what: &str) -> Result<f64, Error> {
        let value = self.number(line, what)?;
        let message = || Error::at(self.file, line, format!("found {value}; expected {what}: above 0"));
        if value > 0.0 { Ok(value) } else { Err(message()) }
    }
}

/// Set of lamps.
struct Lamps {
    /// Below 0 for absolute photometry.
    count: i32,
    lumens: f64,
    watts: f64,
}

/// Parses a text.
pub(super) fn read(file: &Path, text: &str) -> Result<PhotometryAsset, Error> {
    let lines = Lines { file, lines: text.lines().collect() };
    lines.integer(2, "the type of the luminaire (1, 2 or 3)", 0, 3)?;
    let code = lines.integer(3, "the symmetry (0 none, 1 rotational, 2 about C0, 3 about C90, 4 both)", 0, 4)?;
    let planes = lines.integer(4, "the number of C planes", 1, fields::MAX_ANGLES as i32)? as usize;
    let verticals = lines.integer(6, "the number of angles in a plane", 2, fields::MAX_ANGLES as i32)? as u32;
    let output_ratio = lines.above_0(23, "the light output ratio, per cent")? / 100.0;
    let conversion = lines.above_0(24, "the conversion factor of the intensities")?;
    let measured_tilt = lines.optional(25, "the tilt of the luminaire during measurement, degrees")?;
    let sets = lines.integer(26, "the number of sets of lamps", 1, 1000)? as usize;
    let lamps = lamps(&lines)?;
    let rest = text.lines().enumerate().map(|(i, line)| (i + 1, line)).skip(HEAD_LINES + SET_LINES * sets);
    let mut fields = FieldReader::with_decimal_commas(file, rest);
    let factor = conversion * lamps.lumens / 1000.0;
    let (vertical_deg, turn) = grid(file, &mut fields, LdtTable { code, planes, verticals, factor })?;
    let tilt = if measured_tilt == 0.0 { Tilt::None } else { Tilt::Measured(measured_tilt) };
    let mut report: Vec<String> = fields::note(&tilt).into_iter().collect();
    report.extend(fields::dark_above_or_below(PhotometryAxes::C, &vertical_deg));
    report.extend(
        (sets > 1).then(|| format!("{sets} sets of lamps are listed; the first is used ({} lm)", lamps.lumens)),
    );
    Ok(PhotometryAsset {
        format: if lamps.count < 0 { "EULUMDAT, absolute photometry" } else { "EULUMDAT" }.to_owned(),
        axes: PhotometryAxes::C,
        vertical_deg,
        horizontal_deg: turn.iter().map(|(angle, _)| *angle).collect(),
        candela: turn.into_iter().flat_map(|(_, plane)| plane).collect(),
        rated_lumens: Some(lamps.lumens),
        output_ratio: Some(output_ratio),
        lamps: lamps.count.unsigned_abs(),
        factor,
        watts: lamps.watts,
        opening: opening(&lines)?,
        tilt,
        texts: texts(&lines)?,
        report,
        hash: [0; 32],
    })
}

fn lamps(lines: &Lines<'_>) -> Result<Lamps, Error> {
    let count = lines.integer(HEAD_LINES + 1, "the number of lamps", -1_000_000, 1_000_000)?;
    if count == 0 {
        let what = "found 0 lamps; expected their number, negative for absolute photometry";
        return Err(Error::at(lines.file, HEAD_LINES + 1, what));
    }
    let lumens = lines.above_0(HEAD_LINES + 3, "the total lumens of the lamps")?;
    let watts = lines.optional(HEAD_LINES + 6, "the watts of the lamps, ballast included")?;
    Ok(Lamps { count, lumens, watts })
}

fn opening(lines: &Lines<'_>) -> Result<Opening, Error> {
    let metres = |line, what| Ok::<f64, Error>(lines.optional(line, what)?.abs() * 1e-3);
    let (length, width) =
        (metres(16, "the length of the luminous area")?, metres(17, "the width of the luminous area")?);
    let mut height_m: f64 = 0.0;
    for line in 18..=21 {
        height_m = height_m.max(metres(line, "the height of the luminous area")?);
    }
    let shape = match (length > 0.0, width > 0.0) {
        (true, true) => OpeningShape::Rectangular,
        (true, false) => OpeningShape::Round,
        _ => OpeningShape::Point,
    };
    let width = if shape == OpeningShape::Round { length } else { width };
    Ok(Opening { shape, length_m: width, width_m: length, height_m })
}

fn texts(lines: &Lines<'_>) -> Result<Vec<(String, String)>, Error> {
    let named = [
        (1, "manufacturer"),
        (8, "report number"),
        (9, "luminaire"),
        (10, "luminaire number"),
        (11, "file"),
        (12, "date and user"),
        (HEAD_LINES + 2, "type of lamps"),
        (HEAD_LINES + 4, "colour temperature"),
        (HEAD_LINES + 5, "colour rendering"),
    ];
    let mut texts = Vec::new();
    for (line, name) in named {
        let text = lines.text(line, name)?;
        if !text.is_empty() {
            texts.push((name.to_owned(), text.to_owned()));
        }
    }
    Ok(texts)
}

/// Description of the grid that precedes it.
#[derive(Clone, Copy)]
struct LdtTable {
    code: i32,
    planes: usize,
    verticals: u32,
    factor: f64,
}

impl LdtTable {
    fn symmetry(self) -> Symmetry {
        match self.code {
            0 => Symmetry::None,
            1 => Symmetry::Round,
            2 => Symmetry::AboutC0,
            3 => Symmetry::AboutC90,
            _ => Symmetry::Quadrants,
        }
    }

    /// Angles of the stored planes, in order, from all listed angles.
    fn stored_angles(self, all: &[f64]) -> Result<Vec<f64>, String> {
        let (count, half, quarter) = (self.planes, self.planes / 2, self.planes / 4);
        let take = |first: usize, planes: usize| (0..planes).map(|i| all[(first + i) % count]).collect::<Vec<f64>>();
        let (stored, even, ends) = match self.code {
            0 => return Ok(all.to_vec()),
            1 => return Ok(take(0, 1)),
            2 => (take(0, half + 1), 2, [0.0, 180.0]),
            3 => (take(3 * quarter, half + 1), 4, [270.0, 90.0]),
            _ => (take(0, quarter + 1), 4, [0.0, 90.0]),
        };
        if count % even == 0 && [stored[0], stored[stored.len() - 1]] == ends {
            return Ok(stored);
        }
        let [first, last] = ends;
        Err(format!(
            "a light of symmetry {} contains the planes from C{first} to C{last}; expected them at these positions among {count} planes: correct the \
             symmetry in line 3 or the planes",
            self.code
        ))
    }
}

/// Vertical angles, and all planes in cd.
fn grid(file: &Path, fields: &mut FieldReader<'_>, table: LdtTable) -> Result<(Vec<f64>, Vec<symmetry::Plane>), Error> {
    fields.list(10, "direct ratio", |_, _| None)?;
    let all = fields::read(fields, table.planes as u32, "C", &(0.0..=360.0))?;
    let stored = table.stored_angles(&all).map_err(|what| fields.error(what))?;
    let vertical = fields::read(fields, table.verticals, "vertical", &(0.0..=180.0))?;
    let mut intensities = fields.intensities(vertical.len() * stored.len())?;
    fields.end("the last intensity")?;
    intensities.iter_mut().for_each(|value| *value *= table.factor);
    let planes = symmetry::planes(&stored, &intensities);
    Ok((vertical, symmetry::full_turn(file, planes, table.symmetry())?))
}
