//! Measured lamps: IES LM-63 and EULUMDAT files.
//!
//! | file | standard | intensities | angles |
//! | --- | --- | --- | --- |
//! | `.ies` | ANSI/IES LM-63, 1986 to 2019 | cd × multiplier × ballast factors | types A, B and C |
//! | `.ldt` | EULUMDAT (A. W. Stockmar, 1990) | cd per 1 000 lm of the lamps × conversion factor | type C |
//!
//! Both become a [`PhotometryAsset`]: cd on a complete grid. Texts are UTF-8 or Latin-1; lines end in any way; a byte-order mark and the end-of-file character
//! of DOS are ignored. Every error states its line. Memory is allocated only for numbers that are present, so an absurd count costs nothing.

mod fields;
mod ies;
mod ldt;
mod symmetry;

use std::path::Path;

use etendue_scene::asset::PhotometryAsset;

use crate::source::{name_notes, read_description_bytes};
use crate::{Error, ErrorCode, Sandbox, hash};

/// Reads a measured lamp; the file name determines its kind.
///
/// # Errors
/// The first error of the file, with its line.
pub fn read_photometry(file: &Path) -> Result<PhotometryAsset, Error> {
    read_photometry_in(file, &Sandbox::NONE)
}

/// Reads the same; a tilt file must lie in `sandbox`.
pub(crate) fn read_photometry_in(file: &Path, sandbox: &Sandbox) -> Result<PhotometryAsset, Error> {
    let bytes = read_description_bytes(file, "photometric")?;
    let text = fields::decode(file, &bytes)?;
    let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
    let (mut asset, further) = match extension.to_str() {
        Some("ies") => ies::read(file, &text, sandbox)?,
        Some("ldt") => (ldt::read(file, &text)?, None),
        _ => {
            return Err(Error::coded(
                ErrorCode::UnsupportedFile,
                file,
                "expected a photometric file with the extension .ies (LM-63) or .ldt (EULUMDAT)",
            ));
        }
    };
    asset.hash = match further {
        Some(tilt) => hash::hash_parts([&bytes[..], &tilt[..]]),
        None => hash::hash_bytes(&bytes),
    };
    symmetry::check(file, &mut asset)?;
    name_notes(file, &mut asset.report);
    Ok(asset)
}
