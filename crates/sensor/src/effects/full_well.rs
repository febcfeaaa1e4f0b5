//! Full well: the most electrons a pixel holds; what is above is lost.
//!
//! e ← min(e, capacity). Left out: blooming into neighbours, the bend of the response before the well is full.

use super::Verdict;
use crate::sensor::SensorParameters;

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    let clips = format!("clips rows in which a pixel collects more than {} e⁻", p.full_well_e);
    let range_e = (f64::from((1_u32 << p.bits) - 1) - p.black_level_dn) / p.gain_dn_e;
    if range_e < p.full_well_e {
        (Verdict::Guarded, format!("{clips}; the converter's range ends before, at {range_e:.0} e⁻"))
    } else {
        (Verdict::Guarded, clips)
    }
}

/// Full well, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FullWell {
    capacity_e: f64,
}

impl FullWell {
    pub(super) fn new(p: &SensorParameters) -> Self {
        Self { capacity_e: p.full_well_e }
    }

    /// Clips, where a pixel of the row needs it.
    pub(super) fn apply(&self, electrons: &mut [f64]) {
        if electrons.iter().any(|e| *e > self.capacity_e) {
            electrons.iter_mut().for_each(|e| *e = e.min(self.capacity_e));
        }
    }
}
