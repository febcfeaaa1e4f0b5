//! Zemax lens files.
//!
//! A line is a keyword and its values; those of a surface follow its SURF. GLAS names a catalogue glass, or (second value 1)
//! gives index and Abbe number of a model glass. PARM i of an EVENASPH is the coefficient of r²ⁱ. FTYP holds the kind of
//! field and the numbers of fields and wavelengths, for YFLN and WAVM are filled up.
//!
//! A glass that no catalogue here has is taken by the index and Abbe number of its line, unless those are the 1.5 and 40 that Zemax
//! writes for glasses of its catalogues; then by Schott's successor of the same name, with N before it. Either is noted.

use std::path::Path;

use etendue_scene::asset::{GlassAsset, LensFields, PrescriptionAsset};

use super::build::{Raw, RawSurface, by_number, named, successor};
use super::opening::Opening;
use super::text::Words;
use crate::Error;

pub(super) fn read(file: &Path, text: &str) -> Result<PrescriptionAsset, Error> {
    let mut reader = Reader::default();
    for (i, line) in text.lines().enumerate() {
        let words = Words { file, line: i + 1, words: line.split_whitespace().collect() };
        if !words.words.is_empty() {
            reader.command(&words)?;
        }
    }
    reader.finish(file)
}

#[derive(Default)]
struct Reader {
    raw: Raw,
    field_kind: usize,
    counts: [usize; 2],
    heights: Vec<f64>,
}

impl Reader {
    fn command(&mut self, w: &Words<'_>) -> Result<(), Error> {
        match w.word(0) {
            "MODE" if w.word(1) != "SEQ" => Err(w.fault("a non-sequential lens; expected MODE SEQ")),
            "NAME" => {
                self.raw.title = w.words[1..].join(" ");
                Ok(())
            }
            "UNIT" => self.unit(w),
            "ENPD" | "FNUM" | "OBNA" | "FLOA" => {
                self.raw.opening = opening(w)?;
                Ok(())
            }
            "MNUM" if w.number(1)? > 1.0 => {
                self.raw.notes.push(format!(
                    "line {}: of {} configurations the one that the surfaces state is taken",
                    w.line,
                    w.word(1)
                ));
                Ok(())
            }
            "FTYP" => self.field_type(w),
            "YFLN" | "YFLD" => {
                self.heights = w.numbers(1)?;
                Ok(())
            }
            "WAVM" => {
                self.raw.wavelengths_nm.push(1e3 * w.number(2)?);
                Ok(())
            }
            "SURF" => {
                self.raw.surfaces.push(RawSurface::new(w.line));
                Ok(())
            }
            "GLAS" => self.glass(w),
            _ => match self.raw.surfaces.last_mut() {
                Some(surface) => property(surface, w),
                None => Ok(()),
            },
        }
    }

    fn unit(&mut self, w: &Words<'_>) -> Result<(), Error> {
        let unit = match w.word(1) {
            "MM" => 1.0,
            "CM" => 10.0,
            "IN" => 25.4,
            "METER" => 1e3,
            other => return Err(w.fault(format!("UNIT is `{other}`; expected MM, CM, IN or METER"))),
        };
        self.raw.unit_mm = Some(unit);
        Ok(())
    }

    fn field_type(&mut self, w: &Words<'_>) -> Result<(), Error> {
        let count = |place: usize| if w.words.len() > place { w.number(place) } else { Ok(f64::from(u8::MAX)) };
        self.field_kind = w.number(1)? as usize;
        self.counts = [count(3)? as usize, count(4)? as usize];
        Ok(())
    }

    fn glass(&mut self, w: &Words<'_>) -> Result<(), Error> {
        let (glass, note) = glass(w, &self.raw.surfaces)?;
        self.raw.notes.extend(note.map(|note| format!("line {}: {note}", w.line)));
        if let Some(surface) = self.raw.surfaces.last_mut() {
            surface.glass = glass;
        }
        Ok(())
    }

    fn finish(mut self, file: &Path) -> Result<PrescriptionAsset, Error> {
        if self.counts != [0, 0] {
            self.heights.truncate(self.counts[0]);
            self.raw.wavelengths_nm.truncate(self.counts[1]);
        }
        let kinds = [LensFields::AnglesDeg, LensFields::ObjectMm, LensFields::ImageMm, LensFields::ImageMm];
        let kind = kinds.get(self.field_kind).filter(|_| !self.heights.is_empty());
        self.raw.fields = kind.map(|kind| kind(self.heights));
        self.raw.finish(file)
    }
}

