//! Photon shot noise: photo-electrons are counted, and counts fluctuate.
//!
//! k ~ Poisson(μ), μ the mean photo-electrons of the pixel during the exposure; exact at every mean.
//! Draw: `NoiseDraw::Shot` of the pixel. Left out: several electrons a photon (below 400 nm).

use super::{NOISE_OFF, Verdict};
use crate::operation::{Context, Operation};
use crate::parameters::SensorParameters;
use crate::random::Poisson;
use etendue_core::random::{NoiseDraw, NoiseKey, Pixel};

pub(super) fn need(p: &SensorParameters, operation: &Operation) -> (Verdict, String) {
    if !p.noise {
        (Verdict::Skipped, NOISE_OFF.into())
    } else if operation.exposure_s == 0.0 {
        (Verdict::Skipped, "the exposure is zero: no photon is counted".into())
    } else {
        (Verdict::Required, "photo-electrons are counted: Poisson, exact at every mean".into())
    }
}

/// Photon shot noise, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShotNoise {
    key: NoiseKey,
}

impl ShotNoise {
    pub(crate) fn new(context: &Context<'_>) -> Self {
        Self { key: context.noise(NoiseDraw::Shot) }
    }

    /// Replaces means (finite, not negative) by counts.
    pub(crate) fn apply(self, electrons: &mut [f64], y: u32) {
        for (x, e) in electrons.iter_mut().enumerate() {
            if let Some(poisson) = Poisson::new(*e) {
                *e = poisson.draw(&mut self.key.stream(Pixel { x: x as u32, y }));
            }
        }
    }
}
