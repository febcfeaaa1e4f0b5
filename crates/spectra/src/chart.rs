//! The ColorChecker of 24 patches: BabelColor's average of measured reflectances, 380–730 nm, end values held.

use crate::embedded::{embedded, embedded_names};
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chart_has_its_patches_in_order() {
        let patches = colorchecker();
        assert_eq!((patches.len(), patches[0].name, patches[14].name), (24, "dark_skin", "red"));
        assert!(patches.iter().all(|p| p.reflectance.min_value() > 0.0 && p.reflectance.max_value() < 1.0));
        let greys: Vec<f32> = patches[18..].iter().map(|p| p.reflectance.at(550.0)).collect();
        assert!(greys.windows(2).all(|w| w[1] < w[0]), "the last row falls from white to black: {greys:?}");
    }
}
