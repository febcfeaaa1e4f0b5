//! The figures of EMVA 1288 (release 4.0 Linear) that follow from others.
//!
//! | figure | equation |
//! | --- | --- |
//! | quantisation noise | σ_q² = 1/12 DN² |
//! | temporal dark noise, e⁻ | σ_d = √(σ_y.dark² − σ_q²)/K |
//! | absolute sensitivity threshold, e⁻ | μ_e.min = √(σ_d² + σ_q²/K²) + ½ |
//! | greatest signal-to-noise ratio | SNR_max = √μ_e.sat |
//! | dynamic range | DR = μ_e.sat/μ_e.min |

use etendue_core::maths::f64::{log2, log10};

/// Variance of rounding, DN².
pub const QUANTISATION_DN2: f64 = 1.0 / 12.0;

/// The least temporal variance of dark pixels that tells their noise, DN²: below, rounding decides what is measured.
pub const MIN_DARK_DN2: f64 = 0.24;

/// Temporal dark noise, e⁻, of a measured deviation of digital numbers (rounding included) at a gain in DN/e⁻; `None` where
/// rounding alone makes more.
#[must_use]
pub fn dark_noise_e(sigma_y_dark_dn: f64, gain_dn_e: f64) -> Option<f64> {
    let variance = sigma_y_dark_dn * sigma_y_dark_dn - QUANTISATION_DN2;
    (variance >= 0.0).then(|| variance.sqrt() / gain_dn_e)
}

/// Signal at which the signal-to-noise ratio is 1, e⁻, by the standard's approximation.
#[must_use]
pub fn threshold_e(dark_noise_e: f64, gain_dn_e: f64) -> f64 {
    (dark_noise_e * dark_noise_e + QUANTISATION_DN2 / (gain_dn_e * gain_dn_e)).sqrt() + 0.5
}

/// A ratio of amplitudes in decibels.
#[must_use]
pub fn db(ratio: f64) -> f64 {
    20.0 * log10(ratio)
}

/// A ratio of amplitudes in bits.
#[must_use]
pub fn bit(ratio: f64) -> f64 {
    log2(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_goes_to_numbers_and_back() {
        let (sigma_e, gain) = (5.0, 0.25);
        let measured = (sigma_e * sigma_e * gain * gain + QUANTISATION_DN2).sqrt();
        let back = dark_noise_e(measured, gain).expect("more than rounding");
        assert!((back - sigma_e).abs() < 1e-14, "{back}");
        // √(25 + 16/12) + ½.
        assert!((threshold_e(5.0, 0.25) - 5.631_601_439_4).abs() < 1e-9);
        assert_eq!(dark_noise_e(0.28, 1.0), None);
    }

    #[test]
    fn decibels_and_bits() {
        assert!((db(100.0) - 40.0).abs() < 1e-12 && (bit(1024.0) - 10.0).abs() < 1e-12);
    }
}
