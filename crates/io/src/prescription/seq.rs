//! CODE V sequence files.
//!
//! Commands stand one a line or are parted by semicolons; `!` begins a comment, `&` at a line's end continues it. S gives
//! radius (in radius mode), thickness and glass of the next surface, SO those of the object, SI of the image; what follows
//! belongs to the last of them. A glass is a catalogue name, perhaps with its catalogue after an underscore, or a number:
//! `517642` and `516800.641673` are n_d = 1.517 (1.5168) and V_d = 64.2 (64.1673); or it is of the file's own private
//! catalogue (PRV … END). FNO and NA are those of the image, wherever the object stands (as rayoptics reads them). A … G are the coefficients of r⁴ … r¹⁶. The thickness of SI is a defocus; PIM leaves the image to be found.

use std::path::Path;

use etendue_scene::asset::{GlassAsset, LensFields, PrescriptionAsset};

use super::build::{Raw, RawSurface, by_number, named, successor};
use super::opening::Opening;
use super::private::PrivateGlasses;
use super::text::Words;
use crate::Error;

/// Commands that change the light's way in a manner that is not modelled.
const REFUSED: &[&str] = &[
    "XDE", "YDE", "ZDE", "ADE", "BDE", "CDE", "DAR", "BEN", "REV", "RET", "GRT", "DIF", "HOE", "SPS", "XTO", "YTO",
    "CYL", "AAS", "ZOO", "NSS", "REFL", "GRX", "DOE", "REX", "REY", "ELX", "ELY", "ADX", "ADY", "ARO",
];

pub(super) fn read(file: &Path, text: &str) -> Result<PrescriptionAsset, Error> {
    let mut reader = Reader::default();
    for (line, command) in commands(text) {
        let words = Words { file, line, words: words(&command) };
        if !words.words.is_empty() {
            reader.command(&words)?;
        }
    }
    reader.raw.finish(file)
}

/// Commands with the line each begins at.
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

/// Words of a command; a quoted text is one word, with its first quote.
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

#[derive(Default)]
struct Reader {
    raw: Raw,
    glasses: PrivateGlasses,
    /// Whether S lines give radii (RDM) or curvatures.
    radii: Option<bool>,
}

impl Reader {
    fn command(&mut self, w: &Words<'_>) -> Result<(), Error> {
        if self.glasses.reads(w)? {
            return Ok(());
        }
        let name = w.word(0).to_ascii_uppercase();
        match name.as_str() {
            "RDM" => self.radii = Some(!w.word(1).to_ascii_uppercase().starts_with('N')),
            "TITLE" | "TIT" => self.raw.title = w.word(1).trim_start_matches(['\'', '"']).to_owned(),
            "DIM" => self.raw.unit_mm = Some(unit(w)?),
            "EPD" => self.raw.opening = Some(Opening::pupil(w)?),
            "FNO" => self.raw.opening = Some(Opening::f_number(w)?.of_image()),
            "NA" => self.raw.opening = Some(Opening::image_cone(w)?),
            "NAO" => self.raw.opening = Some(Opening::object_cone(w)?),
            "WL" => self.raw.wavelengths_nm = w.numbers(1)?,
            "YAN" => self.raw.fields = Some(LensFields::AnglesDeg(w.numbers(1)?)),
            "YOB" => self.raw.fields = Some(LensFields::ObjectMm(w.numbers(1)?)),
            "YIM" | "YRI" => self.raw.fields = Some(LensFields::ImageMm(w.numbers(1)?)),
            "VUY" => self.raw.vignetting[0] = w.numbers(1)?,
            "VLY" => self.raw.vignetting[1] = w.numbers(1)?,
            "XAN" | "XOB" | "XIM" | "XRI" if w.numbers(1)?.iter().any(|x| *x != 0.0) => {
                self.raw
                    .notes
                    .push(format!("line {}: {name}: fields beside the meridional plane are not read", w.line));
            }
            "PIM" => self.raw.image_is_found = true,
            "S" | "SO" | "SI" => self.surface(w)?,
            "STO" if w.words.len() > 1 => self.stop_at(w)?,
            _ if REFUSED.contains(&name.as_str()) => {
                return Err(w.fault(format!("{name} is not modelled; only centred surfaces of revolution are")));
            }
            _ if name.len() > 1 && name.starts_with('S') && name[1..].parse::<u32>().is_ok() => self.surface(w)?,
            _ => {
                if let Some(surface) = self.raw.surfaces.last_mut() {
                    property(surface, &name, w)?;
                }
            }
        }
        Ok(())
    }

