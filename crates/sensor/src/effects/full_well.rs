//! Full well: the most electrons a pixel holds, and where the rest goes.
//!
//! Without blooming e ← min(e, capacity), and the rest is lost. With it, a share b of what a pixel cannot hold goes on to its
//! neighbours and 1 − b is taken by the overflow drain, again and again until every pixel holds what it has:
//!
//! - along the column, half up and half down ([`bloom_column`]): a CCD, whose channel stops block sideways;
//! - to all sides ([`bloom_around`]): a CMOS sensor.
//!
//! generated = collected + drained + spilt off the edge + clipped ([`ChargeAccount`]).
//! Left out: the bend of the response before the well is full (see [`response`](super::response)).

use super::Verdict;
use super::{bloom_around, bloom_column};
use crate::account::{ChargeAccount, RowTally};
use crate::check::Checks;
use crate::operation::{Context, Operation};
use crate::parameters::SensorParameters;
use etendue_core::Plane;
use etendue_core::quantity::Electrons;
use rayon::prelude::*;

/// Where charge above the full well goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blooming {
    /// Along the column (CCD).
    Column {
        /// Share that goes on; the rest is drained.
        overflow_fraction: f64,
    },
    /// To all sides (CMOS).
    Around {
        /// Share that goes on; the rest is drained.
        overflow_fraction: f64,
    },
}

impl Blooming {
    pub(crate) fn check(&self, checks: &mut Checks) {
        match *self {
            Self::Column { overflow_fraction } => checks.share_above_0("blooming.overflow_fraction", overflow_fraction),
            // Without any drain, charge of a wide light would spread without end.
            Self::Around { overflow_fraction } => {
                checks.legal(
                    "blooming.overflow_fraction",
                    overflow_fraction,
                    overflow_fraction > 0.0 && overflow_fraction <= 0.95,
                    "a share above 0 and up to 0.95",
                );
            }
        }
    }
}

pub(super) fn need(p: &SensorParameters, operation: &Operation) -> (Verdict, String) {
    let capacity = operation.full_well_e;
    let clips = match p.charge.blooming {
        None => format!("a pixel's charge above {capacity} e⁻ is lost"),
        Some(Blooming::Column { overflow_fraction }) => {
            format!("of what exceeds {capacity} e⁻, {overflow_fraction} goes on along the column, the rest is drained")
        }
        Some(Blooming::Around { overflow_fraction }) => {
            format!("of what exceeds {capacity} e⁻, {overflow_fraction} goes on to all sides, the rest is drained")
        }
    };
    let range_e = (p.largest_dn() - p.read_out.black_level_dn) / operation.gain_dn_e;
    if range_e < capacity {
        (Verdict::Guarded, format!("{clips}; the converter's range ends before, at {range_e:.0} e⁻"))
    } else {
        (Verdict::Guarded, clips)
    }
}

/// Full well without blooming, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clip {
    capacity_e: f64,
}

impl Clip {
    pub(crate) fn new(context: &Context<'_>) -> Self {
        Self { capacity_e: context.operation.full_well_e }
    }

    /// Clips, where a pixel of the row needs it, and notes the row's charge.
    pub(crate) fn apply(&self, electrons: &mut [f64], tally: &mut RowTally) {
        let generated_e = row_sum(electrons);
        *tally = RowTally { generated_e, collected_e: generated_e, clipped_e: 0.0 };
        if electrons.iter().any(|e| *e > self.capacity_e) {
            tally.clipped_e = electrons.iter().map(|e| (e - self.capacity_e).max(0.0)).sum();
            electrons.iter_mut().for_each(|e| *e = e.min(self.capacity_e));
            tally.collected_e = row_sum(electrons);
        }
    }
}

/// Sum of a row in eight strands, which always go the same way.
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
pub(crate) struct Overflow {
    pub(super) blooming: Blooming,
    pub(super) capacity_e: f64,
}

impl Overflow {
    pub(crate) fn new(blooming: Blooming, context: &Context<'_>) -> Self {
        Self { blooming, capacity_e: context.operation.full_well_e }
    }

    /// Moves what pixels cannot hold.
    pub(crate) fn apply(&self, plane: &mut Plane<Electrons>) -> ChargeAccount {
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
fn sum(plane: &Plane<Electrons>) -> f64 {
    let rows = plane.samples().par_chunks(plane.width().max(1));
    let sums: Vec<f64> = rows.map(|row| row.iter().map(|q| f64::from(*q)).sum()).collect();
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use crate::frame::tests::{ADDRESS, quiet, run};
    use etendue_core::Plane;

    /// 10 × 3 pixels of 500 e⁻, one of them with 5000, in wells of 2000: by hand, to rounding.
    #[test]
    fn what_a_full_well_loses_is_accounted() {
        let mut p = quiet();
        p.charge.full_well_e = 2000.0;
        let mut means = Plane::filled(10, 3, 500.0);
        means.set(7, 1, 5000.0);
        let [(0, account)] = run(&p, &means, ADDRESS).accounts[..] else { panic!("one capture, one account") };
        assert_eq!(account.generated_e, 29.0 * 500.0 + 5000.0);
        assert_eq!(account.collected_e, 29.0 * 500.0 + 2000.0);
        assert_eq!([account.clipped_e, account.drained_e, account.spilt_e], [3000.0, 0.0, 0.0]);
        assert_eq!(account.imbalance_e(), 0.0);
    }
}
