//! Blooming of a CMOS sensor: charge overflows in all directions.
//!
//! In every round each pixel keeps at most its well. Of the excess the drain takes 1 − b, and b goes to the eight neighbours, 1/5 to each adjacent
//! and 1/20 to each diagonal one (the weights of the most isotropic nine-point Laplacian, Patra and Karttunen 2006). Rounds continue until the excess
//! is below a thousandth of an electron in every pixel; a geometric series, as b < 1. That remainder is clipped. Charge that passes the array's edge
//! is lost.

use std::ops::Range;

use etendue_core::{Plane, quantity::Charge};
use rayon::prelude::*;

use crate::signal_breakdown::ChargeAccount;

const SIDE_FRACTION: f32 = 0.2;
const CORNER_FRACTION: f32 = 0.05;
/// Excess that is clipped rather than moved, e⁻ per pixel.
const MIN_EXCESS_E: f32 = 1e-3;
/// Larger charges count as this value, so that sums of neighbours stay finite.
const MAX_E: f32 = 1e38;

pub(super) fn apply(plane: &mut Plane<Charge>, well: f32, overflow_fraction: f64, account: &mut ChargeAccount) {
    let (width, height) = (plane.width(), plane.height());
    let mut excess = vec![0.0_f32; plane.samples().len()];
    let mut next = excess.clone();
    let mut rows = 0..height;
    let own = |_, charge: &mut [f32], excess: &mut [f32]| {
        charge.iter_mut().zip(excess).for_each(|(q, e)| {
            let own = std::mem::take(q).min(MAX_E);
            *e = add_up_to_well(q, own, well);
        });
    };
    let mut tally = distribute(plane.samples_mut(), &mut excess, width, &rows, own);
    while tally.largest > MIN_EXCESS_E {
        account.drained_e += (1.0 - overflow_fraction) * tally.sum;
        account.spilt_e += overflow_fraction * charge_lost_at_edges(&excess, width, height);
        let before = std::mem::replace(&mut rows, widened(&tally.rows, height));
        // Remainders of earlier rounds lie in the rows of the previous round.
        next[width * before.start..width * before.end].fill(0.0);
        let row_of = |y: usize| excess.get(y * width..(y + 1) * width);
        let of_neighbours = |y: usize, charge: &mut [f32], rest: &mut [f32]| {
            let row = row_of(y).unwrap_or_default();
            let gained = gained(y.checked_sub(1).and_then(row_of), row, row_of(y + 1));
            let pixels = charge.iter_mut().zip(rest).zip(gained);
            pixels.for_each(|((q, e), gained)| *e = add_up_to_well(q, overflow_fraction as f32 * gained, well));
        };
        tally = distribute(plane.samples_mut(), &mut next, width, &rows, of_neighbours);
        std::mem::swap(&mut excess, &mut next);
    }
    account.clipped_e += tally.sum;
}

/// Adds charge to a pixel up to its well; returns the excess. The excess is not computed as a difference of sums with the well: rounding in the last
/// digits of a full well would keep the rounds from ending.
fn add_up_to_well(charge: &mut f32, added: f32, well: f32) -> f32 {
    let room = well - *charge;
    *charge = if added < room { (*charge + added).min(well) } else { well };
    (added - room).max(0.0)
}

/// The excess after a round.
struct ExcessTally {
    sum: f64,
    largest: f32,
    /// The rows with an excess.
    rows: Range<usize>,
}

/// Distributes charge to all pixels of rows: `give` receives the index, the charge and the excess of each row.
fn distribute(
    charge: &mut [f32],
    excess: &mut [f32],
    width: usize,
    rows: &Range<usize>,
    give: impl Fn(usize, &mut [f32], &mut [f32]) + Sync,
) -> ExcessTally {
    let part = rows.start * width..rows.end * width;
    let charge = charge[part.clone()].par_chunks_mut(width);
    let of_row = |(i, (charge, excess)): (usize, (&mut [f32], &mut [f32]))| {
        give(rows.start + i, charge, excess);
        (excess.iter().map(|e| f64::from(*e)).sum::<f64>(), excess.iter().copied().fold(0.0, f32::max))
    };
    let sums: Vec<(f64, f32)> = charge.zip(excess[part].par_chunks_mut(width)).enumerate().map(of_row).collect();
    let first = sums.iter().position(|(sum, _)| *sum > 0.0).unwrap_or(0);
    let last = sums.iter().rposition(|(sum, _)| *sum > 0.0).map_or(first, |i| i + 1);
    ExcessTally {
        sum: sums.iter().map(|(sum, _)| sum).sum(),
        largest: sums.iter().map(|(_, largest)| *largest).fold(0.0, f32::max),
        rows: rows.start + first..rows.start + last,
    }
}

fn widened(rows: &Range<usize>, height: usize) -> Range<usize> {
    rows.start.saturating_sub(1)..(rows.end + 1).min(height)
}

/// Charge that each pixel of the middle row receives from the excess of its eight neighbours.
fn gained(above: Option<&[f32]>, row: &[f32], below: Option<&[f32]>) -> Vec<f32> {
    let mut gained = vec![0.0; row.len()];
    let mut to_sides: Vec<f32> = row.iter().map(|e| SIDE_FRACTION * e).collect();
    for near in [above, below].into_iter().flatten() {
        for ((gained, to_sides), e) in gained.iter_mut().zip(&mut to_sides).zip(near) {
            *gained += SIDE_FRACTION * e;
            *to_sides += CORNER_FRACTION * e;
        }
    }
    gained.iter_mut().skip(1).zip(&to_sides).for_each(|(gained, left)| *gained += left);
    gained.iter_mut().zip(&to_sides[1..]).for_each(|(gained, right)| *gained += right);
    gained
}