fn property(surface: &mut RawSurface, w: &Words<'_>) -> Result<(), Error> {
    match w.word(0) {
        "TYPE" if !["STANDARD", "EVENASPH"].contains(&w.word(1)) => {
            let kind = w.word(1);
            return Err(w.fault(format!("a surface of type {kind}; only STANDARD and EVENASPH are modelled")));
        }
        "TYPE" => surface.aspheric = w.word(1) == "EVENASPH",
        "CURV" => surface.curvature = w.number(1)?,
        "CONI" => surface.conic = w.number(1)?,
        // A STANDARD surface has no parameters.
        "PARM" if surface.aspheric => coefficient(surface, w)?,
        "DISZ" => surface.thickness = if w.word(1) == "INFINITY" { f64::INFINITY } else { w.number(1)? },
        // A clear aperture overrides the diameter that the program keeps for drawing.
        "CLAP" if w.number(1)? != 0.0 => return Err(w.fault("an obscuration; only round, open apertures are modelled")),
        "CLAP" => surface.semi_aperture = Some(w.number(2)?),
        "DIAM" if surface.semi_aperture.is_none() => surface.semi_aperture = Some(w.number(1)?).filter(|d| *d > 0.0),
        "STOP" => surface.stop = true,
        "OBDC" if w.numbers(1)?.iter().all(|shift| *shift == 0.0) => {}
        aperture @ ("SQAP" | "ELAP" | "OBSC" | "SQOB" | "ELOB" | "UDAD" | "OBDC") => {
            return Err(w.fault(format!("an aperture {aperture}; only round, centred apertures are modelled")));
        }
        _ => {}
    }
    Ok(())
}

fn coefficient(surface: &mut RawSurface, w: &Words<'_>) -> Result<(), Error> {
    let (place, value) = (w.number(1)?, w.number(2)?);
    match surface.asphere.get_mut((place - 1.0) as usize) {
        Some(term) if place >= 1.0 => *term = value,
        _ if value == 0.0 => {}
        _ => return Err(w.fault(format!("PARM {place}; expected 1 to 8, the terms r² to r¹⁶"))),
    }
    Ok(())
}

/// How far the lens opens; `None` where the stop's own size says it (FLOA).
fn opening(w: &Words<'_>) -> Result<Option<Opening>, Error> {
    match (w.word(0), w.word(2)) {
        ("ENPD", _) => Opening::pupil(w).map(Some),
        ("FNUM", "1") => Err(w.fault("a working f-number; give the image-space f-number (FNUM with 0), ENPD or FLOA")),
        ("FNUM", _) => Opening::f_number(w).map(Some),
        ("OBNA", "1") => Opening::object_angle(w).map(Some),
        ("OBNA", _) => Opening::object_cone(w).map(Some),
        _ => Ok(None),
    }
}

/// The glass of a GLAS line, and what is to be said of it.
fn glass(w: &Words<'_>, surfaces: &[RawSurface]) -> Result<(GlassAsset, Option<String>), Error> {
    let name = w.word(1);
    if name == "MIRROR" {
        return Err(w.fault("a mirror; only refracting lenses are modelled"));
    }
    let numbers = || Some((w.number(4).ok()?, w.number(5).ok()?)).filter(|(index, abbe)| *index > 1.0 && *abbe > 0.0);
    match w.word(2) {
        "1" => return Ok((GlassAsset::Abbe { index: w.number(4)?, abbe: w.number(5)? }, None)),
        "2" => {
            let from = surfaces.get(w.number(3)? as usize);
            let from = from.ok_or_else(|| w.fault("the glass is picked up from a surface that is not given before"))?;
            return Ok((from.glass.clone(), None));
        }
        _ => {}
    }
    if let Some(known) = named(name).or_else(|| by_number(name)) {
        return Ok((known, None));
    }
    // Zemax writes these where the glass's own numbers stand in a catalogue.
    let own = numbers().filter(|pair| *pair != (1.5, 40.0));
    if let Some((index, abbe)) = own {
        let note = format!("no catalogue here has {name}: n_d {index} and V_d {abbe} of its line are taken");
        return Ok((GlassAsset::Abbe { index, abbe }, Some(note)));
    }
    match successor(name) {
        Some(GlassAsset::Named(today)) => {
            let note = format!("no catalogue here has {name}: its successor {today} is taken");
            Ok((GlassAsset::Named(today), Some(note)))
        }
        _ => Err(w.fault(format!(
            "no glass is called `{name}`; give a name of the Schott or Ohara catalogue, or n_d and V_d on its line (GLAS {name} 1 0 n_d V_d)"
        ))),
    }
}
