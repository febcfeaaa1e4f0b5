//! Deviations that are added to voltages: what the offset pattern and read noise have in common.

use crate::effect::{Row, RowEffect};
use crate::random::pattern::Deviations;
use etendue_core::quantity::Voltage;

/// Voltages that differ by deviations, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct VoltageDeviations(pub(super) Deviations);

impl RowEffect<Voltage> for VoltageDeviations {
    fn apply(&self, row: &mut Row<'_, Voltage>) {
        let voltages = &mut *row.values;
        self.0.of_row(row.y, voltages.len(), |x, d| voltages[x] += d);
    }
}
