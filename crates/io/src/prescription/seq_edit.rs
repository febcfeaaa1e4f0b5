//! CODE V commands for surfaces: the current one, or those that they name (`RDY S1 25`, `CIR S2..4 6`).
//!
//! SO is the object, SI the image, SA all between them. A solve (`CUY UMY -0.1`) of the current surface leaves the value that its line states, and is noted; a
//! solve of a named surface is refused, as its value may differ.

use core::ops::RangeInclusive;

use super::seq::{SeqReader, is_count, thickness};
use super::{raw_surface::RawSurface, text::Words};
use crate::{Error, ErrorCode};

/// Surfaces of a command, and the index of its first value.
struct EditTarget {
    surfaces: RangeInclusive<usize>,
    named: bool,
    value: usize,
}

impl SeqReader<'_> {
    /// Handles a command about surfaces; returns false for others.
    pub(super) fn edit(&mut self, name: &str, w: &Words<'_>) -> Result<bool, Error> {
        let known = ["RDY", "CUY", "THI", "GLA", "RMD", "CIR", "STO", "K"].contains(&name) || order(name).is_some();
        if !known {
            return Ok(false);
        }
        let target = self.target(name, w)?;
        if ["RDY", "CUY", "THI"].contains(&name)
            && !target.named
            && w.word(target.value).starts_with(char::is_alphabetic)
        {
            let solve = w.words[..].join(" ");
            self.raw.notes.push(format!(
                "line {}: the solve {solve} is ignored: the value of the surface's own line is used",
                w.line
            ));
            return Ok(true);
        }
        if name == "STO" && target.named {
            self.raw.surfaces.iter_mut().for_each(|surface| surface.stop = false);
        }
        let medium = if name == "GLA" { Some(self.medium(w, target.value)?) } else { None };
        for place in target.surfaces {
            let surface = &mut self.raw.surfaces[place];
            match &medium {
                Some(medium) => medium.apply(surface),
                None => property(surface, name, w, target.value)?,
            }
        }
        Ok(true)
    }

    fn target(&self, name: &str, w: &Words<'_>) -> Result<EditTarget, Error> {
        let zoom = |word: &str| word.strip_prefix(['Z', 'z']).is_some_and(is_count);
        if zoom(w.word(1)) || zoom(w.word(2)) {
            return Err(w
                .error(format!("{name} of a zoom position: zooms are not supported"))
                .with_code(ErrorCode::UnsupportedFile));
        }
        // A glass may have the name of a surface.
        let lone_glass = name == "GLA" && w.words.len() == 2;
        match SurfaceName::parse(w.word(1)).filter(|_| !lone_glass) {
            Some(named) => {
                let surfaces = named.places(self.raw.surfaces.len(), self.has_image);
                let surfaces = surfaces.ok_or_else(|| {
                    let count = self.raw.surfaces.len();
                    w.error(format!(
                        "{name} {}: no such surface is defined before; the lens has {count} surfaces here, including SO",
                        w.word(1)
                    ))
                })?;
                Ok(EditTarget { surfaces, named: true, value: 2 })
            }
            None if self.raw.surfaces.is_empty() => Err(w.error(format!("{name} precedes the first surface (SO)"))),
            None => Ok(EditTarget { surfaces: self.current..=self.current, named: false, value: 1 }),
        }
    }
}

/// Surfaces by their names.
enum SurfaceName {
    Object,
    Image,
    All,
    Numbers(usize, usize),
}

impl SurfaceName {
    fn parse(word: &str) -> Option<Self> {
        let rest = word.strip_prefix(['S', 's'])?.to_ascii_uppercase();
        let (first, last) = rest.split_once("..").unwrap_or((&rest, &rest));
        match first {
            "O" => Some(Self::Object),
            "I" => Some(Self::Image),
            "A" => Some(Self::All),
            _ if is_count(first) && is_count(last) => Some(Self::Numbers(first.parse().ok()?, last.parse().ok()?)),
            _ => None,
        }
    }

    /// Indices in the list; `None` if they do not exist.
    fn places(&self, count: usize, has_image: bool) -> Option<RangeInclusive<usize>> {
        let (first, last) = match *self {
            Self::Object => (0, 0),
            Self::Image if has_image => (count - 1, count - 1),
            Self::Image => return None,
            Self::All => (1, (count - usize::from(has_image)).checked_sub(1)?),
            Self::Numbers(first, last) => (first, last),
        };
        (first <= last && last < count).then_some(first..=last)
    }
}

/// Index of a coefficient in the list of r², r⁴ …: A is r⁴, H r¹⁸ and J r²⁰.
fn order(name: &str) -> Option<usize> {
    ["A", "B", "C", "D", "E", "F", "G", "H", "J"].iter().position(|letter| *letter == name).map(|place| place + 1)
}

fn property(surface: &mut RawSurface, name: &str, w: &Words<'_>, value: usize) -> Result<(), Error> {
    match name {
        "RDY" => {
            let radius = w.number(value)?;
            surface.curvature = if radius == 0.0 { 0.0 } else { 1.0 / radius };
        }
        "CUY" => surface.curvature = w.number(value)?,
        "THI" => surface.thickness = thickness(w.number(value)?),
        "STO" => surface.stop = true,
        "K" => surface.conic = w.number(value)?,
        "RMD" => match w.word(value).to_ascii_uppercase().as_str() {
            "REFL" => surface.mirror = true,
            "REFR" => surface.mirror = false,
            other => {
                return Err(w
                    .error(format!("RMD {other} is not supported; only REFR and REFL are"))
                    .with_code(ErrorCode::UnsupportedFile));
            }
        },
        "CIR" => circle(surface, w, value)?,
        _ => {
            if let Some(place) = order(name) {
                surface.set_coefficient(place, w.number(value)?);
            }
        }
    }
    Ok(())
}

/// `CIR 5`, `CIR OBS 5`, `CIR OBS L'A' 5`: a kind and a label may precede the radius.
fn circle(surface: &mut RawSurface, w: &Words<'_>, value: usize) -> Result<(), Error> {
    let kind = w.word(value).to_ascii_uppercase();
    let is_kind = ["CLR", "EDG", "HOL", "OBS"].contains(&kind.as_str());
    let place = value + usize::from(is_kind);
    let is_label = ["L'", "L\"", "l'", "l\""].iter().any(|begin| w.word(place).starts_with(begin));
    let radius = w.number(place + usize::from(is_label))?;
    match kind.as_str() {
        // The glass's edge is no clear aperture.
        "EDG" => {}
        // Light within a hole meets no glass or mirror.
        "HOL" | "OBS" => surface.obscured_radius = radius,
        _ => (surface.semi_aperture, surface.is_clear_aperture) = (Some(radius), true),
    }
    Ok(())
}
