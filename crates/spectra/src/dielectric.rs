//! Refractive indices of clear materials, by name; for some also their absorption.
//!
//! Glasses: soda-lime window glass (Rubin 1985), clear and tinted green by iron; water: Hale & Querry (1973); both from the refractiveindex.info
//! database, end values held (below 310 and 320 nm the glasses absorb more than the held value). Plastics: n² − 1 = B λ²/(λ² − C), λ in µm
//! (Sultanova, Kasarova & Nikolov 2009, 437–1 052 nm, extrapolated beyond), assumed non-absorbing. With extinction k light decays by e^(−αd) over a
//! path d, α = 4πk/λ.

use core::f64::consts::PI;
use std::sync::LazyLock;

use crate::Spectrum;
use crate::metal::{ComplexIndex, complex_index};

const NAMES: &[&str] = &["water", "glass", "glass-green", "acrylic", "polycarbonate"];

static TABLES: LazyLock<[ComplexIndex; 5]> = LazyLock::new(|| {
    [
        complex_index(include_str!("../data/nk_h2o.csv")),
        complex_index(include_str!("../data/nk_glass_clear.csv")),
        complex_index(include_str!("../data/nk_glass_green.csv")),
        plastic(1.1819, 0.011_313),
        plastic(1.4182, 0.021_304),
    ]
});

fn plastic(b: f64, c: f64) -> ComplexIndex {
    let n = Spectrum::from_fn(|nm| {
        let square = nm * nm * 1e-6;
        (1.0 + b * square / (square - c)).sqrt()
    });
    ComplexIndex { n, k: Spectrum::constant(0.0) }
}

/// A clear material; `None` for a name not in [`names`].
#[must_use]
pub fn by_name(name: &str) -> Option<&'static ComplexIndex> {
    NAMES.iter().position(|n| *n == name).map(|i| &TABLES[i])
}

/// The names accepted by [`by_name`]: water, glass (clear float glass), glass-green, acrylic, polycarbonate.
#[must_use]
pub fn names() -> &'static [&'static str] {
    NAMES
}

impl ComplexIndex {
    /// Absorption coefficient, 1/m: 4πk/λ.
    #[must_use]
    pub fn absorption(&self) -> Spectrum {
        Spectrum::from_fn(|nm| 4.0 * PI * f64::from(self.k.at(nm as f32)) / (nm * 1e-9))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{illuminant, observer};
    use etendue_core::maths;

    fn index(name: &str, nm: f32) -> f32 {
        by_name(name).expect("a name of the list").n.at(nm)
    }

    #[test]
    fn indices_at_the_sodium_line() {
        // Handbook values at 589 nm; water's table is coarse.
        for (name, n) in [("water", 1.333), ("glass", 1.5233), ("acrylic", 1.4906), ("polycarbonate", 1.5848)] {
            assert!((index(name, 589.3) - n).abs() < 1e-3, "{name}");
        }
        for name in names() {
            assert!(index(name, 400.0) > index(name, 700.0), "{name} disperses normally");
            assert!(by_name(name).is_some_and(|i| i.k.min_value() >= 0.0));
        }
        assert!(by_name("gold").is_none());
    }

    /// Light transmittance of a pane of a thickness in m under D65, with both faces reflecting: (1 − R)² e^(−αd).
    fn pane(name: &str, metres: f64) -> f64 {
        let absorption = by_name(name).expect("a glass").absorption();
        let face = 4.0 * 1.5233 / (2.5233 * 2.5233);
        let through = |nm: f64| face * face * maths::f64::exp(-f64::from(absorption.at(nm as f32)) * metres);
        observer::xyz_of_reflectance(&Spectrum::from_fn(through), illuminant::d65())[1]
    }

    #[test]
    fn panes_let_through_what_makers_state() {
        // Manufacturers' values: clear float about 0.89–0.90 at 4 mm and 0.87–0.89 at 6 mm, green 0.77–0.81 at 4 mm.
        let panes = [pane("glass", 4e-3), pane("glass", 6e-3), pane("glass-green", 4e-3)];
        assert!((0.885..0.905).contains(&panes[0]) && (0.865..0.895).contains(&panes[1]), "{panes:?}");
        assert!((0.76..0.82).contains(&panes[2]), "{panes:?}");
    }

    #[test]
    fn absorption_is_that_of_the_extinction() {
        // 4π · 2.2e-7 / 550 nm; stored in single precision.
        let glass = by_name("glass").expect("glass").absorption();
        assert!((f64::from(glass.at(550.0)) / (4.0 * PI * 2.2e-7 / 550e-9) - 1.0).abs() < 1e-6);
        let water = by_name("water").expect("water").absorption();
        assert!(water.at(500.0) < 0.05 && water.at(975.0) > 20.0, "clear in the green, dark in the infrared");
    }
}
