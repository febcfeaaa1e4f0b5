//! The ColorChecker of 24 patches: BabelColor's average of measured reflectances, 380–730 nm, end values held.

use crate::table::{embedded, embedded_names};
use crate::{Outside, Spectrum};
use std::sync::LazyLock;

/// A patch of the chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// The patch's name, as the table gives it: `dark_skin`, … `black_2_(1.5_D)`.
    pub name: &'static str,
    /// Its reflectance.
    pub reflectance: Spectrum,
}

/// The 24 patches in the chart's order: four rows of six, from dark skin to black.
#[must_use]
pub fn colorchecker() -> &'static [Patch] {
    static PATCHES: LazyLock<Vec<Patch>> = LazyLock::new(|| {
        let text = include_str!("../data/colorchecker_reflectance.csv");
        let spectra = embedded::<25>(text, Outside::Hold);
        embedded_names(text).zip(spectra).map(|(name, reflectance)| Patch { name, reflectance }).collect()
    });
    &PATCHES
}
