//! Optical glasses: the refractive index as a smooth function of wavelength, in double precision.
//!
//! **Relative to air.** Catalogues state n relative to air at about 20 °C and 1 atm. A lens in air therefore has index 1 around it. Air's own
//! dispersion (3e-7 over the visible), temperature, pressure and absorption are left out.
//!
//! λ in µm:
//!
//! | form | equation | for |
//! | --- | --- | --- |
//! | [`Dispersion::Sellmeier`] | n² = 1 + Σ Bᵢ λ²/(λ² − Cᵢ) | catalogue glasses (Sellmeier 1871; Schott TIE-29) |
//! | [`Dispersion::Cauchy`] | n = A + B/λ² + C/λ⁴ | Cauchy 1836 |
//! | [`Dispersion::Conrady`] | n = A + B/λ + C/λ³·⁵ | Conrady 1929 |
//! | [`Dispersion::Series`] | n² = A + Σ Bᵢ λ²/(λ² − Cᵢ) + Σ aₖ λ²ᵏ | formulas of Zemax glass catalogues ([`agf`]) |
//! | [`Dispersion::Herzberger`] | n = A + B L + C L² + D λ² + E λ⁴ + F λ⁶, L = 1/(λ² − 0.028) | Herzberger 1959 |
//!
//! A glass given only by index and Abbe number ([`Dispersion::from_abbe`]) is a Conrady curve through n_d, with n_F − n_C = (n_d − 1)/V_d and the
//! partial dispersion of Schott's normal line, (n_g − n_F)/(n_F − n_C) = 0.6438 − 0.001682 V_d (Schott TIE-29). Ordinary glasses obey this third
//! condition to 1 %; fluor crowns and short flints deviate from it by design.

pub mod agf;
mod catalogue;
mod series;

pub use catalogue::{CatalogueGlass, GlassMatch, built_in, by_name, by_number, find, find_first, plain, successor};
pub use series::DispersionSeries;

use etendue_core::wavelength::{MAX_NM, MIN_NM};

/// The helium d line, nm: the wavelength of n_d.
pub const LINE_D_NM: f64 = 587.5618;
/// The hydrogen F line, nm.
pub const LINE_F_NM: f64 = 486.1327;
/// The hydrogen C line, nm.
pub const LINE_C_NM: f64 = 656.2725;
/// The mercury g line, nm.
pub const LINE_G_NM: f64 = 435.8343;

/// Refractive index of a clear material over wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dispersion {
    /// The same index at every wavelength; 1 is air.
    Constant {
        /// The index.
        n: f64,
    },
    /// n² = 1 + Σ B λ²/(λ² − C).
    Sellmeier {
        /// Strengths.
        b: [f64; 3],
        /// Squares of the resonances, µm².
        c_um2: [f64; 3],
    },
    /// n = A + B/λ² + C/λ⁴.
    Cauchy {
        /// A.
        a: f64,
        /// B, µm².
        b_um2: f64,
        /// C, µm⁴.
        c_um4: f64,
    },
    /// n = A + B/λ + C/λ³·⁵.
    Conrady {
        /// A.
        a: f64,
        /// B, µm.
        b_um: f64,
        /// C, µm³·⁵.
        c_um35: f64,
    },
    /// A squared index of resonances and powers.
    Series(DispersionSeries),
    /// n = A + B L + C L² + D λ² + E λ⁴ + F λ⁶ with L = 1/(λ² − 0.028 µm²).
    Herzberger {
        /// A to F, for λ in µm.
        coefficients: [f64; 6],
    },
}

/// Error of a glass.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GlassError {
    /// A name in no catalogue of the crate.
    #[error(
        "no glass is called `{name}`{}; give a name of a catalogue, n_d and V_d, or a file of its catalogue (\"glasses\")",
        hint(near)
    )]
    Unknown {
        name: String,
        /// Similar names.
        near: Vec<&'static str>,
    },
    /// An index or Abbe number outside the range of glasses.
    #[error(
        "the glass has index {index} and Abbe number {abbe}; the index must be above 1 and at most 5, the Abbe number above 5"
    )]
    Abbe {
        /// n_d.
        index: f64,
        /// V_d.
        abbe: f64,
    },
    /// A curve outside the range of clear materials.
    #[error(
        "the index is {n} at {nm} nm; between 300 and 1100 nm it must stay within 1 and 5: check the coefficients' unit (µm)"
    )]
    Range {
        /// The wavelength, nm.
        nm: f64,
        /// The index there.
        n: f64,
    },
}

