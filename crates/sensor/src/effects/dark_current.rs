//! Dark current: electrons that heat sets free, with their own shot noise.
//!
//! k ~ Poisson(I t), I the mean dark current (e⁻/s) at the sensor's temperature; the mean I t itself where noise is off.
//! Draw: `NoiseDraw::Dark` of the pixel. Left out: dependence on temperature, differences between pixels (DSNU).

use super::{Row, Verdict};
use crate::random::Poisson;
use crate::sensor::SensorParameters;
use etendue_core::random::NoiseDraw;

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    let mean_e = p.dark_current_e_s * p.exposure_s;
    if mean_e == 0.0 {
        (Verdict::Skipped, format!("{} e-/s over {} s frees no electron", p.dark_current_e_s, p.exposure_s))
    } else if p.noise {
        (Verdict::Required, format!("{mean_e} e⁻ a pixel on average, Poisson"))
    } else {
        (Verdict::Required, format!("{mean_e} e⁻ a pixel; its shot noise is switched off"))
    }
}

/// Dark current, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DarkCurrent {
    mean_e: f64,
    /// `None` where only the mean is added.
    counts: Option<Poisson>,
}

impl DarkCurrent {
    pub(super) fn new(p: &SensorParameters) -> Self {
        let mean_e = p.dark_current_e_s * p.exposure_s;
        Self { mean_e, counts: Poisson::new(mean_e).filter(|_| p.noise) }
    }

    /// Adds dark electrons.
    pub(super) fn apply(&self, electrons: &mut [f64], row: Row) {
        match self.counts {
            None => electrons.iter_mut().for_each(|e| *e += self.mean_e),
            Some(counts) => {
                for (x, e) in electrons.iter_mut().enumerate() {
                    *e += counts.draw(&mut row.address.stream(x, row.y, NoiseDraw::Dark));
                }
            }
        }
    }
}
