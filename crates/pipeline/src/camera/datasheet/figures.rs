//! The figures that a camera is made of, and how closely they have to agree.

use etendue_scene::record::DataSheet;

/// Relative difference (of amplitudes) up to which figures of a data sheet are told to differ and are taken.
pub const LOOSE: f64 = 0.05;

/// The figures that a camera is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Figures {
    /// K, DN/e⁻.
    pub(super) gain_dn_e: f64,
    /// σ_d, e⁻, without quantisation.
    pub(super) dark_noise_e: f64,
    /// Digital number of no signal.
    pub(super) black_level_dn: f64,
}

pub(super) fn largest_dn(sheet: &DataSheet) -> f64 {
    f64::from((1_u32 << sheet.bits.value) - 1)
}
