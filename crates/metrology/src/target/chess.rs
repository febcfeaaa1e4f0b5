//! Where a picture looks like the corner of four squares: ChESS (Bennett & Lasenby 2014).
//!
//! On a ring of 16 pixels of radius 5, I₀ … I₁₅, with M the mean of five pixels at the middle:
//! R = Σₙ₌₀³ |Iₙ + Iₙ₊₈ − Iₙ₊₄ − Iₙ₊₁₂| − Σₙ₌₀⁷ |Iₙ − Iₙ₊₈| − 16 |M − mean of the ring|.
//! A corner of contrast C has R of 6 to 8 C; an edge, a line and a stripe have none. A pixel is a candidate where R is
//! the largest within three pixels and at least a quarter of what a corner of the ring's own contrast would have.

use crate::Image;
use rayon::prelude::*;

/// Radius of the ring, px.
pub(super) const RING_PX: usize = 5;

const RING: [[isize; 2]; 16] = [
    [0, -5],
    [2, -5],
    [3, -3],
    [5, -2],
    [5, 0],
    [5, 2],
    [3, 3],
    [2, 5],
    [0, 5],
    [-2, 5],
    [-3, 3],
    [-5, 2],
    [-5, 0],
    [-5, -2],
    [-3, -3],
    [-2, -5],
];

/// Candidates: column and row, in the order of the pixels. `least` is the contrast below which nothing is one.
pub(super) fn candidates(image: &Image, least: f32) -> Vec<[usize; 2]> {
    let (width, height) = (image.width(), image.height());
    if width <= 2 * RING_PX || height <= 2 * RING_PX {
        return Vec::new();
    }
    let rows: Vec<Vec<f32>> = (RING_PX..height - RING_PX).into_par_iter().map(|y| responses(image, y)).collect();
    (0..rows.len()).into_par_iter().flat_map_iter(|r| row_peaks(image, &rows, r, least)).collect()
}

/// R of row y, columns from the ring's radius on.
fn responses(image: &Image, y: usize) -> Vec<f32> {
    let (width, samples) = (image.width(), image.samples());
    let count = width - 2 * RING_PX;
    let from = |dx: isize, dy: isize| {
        let row = (y as isize + dy) as usize * width;
        &samples[row + (RING_PX as isize + dx) as usize..][..count]
    };
    let ring = RING.map(|[dx, dy]| from(dx, dy));
    let mut out = vec![0.0_f32; count];
    for n in 0..4 {
        let pairs = ring[n].iter().zip(ring[n + 8]).zip(ring[n + 4].iter().zip(ring[n + 12]));
        out.iter_mut().zip(pairs).for_each(|(o, ((a, b), (c, d)))| *o += (a + b - c - d).abs());
    }
    for n in 0..8 {
        out.iter_mut().zip(ring[n].iter().zip(ring[n + 8])).for_each(|(o, (a, b))| *o -= (a - b).abs());
    }
    let mut difference = vec![0.0_f32; count];
    for slice in ring {
        difference.iter_mut().zip(slice).for_each(|(d, v)| *d -= v);
    }
    for slice in [from(0, 0), from(-1, 0), from(1, 0), from(0, -1), from(0, 1)] {
        difference.iter_mut().zip(slice).for_each(|(d, v)| *d += 3.2 * v);
    }
    out.iter_mut().zip(&difference).for_each(|(o, d)| *o -= d.abs());
    out
}

fn row_peaks(image: &Image, rows: &[Vec<f32>], r: usize, least: f32) -> Vec<[usize; 2]> {
    const SHARE: f32 = 2.0;
    const APART: usize = 3;
    let row = &rows[r];
    let is_peak = |x: usize| {
        let value = row[x];
        (r.saturating_sub(APART)..(r + APART + 1).min(rows.len())).all(|s| {
            let (from, to) = (x.saturating_sub(APART), (x + APART + 1).min(row.len()));
            // Of equal ones the first is taken.
            (from..to).all(|t| rows[s][t] < value || (rows[s][t] == value && (s, t) >= (r, x)))
        })
    };
    let contrast = |x: usize| {
        let at = |[dx, dy]: [isize; 2]| {
            image.at((x + RING_PX).wrapping_add_signed(dx), (r + RING_PX).wrapping_add_signed(dy))
        };
        let (low, high) =
            RING.iter().map(|d| at(*d)).fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        high - low
    };
    let found = (0..row.len()).filter(|x| {
        row[*x] > SHARE * least && {
            let contrast = contrast(*x);
            contrast > least && row[*x] > SHARE * contrast && is_peak(*x)
        }
    });
    found.map(|x| [x + RING_PX, r + RING_PX]).collect()
}