/// Charge that pixels at the edges lose to absent neighbours.
fn charge_lost_at_edges(excess: &[f32], width: usize, height: usize) -> f64 {
    let weight = |x: usize, y: usize| {
        let columns = [x > 0, true, x + 1 < width];
        let rows = [y > 0, true, y + 1 < height];
        let mut lost = 0.0;
        for (j, row) in rows.into_iter().enumerate() {
            for (i, column) in columns.into_iter().enumerate() {
                let weight = [CORNER_FRACTION, SIDE_FRACTION, if i == 1 { 0.0 } else { SIDE_FRACTION }];
                let kind = usize::from(i == 1 || j == 1) + usize::from(i == 1 && j == 1);
                lost += if row && column { 0.0 } else { weight[kind] };
            }
        }
        f64::from(lost)
    };
    let at = |x: usize, y: usize| match excess[y * width + x] {
        0.0 => 0.0,
        e => f64::from(e) * weight(x, y),
    };
    let ends = |n: usize| if n > 1 { vec![0, n - 1] } else { vec![0] };
    let top_and_bottom: f64 = ends(height).into_iter().map(|y| (0..width).map(|x| at(x, y)).sum::<f64>()).sum();
    let between = 1..height.saturating_sub(1).max(1);
    let sides: f64 = ends(width).into_iter().map(|x| between.clone().map(|y| at(x, y)).sum::<f64>()).sum();
    top_and_bottom + sides
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal_breakdown::tests::accounted;

    fn bloomed(plane: &Plane<Charge>, well: f32, overflow_fraction: f64) -> (Plane<Charge>, ChargeAccount) {
        accounted(plane, |out, account| apply(out, well, overflow_fraction, account))
    }

    #[test]
    fn a_point_s_first_round() {
        let mut plane = Plane::new(7, 7);
        plane.set(3, 3, 1100.0);
        let (out, account) = bloomed(&plane, 1000.0, 0.5);
        assert_eq!((out.at(3, 3), out.at(2, 3), out.at(2, 2), out.at(1, 3)), (1000.0, 10.0, 2.5, 0.0));
        assert!((account.drained_e - 50.0).abs() < 1e-9 && account.spilt_e == 0.0);
    }

    #[test]
    fn laws_of_charge() {
        for seed in 0..24_u32 {
            let (width, height) = [(1, 1), (1, 9), (9, 1), (13, 11), (2, 2), (24, 17)][seed as usize % 6];
            let value = |i: usize| {
                let r = (i as u32 + 1).wrapping_mul(2_654_435_761).wrapping_add(seed.wrapping_mul(97_531)) >> 16;
                if r.is_multiple_of(13) { 1e4 * (r % 97) as f32 } else { (r % 1000) as f32 }
            };
            let plane = Plane::from_samples(width, height, (0..width * height).map(value).collect()).expect("filled");
            let overflow_fraction = [0.2, 0.6, 0.95][seed as usize % 3];
            let (out, account) = bloomed(&plane, 1000.0, overflow_fraction);
            assert!(out.samples().iter().all(|q| (0.0..=1000.0).contains(q)), "the well is never exceeded");
            // Each round rounds sums of up to 1e6 e⁻ a pixel to 24 bits.
            assert!(account.imbalance_e().abs() <= 1e-5 * account.generated_e + 1e-2, "{seed}: {account:?}");
            assert!(account.drained_e >= 0.0 && account.spilt_e >= 0.0);
            assert!(account.clipped_e <= 1e-3 * (width * height) as f64);
        }
    }

    #[test]
    fn a_wide_light_ends_after_the_rounds_of_its_series() {
        // 0.95ⁿ · 1e5 e⁻ is a thousandth of an electron after 360 rounds. A well of 1e5 e⁻ has a last digit of about a hundredth: rounded together
        // with it, the excess of a uniform image would stop decreasing.
        let plane = Plane::filled(300, 200, 2e5);
        let (out, account) = bloomed(&plane, 1e5, 0.95);
        assert!(out.samples().iter().all(|q| *q == 1e5));
        // Rounds of f32, each of half a unit of the last of 24 bits at most.
        assert!(account.imbalance_e().abs() < 1e-7 * account.generated_e, "{account:?}");
        assert!(account.clipped_e <= 1e-3 * 60_000.0 && account.spilt_e > 0.0, "{account:?}");
    }

    #[test]
    fn charge_without_end_comes_to_an_end() {
        let mut plane = Plane::new(9, 9);
        plane.set(4, 4, f32::INFINITY);
        assert!(bloomed(&plane, 100.0, 0.5).0.samples().iter().all(|q| *q == 100.0));
    }

    #[test]
    fn a_point_spreads_alike_to_all_sides() {
        let mut plane = Plane::new(41, 41);
        plane.set(20, 20, 1e6);
        let (out, _) = bloomed(&plane, 1000.0, 0.9);
        for (x, y) in [(7, 3), (12, 0), (5, 5)] {
            let q = out.at(20 + x, 20 + y);
            let turned =
                [out.at(20 - x, 20 + y), out.at(20 + x, 20 - y), out.at(20 + y, 20 + x), out.at(20 - y, 20 - x)];
            // Sums of f32 in different orders.
            assert!(turned.iter().all(|t| (t - q).abs() <= 1e-3 * q.max(1.0)), "{turned:?} {q}");
        }
        // The reach along the axis equals that along the diagonal: a disc, to within a pixel or two.
        let reach =
            |dx: usize, dy: usize| (0..20).find(|k| out.at(20 + k * dx, 20 + k * dy) < 500.0).expect("it ends") as f64;
        assert!((reach(1, 0) / (reach(1, 1) * 2.0_f64.sqrt()) - 1.0).abs() < 0.15);
    }
}
