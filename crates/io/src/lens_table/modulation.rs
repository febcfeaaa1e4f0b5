//! Zemax's "FFT MTF" (also "Huygens MTF" and "Geometric MTF"), or any table of spatial frequency and modulation with a header that states both.
//!
//! A single column is read as it is; of two, tangential and sagittal, the mean. Of several fields the first, the axis, is read; a table of the diffraction
//! limit is ignored.

use etendue_scene::asset::{LensNumbers, LensTableAsset};

use super::listing::{Listing, ListingTable};
use crate::Error;

/// Tolerance of the modulation at frequency 0 from 1.
const ZERO_FREQUENCY_TOLERANCE: f64 = 1e-3;
/// Spellings of the unit of frequencies in headers.
const PER_MM: [&str; 5] = ["cycles per mm", "cycles/mm", "cycles per millimet", "lp/mm", "line pairs per mm"];

pub(super) fn read(listing: &Listing<'_>) -> Result<LensTableAsset, Error> {
    if !["mtf", "modulation"].iter().any(|words| listing.header_contains(words)) {
        return Err(listing.error(0, "not a table of modulation: its header mentions neither MTF nor modulation"));
    }
    if !PER_MM.iter().any(|words| listing.header_contains(words)) {
        let problem = "its header does not state that frequencies are in cycles per mm of the image; expected a line such as \"Spatial Frequency units \
            are cycles per mm\"";
        return Err(listing.error(0, problem));
    }
    let is_limit = |table: &ListingTable<'_>| {
        table.above.iter().any(|(_, line)| line.to_lowercase().contains("diffraction limit"))
    };
    let tables: Vec<&ListingTable<'_>> = listing.tables.iter().filter(|table| !is_limit(table)).collect();
    let [table, others @ ..] = &tables[..] else {
        return Err(listing.error(
            listing.tables[0].rows[0].line,
            "contains only the diffraction limit; expected the modulation of a lens",
        ));
    };
    let points = points(listing, table)?;
    let mut notes =
        vec!["modulation used for all wavelengths, directions and image positions, without phase".to_owned()];
    if table.rows[0].numbers.len() > 2 {
        notes.push("mean of tangential and sagittal modulation".to_owned());
    }
    if !others.is_empty() {
        notes.push(format!("the tables of {} other fields are not used", others.len()));
    }
    Ok(LensTableAsset { numbers: LensNumbers::Modulation, points, notes, hash: [0; 32] })
}

fn points(listing: &Listing<'_>, table: &ListingTable<'_>) -> Result<Vec<(f64, f64)>, Error> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for row in &table.rows {
        let frequency = row.numbers[0];
        let columns = &row.numbers[1..row.numbers.len().min(3)];
        let modulation = columns.iter().sum::<f64>() / columns.len() as f64;
        let wrong = match points.last() {
            _ if !(0.0..=1.0 + ZERO_FREQUENCY_TOLERANCE).contains(&modulation) => {
                Some(format!("the modulation is {modulation}; expected 0 … 1"))
            }
            None if frequency < 0.0 => Some(format!("the frequency is {frequency}; expected 0 or more")),
            None if frequency == 0.0 && (modulation - 1.0).abs() > ZERO_FREQUENCY_TOLERANCE => {
                Some(format!("the modulation at frequency 0 is {modulation}; expected 1"))
            }
            Some((before, _)) if frequency <= *before => {
                Some(format!("the frequency {frequency} follows {before}; expected increasing frequencies"))
            }
            _ => None,
        };
        if let Some(wrong) = wrong {
            return Err(listing.error(row.line, wrong));
        }
        points.push((frequency, modulation.min(1.0)));
    }
    if points.iter().filter(|(frequency, _)| *frequency > 0.0).count() < 2 {
        return Err(listing.error(table.rows[0].line, "has fewer than two frequencies above 0; expected at least two"));
    }
    Ok(points)
}
