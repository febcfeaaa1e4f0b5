//! Blooming of a CCD: charge overflows along its column.
//!
//! A pixel above its well passes half of the overflow upwards and half downwards. Each half moves to the next pixel that is not full, fills it and
//! moves on. At every full pixel, including its origin, the drain takes the fraction 1 − b of the passing charge (b = 1: a CCD without
//! anti-blooming). Charge that passes the first or last row leaves the array.
//!
//! Two streams that meet compete for the same pixels. The upward charge is moved first in one solution and last in another, and the result is their
//! mean: it conserves charge and respects the well as each of them does, and treats both directions equally. (Overflow along the column: the
//! charge-coupled model of the e2v and Kodak application notes.)

use etendue_core::{Plane, quantity::Charge};
use rayon::prelude::*;

use crate::signal_breakdown::ChargeAccount;

pub(super) fn apply(plane: &mut Plane<Charge>, well: f32, overflow_fraction: f64, account: &mut ChargeAccount) {
    let (width, height) = (plane.width(), plane.height());
    let samples = plane.samples();
    let column = |x: usize| (0..height).map(move |y| samples[y * width + x]);
    let full: Vec<usize> = (0..width).into_par_iter().filter(|x| column(*x).any(|q| q > well)).collect();
    let solved: Vec<OverflowColumn> = full
        .par_iter()
        .map(|x| solve(column(*x).map(f64::from).collect(), f64::from(well), overflow_fraction))
        .collect();
    for (x, column) in full.into_iter().zip(solved) {
        for (y, q) in column.charge.into_iter().enumerate() {
            plane.samples_mut()[y * width + x] = (q as f32).min(well);
        }
        account.drained_e += column.drained;
        account.spilt_e += column.spilt;
    }
}

/// A column after overflow, and the charge that left it.
#[derive(Clone, Debug, Default, PartialEq)]
struct OverflowColumn {
    charge: Vec<f64>,
    drained: f64,
    spilt: f64,
}

/// Both directions treated equally.
fn solve(charge: Vec<f64>, well: f64, overflow_fraction: f64) -> OverflowColumn {
    let excess: Vec<f64> = charge.iter().map(|q| (q - well).max(0.0)).collect();
    let start = || {
        let drained = excess.iter().sum::<f64>() * (1.0 - overflow_fraction);
        OverflowColumn { charge: charge.iter().map(|q| q.min(well)).collect(), drained, spilt: 0.0 }
    };
    let halves: Vec<f64> = excess.iter().map(|e| 0.5 * overflow_fraction * e).collect();
    let height = charge.len();
    let (mut a, mut b) = (start(), start());
    a.stream((0..height).rev(), &halves, well, overflow_fraction);
    a.stream(0..height, &halves, well, overflow_fraction);
    b.stream(0..height, &halves, well, overflow_fraction);
    b.stream((0..height).rev(), &halves, well, overflow_fraction);
    let mean = |p: f64, q: f64| 0.5 * (p + q);
    OverflowColumn {
        charge: a.charge.iter().zip(&b.charge).map(|(p, q)| mean(*p, *q)).collect(),
        drained: mean(a.drained, b.drained),
        spilt: mean(a.spilt, b.spilt),
    }
}

impl OverflowColumn {
    /// Moves the halves of all pixels in one direction, in the order of `rows`.
    fn stream(&mut self, rows: impl Iterator<Item = usize>, halves: &[f64], well: f64, overflow_fraction: f64) {
        let mut carried = 0.0;
        for y in rows {
            let held = (well - self.charge[y]).clamp(0.0, carried);
            self.charge[y] += held;
            let excess = carried - held;
            self.drained += (1.0 - overflow_fraction) * excess;
            carried = overflow_fraction * excess + halves[y];
        }
        self.spilt += carried;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal_breakdown::tests::accounted;

    fn bloomed(plane: &Plane<Charge>, well: f32, overflow_fraction: f64) -> (Plane<Charge>, ChargeAccount) {
        accounted(plane, |out, account| apply(out, well, overflow_fraction, account))
    }

    #[test]
    fn a_point_fills_its_column_half_up_and_half_down() {
        let mut plane = Plane::new(3, 21);
        plane.set(1, 10, 700.0);
        let (out, account) = bloomed(&plane, 100.0, 1.0);
        for y in 0..21 {
            assert_eq!(out.at(1, y), if (7..=13).contains(&y) { 100.0 } else { 0.0 });
            assert_eq!((out.at(0, y), out.at(2, y)), (0.0, 0.0));
        }
        assert_eq!((account.drained_e, account.spilt_e, account.imbalance_e()), (0.0, 0.0, 0.0));
    }

    #[test]
    fn drains_take_their_part_at_every_full_pixel() {
        // Excess 800: half is drained, 200 go each way; 100 fill a pixel, of the other 100 half is drained, 50 go on.
        let mut plane = Plane::new(1, 9);
        plane.set(0, 4, 900.0);
        let (out, account) = bloomed(&plane, 100.0, 0.5);
        let column: Vec<f32> = (0..9).map(|y| out.at(0, y)).collect();
        assert_eq!(column, [0.0, 0.0, 50.0, 100.0, 100.0, 100.0, 50.0, 0.0, 0.0]);
        assert_eq!((account.drained_e, account.spilt_e), (400.0 + 2.0 * 50.0, 0.0));
    }

    #[test]
    fn laws_of_charge() {
        for seed in 0..40_u32 {
            let value = |i: usize| {
                let r = (i as u32 + 1).wrapping_mul(2_654_435_761).wrapping_add(seed.wrapping_mul(97_531)) >> 16;
                if r.is_multiple_of(11) { 1e4 * (r % 97) as f32 } else { (r % 1000) as f32 }
            };
            let plane = Plane::from_samples(5, 33, (0..165).map(value).collect()).expect("filled");
            let overflow_fraction = [1.0, 0.9, 0.3][seed as usize % 3];
            let (out, account) = bloomed(&plane, 1000.0, overflow_fraction);
            assert!(out.samples().iter().all(|q| (0.0..=1000.0).contains(q)), "the well is never exceeded");
            // f32 samples of at most 1000 e⁻, 165 of them.
            assert!(account.imbalance_e().abs() < 165.0 * 3.1e-5, "{seed}: {account:?}");
            assert!(account.drained_e >= 0.0 && account.spilt_e >= 0.0 && account.clipped_e == 0.0);
            let sums = |p: &Plane<Charge>, x: usize| (0..33).map(|y| f64::from(p.at(x, y))).sum::<f64>();
            for x in 0..5 {
                assert!(sums(&out, x) <= sums(&plane, x) + 1e-2, "nothing comes from another column");
            }
            // A flipped input gives a flipped result.
            let flip = |p: &Plane<Charge>| {
                let samples = (0..165).map(|i| p.at(i % 5, 32 - i / 5)).collect();
                Plane::from_samples(5, 33, samples).expect("filled")
            };
            assert_eq!(flip(&bloomed(&flip(&plane), 1000.0, overflow_fraction).0), out);
        }
    }

    #[test]
    fn a_column_that_is_full_spills_off_the_array() {
        let (out, account) = bloomed(&Plane::filled(1, 4, 150.0), 100.0, 1.0);
        assert_eq!(out, Plane::filled(1, 4, 100.0));
        assert_eq!((account.spilt_e, account.drained_e), (200.0, 0.0));
    }
}
