//! Zemax lens files.
//!
//! A line is a keyword and its values; those of a surface follow its SURF. GLAS names a catalogue glass, or (second value 1) gives index and Abbe number of a
//! model glass. PARM i of an EVENASPH is the coefficient of r²ⁱ, of an ODDASPHE that of rⁱ. FTYP holds the kind of field and the numbers of fields and wavelengths, as YFLN and WAVM are
//! padded. PWAV counts the wavelengths.
//!
//! Glasses are those of GLAS lines.
//!
//! `GLAS name mode surface n_d V_d …`: mode 0 names a glass of a catalogue, 1 is a model glass of n_d and V_d, 2 picks up the glass of an earlier surface. With
//! mode 0 the two numbers are meaningless: Zemax writes 1.5 and 40, or leaves those of an earlier model glass. A glass of mode 0 is therefore, in this order, a
//! catalogue glass of that name, a glass by its number (517642), the catalogue's successor of that name (N-SK2 for SK2, S-LAH66 for LAH66; noted), and only
//! then n_d and V_d of its line (noted). A name must have one pair of these numbers in a file: a second pair shows that one of them is a leftover, and is
//! refused.

use std::{collections::BTreeSet, path::Path};

use etendue_scene::asset::{GlassAsset, GlassCatalogueAsset, LensFields, PrescriptionAsset};

use super::build::{PrimaryWavelength, RawLens, StatedOpening};
use super::glasses::{self, GlassSearch, NotedGlass};
use super::raw_surface::RawSurface;
use super::text::Words;
use super::zmx_surface::property;
use crate::{Error, ErrorCode};

pub(super) fn read(file: &Path, text: &str, catalogues: &[GlassCatalogueAsset]) -> Result<PrescriptionAsset, Error> {
    let mut reader = ZmxReader::new(catalogues);
    for (i, line) in text.lines().enumerate() {
        let words = Words { file, line: i + 1, words: line.split_whitespace().collect() };
        if !words.words.is_empty() {
            reader.note_unknown(&words, line.starts_with([' ', '\t']));
            reader.command(&words)?;
        }
    }
    reader.finish(file)
}

struct ZmxReader<'a> {
    raw: RawLens,
    glasses: Glasses<'a>,
    field_kind: usize,
    counts: [usize; 2],
    heights: Vec<f64>,
    /// Keywords of surfaces that are not read; each is noted once.
    unknown: BTreeSet<String>,
}

/// Keywords of a surface, indented below its SURF: those that are read, and those without an effect on images: drawing (HIDE, MIRR, SLAB, COMM), propagation by
/// diffraction (POPS), mounting (MEMA, OEMA, FIMP) and search (MAZH).
const SURFACE_KEYWORDS: [&str; 26] = [
    "TYPE", "CURV", "CONI", "PARM", "DISZ", "CLAP", "FLAP", "DIAM", "STOP", "OBDC", "GLAS", "SQAP", "ELAP", "OBSC",
    "SQOB", "ELOB", "UDAD", "COMM", "HIDE", "MIRR", "SLAB", "POPS", "FIMP", "MEMA", "OEMA", "MAZH",
];

impl<'a> ZmxReader<'a> {
    fn new(catalogues: &'a [GlassCatalogueAsset]) -> Self {
        Self {
            raw: RawLens::default(),
            glasses: Glasses { search: GlassSearch::new(catalogues), by_line: Vec::new() },
            field_kind: 0,
            counts: [0; 2],
            heights: Vec::new(),
            unknown: BTreeSet::new(),
        }
    }

