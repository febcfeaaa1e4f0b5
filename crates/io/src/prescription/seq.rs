//! CODE V sequence files.
//!
//! There is one command per line, or several separated by semicolons; `!` begins a comment, `&` at a line's end continues it. S gives radius (in radius mode),
//! thickness and glass of the next surface, SO those of the object, SI of the image; later commands apply to the last of them. A glass is a catalogue name,
//! optionally with its catalogue after an underscore, or a number: `517642` and `516800.641673` are n_d = 1.517 (1.5168) and V_d = 64.2 (64.1673); or it is
//! from the file's own private catalogue (PRV … END). FNO and NA are those of the image, wherever the object is (as in rayoptics). A … H and J are the
//! coefficients of r⁴ … r²⁰. REFL in the place of a glass makes a mirror. The thickness of SI is a defocus; PIM leaves the image to be found. REF counts the wavelengths of WL.
//!
//! A command takes effect from its line on, on a named surface (`RDY S1 25`, `THI S2..4 8`, `S3 25 8`; see `seq_edit.rs`), or on the whole lens as defined
//! there (`SCA 2`). Commands that would change the lens in a way that is not modelled are refused with their line; unknown ones are noted.

use std::path::Path;

use etendue_scene::asset::{GlassAsset, GlassCatalogueAsset, LensFields, PrescriptionAsset};

use super::build::{PrimaryWavelength, RawLens, StatedOpening};
use super::glasses::{self, GlassSearch};
use super::raw_surface::RawSurface;
use super::{private::PrivateGlasses, text::Words};
use crate::{Error, ErrorCode};

/// Commands that change the lens in an unsupported way.
const REFUSED: &[&str] = &[
    "XDE", "YDE", "ZDE", "ADE", "BDE", "CDE", "DAR", "BEN", "REV", "RET", "GRT", "DIF", "HOE", "SPS", "XTO", "YTO",
    "CYL", "AAS", "ZOO", "NSS", "REFL", "GRX", "DOE", "REX", "REY", "ELX", "ELY", "ADX", "ADY", "ARO", "RDX", "CUX",
    "KX", "INS", "DEL", "COP", "FLI", "UDS", "XYP", "ZRN", "ZFR", "SPL", "TOR", "GRN",
];

/// Commands of the list above that have no effect with the value 0: shifts and tilts.
const SHIFTS: &[&str] = &["XDE", "YDE", "ZDE", "ADE", "BDE", "CDE"];

/// Commands without an effect on the lens: weights and variables of optimisation, labels, surface forms that follow from their terms, and the end of input.
const PASSED_OVER: &[&str] = &[
    "GO", "LEN", "INI", "SLB", "DDM", "UID", "CCY", "CCX", "THC", "GLC", "KC", "AC", "BC", "CC", "DC", "EC", "FC",
    "GC", "HC", "JC", "ASP", "SPH", "CON", "WTW", "WTF", "WTX", "WTY", "VUX", "VLX", "HIN", "EVA", "CA", "END",
];

pub(super) fn read(file: &Path, text: &str, catalogues: &[GlassCatalogueAsset]) -> Result<PrescriptionAsset, Error> {
    let mut reader = SeqReader::new(catalogues);
    for (line, command) in commands(text) {
        let words = Words { file, line, words: words(&command) };
        if !words.words.is_empty() {
            reader.command(&words)?;
        }
    }
    reader.finish(file)
}

/// Commands, with the line on which each begins.
fn commands(text: &str) -> Vec<(usize, String)> {
    let mut list: Vec<(usize, String)> = Vec::new();
    let mut continued = false;
    for (i, line) in text.lines().enumerate() {
        let line = line.split('!').next().unwrap_or("").trim();
        let (body, goes_on) = line.strip_suffix('&').map_or((line, false), |body| (body, true));
        for (k, part) in body.split(';').enumerate() {
            match list.last_mut() {
                Some((_, last)) if continued && k == 0 => {
                    last.push(' ');
                    last.push_str(part);
                }
                _ => list.push((i + 1, part.to_owned())),
            }
        }
        continued = goes_on;
    }
    list
}

/// Words of a command; a quoted text is one word, including its first quote.
fn words(command: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = command.trim();
    while !rest.is_empty() {
        let quote = rest.chars().next().filter(|c| ['\'', '"'].contains(c));
        let end = match quote {
            Some(q) => rest[1..].find(q).map_or(rest.len(), |i| i + 1),
            None => rest.find(char::is_whitespace).unwrap_or(rest.len()),
        };
        words.push(&rest[..end]);
        rest = rest[end..].trim_start_matches(['\'', '"']).trim_start();
    }
    words
}

