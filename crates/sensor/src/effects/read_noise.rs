//! Read noise: what the read-out chain adds, stated in electrons at the input of the converter.
//!
//! e ← e + d, d normal with a white, a row and a column part, new in every capture; the result may be negative, which the black
//! level takes up. Draws: `Read` of the pixel, `RowRead`, `ColumnRead`.
//! Left out: spread of σ over pixels (see [`rts_noise`](super::rts_noise) for its tail), correlation along a row (1/f).

use super::{NOISE_OFF, Verdict};
use crate::check::Checks;
use crate::operation::{Context, Operation};
use crate::parameters::SensorParameters;
use crate::random::pattern::{Deviations, Sigmas};
use etendue_core::random::NoiseDraw;

/// Standard deviations, e⁻.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadNoise {
    /// From pixel to pixel.
    pub white_e: f64,
    /// Common to a row.
    pub row_e: f64,
    /// Common to a column.
    pub column_e: f64,
}

impl ReadNoise {
    pub(crate) fn check(&self, checks: &mut Checks) {
        checks.not_negative("read_noise_e", self.white_e);
        checks.not_negative("row_noise_e", self.row_e);
        checks.not_negative("column_noise_e", self.column_e);
    }

    fn sigmas(&self, operation: &Operation) -> Sigmas {
        Sigmas { white: operation.read_noise_e, row: self.row_e, column: self.column_e }
    }
}

pub(super) fn need(p: &SensorParameters, operation: &Operation) -> (Verdict, String) {
    let noise = p.read_out.noise;
    if noise.sigmas(operation).is_zero() {
        (Verdict::Skipped, "the read noise is 0 e⁻".into())
    } else if p.noise {
        let part = |name, e: f64| if e > 0.0 { format!(", {e} e⁻ common to a {name}") } else { String::new() };
        let shared = part("row", noise.row_e) + &part("column", noise.column_e);
        (Verdict::Required, format!("{} e⁻ of standard deviation, normal{shared}", operation.read_noise_e))
    } else {
        (Verdict::Skipped, NOISE_OFF.into())
    }
}

/// Read noise, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PreparedReadNoise {
    deviations: Deviations,
}

impl PreparedReadNoise {
    pub(crate) fn new(context: &Context<'_>) -> Self {
        let draws = [NoiseDraw::Read, NoiseDraw::RowRead, NoiseDraw::ColumnRead];
        let sigmas = context.p.read_out.noise.sigmas(&context.operation);
        Self { deviations: Deviations::new(sigmas, draws, |draw| context.noise(draw), context.width) }
    }

    /// Adds normal noise.
    pub(crate) fn apply(&self, electrons: &mut [f64], y: u32) {
        self.deviations.of_row(y, electrons.len(), |x, d| electrons[x] += d);
    }
}
