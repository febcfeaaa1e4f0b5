//! Metals: complex refractive indices n + ik, for light of time dependence exp(−iωt) (k > 0 absorbs).
//!
//! Johnson & Christy 1972 (Ag, Au, Cu) and 1974 (Cr, Fe), Rakić 1995 (Al); end values held. Surfaces are taken clean:
//! oxide layers are left out.

use crate::embedded::embedded;
use crate::{Outside, Spectrum};
use std::sync::LazyLock;

/// A complex refractive index over wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct ComplexIndex {
    /// Refractive index.
    pub n: Spectrum,
    /// Extinction coefficient.
    pub k: Spectrum,
}

const NAMES: &[&str] = &["Ag", "Al", "Au", "Cr", "Cu", "Fe"];

static TABLES: LazyLock<Vec<ComplexIndex>> = LazyLock::new(|| {
    [
        include_str!("../data/nk_ag.csv"),
        include_str!("../data/nk_al.csv"),
        include_str!("../data/nk_au.csv"),
        include_str!("../data/nk_cr.csv"),
        include_str!("../data/nk_cu.csv"),
        include_str!("../data/nk_fe.csv"),
    ]
    .into_iter()
    .map(complex_index)
    .collect()
});

pub(crate) fn complex_index(text: &str) -> ComplexIndex {
    let [n, k] = embedded::<3>(text, Outside::Hold).try_into().expect("two columns");
    ComplexIndex { n, k }
}

/// A metal by its chemical symbol; `None` for one not in [`names`].
#[must_use]
pub fn named(name: &str) -> Option<&'static ComplexIndex> {
    NAMES.iter().position(|n| *n == name).map(|i| &TABLES[i])
}

/// The symbols that [`named`] knows: Ag, Al, Au, Cr, Cu, Fe.
#[must_use]
pub fn names() -> &'static [&'static str] {
    NAMES
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reflectance at normal incidence, ((n − 1)² + k²)/((n + 1)² + k²).
    fn mirror(name: &str, nm: f32) -> f32 {
        let index = named(name).expect("a metal");
        let (n, k) = (index.n.at(nm), index.k.at(nm));
        ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k)
    }

    #[test]
    fn metals_reflect_as_handbooks_say() {
        // Clean evaporated films, CRC Handbook: Al 0.915 and Ag 0.98 at 550–600 nm; gold and copper are red. Samples
        // and preparations differ by some parts in a hundred.
        assert!((mirror("Al", 550.0) - 0.915).abs() < 0.02);
        assert!((mirror("Ag", 600.0) - 0.98).abs() < 0.02);
        assert!(mirror("Au", 650.0) > 0.9 && mirror("Au", 450.0) < 0.45);
        assert!(mirror("Cu", 650.0) > 0.9 && mirror("Cu", 450.0) < 0.65);
        assert!((0.5..0.75).contains(&mirror("Cr", 550.0)) && (0.45..0.7).contains(&mirror("Fe", 550.0)));
        assert!(names().iter().all(|name| named(name).is_some()) && named("Pb").is_none());
        assert_eq!(named("Ag").map(|m| m.n.at(1100.0)), Some(0.04), "the end value is held");
    }
}
