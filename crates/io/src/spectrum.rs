//! Tabulated spectra: CSV of two columns, wavelength in nm and value, `#` comments and one header line allowed.

use std::path::Path;

use etendue_scene::asset::SpectrumAsset;
use etendue_spectra::{Outside, Spectrum};

use crate::source::{decode_text, read_bytes};
use crate::{Error, hash};

/// Reads a spectrum. The grammar and the checks are those of [`Spectrum::from_csv`].
pub fn read_spectrum(file: &Path) -> Result<SpectrumAsset, Error> {
    let bytes = read_bytes(file, "spectrum")?;
    let text = decode_text(file, &bytes)?;
    Spectrum::from_csv(text, Outside::Hold).map_err(|cause| Error::new(file, cause.to_string()))?;
    Ok(SpectrumAsset { points: text.lines().filter_map(point).collect(), hash: hash::of_bytes(&bytes) })
}

/// The point of a line of a table that has been checked: what is no point is a header, a comment or empty.
fn point(line: &str) -> Option<(f64, f64)> {
    let (nm, value) = line.split('#').next()?.split_once(',')?;
    Some((nm.trim().parse().ok()?, value.trim().parse().ok()?))
}
