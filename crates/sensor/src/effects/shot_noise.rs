//! Photon shot noise: photo-electrons are counted, and counts fluctuate.
//!
//! k ~ Poisson(μ), μ the mean photo-electrons of the pixel during the exposure; exact at every mean.
//! Draw: `NoiseDraw::Shot` of the pixel. Left out: several electrons a photon (below 400 nm).

use super::{NOISE_OFF, Row, Verdict};
use crate::random::Poisson;
use crate::sensor::SensorParameters;
use etendue_core::random::NoiseDraw;

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    if !p.noise {
        (Verdict::Skipped, NOISE_OFF.into())
    } else if p.exposure_s == 0.0 {
        (Verdict::Skipped, "the exposure is zero: no photon is counted".into())
    } else {
        (Verdict::Required, "photo-electrons are counted: Poisson, exact at every mean".into())
    }
}

/// Photon shot noise, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShotNoise;

impl ShotNoise {
    /// Replaces means (finite, not negative) by counts.
    pub(super) fn apply(self, electrons: &mut [f64], row: Row) {
        for (x, e) in electrons.iter_mut().enumerate() {
            if let Some(poisson) = Poisson::new(*e) {
                *e = poisson.draw(&mut row.address.stream(x, row.y, NoiseDraw::Shot));
            }
        }
    }
}
