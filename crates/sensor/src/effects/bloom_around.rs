//! Blooming of a CMOS sensor: charge overflows to all sides.
//!
//! In every round each pixel keeps at most its well; of what it cannot hold the drain takes 1 − b, and b goes to the eight
//! neighbours, 1/5 to each beside and 1/20 to each across a corner (the weights of the most isotropic Laplacian of nine points,
//! Patra and Karttunen 2006). Rounds go on until less than a thousandth of an electron a pixel is too much anywhere; a geometric
//! series, as b < 1. That rest is clipped. What goes past the array's edge has left it.

use crate::account::ChargeAccount;
use etendue_core::Plane;
use etendue_core::quantity::Electrons;
use rayon::prelude::*;
use std::ops::Range;

const BESIDE: f32 = 0.2;
const CORNER: f32 = 0.05;
/// Excess that is clipped rather than moved, e⁻ a pixel.
const NEGLIGIBLE_E: f32 = 1e-3;

pub(super) fn apply(plane: &mut Plane<Electrons>, well: f32, spill: f64, account: &mut ChargeAccount) {
    let (width, height) = (plane.width(), plane.height());
    let mut excess = vec![0.0_f32; plane.samples().len()];
    let mut next = excess.clone();
    let mut rows = 0..height;
    let mut tally = settle(plane.samples_mut(), &mut excess, width, &rows, well);
    while tally.largest > NEGLIGIBLE_E {
        account.drained_e += (1.0 - spill) * tally.sum;
        account.spilt_e += spill * lost_at_edges(&excess, width, height);
        let before = std::mem::replace(&mut rows, widened(&tally.rows, height));
        spread(plane.samples_mut(), &excess, width, &rows, spill as f32);
        // What is left of earlier rounds lies in rows that the round before settled or cleared.
        next[width * before.start..width * before.end].fill(0.0);
        tally = settle(plane.samples_mut(), &mut next, width, &rows, well);
        std::mem::swap(&mut excess, &mut next);
    }
    account.clipped_e += tally.sum;
}

/// What is too much after a round.
struct Tally {
    sum: f64,
    largest: f32,
    /// The rows that have any.
    rows: Range<usize>,
}

/// Cuts rows at the well; what was above it goes to `excess`.
fn settle(charge: &mut [f32], excess: &mut [f32], width: usize, rows: &Range<usize>, well: f32) -> Tally {
    let part = rows.start * width..rows.end * width;
    let charge = charge[part.clone()].par_chunks_mut(width);
    let of_row = |(charge, excess): (&mut [f32], &mut [f32])| {
        let (mut sum, mut largest) = (0.0, 0.0_f32);
        for (q, e) in charge.iter_mut().zip(excess) {
            *e = (*q - well).max(0.0);
            *q = q.min(well);
            sum += f64::from(*e);
            largest = largest.max(*e);
        }
        (sum, largest)
    };
    let sums: Vec<(f64, f32)> = charge.zip(excess[part].par_chunks_mut(width)).map(of_row).collect();
    let first = sums.iter().position(|(sum, _)| *sum > 0.0).unwrap_or(0);
    let last = sums.iter().rposition(|(sum, _)| *sum > 0.0).map_or(first, |i| i + 1);
    Tally {
        sum: sums.iter().map(|(sum, _)| sum).sum(),
        largest: sums.iter().map(|(_, largest)| *largest).fold(0.0, f32::max),
        rows: rows.start + first..rows.start + last,
    }
}

fn widened(rows: &Range<usize>, height: usize) -> Range<usize> {
    rows.start.saturating_sub(1)..(rows.end + 1).min(height)
}

/// Adds to the pixels of rows what their neighbours give.
fn spread(charge: &mut [f32], excess: &[f32], width: usize, rows: &Range<usize>, spill: f32) {
    let row_of = |y: usize| excess.get(y * width..(y + 1) * width);
    let part = &mut charge[rows.start * width..rows.end * width];
    part.par_chunks_mut(width).enumerate().for_each(|(i, charge)| {
        let y = rows.start + i;
        let near = [y.checked_sub(1).and_then(row_of), row_of(y), row_of(y + 1)];
        for (x, q) in charge.iter_mut().enumerate() {
            *q += spill * gained(near, x);
        }
    });
}

fn gained(near: [Option<&[f32]>; 3], x: usize) -> f32 {
    const WEIGHTS: [(f32, f32); 3] = [(BESIDE, CORNER), (0.0, BESIDE), (BESIDE, CORNER)];
    let mut sum = 0.0;
    for (row, (own, side)) in near.into_iter().zip(WEIGHTS) {
        let Some(row) = row else { continue };
        let left = x.checked_sub(1).map_or(0.0, |i| row[i]);
        let right = row.get(x + 1).copied().unwrap_or(0.0);
        sum += own * row[x] + side * (left + right);
    }
    sum
}

/// What pixels at the edges would give to neighbours that are not there.
fn lost_at_edges(excess: &[f32], width: usize, height: usize) -> f64 {
    let weight = |x: usize, y: usize| {
        let columns = [x > 0, true, x + 1 < width];
        let rows = [y > 0, true, y + 1 < height];
        let mut lost = 0.0;
        for (j, row) in rows.into_iter().enumerate() {
            for (i, column) in columns.into_iter().enumerate() {
                let weight = [CORNER, BESIDE, if i == 1 { 0.0 } else { BESIDE }];
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

    fn bloomed(plane: &Plane<Electrons>, well: f32, spill: f64) -> (Plane<Electrons>, ChargeAccount) {
        let sum = |p: &Plane<Electrons>| p.samples().iter().map(|q| f64::from(*q)).sum::<f64>();
        let mut out = plane.clone();
        let mut account = ChargeAccount { generated_e: sum(plane), ..ChargeAccount::default() };
        apply(&mut out, well, spill, &mut account);
        account.collected_e = sum(&out);
        (out, account)
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
            let spill = [0.2, 0.6, 0.95][seed as usize % 3];
            let (out, account) = bloomed(&plane, 1000.0, spill);
            assert!(out.samples().iter().all(|q| (0.0..=1000.0).contains(q)), "the well is never exceeded");
            // Each round rounds sums of up to 1e6 e⁻ a pixel to 24 bits.
            assert!(account.imbalance_e().abs() <= 1e-5 * account.generated_e + 1e-2, "{seed}: {account:?}");
            assert!(account.drained_e >= 0.0 && account.spilt_e >= 0.0);
            assert!(account.clipped_e <= 1e-3 * (width * height) as f64);
        }
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
        // As far along the axis as along the diagonal: a disc, to within a pixel or two.
        let reach =
            |dx: usize, dy: usize| (0..20).find(|k| out.at(20 + k * dx, 20 + k * dy) < 500.0).expect("it ends") as f64;
        assert!((reach(1, 0) / (reach(1, 1) * 2.0_f64.sqrt()) - 1.0).abs() < 0.15);
    }
}
