//! The refractive index over wavelength, and errors of glasses.

use super::series::DispersionSeries;
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
