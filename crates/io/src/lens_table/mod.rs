//! Tables of a lens that Zemax OpticStudio writes as text (UTF-8, UTF-16 or Latin-1).
//!
//! | export | columns that are read | fields |
//! | --- | --- | --- |
//! | Relative Illumination | field, `Rel. Ill.` | degrees, or mm in the image |
//! | Field Curvature/Distortion | field, `Ref. Height`, distortion | degrees |
//! | Huygens and FFT PSF | all: samples of one field ([`read_point_spread`]) | degrees, or mm in the image |
//! | FFT, Huygens and Geometric MTF | spatial frequency, tangential, sagittal | the first |
//!
//! The unit of the fields is stated by the header line that begins with "Field" or by the title of the first column. A table of one direction from the axis is
//! read, to either side. Other content (lens, date, further columns) is ignored.

mod distortion;
mod illumination;
mod listing;
mod modulation;
mod point_spread;

use std::path::Path;

use etendue_scene::asset::{LensQuantity, LensTableAsset, PointSpreadAsset};

use crate::source::{decode_lens_text, read_bytes, read_description_bytes};
use crate::{Error, hash};
use listing::Listing;

/// Reads a table of a lens.
///
/// # Errors
/// The first error of the file, with its line.
pub fn read_lens_table(file: &Path, quantity: LensQuantity) -> Result<LensTableAsset, Error> {
    let bytes = read_description_bytes(file, "lens table")?;
    let text = decode_lens_text(file, &bytes)?;
    let listing = Listing::read(file, &text)?;
    let mut table = match quantity {
        LensQuantity::RelativeIllumination => illumination::read(&listing)?,
        LensQuantity::Distortion => distortion::read(&listing)?,
        LensQuantity::Modulation => modulation::read(&listing)?,
    };
    table.hash = hash::hash_bytes(&bytes);
    Ok(table)
}

/// Reads the point spread at one field point.
///
/// # Errors
/// The first error of the file, with its line.
pub fn read_point_spread(file: &Path) -> Result<PointSpreadAsset, Error> {
    let bytes = read_bytes(file, "point spread")?;
    let text = decode_lens_text(file, &bytes)?;
    let mut spread = point_spread::read(&Listing::read(file, &text)?)?;
    spread.hash = hash::hash_bytes(&bytes);
    Ok(spread)
}
