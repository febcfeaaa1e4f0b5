//! Lens prescriptions: Zemax and CODE V files, as text.
//!
//! | file | read | refused |
//! | --- | --- | --- |
//! | `.zmx` (Zemax, UTF-8 or UTF-16) | UNIT, GCAT, SURF, TYPE STANDARD, EVENASPH, ODDASPHE without odd terms, PARAXIAL, COORDBRK of zeros, CURV, CONI, PARM, DISZ, GLAS (MIRROR, catalogue, number, model, picked up; else by its successor, else by its n_d and V_d), DIAM, CLAP, OBSC (a disc), STOP, ENPD, FNUM, OBNA, FLOA, FTYP, YFLN, WAVM, PWAV | other surfaces, tilts, other apertures, non-sequential parts |
//! | `.seq` (CODE V) | RDM, DIM, S, SO, SI, RDY, CUY, THI, GLA (REFL: mirror), RMD, STO, K, A–H, J, CIR, also OBS and HOL (of the current surface or of named ones), SCA, EPD, FNO, NA, NAO, PIM, PRV, WL, REF, YAN, YOB, YIM, VUY, VLY, TITLE | tilts and decentres, other surface forms, zooms, solves of named surfaces, surfaces inserted or deleted |
//!
//! Both become a [`PrescriptionAsset`] in mm. Other content (tolerances, plots, solves, merit functions) does not describe the lens itself and is ignored. No
//! program of the files is run.

mod build;
mod glasses;
mod private;
mod raw_surface;
mod seq;
mod seq_edit;
mod text;
mod unfold;
mod zmx;
mod zmx_surface;

use std::path::Path;

use etendue_scene::asset::{GlassCatalogueAsset, PrescriptionAsset};
use etendue_spectra::glass::agf;

use crate::source::{decode_lens_text, read_description_bytes};
use crate::{Error, ErrorCode, hash};

/// Reads a prescription; the file name determines its kind.
///
/// # Errors
/// The first error of the file, with its line.
pub fn read_prescription(file: &Path) -> Result<PrescriptionAsset, Error> {
    read_prescription_with(file, &[])
}

/// Reads a prescription whose glasses are searched first in `catalogues`, in order.
///
/// # Errors
/// The first error of the file, with its line.
pub fn read_prescription_with(file: &Path, catalogues: &[GlassCatalogueAsset]) -> Result<PrescriptionAsset, Error> {
    let bytes = read_description_bytes(file, "lens")?;
    let text = decode_lens_text(file, &bytes)?;
    let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
    let mut asset = match extension.to_str() {
        Some("zmx") => zmx::read(file, &text, catalogues)?,
        Some("seq") => seq::read(file, &text, catalogues)?,
        _ => {
            return Err(Error::coded(
                ErrorCode::UnsupportedFile,
                file,
                "expected a lens file with the extension .zmx (Zemax) or .seq (CODE V)",
            ));
        }
    };
    asset.hash = hash::hash_bytes(&bytes);
    Ok(asset)
}

/// Reads a glass catalogue of Zemax (`.agf`).
///
/// # Errors
/// The file is no such catalogue.
pub fn read_glass_catalogue(file: &Path) -> Result<GlassCatalogueAsset, Error> {
    let bytes = read_description_bytes(file, "glass catalogue")?;
    let text = decode_lens_text(file, &bytes)?;
    let catalogue = agf::read(&text).map_err(|error| Error::at(file, error.line, error.problem))?;
    Ok(GlassCatalogueAsset { file: file.to_owned(), catalogue, hash: hash::hash_bytes(&bytes) })
}
