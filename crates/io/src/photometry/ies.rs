//! ANSI/IES LM-63: the editions of 1986, 1991, 1995, 2002 and 2019.
//!
//! A line of identification (none in 1986; see `ies/edition.rs`), `[KEYWORD] text` lines, `TILT=`, then numbers in any arrangement: lamps, lumens per lamp (−1:
//! absolute photometry), multiplier, counts of vertical and horizontal angles, type (1 C, 2 B, 3 A), unit (1 feet, 2 metres), width, length and height of the
//! luminous opening, ballast factor, one more, watts, the angles, and the intensities plane by plane. The extra number is the ballast-lamp photometric factor
//! up to 1995, reserved in 2002, the type of file generation in 2019: only the first is a factor.
//!
//! Horizontal angles determine the symmetry. Type C: 0 alone, 0–90, 0–180, 90–270 (about the C90 plane), 0–360. Types A and B: from 0 on (the left is the
//! mirror image of the right), or both sides.
//!
//! The shape of the luminous opening follows from the signs of its sizes (LM-63-2002, annex D): negative sizes are round.

mod edition;

use std::path::Path;

use etendue_scene::asset::{Opening, OpeningShape, PhotometryAsset, PhotometryAxes, Tilt};

use super::fields::{self, FieldReader};
use super::symmetry::{self, Symmetry};
use crate::{Error, Sandbox};
use edition::{Edition, Identification};

/// Content before the numbers.
struct IesHead<'a> {
    identification: Identification,
    texts: Vec<(String, String)>,
    tilt: fields::TiltStatement<'a>,
    /// Line of TILT, counted from 1.
    line: usize,
}

/// Numbers between TILT and the angles.
struct IesBody {
    lamps: u32,
    lumens: f64,
    multiplier: f64,
    verticals: u32,
    horizontals: u32,
    axes: PhotometryAxes,
    metres: f64,
    size: [f64; 3],
    ballast: f64,
    further: f64,
    watts: f64,
}

/// Parses a text; also returns the bytes of a tilt file, if it names one.
pub(super) fn read(file: &Path, text: &str, sandbox: &Sandbox) -> Result<(PhotometryAsset, Option<Vec<u8>>), Error> {
    let head = head(file, text)?;
    let numbered = text.lines().enumerate().map(|(i, line)| (i + 1, line)).skip(head.line);
    let mut fields = FieldReader::divided_by_commas(file, numbered);
    let (tilt, further, tilt_note) = match head.tilt {
        fields::TiltStatement::None => (Tilt::None, None, None),
        fields::TiltStatement::Include => (fields::table(&mut fields)?, None, None),
        fields::TiltStatement::File(name) => {
            let fields::TiltFile { tilt, bytes, note } = fields::from_file(file, head.line, name, sandbox)?;
            (tilt, Some(bytes), note)
        }
    };
    let body = body(&mut fields)?;
    let edition = head.identification.edition(file, body.further)?;
    let mut report: Vec<String> = head.identification.note().into_iter().collect();
    report.extend(body.edition_notes(edition));
    report.extend(tilt_note);
    report.extend(fields::note(&tilt));
    let factor = body.factor(edition);
    let (vertical_deg, planes) = grid(file, &mut fields, &body, factor, &mut report)?;
    let asset = PhotometryAsset {
        format: format!("IES LM-63, {}", edition.name()),
        axes: body.axes,
        vertical_deg,
        horizontal_deg: planes.iter().map(|(angle, _)| *angle).collect(),
        candela: planes.into_iter().flat_map(|(_, plane)| plane).collect(),
        rated_lumens: (body.lumens > 0.0).then(|| body.lumens * f64::from(body.lamps)),
        output_ratio: None,
        lamps: body.lamps,
        factor,
        watts: body.watts,
        opening: opening_from_size(body.size.map(|v| v * body.metres)),
        tilt,
        texts: head.texts,
        report,
        hash: [0; 32],
    };
    Ok((asset, further))
}

fn head<'a>(file: &Path, text: &'a str) -> Result<IesHead<'a>, Error> {
    let mut texts: Vec<(String, String)> = Vec::new();
    let mut identification = Identification::None;
    for (index, line) in text.lines().enumerate() {
        if let Some(word) = after_tilt(line) {
            if word.is_empty() {
                let what = "nothing follows TILT=; expected NONE, INCLUDE or the name of a file";
                return Err(Error::at(file, index + 1, what));
            }
            return Ok(IesHead {
                identification,
                texts,
                tilt: fields::TiltStatement::from_word(word),
                line: index + 1,
            });
        }
        match Identification::read(line, index + 1) {
            Some(edition) if identification == Identification::None => identification = edition,
            _ => add_text(&mut texts, line.trim()),
        }
    }
    let what = "no line begins with TILT=; expected TILT=NONE, TILT=INCLUDE or TILT=file before the numbers: not an IES file, or a damaged one";
    Err(Error::new(file, what))
}