    fn command(&mut self, w: &Words<'_>) -> Result<(), Error> {
        match w.word(0) {
            "MODE" if w.word(1) != "SEQ" => {
                Err(w.error("a non-sequential lens; expected MODE SEQ").with_code(ErrorCode::UnsupportedFile))
            }
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
                    "line {}: of {} configurations, the one stated by the surfaces is used",
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
                self.raw.wavelengths_nm.push(nanometres(w.number(2)?));
                Ok(())
            }
            "PWAV" => {
                self.raw.primary = Some(PrimaryWavelength::read(w)?);
                Ok(())
            }
            "SURF" => {
                self.raw.surfaces.push(RawSurface::new(w.line));
                Ok(())
            }
            "GLAS" => self.glass(w),
            "GCAT" => {
                self.glasses.search.prefer(&w.words[1..]);
                Ok(())
            }
            _ => {
                let number = self.raw.surfaces.len().wrapping_sub(1);
                match self.raw.surfaces.last_mut() {
                    Some(surface) => property(surface, number, w),
                    None => Ok(()),
                }
            }
        }
    }

    /// Notes keywords of a surface that are not read: coatings (COAT) and unknown keywords.
    fn note_unknown(&mut self, w: &Words<'_>, indented: bool) {
        let name = w.word(0);
        let of_surface = indented && !self.raw.surfaces.is_empty() && !SURFACE_KEYWORDS.contains(&name);
        if of_surface && self.unknown.insert(name.to_owned()) {
            self.raw.notes.push(format!("line {}: {name} of a surface is ignored", w.line));
        }
    }

    fn unit(&mut self, w: &Words<'_>) -> Result<(), Error> {
        let unit = match w.word(1) {
            "MM" => 1.0,
            "CM" => 10.0,
            "IN" => 25.4,
            "METER" => 1e3,
            other => {
                return Err(w
                    .error(format!("UNIT is `{other}`; expected MM, CM, IN or METER"))
                    .with_code(ErrorCode::UnsupportedFile));
            }
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
        let copied = if w.word(2) == "2" { self.raw.surfaces.get(w.number(3)? as usize) } else { None };
        if w.word(1) == "MIRROR" || copied.is_some_and(|surface| surface.mirror) {
            self.raw.surfaces.last_mut().into_iter().for_each(|surface| surface.mirror = true);
            return Ok(());
        }
        let NotedGlass { glass, note, .. } = self.glasses.read(w, &self.raw.surfaces)?;
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

/// Micrometres in nm, to the precision of files.
fn nanometres(um: f64) -> f64 {
    (1e9 * um).round() / 1e6
}

/// Aperture of the lens; `None` if the stop's own size defines it (FLOA).
fn opening(w: &Words<'_>) -> Result<Option<StatedOpening>, Error> {
    match (w.word(0), w.word(2)) {
        ("ENPD", _) => StatedOpening::pupil(w).map(Some),
        // A working f-number is 1/(2 sin θ) of the image's cone: the image-space f-number if the object is far.
        ("FNUM", "1") => StatedOpening::f_number(w).map(|opening| Some(opening.in_image_space())),
        ("FNUM", _) => StatedOpening::f_number(w).map(Some),
        ("OBNA", "1") => StatedOpening::object_angle(w).map(Some),
        ("OBNA", _) => StatedOpening::object_cone(w).map(Some),
        _ => Ok(None),
    }
}

/// Numbers that Zemax writes for a glass of a catalogue.
const CATALOGUE_NUMBERS: [f64; 2] = [1.5, 40.0];
/// Half a unit of the last digit of the coarsest catalogue values of n_d and V_d.
const ROUNDING: [f64; 2] = [5e-5, 0.05];

/// Glasses of a file.
struct Glasses<'a> {
    search: GlassSearch<'a>,
    /// Those defined by the numbers of their lines.
    by_line: Vec<GlassOfLine>,
}

struct GlassOfLine {
    name: String,
    line: usize,
    numbers: [f64; 2],
}

impl Glasses<'_> {
    /// Glass of a GLAS line, and a note on it.
    fn read(&mut self, w: &Words<'_>, surfaces: &[RawSurface]) -> Result<NotedGlass, Error> {
        match w.word(2) {
            "1" => Ok(NotedGlass::plain(model_glass(w.number(4)?, w.number(5)?))),
            "2" => {
                let from = surfaces.get(w.number(3)? as usize);
                let from = from.ok_or_else(|| {
                    w.error("the glass is picked up from a surface that is not defined before")
                        .with_code(ErrorCode::UnsupportedFile)
                })?;
                Ok(NotedGlass::plain(from.glass.clone()))
            }
            _ => self.catalogue_glass(w),
        }
    }

    fn catalogue_glass(&mut self, w: &Words<'_>) -> Result<NotedGlass, Error> {
        let name = w.word(1);
        let numbers = own_numbers(w);
        if let Some(mut known) = self.search.find(name, w)? {
            if let (Some([index, abbe]), Some(note)) = (numbers.filter(|_| known.is_successor), &mut known.note) {
                *note +=
                    &format!(", not n_d {index} and V_d {abbe} of its line, which are not used for a catalogue glass");
            }
            return Ok(known);
        }
        let Some(numbers) = numbers else {
            return Err(glasses::unknown(w, name, &format!("or n_d and V_d on its line (GLAS {name} 1 0 n_d V_d)")));
        };
        self.check_same(w, numbers)?;
        let [index, abbe] = numbers;
        self.by_line.push(GlassOfLine { name: name.to_owned(), line: w.line, numbers });
        let note = format!("{name} is in no supported catalogue: n_d {index} and V_d {abbe} of its line are used");
        Ok(NotedGlass { note: Some(note), ..NotedGlass::plain(GlassAsset::Abbe { index, abbe }) })
    }

    /// Refuses a second pair of numbers for one name.
    fn check_same(&self, w: &Words<'_>, numbers: [f64; 2]) -> Result<(), Error> {
        let differs = |other: &&GlassOfLine| {
            let far = |i: usize| (other.numbers[i] - numbers[i]).abs() > ROUNDING[i];
            other.name == w.word(1) && (far(0) || far(1))
        };
        let Some(other) = self.by_line.iter().find(differs) else { return Ok(()) };
        let ([index, abbe], [first_index, first_abbe]) = (numbers, other.numbers);
        Err(w.error(format!(
            "{} has n_d {index} and V_d {abbe} here, n_d {first_index} and V_d {first_abbe} in line {}: one pair belongs to another glass; give the \
             right n_d and V_d in both lines (GLAS {} 1 0 n_d V_d)",
            other.name, other.line, other.name
        )))
    }
}

/// Model glass; without dispersion for V_d = 0.
fn model_glass(index: f64, abbe: f64) -> GlassAsset {
    if abbe == 0.0 { GlassAsset::Index(index) } else { GlassAsset::Abbe { index, abbe } }
}

/// n_d and V_d of a line, if they are those of a glass and not Zemax's placeholder.
fn own_numbers(w: &Words<'_>) -> Option<[f64; 2]> {
    let numbers = [w.number(4).ok()?, w.number(5).ok()?];
    (numbers[0] > 1.0 && numbers[1] > 0.0 && numbers != CATALOGUE_NUMBERS).then_some(numbers)
}
