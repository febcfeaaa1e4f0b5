//! Laws of snow.

use etendue_core::maths::f64::{cbrt, pow};

/// Rates that snow may have, mm/h of water.
pub(super) const RATES_MM_H: [f64; 2] = [0.1, 3.0];

/// Density of ice, g/cm³.
const ICE: f64 = 0.917;

/// What flakes are made of, which decides how large, dense and quick they are at the same rate: visibility in snow of one rate differs by
/// 3 to 10 times with it (Rasmussen et al., J. Appl. Meteorol. 38, 1999).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Crystals {
    /// Dry, feathery: half the density of aggregates.
    Dendrites,
    /// Flakes of many crystals: 0.178 D^−0.922 g/cm³, D in mm (Brandes et al., J. Appl. Meteorol. Climatol. 46, 2007).
    #[default]
    Aggregates,
    /// Covered by frozen droplets: twice the density of aggregates.
    Rimed,
    /// Soft hail: four times the density of aggregates.
    Graupel,
}

/// N₀, 1/(m³ mm), and Λ, 1/mm, by Sekhon and Srivastava ("Snow size spectra and radar reflectivity", J. Atmos. Sci. 27, 1970) at a rate, mm/h of
/// water: N(D) = 2500 R^−0.94 exp(−2.29 R^−0.45 D) 1/(m³ mm), D the diameter of the molten flake.
pub(super) fn sekhon_srivastava(rate_mm_h: f64) -> [f64; 2] {
    [2500.0 * pow(rate_mm_h, -0.94), 2.29 * pow(rate_mm_h, -0.45)]
}

impl Crystals {
    /// Density over that of aggregates of the same size. The factors are a choice that spans what Rasmussen found.
    fn density_factor(self) -> f64 {
        match self {
            Self::Dendrites => 0.5,
            Self::Aggregates => 1.0,
            Self::Rimed => 2.0,
            Self::Graupel => 4.0,
        }
    }

    /// Diameter of a flake, mm, that melts to a drop of `melted_mm`: ρ(D) D³ = d³ g/cm³, but never denser than ice.
    pub(super) fn flake_mm(self, melted_mm: f64) -> f64 {
        let cube = melted_mm * melted_mm * melted_mm;
        let by_law = pow(cube / (0.178 * self.density_factor()), 1.0 / 2.078);
        by_law.max(cbrt(cube / ICE))
    }

    /// Speed of fall, m/s: 1 m/s for an aggregate of 1 mm, and as the root of density times diameter by the balance of weight and drag;
    /// within 1 to 2 m/s, as flakes fall.
    pub(super) fn speed_mps(self, melted_mm: f64) -> f64 {
        let flake = self.flake_mm(melted_mm);
        let ratio = if flake > 0.0 { melted_mm / flake } else { 1.0 };
        (ratio * ratio * ratio * flake / 0.178).sqrt().clamp(1.0, 2.0)
    }
}