/// Text after `TILT=`, trimmed.
fn after_tilt(line: &str) -> Option<&str> {
    let (name, word) = line.split_once('=')?;
    name.trim().eq_ignore_ascii_case("tilt").then(|| word.trim())
}

/// `[KEYWORD] text`; `[MORE]` continues; a line without a keyword is a text without a name.
fn add_text(texts: &mut Vec<(String, String)>, line: &str) {
    let keyword = line.strip_prefix('[').and_then(|rest| rest.split_once(']'));
    match (keyword, texts.last_mut()) {
        (Some((name, more)), Some((_, text))) if name.eq_ignore_ascii_case("MORE") => {
            text.push(' ');
            text.push_str(more.trim());
        }
        (Some((name, text)), _) => texts.push((name.trim().to_owned(), text.trim().to_owned())),
        (None, _) if line.is_empty() => {}
        (None, _) => texts.push((String::new(), line.to_owned())),
    }
}

fn body(fields: &mut FieldReader<'_>) -> Result<IesBody, Error> {
    Ok(IesBody {
        lamps: fields.integer("the number of lamps", 1..=1_000_000)?,
        lumens: lumens(fields)?,
        multiplier: fields.positive("the multiplier of the intensities")?,
        verticals: fields.integer("the number of vertical angles", 2..=fields::MAX_ANGLES)?,
        horizontals: fields.integer("the number of horizontal angles", 1..=fields::MAX_ANGLES)?,
        axes: axes(fields)?,
        metres: if fields.integer("the unit (1 feet, 2 metres)", 1..=2)? == 1 { 0.3048 } else { 1.0 },
        size: [size(fields, "width")?, size(fields, "length")?, size(fields, "height")?],
        ballast: fields.positive("the ballast factor")?,
        further: fields.number("the ballast-lamp factor, or its replacement in later editions")?,
        watts: fields.amount("the watts")?,
    })
}

fn lumens(fields: &mut FieldReader<'_>) -> Result<f64, Error> {
    let lumens = fields.number("the lumens per lamp")?;
    if lumens >= 0.0 || lumens == -1.0 {
        return Ok(lumens);
    }
    Err(fields.error(format!("found {lumens} lumens; expected the lumens per lamp, or -1 for absolute photometry")))
}

fn axes(fields: &mut FieldReader<'_>) -> Result<PhotometryAxes, Error> {
    let types = [PhotometryAxes::C, PhotometryAxes::B, PhotometryAxes::A];
    let number = fields.integer("the photometric type (1 is C, 2 is B, 3 is A)", 1..=3)?;
    Ok(types[number as usize - 1])
}

fn size(fields: &mut FieldReader<'_>, which: &str) -> Result<f64, Error> {
    fields.number(&format!("the {which} of the luminous opening"))
}

impl IesBody {
    /// Factor of the intensities.
    fn factor(&self, edition: Edition) -> f64 {
        let lamp_factor = if edition <= Edition::Of1995 { self.further } else { 1.0 };
        self.multiplier * self.ballast * lamp_factor
    }

    fn edition_notes(&self, edition: Edition) -> Vec<String> {
        let reserved = edition == Edition::Of2002 && self.further != 1.0;
        let notes = [
            (self.lumens == 0.0, "the lamps are rated 0 lumens: the flux cannot be checked".to_owned()),
            (reserved, format!("the number {} in the field reserved by LM-63-2002 is not used", self.further)),
        ];
        notes.into_iter().filter(|(is, _)| *is).map(|(_, note)| note).collect()
    }

    /// Symmetry determined by the horizontal angles.
    fn symmetry(&self, horizontal: &[f64]) -> Result<Symmetry, String> {
        let (first, last) = (horizontal[0], horizontal[horizontal.len() - 1]);
        match (self.axes, horizontal.len()) {
            (PhotometryAxes::C, 1) => Ok(Symmetry::Round),
            (PhotometryAxes::C, _) => turn(first, last, horizontal),
            (_, 1) => Err("found one horizontal angle; expected at least two for photometry of type A or B".to_owned()),
            _ if first == 0.0 => Ok(Symmetry::LeftRight),
            _ => Ok(Symmetry::None),
        }
    }
}

