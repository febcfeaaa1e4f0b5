//! Tables over the field that Zemax OpticStudio writes as text (UTF-8, UTF-16 or Latin-1).
//!
//! | export | columns that are read | fields |
//! | --- | --- | --- |
//! | Relative Illumination | field, `Rel. Ill.` | degrees, or mm of the picture |
//!
//! The unit of the fields is what the line of the head that begins with "Field" or the title of the first column says. A table of one direction from
//! the axis is read, to either side of it. What else the file says (its lens, its date, further columns) is passed over.

mod illumination;
mod listing;

use std::path::Path;

use etendue_scene::asset::{FieldQuantity, FieldTableAsset};

use crate::source::{decode_lens_text, read_description_bytes};
use crate::{Error, hash};
use listing::Listing;

/// Reads a table over the field.
///
/// # Errors
/// The first fault of the file, with its line.
pub fn read_field_table(file: &Path, quantity: FieldQuantity) -> Result<FieldTableAsset, Error> {
    let bytes = read_description_bytes(file, "lens table")?;
    let text = decode_lens_text(file, &bytes)?;
    let listing = Listing::read(file, &text)?;
    let mut table = match quantity {
        FieldQuantity::RelativeIllumination => illumination::read(&listing)?,
    };
    table.hash = hash::of_bytes(&bytes);
    Ok(table)
}