pub(super) struct SeqReader<'a> {
    pub(super) raw: RawLens,
    private: PrivateGlasses,
    glasses: GlassSearch<'a>,
    /// True if S lines give radii (RDM), false for curvatures.
    radii: Option<bool>,
    /// Surface that commands without a surface apply to.
    pub(super) current: usize,
    /// True once the image is given.
    pub(super) has_image: bool,
    /// Unknown commands, with their lines.
    unknown: Vec<(String, usize)>,
}

impl<'a> SeqReader<'a> {
    fn new(catalogues: &'a [GlassCatalogueAsset]) -> Self {
        Self {
            raw: RawLens::default(),
            private: PrivateGlasses::default(),
            glasses: GlassSearch::new(catalogues),
            radii: None,
            current: 0,
            has_image: false,
            unknown: Vec::new(),
        }
    }

    fn command(&mut self, w: &Words<'_>) -> Result<(), Error> {
        if self.private.reads(w)? {
            return Ok(());
        }
        let name = w.word(0).to_ascii_uppercase();
        match name.as_str() {
            "RDM" => self.radii = Some(!w.word(1).to_ascii_uppercase().starts_with('N')),
            "TITLE" | "TIT" => self.raw.title = w.word(1).trim_start_matches(['\'', '"']).to_owned(),
            "DIM" => self.raw.unit_mm = Some(unit(w)?),
            "EPD" => self.raw.opening = Some(StatedOpening::pupil(w)?),
            "FNO" => self.raw.opening = Some(StatedOpening::f_number(w)?.in_image_space()),
            "NA" => self.raw.opening = Some(StatedOpening::image_cone(w)?),
            "NAO" => self.raw.opening = Some(StatedOpening::object_cone(w)?),
            "WL" => self.raw.wavelengths_nm = w.numbers(1)?,
            "REF" => self.raw.primary = Some(PrimaryWavelength::read(w)?),
            "YAN" => self.raw.fields = Some(LensFields::AnglesDeg(w.numbers(1)?)),
            "YOB" => self.raw.fields = Some(LensFields::ObjectMm(w.numbers(1)?)),
            "YIM" | "YRI" => self.raw.fields = Some(LensFields::ImageMm(w.numbers(1)?)),
            "VUY" => self.raw.vignetting[0] = w.numbers(1)?,
            "VLY" => self.raw.vignetting[1] = w.numbers(1)?,
            "XAN" | "XOB" | "XIM" | "XRI" => self.fields_across(&name, w)?,
            "PIM" => self.raw.image_is_found = true,
            "SCA" => self.scale(w)?,
            "S" | "SO" | "SI" => self.surface(&name, w)?,
            _ if name.strip_prefix('S').is_some_and(is_count) => self.surface(&name, w)?,
            _ if SHIFTS.contains(&name.as_str()) && shifts_nothing(w) => {}
            _ if REFUSED.contains(&name.as_str()) => {
                return Err(w
                    .error(format!("{name} is not supported; only centred surfaces of revolution are"))
                    .with_code(ErrorCode::UnsupportedFile));
            }
            _ if self.edit(&name, w)? || PASSED_OVER.contains(&name.as_str()) => {}
            _ => self.unknown.push((name, w.line)),
        }
        Ok(())
    }

    fn finish(mut self, file: &Path) -> Result<PrescriptionAsset, Error> {
        if !self.unknown.is_empty() {
            let list: Vec<String> = self.unknown.iter().map(|(name, line)| format!("{name} (line {line})")).collect();
            let list = list.join(", ");
            self.raw.notes.push(format!("unknown commands are ignored, as if they did not change the lens: {list}"));
        }
        self.choose_stop();
        self.raw.finish(file)
    }

    /// Makes the first surface the stop if the file names none, as CODE V does.
    fn choose_stop(&mut self) {
        if self.raw.surfaces.len() > 2
            && !self.raw.surfaces.iter().any(|surface| surface.stop)
            && let Some(first) = self.raw.surfaces.get_mut(1)
        {
            first.stop = true;
            self.raw.notes.push("no surface is the stop (STO): the first one is".to_owned());
        }
    }

    fn fields_across(&mut self, name: &str, w: &Words<'_>) -> Result<(), Error> {
        if w.numbers(1)?.iter().any(|x| *x != 0.0) {
            let note = format!("line {}: {name}: fields outside the meridional plane are ignored", w.line);
            self.raw.notes.push(note);
        }
        Ok(())
    }

