//! Reflectances by name: typical materials of roads and streets, and the ColorChecker of 24 patches.
//!
//! Typical spectra of the materials of roads and streets, by name.
//!
//! Values are typical of a material class and set by hand. Level and form follow the works that [`source`] names, to some tens of per cent, but no
//! value was read from them and none is the measurement of a sample. (Leaves are computed.) Where a spectrum matters, use a measured one. They are
//! reflectances (one, `leaf-green-transmittance`, a transmittance) in [0, 1], for scattered light: the gloss of a surface is part of its material.
//! End values are held from 300 to 1 100 nm.
//!
//! **Left out:** spread within a class, dirt, weathering, fluorescence (hence no daylight-fluorescent sheeting, no optical brightener in cloth),
//! dependence on direction.
//!
//! The ColorChecker of 24 patches: BabelColor's average of measured reflectances, 380–730 nm, end values held.

use std::sync::LazyLock;

use crate::spectrum::{embedded, embedded_names};
use crate::{Extrapolation, Spectrum, table};

/// A spectrum of the table.
struct ReflectanceEntry {
    name: &'static str,
    source: &'static str,
    spectrum: Spectrum,
}

static ENTRIES: LazyLock<Vec<ReflectanceEntry>> = LazyLock::new(|| {
    let (_, entries) = include_str!("../data/reflectance.txt").split_once("\n[").expect("entries");
    entries.split("\n[").map(entry).collect()
});

static NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| ENTRIES.iter().map(|entry| entry.name).collect());

/// An entry's text: `name] source`, then pairs of wavelength and value, separated by commas.
fn entry(text: &'static str) -> ReflectanceEntry {
    let (head, values) = text.split_once('\n').expect("a head line");
    let (name, source) = head.split_once("] ").expect("a name and a source");
    let points: Vec<_> = values.split(',').map(point).collect();
    table::check(&points, table::TablePlace::Point).expect("a table of the crate is in order");
    ReflectanceEntry { name, source, spectrum: Spectrum::from_checked(&points, Extrapolation::Hold) }
}

fn point(text: &str) -> (f64, f64) {
    let mut numbers = text.split_whitespace().map(|word| word.parse().expect("a number"));
    (numbers.next().expect("a wavelength"), numbers.next().expect("a value"))
}

fn find(name: &str) -> Option<&'static ReflectanceEntry> {
    ENTRIES.iter().find(|entry| entry.name == name)
}

/// The reflectance of a material; `None` for a name not in [`names`].
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Spectrum> {
    find(name).map(|entry| &entry.spectrum)
}

/// The nature of a name's values, and the works they follow.
#[must_use]
pub fn source(name: &str) -> Option<&'static str> {
    find(name).map(|entry| entry.source)
}

/// The names accepted by [`by_name`]: leaves, asphalt, concrete, soil, skin, rubber, paints, road markings, sheeting, cotton.
#[must_use]
pub fn names() -> &'static [&'static str] {
    &NAMES
}

/// A patch of the chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// The patch's name in the table: `dark_skin`, … `black_2_(1.5_D)`.
    pub name: &'static str,
    pub reflectance: Spectrum,
}

/// The 24 patches in the chart's order: four rows of six, from dark skin to black.
#[must_use]
pub fn colorchecker() -> &'static [Patch] {
    static PATCHES: LazyLock<Vec<Patch>> = LazyLock::new(|| {
        let text = include_str!("../data/colorchecker_reflectance.csv");
        let spectra = embedded::<25>(text, Extrapolation::Hold);
        embedded_names(text).zip(spectra).map(|(name, reflectance)| Patch { name, reflectance }).collect()
    });
    &PATCHES
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{illuminant, observer};

    fn at(name: &str, nm: f32) -> f32 {
        by_name(name).expect("a name of the table").at(nm)
    }

    fn luminance_factor(name: &str) -> f64 {
        observer::xyz_of_reflectance(by_name(name).expect("a name of the table"), illuminant::d65())[1]
    }

    #[test]
    fn every_name_has_a_source_and_values_between_none_and_all() {
        assert_eq!(names().len(), 25);
        for name in names() {
            let spectrum = by_name(name).expect("a name of the list");
            assert!(spectrum.min_value() >= 0.0 && spectrum.max_value() < 0.95, "{name}");
            assert!(source(name).is_some_and(|s| s.len() > 20), "{name}");
            assert_eq!(names().iter().filter(|n| *n == name).count(), 1, "{name}");
        }
        assert!(by_name("gold").is_none() && source("gold").is_none());
    }

    #[test]
    fn a_leaf_is_green_has_its_red_edge_and_keeps_energy() {
        assert!(
            at("leaf-green", 550.0) > 2.0 * at("leaf-green", 670.0)
                && at("leaf-green", 550.0) > 2.0 * at("leaf-green", 450.0)
        );
        let (red, infrared) = (at("leaf-green", 670.0), at("leaf-green", 800.0));
        // The vegetation index of a healthy leaf is 0.8 to 0.9.
        assert!((0.8..0.9).contains(&((infrared - red) / (infrared + red))));
        for nm in 300..=1100 {
            let sum = at("leaf-green", nm as f32) + at("leaf-green-transmittance", nm as f32);
            assert!(sum < 0.96, "{nm} nm: {sum}");
        }
    }

    #[test]
    fn luminance_factors_meet_their_classes() {
        // The classes that the table's source lines name.
        let minimum = [
            ("marking-white", 0.40),
            ("marking-yellow", 0.30),
            ("sheeting-white", 0.27),
            ("sheeting-yellow", 0.16),
            ("sheeting-red", 0.03),
            ("sheeting-green", 0.03),
            ("sheeting-blue", 0.01),
        ];
        for (name, minimum) in minimum {
            let factor = luminance_factor(name);
            assert!(factor > minimum && factor < 2.0 * minimum + 0.1, "{name}: {factor}");
        }
    }

    #[test]
    fn materials_are_ordered_as_they_look() {
        for names in [
            ["skin-dark", "skin-medium", "skin-light"],
            ["asphalt-wet", "asphalt-dry", "concrete"],
            ["asphalt-new", "asphalt-dry", "marking-yellow"],
            ["paint-black", "paint-silver", "paint-white"],
        ] {
            assert!(names.map(luminance_factor).is_sorted(), "{names:?}");
        }
        assert!(at("paint-red", 650.0) > 10.0 * at("paint-red", 500.0));
        assert!(at("paint-blue", 460.0) > 5.0 * at("paint-blue", 620.0));
    }

    #[test]
    fn the_chart_has_its_patches_in_order() {
        let patches = colorchecker();
        assert_eq!((patches.len(), patches[0].name, patches[14].name), (24, "dark_skin", "red"));
        assert!(patches.iter().all(|p| p.reflectance.min_value() > 0.0 && p.reflectance.max_value() < 1.0));
        let greys: Vec<f32> = patches[18..].iter().map(|p| p.reflectance.at(550.0)).collect();
        assert!(greys.windows(2).all(|w| w[1] < w[0]), "the last row falls from white to black: {greys:?}");
    }
}
