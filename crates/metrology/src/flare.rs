//! Flare: how much light reaches places that send none.
//!
//! ISO 18844:2017: light traps in a white field, readings linear,
//!
//! ```text
//! F = (Y_black − b)/(Y_white − b) · 100 %        b: reading of no light
//! ```
//!
//! at each trap against the white about it. Uncertainty: the scatter of the pixels within each region over √n; light that the
//! traps themselves reflect is not in it. IEEE 2020 adds a source within or outside the field: measure its traps the same way with the
//! source on.

use crate::flat::{SATURATED_SHARE, saturated_share};
use crate::{Estimate, Image};
use etendue_stats::Moments;

/// Why flare cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlareError {
    /// No or tiny regions.
    #[error("flare needs light traps and a white region of at least four pixels each")]
    TooSmall,
    /// The white region is saturated.
    #[error("{percent:.1} % of the white region is saturated: expose less")]
    Saturated {
        /// Share of pixels.
        percent: f64,
    },
    /// The traps are as bright as the white.
    #[error("the white region ({white:.2}) is no brighter than black ({black:.2}): are the regions mixed up?")]
    NotWhite {
        /// Mean of the white region.
        white: f64,
        /// Reading of no light, or of the traps.
        black: f64,
    },
}

/// Flare of each trap, a share of the white.
///
/// # Errors
/// Where regions are too small, the white is saturated, or no brighter than the traps.
pub fn measure_flare(
    traps: &[Image],
    white: &Image,
    black: f64,
    full_scale: Option<f64>,
) -> Result<Vec<Estimate>, FlareError> {
    if traps.is_empty() || traps.iter().chain([white]).any(|region| region.samples().len() < 4) {
        return Err(FlareError::TooSmall);
    }
    let share = saturated_share(white.samples(), full_scale.or(Some(f64::INFINITY)));
    if share > SATURATED_SHARE {
        return Err(FlareError::Saturated { percent: 100.0 * share });
    }
    let white = mean(white);
    traps.iter().map(|trap| flare(mean(trap), white, black)).collect()
}

fn flare(trap: Estimate, white: Estimate, black: f64) -> Result<Estimate, FlareError> {
    let (dark, light) = (trap.value - black, white.value - black);
    if light <= dark.max(0.0) {
        return Err(FlareError::NotWhite { white: white.value, black: trap.value.max(black) });
    }
    let share = dark / light;
    let (own, other) = (trap.standard_uncertainty / light, share * white.standard_uncertainty / light);
    Ok(Estimate::new(share, (own * own + other * other).sqrt()))
}

/// Mean of a region with the standard uncertainty from its scatter.
pub(crate) fn mean(region: &Image) -> Estimate {
    let moments = Moments::of(region.samples().iter().map(|s| f64::from(*s)));
    Estimate::new(moments.mean(), moments.variance_of_mean().unwrap_or(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flare_is_the_traps_light_over_the_white() {
        let region = |a: f32, b: f32| Image::from_samples(4, 2, vec![a, b, a, b, a, b, a, b]).expect("a rectangle");
        let (trap, white) = (region(29.0, 31.0), region(995.0, 1005.0));
        let [flare] = measure_flare(core::slice::from_ref(&trap), &white, 20.0, None).expect("regions")[..] else {
            panic!()
        };
        assert!((flare.value - 10.0 / 980.0).abs() < 1e-12);
        // Scatter of ±1: variance 8/7, mean of eight.
        assert!((flare.standard_uncertainty - (8.0_f64 / 7.0 / 8.0).sqrt() / 980.0).abs() < 1e-6);
        assert!(matches!(
            measure_flare(core::slice::from_ref(&white), &trap, 20.0, None),
            Err(FlareError::NotWhite { .. })
        ));
        let clipped = measure_flare(core::slice::from_ref(&trap), &white, 20.0, Some(1000.0));
        assert!(matches!(clipped, Err(FlareError::Saturated { .. })));
        assert_eq!(measure_flare(&[], &white, 0.0, None), Err(FlareError::TooSmall));
    }
}
