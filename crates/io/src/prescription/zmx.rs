//! Zemax lens files.
//!
//! A line is a keyword and its values; those of a surface follow its SURF. GLAS names a catalogue glass, or (second value 1)
//! gives index and Abbe number of a model glass. PARM i of an EVENASPH is the coefficient of r²ⁱ. FTYP holds the kind of
//! field and the numbers of fields and wavelengths, for YFLN and WAVM are filled up.

use std::path::Path;

use etendue_scene::asset::{GlassAsset, LensFields, LensOpening, PrescriptionAsset};

use super::build::{Raw, RawSurface, named};
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
            "ENPD" => {
                self.raw.opening = Some(LensOpening::EntrancePupil { diameter_mm: w.number(1)? });
                Ok(())
            }
            "FNUM" => {
                self.raw.opening = Some(LensOpening::FNumber { f_number: w.number(1)? });
                Ok(())
            }
            "FTYP" => self.field_type(w),
            "YFLN" => {
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
        "CURV" => surface.curvature = w.number(1)?,
        "CONI" => surface.conic = w.number(1)?,
        "PARM" => coefficient(surface, w)?,
        "DISZ" => surface.thickness = if w.word(1) == "INFINITY" { f64::INFINITY } else { w.number(1)? },
        "GLAS" => surface.glass = glass(w)?,
        // A clear aperture overrides the diameter that the program keeps for drawing.
        "CLAP" => surface.semi_aperture = Some(w.number(2)?),
        "DIAM" if surface.semi_aperture.is_none() => surface.semi_aperture = Some(w.number(1)?).filter(|d| *d > 0.0),
        "STOP" => surface.stop = true,
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

fn glass(w: &Words<'_>) -> Result<GlassAsset, Error> {
    let name = w.word(1);
    if name == "MIRROR" {
        return Err(w.fault("a mirror; only refracting lenses are modelled"));
    }
    if w.word(2) == "1" {
        return Ok(GlassAsset::Abbe { index: w.number(4)?, abbe: w.number(5)? });
    }
    named(name).ok_or_else(|| {
        w.fault(format!("no glass is called `{name}`; give a name of the Schott or Ohara catalogue, or a model glass"))
    })
}