fn hint(near: &[&str]) -> String {
    if near.is_empty() { String::new() } else { format!(" (similar: {})", near.join(", ")) }
}

impl Dispersion {
    /// Air, or any medium of index 1.
    pub const AIR: Self = Self::Constant { n: 1.0 };

    /// The curve of a glass given by n_d and V_d: see the module.
    ///
    /// # Errors
    /// If no glass has these numbers.
    pub fn from_abbe(index: f64, abbe: f64) -> Result<Self, GlassError> {
        if !(index > 1.0 && index <= 5.0 && abbe > 5.0 && abbe.is_finite()) {
            return Err(GlassError::Abbe { index, abbe });
        }
        let principal = (index - 1.0) / abbe;
        let partial = principal * (0.6438 - 0.001_682 * abbe);
        let terms = |nm: f64| [1e3 / nm, conrady_power(nm * 1e-3)];
        let ([d1, d2], [f1, f2], [c1, c2], [g1, g2]) =
            (terms(LINE_D_NM), terms(LINE_F_NM), terms(LINE_C_NM), terms(LINE_G_NM));
        // Two linear equations: B (F1 − C1) + C (F2 − C2) = n_F − n_C, and the same for g and F.
        let (p, q, r, s) = (f1 - c1, f2 - c2, g1 - f1, g2 - f2);
        let determinant = p * s - q * r;
        let b_um = (principal * s - q * partial) / determinant;
        let c_um35 = (p * partial - principal * r) / determinant;
        Self::Conrady { a: index - b_um * d1 - c_um35 * d2, b_um, c_um35 }.checked()
    }

    /// Returns this curve if it is that of a clear material at every legal wavelength.
    ///
    /// # Errors
    /// If the index leaves 1 to 5 between 300 and 1 100 nm.
    pub fn checked(self) -> Result<Self, GlassError> {
        let grid = (MIN_NM as u32..=MAX_NM as u32).map(f64::from);
        let outside = grid.map(|nm| (nm, self.index(nm))).find(|(_, n)| !(1.0..=5.0).contains(n));
        outside.map_or(Ok(self), |(nm, n)| Err(GlassError::Range { nm, n }))
    }

    /// The refractive index at a wavelength, relative to air.
    #[must_use]
    pub fn index(&self, nm: f64) -> f64 {
        let um = nm * 1e-3;
        let square = um * um;
        match *self {
            Self::Constant { n } => n,
            Self::Sellmeier { b, c_um2 } => {
                let term = |i: usize| b[i] * square / (square - c_um2[i]);
                (1.0 + term(0) + term(1) + term(2)).sqrt()
            }
            Self::Cauchy { a, b_um2, c_um4 } => a + (b_um2 + c_um4 / square) / square,
            Self::Conrady { a, b_um, c_um35 } => a + b_um / um + c_um35 * conrady_power(um),
            Self::Series(ref series) => series.index(um),
            Self::Herzberger { coefficients: [a, b, c, d, e, f] } => {
                let l = 1.0 / (square - HERZBERGER_UM2);
                a + (b + c * l) * l + (d + (e + f * square) * square) * square
            }
        }
    }

    /// Abbe number V_d = (n_d − 1)/(n_F − n_C); infinite without dispersion.
    #[must_use]
    pub fn abbe(&self) -> f64 {
        (self.index(LINE_D_NM) - 1.0) / (self.index(LINE_F_NM) - self.index(LINE_C_NM))
    }

    /// True if the index depends on wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        !matches!(self, Self::Constant { .. })
    }
}

/// Squared resonance of Herzberger's formula, µm².
const HERZBERGER_UM2: f64 = 0.028;