    /// `SCA 2`: scales the lengths defined before this line.
    fn scale(&mut self, w: &Words<'_>) -> Result<(), Error> {
        let factor = w.word(1).parse::<f64>().ok().filter(|factor| factor.is_finite() && *factor > 0.0);
        match factor {
            Some(factor) if w.words.len() == 2 => {
                self.raw.scale(factor);
                Ok(())
            }
            _ => Err(w.error("SCA: expected one factor above 0 (SCA 2.0), which scales all lengths before this line")),
        }
    }

    /// S, SO, SI or S3: the next surface, or an existing one.
    fn surface(&mut self, name: &str, w: &Words<'_>) -> Result<(), Error> {
        let count = self.raw.surfaces.len();
        let place = match name {
            "S" => count,
            "SO" => 0,
            "SI" if self.has_image => count - 1,
            "SI" => count,
            numbered => numbered[1..].parse().unwrap_or(usize::MAX),
        };
        if place > count || (place == count && self.has_image) {
            let last = count.saturating_sub(1);
            return Err(w.error(format!(
                "{name}: expected a surface defined before (S0 to S{last}), or the next one before the image (SI)"
            )));
        }
        if name == "S" && self.current + 1 < count {
            return Err(w
                .error(format!("S after S{}: inserting surfaces is not supported; write them in order", self.current))
                .with_code(ErrorCode::UnsupportedFile));
        }
        let Some(radii) = self.radii else {
            return Err(w.error("surfaces precede RDM; state whether they have radii (RDM) or curvatures (RDM N)"));
        };
        if place == count {
            self.raw.surfaces.push(RawSurface::new(w.line));
        }
        self.has_image |= name == "SI";
        self.current = place;
        let fresh = place == count;
        if fresh || w.words.len() > 1 {
            let value = if w.words.len() > 1 { w.number(1)? } else { 0.0 };
            self.raw.surfaces[place].curvature = if radii && value != 0.0 { 1.0 / value } else { value };
        }
        if w.words.len() > 2 {
            self.raw.surfaces[place].thickness = thickness(w.number(2)?);
        }
        if fresh || w.words.len() > 3 {
            let medium = self.medium(w, 3)?;
            medium.apply(&mut self.raw.surfaces[place]);
        }
        Ok(())
    }

    /// Medium behind a surface, or the mirror that it is.
    pub(super) fn medium(&mut self, w: &Words<'_>, place: usize) -> Result<Medium, Error> {
        match w.word(place).to_ascii_uppercase().as_str() {
            "" | "AIR" => Ok(Medium::Glass(GlassAsset::Air)),
            "REFL" => Ok(Medium::Mirror),
            _ => self.glass(w, place).map(Medium::Glass),
        }
    }

    fn glass(&mut self, w: &Words<'_>, place: usize) -> Result<GlassAsset, Error> {
        let name = w.word(place);
        let plain = name.trim_start_matches(['\'', '"']);
        if let Some(glass) = self.private.find(plain) {
            return Ok(glass);
        }
        let Some(matched) = self.glasses.find(plain, w)? else {
            let remedy = "a number such as 517642, or its indices in a private catalogue (PRV) before the surfaces";
            return Err(glasses::unknown(w, plain, remedy));
        };
        self.raw.notes.extend(matched.note.map(|note| format!("line {}: {note}", w.line)));
        Ok(matched.glass)
    }
}

/// Space behind a surface.
pub(super) enum Medium {
    Glass(GlassAsset),
    /// Reflected: the space before the surface.
    Mirror,
}

impl Medium {
    pub(super) fn apply(&self, surface: &mut RawSurface) {
        match self {
            Self::Glass(glass) => (surface.glass, surface.mirror) = (glass.clone(), false),
            Self::Mirror => surface.mirror = true,
        }
    }
}

/// True if all values of a command are 0.
fn shifts_nothing(w: &Words<'_>) -> bool {
    let values: Vec<&str> = w.words[1..].iter().copied().filter(|word| !word.starts_with(['S', 's'])).collect();
    !values.is_empty() && values.iter().all(|word| word.parse() == Ok(0.0))
}

fn unit(w: &Words<'_>) -> Result<f64, Error> {
    match w.word(1).to_ascii_uppercase().as_str() {
        "M" | "MM" => Ok(1.0),
        "C" | "CM" => Ok(10.0),
        "I" | "IN" => Ok(25.4),
        other => Err(w
            .error(format!("DIM is `{other}`; expected M (mm), C (cm) or I (inches)"))
            .with_code(ErrorCode::UnsupportedFile)),
    }
}

/// Distance; CODE V writes 1e13 for an infinite one.
pub(super) fn thickness(value: f64) -> f64 {
    if value.abs() >= 1e10 { f64::INFINITY } else { value }
}

pub(super) fn is_count(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())
}
