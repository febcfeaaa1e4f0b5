//! Flare: veiling light in places that emit none.
//!
//! ISO 18844:2017: light traps in a white field, readings linear,
//!
//! ```text
//! F = (Y_black − b)/(Y_white − b) · 100 %        b: reading without light
//! ```
//!
//! for each trap relative to the surrounding white, the mean of one or more regions. Uncertainty: from the regions' means
//! ([`patch_statistics`](crate::patch_statistics)); it does not include light that the traps themselves reflect. IEEE 2020 adds a
//! source inside or outside the field: measure its traps in the same way with the source on.

use crate::patch_statistics::{patch_statistics, saturated_percent};
use crate::{Estimate, Image};

/// Reason why flare cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlareError {
    /// No regions, or too small.
    #[error("flare needs light traps and a white region of at least four pixels each")]
    TooSmall,
    /// The white region is saturated.
    #[error("{percent:.1} % of the white region is saturated: expose less")]
    Saturated {
        /// Percentage of saturated pixels.
        percent: f64,
    },
    /// The traps are as bright as the white.
    #[error(
        "the white region ({white:.2}) is no brighter than black ({black:.2}): check that the regions are not swapped"
    )]
    NotWhite {
        /// Mean of the white region.
        white: f64,
        /// Reading without light, or of the traps.
        black: f64,
    },
}

/// Flare of a trap, a fraction of the surrounding white; errors are equal in blocks of `shared_px` × `shared_px` pixels (1:
/// none).
///
/// # Errors
/// If regions are too small, or the white is saturated or no brighter than the trap.
pub fn measure_flare(
    trap: &Image,
    whites: &[Image],
    black: f64,
    full_scale: Option<f64>,
    shared_px: usize,
) -> Result<Estimate, FlareError> {
    if whites.is_empty() || whites.iter().chain([trap]).any(|region| region.samples().len() < 4) {
        return Err(FlareError::TooSmall);
    }
    if let Some(percent) = saturated_percent(whites, full_scale) {
        return Err(FlareError::Saturated { percent });
    }
    let count = whites.len() as f64;
    let all = whites.iter().map(|w| patch_statistics(w, shared_px).mean).fold([0.0; 2], |[value, squares], e| {
        [value + e.value, squares + e.standard_uncertainty * e.standard_uncertainty]
    });
    flare(patch_statistics(trap, shared_px).mean, Estimate::new(all[0] / count, all[1].sqrt() / count), black)
}

fn flare(trap: Estimate, white: Estimate, black: f64) -> Result<Estimate, FlareError> {
    let (dark, light) = (trap.value - black, white.value - black);
    if light <= dark.max(0.0) {
        return Err(FlareError::NotWhite { white: white.value, black: trap.value.max(black) });
    }
    let ratio = dark / light;
    let (own, other) = (trap.standard_uncertainty / light, ratio * white.standard_uncertainty / light);
    Ok(Estimate::new(ratio, (own * own + other * other).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flare_is_the_traps_light_over_the_white() {
        let region = |a: f32, b: f32| Image::from_samples(4, 2, vec![a, b, a, b, a, b, a, b]).expect("a rectangle");
        let (trap, white) = (region(29.0, 31.0), region(995.0, 1005.0));
        let flare = measure_flare(&trap, core::slice::from_ref(&white), 20.0, None, 1).expect("regions");
        assert!((flare.value - 10.0 / 980.0).abs() < 1e-12);
        // Scatter of ±1: variance 8/7, mean of eight.
        assert!((flare.standard_uncertainty - (8.0_f64 / 7.0 / 8.0).sqrt() / 980.0).abs() < 1e-6);
        // Two whites of 980 and 480 above black.
        let two = measure_flare(&trap, &[white.clone(), region(495.0, 505.0)], 20.0, None, 1).expect("regions");
        assert!((two.value - 10.0 / 730.0).abs() < 1e-12, "{two:?}");
        let mixed = measure_flare(&white, core::slice::from_ref(&trap), 20.0, None, 1);
        assert!(matches!(mixed, Err(FlareError::NotWhite { .. })));
        let clipped = measure_flare(&trap, core::slice::from_ref(&white), 20.0, Some(1000.0), 1);
        assert!(matches!(clipped, Err(FlareError::Saturated { .. })));
        assert_eq!(measure_flare(&trap, &[], 0.0, None, 1), Err(FlareError::TooSmall));
    }
}
