//! Tables that come with the crate.

use crate::spectrum::Spectrum;
use crate::table::{Outside, rows};

/// The spectra of a table that comes with the crate: `C` columns, the first the wavelength in nm.
pub(crate) fn embedded<const C: usize>(text: &str, outside: Outside) -> Vec<Spectrum> {
    let rows = rows::<C>(text).expect("a table of the crate has numbers in every column");
    let column = |c: usize| rows.iter().map(|(_, row)| (row[0], row[c])).collect::<Vec<_>>();
    (1..C).map(|c| Spectrum::from_points(&column(c), outside).expect("a table of the crate is in order")).collect()
}

/// The column names of a table that comes with the crate, without the wavelength's.
pub(crate) fn embedded_names(text: &'static str) -> impl Iterator<Item = &'static str> {
    text.lines().next().unwrap_or("").split(',').skip(1)
}