/// Symmetry of planes about a vertical axis.
fn turn(first: f64, last: f64, horizontal: &[f64]) -> Result<Symmetry, String> {
    let step = horizontal.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    if first == 0.0 && last == 90.0 {
        Ok(Symmetry::Quadrants)
    } else if first == 0.0 && last == 180.0 {
        Ok(Symmetry::AboutC0)
    } else if first == 90.0 && last == 270.0 {
        Ok(Symmetry::AboutC90)
    } else if first + 360.0 - last <= step || (first == 0.0 && last == 360.0) {
        Ok(Symmetry::None)
    } else {
        Err(format!(
            "found horizontal angles from {first}° to {last}°; expected 0° alone, or from 0° to 90°, 180° or 360°, or from 90° to 270°: measure the \
             rest or state the symmetry"
        ))
    }
}

/// Vertical angles, and the planes with every factor applied.
fn grid(
    file: &Path,
    fields: &mut FieldReader<'_>,
    body: &IesBody,
    factor: f64,
    report: &mut Vec<String>,
) -> Result<(Vec<f64>, Vec<symmetry::Plane>), Error> {
    if factor.is_nan() || factor <= 0.0 {
        return Err(fields
            .error(format!("the product of multiplier and ballast factors is {factor}; expected a number above 0")));
    }
    let (up, across) = (fields::vertical_range(body.axes), fields::horizontal_range(body.axes));
    let vertical = fields::read(fields, body.verticals, "vertical", &up)?;
    let horizontal = fields::read(fields, body.horizontals, "horizontal", &across)?;
    let symmetry = body.symmetry(&horizontal).map_err(|what| fields.error(what))?;
    let mut intensities = fields.intensities(vertical.len() * horizontal.len())?;
    fields.end("the last intensity")?;
    intensities.iter_mut().for_each(|value| *value *= factor);
    let planes = symmetry::planes(&horizontal, &intensities);
    report.extend(fields::dark_above_or_below(body.axes, &vertical));
    let planes = match body.axes {
        PhotometryAxes::C => symmetry::full_turn(file, planes, symmetry)?,
        PhotometryAxes::A | PhotometryAxes::B => symmetry::fan(planes, symmetry),
    };
    if body.axes != PhotometryAxes::C {
        let all: Vec<f64> = planes.iter().map(|(angle, _)| *angle).collect();
        report.extend(fields::dark_beyond("horizontal", &all, &[-90.0, -180.0], &[90.0, 180.0]));
    }
    Ok((vertical, planes))
}

/// Opening from a width, length and height, m.
fn opening_from_size([width, length, height]: [f64; 3]) -> Opening {
    let round = [width < 0.0, length < 0.0, height < 0.0];
    let shape = match round {
        [false, false, _] if [width, length, height] == [0.0; 3] => OpeningShape::Point,
        [false, false, _] => OpeningShape::Rectangular,
        [true, true, true] => OpeningShape::Ball,
        [_, _, false] => OpeningShape::Round,
        [true, false, true] => OpeningShape::Lying,
        [false, true, true] => OpeningShape::LyingAcross,
    };
    // Editions before 2002 state a circle by its width alone.
    let length = if shape == OpeningShape::Round && length == 0.0 { width } else { length };
    Opening { shape, length_m: length.abs(), width_m: width.abs(), height_m: height.abs() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_tell_the_shape() {
        let shapes = [
            ([0.0, 0.0, 0.0], OpeningShape::Point),
            ([1.0, 2.0, 0.0], OpeningShape::Rectangular),
            ([1.0, 2.0, 0.5], OpeningShape::Rectangular),
            ([-1.0, -1.0, 0.0], OpeningShape::Round),
            ([-1.0, 0.0, 0.0], OpeningShape::Round),
            ([-1.0, -2.0, 0.5], OpeningShape::Round),
            ([-1.0, -1.0, -1.0], OpeningShape::Ball),
            ([-1.0, 2.0, -1.0], OpeningShape::Lying),
            ([0.0, -1.0, -1.0], OpeningShape::LyingAcross),
        ];
        for (size, shape) in shapes {
            assert_eq!(opening_from_size(size).shape, shape, "{size:?}");
        }
        let circle = opening_from_size([-0.5, 0.0, 0.0]);
        assert_eq!((circle.width_m, circle.length_m, circle.height_m), (0.5, 0.5, 0.0));
    }
}
