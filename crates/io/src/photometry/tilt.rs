//! Factors for lamps that burn at a tilt (LM-63, TILT=).

use std::path::Path;

use etendue_scene::asset::Tilt;

use super::fields::Fields;
use super::{angles, text};
use crate::source::read_description_bytes;
use crate::{Error, Sandbox};

/// What the line says behind `TILT=`.
pub(super) enum Statement<'a> {
    None,
    Include,
    File(&'a str),
}

impl<'a> Statement<'a> {
    pub(super) fn of(word: &'a str) -> Self {
        match word {
            _ if word.eq_ignore_ascii_case("none") => Self::None,
            _ if word.eq_ignore_ascii_case("include") => Self::Include,
            other => Self::File(other),
        }
    }
}

/// The next numbers as a table of tilts.
pub(super) fn table(fields: &mut Fields<'_>) -> Result<Tilt, Error> {
    let geometry = fields.whole("the lamp-to-luminaire geometry", 1..=3)? as u8;
    let count = fields.whole("the count of tilts", 1..=angles::MOST)?;
    let tilts = angles::read(fields, count, "tilt", &(-180.0..=180.0))?;
    let factors = fields.list(count as usize, "factor of a tilt", |_, factor| {
        (factor < 0.0).then(|| format!("found the factor {factor}; expected 0 or more"))
    })?;
    Ok(Tilt::Table { geometry, factors: tilts.into_iter().zip(factors).collect() })
}

/// The table in the file of that name beside `file`, and its bytes.
pub(super) fn from_file(file: &Path, line: usize, name: &str, sandbox: &Sandbox) -> Result<(Tilt, Vec<u8>), Error> {
    let path = file.parent().unwrap_or(Path::new("")).join(name.replace('\\', "/"));
    let place = format!("{}:{line}: TILT", file.display());
    let read = || {
        sandbox.check(&path).map_err(|told| Error::new(&path, told))?;
        let bytes = read_description_bytes(&path, "tilt")?;
        let text = text::decode(&path, &bytes)?.into_owned();
        let mut fields = Fields::divided_by_commas(&path, text.lines().enumerate().map(|(i, line)| (i + 1, line)));
        let tilt = table(&mut fields)?;
        fields.end("the factors of tilts")?;
        Ok((tilt, bytes))
    };
    read().map_err(|error: Error| error.named_at(place))
}

/// What the user has to know of a table.
pub(super) fn remark(tilt: &Tilt) -> Option<String> {
    match tilt {
        Tilt::None => None,
        Tilt::Table { factors, .. } => {
            let (low, high) =
                factors.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), (_, f)| (low.min(*f), high.max(*f)));
            Some(format!(
                "its light changes with the tilt of the lamp (factors {low} to {high}); they are not applied: the intensities \
                 are those of the position it was measured in"
            ))
        }
        Tilt::Measured(degrees) if *degrees == 0.0 => None,
        Tilt::Measured(degrees) => Some(format!(
            "it was measured at a tilt of {degrees}°; its angles are used as the file gives them, without turning them back"
        )),
    }
}
