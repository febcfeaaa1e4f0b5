//! Full well: the maximum charge of a pixel, and the overflow above it.
//!
//! Without blooming e ← min(e, capacity), and the rest is lost. With it, a fraction b of the excess goes on to the neighbours and 1 − b is taken by
//! the overflow drain, repeatedly until no pixel exceeds its well:
//!
//! - along the column, half up and half down (`bloom_column`): a CCD (channel stops block sideways flow);
//! - in all directions (`bloom_around`): a CMOS sensor.
//!
//! generated = collected + drained + spilt at the edge + clipped ([`ChargeAccount`]).
//! Left out: the bend of the response before the well is full (see [`response`](super::response)).

use etendue_core::{EffectStatus, KeyChange, Plane, quantity::Charge};
use rayon::prelude::*;

use super::{bloom_around, bloom_column};
use crate::effect::{
    Action, Context, Effect, Memory, PlaneEffect, QuantityEffect, Row, RowEffect, SensorFacts, Traces,
};
use crate::signal_breakdown::{ChargeAccount, RowTally, SignalComponent};
use crate::{capture::Operation, check::Checks};

/// The maximum charge of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FullWell {
    /// Electrons that a pixel can hold, above 0; captures may have their own.
    pub capacity_e: f64,
    /// Blooming of the excess charge; `None`: it is lost.
    pub blooming: Option<Blooming>,
}

/// Direction of the overflow above the full well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blooming {
    /// Along the column (CCD).
    Column {
        /// Fraction passed on, above 0 and up to 1; the rest is drained.
        overflow_fraction: f64,
    },
    /// In all directions (CMOS).
    Around {
        /// Fraction passed on, above 0 and up to 0.95; the rest is drained.
        overflow_fraction: f64,
    },
}

impl Blooming {
    fn check(&self, checks: &mut Checks) {
        match *self {
            Self::Column { overflow_fraction } => {
                checks.fraction_above_0("blooming.overflow_fraction", overflow_fraction);
            }
            // Without a drain, the charge of an extended light would spread without limit.
            Self::Around { overflow_fraction } => {
                checks.legal(
                    "blooming.overflow_fraction",
                    overflow_fraction,
                    overflow_fraction > 0.0 && overflow_fraction <= 0.95,
                    "a fraction above 0 and up to 0.95",
                );
            }
        }
    }
}

impl Effect for FullWell {
    const NAME: &'static str = "full well";
    const KEY: &'static str = "sensor.full_well_e";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        checks.positive("full_well_e", self.capacity_e);
        if let Some(blooming) = &self.blooming {
            blooming.check(checks);
        }
    }

    fn status(&self, facts: &SensorFacts, operation: &Operation) -> EffectStatus {
        let capacity = operation.full_well_e;
        let clips = match self.blooming {
            None => format!("a pixel saturates at {capacity} e⁻"),
            Some(Blooming::Column { overflow_fraction: b }) => {
                format!("of the charge above {capacity} e⁻, {b} overflows along the column, the rest is drained")
            }
            Some(Blooming::Around { overflow_fraction: b }) => {
                format!("of the charge above {capacity} e⁻, {b} overflows to all sides, the rest is drained")
            }
        };
        let range_e = facts.converter_range_dn / operation.gain_dn_e;
        if range_e < capacity {
            EffectStatus::WhereNeeded(format!("{clips}; the ADC's range ends earlier, at {range_e:.0} e⁻"))
        } else {
            EffectStatus::WhereNeeded(clips)
        }
    }

    /// A sensor always has a full well.
    fn left_out_by(&self) -> Vec<KeyChange> {
        Vec::new()
    }
}

impl QuantityEffect for FullWell {
    type Signal = Charge;
    const COMPONENT: SignalComponent = SignalComponent::Blooming;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<Charge> {
        let capacity_e = context.operation.full_well_e;
        match self.blooming {
            None => Action::rows(PreparedClipping { capacity_e }),
            Some(blooming) => Action::plane(PreparedOverflow { blooming, capacity_e }),
        }
    }
}

/// Full well without blooming, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PreparedClipping {
    capacity_e: f64,
}

impl RowEffect<Charge> for PreparedClipping {
    /// Clips the pixels of the row that need it, and records the row's charge.
    fn apply(&self, row: &mut Row<'_, Charge>) {
        let electrons = &mut *row.values;
        let generated_e = row_sum(electrons);
        let mut tally = RowTally { generated_e, collected_e: generated_e, clipped_e: 0.0 };
        if electrons.iter().any(|e| *e > self.capacity_e) {
            tally.clipped_e = electrons.iter().map(|e| (e - self.capacity_e).max(0.0)).sum();
            electrons.iter_mut().for_each(|e| *e = e.min(self.capacity_e));
            tally.collected_e = row_sum(electrons);
        }
        *row.tally = Some(tally);
    }
}

/// Sum of a row in eight partial sums of fixed order.
fn row_sum(electrons: &[f64]) -> f64 {
    let (strands, rest) = electrons.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for strand in strands {
        sums.iter_mut().zip(strand).for_each(|(sum, e)| *sum += e);
    }
    sums.iter().chain(rest).sum()
}

/// Full well with blooming, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PreparedOverflow {
    blooming: Blooming,
    capacity_e: f64,
}

impl PlaneEffect<Charge> for PreparedOverflow {
    fn apply(&self, mut plane: Plane<Charge>, traces: &mut Traces<'_>) -> Plane<Charge> {
        *traces.account = Some(self.spread(&mut plane));
        plane
    }
}

impl PreparedOverflow {
    /// Moves the charge above the well.
    fn spread(&self, plane: &mut Plane<Charge>) -> ChargeAccount {
        let generated_e = sum(plane);
        // The well in the precision of the plane.
        let well = self.capacity_e as f32;
        let mut account = ChargeAccount { generated_e, ..ChargeAccount::default() };
        if plane.samples().par_iter().any(|q| *q > well) {
            match self.blooming {
                Blooming::Column { overflow_fraction } => {
                    bloom_column::apply(plane, well, overflow_fraction, &mut account);
                }
                Blooming::Around { overflow_fraction } => {
                    bloom_around::apply(plane, well, overflow_fraction, &mut account);
                }
            }
        }
        account.collected_e = sum(plane);
        account
    }
}

/// Sum of a plane, rows first, so that it does not depend on threads.
fn sum(plane: &Plane<Charge>) -> f64 {
    let rows = plane.samples().par_chunks(plane.width().max(1));
    let sums: Vec<f64> = rows.map(|row| row.iter().map(|q| f64::from(*q)).sum()).collect();
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use crate::frame::tests::{ADDRESS, quiet, run};
    use etendue_core::Plane;

    /// 10 × 3 pixels of 500 e⁻, one of them with 5000, in wells of 2000: computed by hand, to rounding.
    #[test]
    fn what_a_full_well_loses_is_accounted() {
        let mut p = quiet();
        p.charge.full_well.capacity_e = 2000.0;
        let mut means = Plane::filled(10, 3, 500.0);
        means.set(7, 1, 5000.0);
        let [(0, account)] = run(&p, &means, ADDRESS).accounts[..] else { panic!("one capture, one account") };
        assert_eq!(account.generated_e, 29.0 * 500.0 + 5000.0);
        assert_eq!(account.collected_e, 29.0 * 500.0 + 2000.0);
        assert_eq!([account.clipped_e, account.drained_e, account.spilt_e], [3000.0, 0.0, 0.0]);
        assert_eq!(account.imbalance_e(), 0.0);
    }
}
