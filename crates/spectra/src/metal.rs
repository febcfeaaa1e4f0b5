//! Metals: complex refractive indices n + ik, for light of time dependence exp(−iωt) (k > 0 absorbs).
//!
//! Johnson & Christy 1972 (Ag, Au, Cu) and 1974 (Cr, Fe), Rakić 1995 (Al), Querry 1985 (brass CuZn of 70 % copper); end values held. Surfaces are assumed
//! clean: oxide layers are left out. Two clear oxides, named as metals in scene files, have k = 0: MgO (Stephens & Malitson 1952) and rutile TiO2,
//! extraordinary ray (Devore 1951).

use std::sync::LazyLock;

use crate::{Extrapolation, Spectrum, spectrum::embedded};

/// A complex refractive index over wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct ComplexIndex {
    /// Refractive index.
    pub n: Spectrum,
    /// Extinction coefficient.
    pub k: Spectrum,
}

const NAMES: &[&str] = &["Ag", "Al", "Au", "Cr", "Cu", "CuZn", "Fe", "MgO", "TiO2"];

static TABLES: LazyLock<Vec<ComplexIndex>> = LazyLock::new(|| {
    [
        include_str!("../data/nk_ag.csv"),
        include_str!("../data/nk_al.csv"),
        include_str!("../data/nk_au.csv"),
        include_str!("../data/nk_cr.csv"),
        include_str!("../data/nk_cu.csv"),
        include_str!("../data/nk_cuzn.csv"),
        include_str!("../data/nk_fe.csv"),
        include_str!("../data/nk_mgo.csv"),
        include_str!("../data/nk_tio2.csv"),
    ]
    .into_iter()
    .map(complex_index)
    .collect()
});

pub(crate) fn complex_index(text: &str) -> ComplexIndex {
    let [n, k] = embedded::<3>(text, Extrapolation::Hold).try_into().expect("two columns");
    ComplexIndex { n, k }
}

/// The index of a metal given only by its reflectance at normal incidence, r (0 to 1).
///
/// n lies between the two bounds set by r, (1 − r)/(1 + r) and (1 + √r)/(1 − √r), and k follows from both (Gulbrandsen, "Artist friendly metallic
/// Fresnel", JCGT 3(4), 2014). Its position, a fraction g = 1 − (1 − r)³ of the way to the lower bound, was fitted so that the reflectance over all
/// directions is that of Schlick's approximation, which glTF uses to define its metals: within 0.02 for r of 0.02 and above, and up to 0.05 less
/// below.
#[must_use]
pub fn from_reflectance(normal: &Spectrum) -> ComplexIndex {
    let at = |nm: f64| index_of(f64::from(normal.at(nm as f32)));
    ComplexIndex { n: Spectrum::from_fn(|nm| at(nm).0), k: Spectrum::from_fn(|nm| at(nm).1) }
}

/// n and k of a reflectance at normal incidence.
fn index_of(r: f64) -> (f64, f64) {
    const MAX_REFLECTANCE: f64 = 0.999;
    let r = r.clamp(0.0, MAX_REFLECTANCE);
    let g = 1.0 - (1.0 - r) * (1.0 - r) * (1.0 - r);
    let n = g * (1.0 - r) / (1.0 + r) + (1.0 - g) * (1.0 + r.sqrt()) / (1.0 - r.sqrt());
    let k2 = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    (n, k2.max(0.0).sqrt())
}

/// A metal by its chemical symbol; `None` for one not in [`names`].
#[must_use]
pub fn by_name(name: &str) -> Option<&'static ComplexIndex> {
    NAMES.iter().position(|n| *n == name).map(|i| &TABLES[i])
}

/// The symbols accepted by [`by_name`]: Ag, Al, Au, Cr, Cu, CuZn, Fe, MgO, TiO2.
#[must_use]
pub fn names() -> &'static [&'static str] {
    NAMES
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unpolarised Fresnel reflectance of n + ik.
    fn fresnel(cos: f64, (n, k): (f64, f64)) -> f64 {
        let square = |x: f64| x * x;
        let sin2 = 1.0 - cos * cos;
        let d = n * n - k * k - sin2;
        let t = (d * d + 4.0 * n * n * k * k).sqrt();
        let (a, b2) = (((t + d) / 2.0).max(0.0).sqrt(), (t - d) / 2.0);
        let s = (square(a - cos) + b2) / (square(a + cos) + b2);
        let p = s * (square(a * cos - sin2) + b2 * cos * cos) / (square(a * cos + sin2) + b2 * cos * cos);
        0.5 * (s + p)
    }

    #[test]
    fn a_metal_known_by_its_colour_reflects_as_schlick_says_over_all_directions() {
        for r in [0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99] {
            let index = index_of(r);
            assert!((fresnel(1.0, index) - r).abs() < 1e-9, "{r}: at normal incidence");
            let mean = |f: &dyn Fn(f64) -> f64| {
                (0..400).map(|i| f(((f64::from(i) + 0.5) / 400.0).sqrt())).sum::<f64>() / 400.0
            };
            let difference = mean(&|cos| fresnel(cos, index))
                - mean(&|cos: f64| {
                    let rest = 1.0 - cos;
                    r + (1.0 - r) * rest * rest * rest * rest * rest
                });
            assert!(difference.abs() < 0.02, "{r}: {difference}");
        }
    }

    /// Reflectance at normal incidence, ((n − 1)² + k²)/((n + 1)² + k²).
    fn mirror(name: &str, nm: f32) -> f32 {
        let index = by_name(name).expect("a metal");
        let (n, k) = (index.n.at(nm), index.k.at(nm));
        ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k)
    }

    #[test]
    fn metals_reflect_as_handbooks_say() {
        // Clean evaporated films, CRC Handbook: Al 0.915 and Ag 0.98 at 550–600 nm; gold and copper are red. Samples and preparations differ by a few
        // per cent.
        assert!((mirror("Al", 550.0) - 0.915).abs() < 0.02);
        assert!((mirror("Ag", 600.0) - 0.98).abs() < 0.02);
        assert!(mirror("Au", 650.0) > 0.9 && mirror("Au", 450.0) < 0.45);
        assert!(mirror("Cu", 650.0) > 0.9 && mirror("Cu", 450.0) < 0.65);
        assert!((0.5..0.75).contains(&mirror("Cr", 550.0)) && (0.45..0.7).contains(&mirror("Fe", 550.0)));
        // Brass is yellow (Cu70Zn30); the oxides reflect ((n − 1)/(n + 1))² for n = 1.737 and, by Devore's formula n² = 7.197 + 0.3322/(λ² − 0.0843), 2.9087.
        assert!(mirror("CuZn", 650.0) > 0.85 && mirror("CuZn", 450.0) < 0.55);
        assert!((mirror("MgO", 589.3) - 0.0725).abs() < 2e-4 && (mirror("TiO2", 589.3) - 0.238_45).abs() < 2e-4);
        assert!(names().iter().all(|name| by_name(name).is_some()) && by_name("Pb").is_none());
        assert_eq!(by_name("Ag").map(|m| m.n.at(1100.0)), Some(0.04), "the end value is held");
    }
}
