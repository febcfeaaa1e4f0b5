//! GLAS lines of Zemax files.
//!
//! `GLAS name mode surface n_d V_d …`: mode 0 names a glass of a catalogue, 1 is a model glass of n_d and V_d, 2 picks the glass of an
//! earlier surface up. With mode 0 the two numbers mean nothing: Zemax writes 1.5 and 40, or leaves those of the model glass that stood there
//! before. A glass of mode 0 is therefore, in this order, a catalogue glass of that name, a glass by its number (517642), the catalogue's
//! successor of that name (N-SK2 for SK2, S-LAH66 for LAH66; noted), and only then n_d and V_d of its line (noted). Of these two numbers
//! one name has one pair in a file: another pair shows that one of them is left over, and is refused.

use etendue_scene::asset::GlassAsset;

use super::build::{RawSurface, by_number, named, successor};
use super::text::Words;
use crate::{Error, ErrorCode};

/// What Zemax writes where the numbers of a glass stand in a catalogue.
const CATALOGUE_NUMBERS: [f64; 2] = [1.5, 40.0];
/// Half a unit of the last digit to which catalogues round n_d and V_d at least.
const ROUNDING: [f64; 2] = [5e-5, 0.05];

/// The glasses of a file that are known by the numbers of their lines.
#[derive(Default)]
pub(super) struct Glasses {
    by_line: Vec<GlassOfLine>,
}

struct GlassOfLine {
    name: String,
    line: usize,
    numbers: [f64; 2],
}

impl Glasses {
    /// The glass of a GLAS line, and what is to be said of it.
    pub(super) fn read(
        &mut self,
        w: &Words<'_>,
        surfaces: &[RawSurface],
    ) -> Result<(GlassAsset, Option<String>), Error> {
        if w.word(1) == "MIRROR" {
            return Err(w.fault("a mirror; only refracting lenses are modelled").with_code(ErrorCode::UnsupportedFile));
        }
        match w.word(2) {
            "1" => Ok((GlassAsset::Abbe { index: w.number(4)?, abbe: w.number(5)? }, None)),
            "2" => {
                let from = surfaces.get(w.number(3)? as usize);
                let from = from.ok_or_else(|| {
                    w.fault("the glass is picked up from a surface that is not given before")
                        .with_code(ErrorCode::UnsupportedFile)
                })?;
                Ok((from.glass.clone(), None))
            }
            _ => self.of_catalogue(w),
        }
    }

    fn of_catalogue(&mut self, w: &Words<'_>) -> Result<(GlassAsset, Option<String>), Error> {
        let name = w.word(1);
        if let Some(known) = named(name).or_else(|| by_number(name)) {
            return Ok((known, None));
        }
        let numbers = own_numbers(w);
        if let Some((glass, today)) = successor(name) {
            let beside = numbers.map_or_else(String::new, |[index, abbe]| {
                format!(", not n_d {index} and V_d {abbe} of its line, which a catalogue glass leaves unused")
            });
            return Ok((glass, Some(format!("no catalogue here has {name}: its successor {today} is taken{beside}"))));
        }
        let Some(numbers) = numbers else {
            return Err(w.fault(format!(
                "no glass is called `{name}`; give a name of the Schott or Ohara catalogue, or n_d and V_d on its line (GLAS {name} 1 0 n_d V_d)"
            )).with_code(ErrorCode::UnknownName));
        };
        self.check_same(w, numbers)?;
        let [index, abbe] = numbers;
        self.by_line.push(GlassOfLine { name: name.to_owned(), line: w.line, numbers });
        let note = format!("no catalogue here has {name}: n_d {index} and V_d {abbe} of its line are taken");
        Ok((GlassAsset::Abbe { index, abbe }, Some(note)))
    }

    /// Refuses a second pair of numbers for one name.
    fn check_same(&self, w: &Words<'_>, numbers: [f64; 2]) -> Result<(), Error> {
        let differs = |other: &&GlassOfLine| {
            let far = |i: usize| (other.numbers[i] - numbers[i]).abs() > ROUNDING[i];
            other.name == w.word(1) && (far(0) || far(1))
        };
        let Some(other) = self.by_line.iter().find(differs) else { return Ok(()) };
        let ([index, abbe], [first_index, first_abbe]) = (numbers, other.numbers);
        Err(w.fault(format!(
            "{} has n_d {index} and V_d {abbe} here, n_d {first_index} and V_d {first_abbe} in line {}: one of them is left over from another \
             glass; give the right n_d and V_d in both lines (GLAS {} 1 0 n_d V_d)",
            other.name, other.line, other.name
        )))
    }
}

/// n_d and V_d of a line, where they are those of a glass and not Zemax's fill.
fn own_numbers(w: &Words<'_>) -> Option<[f64; 2]> {
    let numbers = [w.number(4).ok()?, w.number(5).ok()?];
    (numbers[0] > 1.0 && numbers[1] > 0.0 && numbers != CATALOGUE_NUMBERS).then_some(numbers)
}
