//! Dark-signal non-uniformity (DSNU) of the read-out: offsets that are there after no time at all.
//!
//! e ← e + d, d normal with a white, a row and a column part, in electrons (EMVA 1288 release 4). The pattern is the specimen's.
//! Draws: `PixelOffset`, `RowOffset`, `ColumnOffset`. What grows with the exposure is the spread of the
//! [dark current](super::dark_current).

use super::Verdict;
use crate::check::Checks;
use crate::operation::Context;
use crate::parameters::SensorParameters;
use crate::random::pattern::{Deviations, Sigmas};
use etendue_core::random::NoiseDraw;

/// Standard deviations of the offsets, e⁻.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OffsetPattern {
    /// From pixel to pixel.
    pub white_e: f64,
    /// From row to row.
    pub row_e: f64,
    /// From column to column.
    pub column_e: f64,
}

impl OffsetPattern {
    pub(crate) fn check(&self, checks: &mut Checks) {
        checks.not_negative("non_uniformity.dsnu_e", self.white_e);
        checks.not_negative("non_uniformity.dsnu_row_e", self.row_e);
        checks.not_negative("non_uniformity.dsnu_column_e", self.column_e);
    }

    fn sigmas(self) -> Sigmas {
        Sigmas { white: self.white_e, row: self.row_e, column: self.column_e }
    }
}

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    let o = p.pattern.offset;
    if o.sigmas().is_zero() {
        return (Verdict::Skipped, super::NOT_DESCRIBED.into());
    }
    let part = |name, e: f64| if e > 0.0 { format!(", {name} by {e} e⁻") } else { String::new() };
    let parts = [part("pixels", o.white_e), part("rows", o.row_e), part("columns", o.column_e)].concat();
    (Verdict::Required, format!("offsets differ: {}", parts.trim_start_matches(", ")))
}

/// Offset non-uniformity, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Offsets {
    deviations: Deviations,
}

impl Offsets {
    pub(crate) fn new(context: &Context<'_>) -> Self {
        let draws = [NoiseDraw::PixelOffset, NoiseDraw::RowOffset, NoiseDraw::ColumnOffset];
        let sigmas = context.p.pattern.offset.sigmas();
        Self { deviations: Deviations::new(sigmas, draws, |draw| context.pattern(draw), context.width) }
    }

    pub(crate) fn apply(&self, electrons: &mut [f64], y: u32) {
        self.deviations.of_row(y, electrons.len(), |x, d| electrons[x] += d);
    }
}