    fn surface(&mut self, w: &Words<'_>) -> Result<(), Error> {
        let Some(radii) = self.radii else {
            return Err(w.fault("surfaces before RDM: say whether they give radii (RDM) or curvatures (RDM N)"));
        };
        let mut surface = RawSurface::new(w.line);
        let value = if w.words.len() > 1 { w.number(1)? } else { 0.0 };
        surface.curvature = if radii && value != 0.0 { 1.0 / value } else { value };
        surface.thickness = if w.words.len() > 2 { w.number(2)? } else { 0.0 };
        if surface.thickness.abs() >= 1e10 {
            surface.thickness = f64::INFINITY;
        }
        surface.glass = self.glass(w, 3)?;
        self.raw.surfaces.push(surface);
        Ok(())
    }

    fn glass(&mut self, w: &Words<'_>, place: usize) -> Result<GlassAsset, Error> {
        let name = w.word(place);
        let plain = name.trim_start_matches(['\'', '"']);
        match name.to_ascii_uppercase().as_str() {
            "" | "AIR" => return Ok(GlassAsset::Air),
            "REFL" => return Err(w.fault("a mirror; only refracting lenses are modelled")),
            _ => {}
        }
        if let Some(glass) = self.glasses.find(plain).or_else(|| named(plain)).or_else(|| by_number(plain)) {
            return Ok(glass);
        }
        let Some((glass, today)) = successor(plain) else {
            return Err(w.fault(format!(
                "no glass is called `{plain}`; give a name of the Schott or Ohara catalogue, a number as 517642, or its indices in a private \
                 catalogue (PRV) before the surfaces"
            )));
        };
        let note = format!("line {}: no catalogue here has {plain}: its successor {today} is taken", w.line);
        self.raw.notes.push(note);
        Ok(glass)
    }

    /// `STO S5`.
    fn stop_at(&mut self, w: &Words<'_>) -> Result<(), Error> {
        let place = w.word(1).trim_start_matches(['S', 's']).parse::<usize>().ok();
        let surface = place.and_then(|place| self.raw.surfaces.get_mut(place));
        surface.ok_or_else(|| w.fault("STO: expected a surface given before, as S5"))?.stop = true;
        Ok(())
    }
}

fn unit(w: &Words<'_>) -> Result<f64, Error> {
    match w.word(1).to_ascii_uppercase().as_str() {
        "M" | "MM" => Ok(1.0),
        "C" | "CM" => Ok(10.0),
        "I" | "IN" => Ok(25.4),
        other => Err(w.fault(format!("DIM is `{other}`; expected M (mm), C (cm) or I (inches)"))),
    }
}

fn property(surface: &mut RawSurface, name: &str, w: &Words<'_>) -> Result<(), Error> {
    match name {
        "STO" => surface.stop = true,
        "K" => surface.conic = w.number(1)?,
        "A" | "B" | "C" | "D" | "E" | "F" | "G" => {
            surface.asphere[1 + usize::from(name.as_bytes()[0] - b'A')] = w.number(1)?;
        }
        "CIR" => match w.word(1).to_ascii_uppercase().as_str() {
            // The glass's edge is no clear aperture.
            "EDG" | "HOL" => {}
            "OBS" => return Err(w.fault("an obscuration is not modelled; only round, open apertures are")),
            _ => (surface.semi_aperture, surface.rim) = (Some(w.number(1)?), true),
        },
        _ => {}
    }
    Ok(())
}
