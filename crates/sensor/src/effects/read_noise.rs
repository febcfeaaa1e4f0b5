//! Read noise: what the read-out chain adds, stated in electrons at the input of the converter.
//!
//! e ← e + σ z, z standard normal; the result may be negative, which the black level takes up.
//! Draw: `NoiseDraw::Read` of the pixel. Left out: noise of rows and columns, telegraph noise, spread of σ over pixels.

use super::{NOISE_OFF, Row, Verdict};
use crate::random::standard_normal;
use crate::sensor::SensorParameters;
use etendue_core::random::NoiseDraw;

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    if p.read_noise_e == 0.0 {
        (Verdict::Skipped, "the read noise is 0 e⁻".into())
    } else if p.noise {
        (Verdict::Required, format!("{} e⁻ of standard deviation, normal", p.read_noise_e))
    } else {
        (Verdict::Skipped, NOISE_OFF.into())
    }
}

/// Read noise, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ReadNoise {
    sigma_e: f64,
}

impl ReadNoise {
    pub(super) fn new(p: &SensorParameters) -> Self {
        Self { sigma_e: p.read_noise_e }
    }

    /// Adds normal noise.
    pub(super) fn apply(&self, electrons: &mut [f64], row: Row) {
        for (x, e) in electrons.iter_mut().enumerate() {
            *e += self.sigma_e * standard_normal(&mut row.address.stream(x, row.y, NoiseDraw::Read));
        }
    }
}
