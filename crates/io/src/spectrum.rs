//! Tabulated spectra: CSV of two columns, wavelength in nm and value, `#` comments and one header line allowed.

use std::path::Path;

use etendue_scene::asset::{SpectrumAsset, SpectrumValues};
use etendue_spectra::{Extrapolation, Spectrum, SpectrumError};

use crate::source::{decode_text, read_bytes};
use crate::{Error, hash};

/// A line, counted from 1, and its wavelength (nm) and value.
type SpectrumRow = (usize, (f64, f64));

/// Reads a spectrum. The grammar and the checks are those of [`Spectrum::from_csv`].
pub fn read_spectrum(file: &Path) -> Result<SpectrumAsset, Error> {
    let (rows, hash) = read(file)?;
    Ok(asset(&rows, hash))
}

/// Reads a spectrum whose values are all `values`.
pub fn read_spectrum_of(file: &Path, values: SpectrumValues) -> Result<SpectrumAsset, Error> {
    let (rows, hash) = read(file)?;
    match rows.iter().find(|(_, (_, value))| !values.admit(*value)) {
        Some((line, (nm, value))) => {
            Err(Error::at(file, *line, format!("found {value} at {nm} nm; expected {}", values.words())))
        }
        None => Ok(asset(&rows, hash)),
    }
}

fn read(file: &Path) -> Result<(Vec<SpectrumRow>, [u8; 32]), Error> {
    let bytes = read_bytes(file, "spectrum")?;
    let text = decode_text(file, &bytes)?;
    Spectrum::from_csv(text, Extrapolation::Hold).map_err(|cause| spectrum_error(file, &cause))?;
    let rows = text.lines().enumerate().filter_map(|(i, line)| Some((i + 1, point(line)?)));
    Ok((rows.collect(), hash::hash_bytes(&bytes)))
}

fn asset(rows: &[SpectrumRow], hash: [u8; 32]) -> SpectrumAsset {
    SpectrumAsset { points: rows.iter().map(|(_, point)| *point).collect(), hash }
}

/// Error at its line, in the form of all other files.
fn spectrum_error(file: &Path, cause: &SpectrumError) -> Error {
    let text = cause.to_string();
    let located = text.strip_prefix("line ").and_then(|rest| rest.split_once(": "));
    match located.and_then(|(line, what)| Some((line.parse().ok()?, what))) {
        Some((line, what)) => Error::at(file, line, what),
        None => Error::new(file, text),
    }
}

/// Point of a line of a checked table; other lines are headers, comments or empty.
fn point(line: &str) -> Option<(f64, f64)> {
    let (nm, value) = line.split('#').next()?.split_once(',')?;
    Some((nm.trim().parse().ok()?, value.trim().parse().ok()?))
}
