//! Metals: complex refractive indices n + ik, for light of time dependence exp(−iωt) (k > 0 absorbs).
//!
//! Johnson & Christy 1972 (Ag, Au, Cu) and 1974 (Cr, Fe), Rakić 1995 (Al); end values held. Surfaces are taken clean:
//! oxide layers are left out.

use crate::table::embedded;
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

fn complex_index(text: &str) -> ComplexIndex {
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