/// λ^−3.5, λ in µm.
fn conrady_power(um: f64) -> f64 {
    1.0 / (um * um * um * um.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glass(name: &str) -> Dispersion {
        by_name(name).expect("a name of the catalogue").dispersion
    }

    #[test]
    fn catalogue_glasses_have_their_makers_index_and_abbe_number() {
        // Data sheets: n_d to 5 decimals, V_d to 2 (half a unit of the last place, and the fit's own 5e-6).
        for (name, n, v) in [("N-BK7", 1.516_80, 64.17), ("N-SF6", 1.805_18, 25.36), ("S-LAH58", 1.882_997, 40.76)] {
            assert!((glass(name).index(LINE_D_NM) - n).abs() < 1e-5, "{name} {}", glass(name).index(LINE_D_NM));
            assert!((glass(name).abbe() - v).abs() < 0.01, "{name} {}", glass(name).abbe());
        }
        assert_eq!(by_name("n-bk7").map(|g| g.name), Ok("N-BK7"), "capitals do not matter");
    }

    #[test]
    fn every_catalogue_glass_is_clear_and_disperses_normally() {
        for glass in built_in() {
            assert!(glass.dispersion.checked().is_ok(), "{}", glass.name);
            assert!(glass.dispersion.abbe() > 15.0 && glass.dispersion.disperses(), "{}", glass.name);
        }
    }

    #[test]
    fn index_and_abbe_number_give_a_curve_that_has_both() {
        for (n, v) in [(1.517, 64.2), (1.805, 25.4), (1.497, 81.6), (1.62, 36.3)] {
            let curve = Dispersion::from_abbe(n, v).expect("a glass");
            // Rounding of the two linear equations.
            assert!((curve.index(LINE_D_NM) - n).abs() < 1e-14);
            assert!((curve.abbe() / v - 1.0).abs() < 1e-12, "{}", curve.abbe());
        }
    }

    #[test]
    fn the_curve_of_an_abbe_number_follows_the_real_glass() {
        // Accuracy of the model over 400–700 nm: the root mean square over the whole catalogue, and the worst glass on the normal line.
        let (mut sum, mut count, mut worst) = (0.0, 0.0, 0.0_f64);
        for glass in built_in().iter().filter(|glass| ["schott", "ohara"].contains(&glass.maker)).take(378) {
            let real = glass.dispersion;
            let model = Dispersion::from_abbe(real.index(LINE_D_NM), real.abbe()).expect("a glass");
            for nm in (400..=700).step_by(10).map(f64::from) {
                let error = model.index(nm) - real.index(nm);
                sum += error * error;
                count += 1.0;
                if ["N-BK7", "F2"].contains(&glass.name) {
                    worst = worst.max(error.abs());
                }
            }
        }
        let rms = f64::sqrt(sum / count);
        assert!(rms < 4e-4, "{rms}");
        assert!(worst < 2e-4, "K7 and F2 define the normal line: {worst}");
    }

    #[test]
    fn other_forms_are_their_equations() {
        let cauchy = Dispersion::Cauchy { a: 1.5, b_um2: 0.004, c_um4: 1e-4 };
        assert!((cauchy.index(500.0) - (1.5 + 0.016 + 0.0016)).abs() < 1e-15);
        let conrady = Dispersion::Conrady { a: 1.5, b_um: 0.01, c_um35: 3e-4 };
        assert!((conrady.index(250.0) - (1.5 + 0.04 + 3e-4 * 128.0)).abs() < 1e-14);
        assert_eq!(Dispersion::AIR.index(400.0), 1.0);
    }

    #[test]
    fn faults_say_what_to_do() {
        let unknown = by_name("BK7X").expect_err("no such glass").to_string();
        assert!(unknown.starts_with("no glass is called `BK7X`; give a name"), "{unknown}");
        let old = by_name("LAK8").expect_err("an old name").to_string();
        assert!(old.contains("(similar: N-LAK8"), "{old}");
        assert!(Dispersion::from_abbe(0.9, 50.0).is_err() && Dispersion::from_abbe(1.5, f64::NAN).is_err());
        let in_nm = Dispersion::Cauchy { a: 1.5, b_um2: 4000.0, c_um4: 0.0 }.checked().expect_err("unit").to_string();
        assert!(in_nm.contains("check the coefficients' unit"), "{in_nm}");
    }
}
