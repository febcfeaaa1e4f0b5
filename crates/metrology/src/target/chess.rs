//! Detector of the corners of four squares: ChESS (Bennett & Lasenby 2014).
//!
//! On a ring of 16 pixels of radius 5, I₀ … I₁₅, with M the mean of five pixels at the centre: R = Σₙ₌₀³ |Iₙ + Iₙ₊₈ − Iₙ₊₄ −
//! Iₙ₊₁₂| − Σₙ₌₀⁷ |Iₙ − Iₙ₊₈| − 16 |M − mean of the ring|. A corner of contrast C has R of 6 to 8 C; an edge, a line and a stripe
//! have none. A pixel is a candidate if R is the largest within three pixels and at least a quarter of that of a corner of the
//! ring's own contrast.
//!
//! Refinement of the corner to a hundredth of a pixel:
//!
//! Every edge through the corner q is perpendicular to the image gradient g there, so q minimises Σ w (g · (q − p))² over the
//! pixels p around it (Förstner & Gülch 1987): a linear equation for q, solved repeatedly with the window centred on q until
//! convergence. The window w = (1 − (|p − q|/R)²)² ends smoothly, so that q depends on the image smoothly. The gradient is that
//! of the image blurred by a Gaussian of 1 px: gradients between neighbouring pixels alias at edges sharper than pixels, and
//! shift q by up to a tenth of a pixel. Edges with a radius of curvature ρ shift q by less than R²/(20 ρ).

use glam::{DMat2, DVec2};
use rayon::prelude::*;

use crate::Image;

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

/// Candidates: column and row, in the order of the pixels. `least` is the minimum contrast of a candidate.
pub(super) fn candidates(image: &Image, min_response: f32) -> Vec<[usize; 2]> {
    let (width, height) = (image.width(), image.height());
    if width <= 2 * RING_PX || height <= 2 * RING_PX {
        return Vec::new();
    }
    let rows: Vec<Vec<f32>> = (RING_PX..height - RING_PX).into_par_iter().map(|y| responses(image, y)).collect();
    (0..rows.len()).into_par_iter().flat_map_iter(|r| row_peaks(image, &rows, r, min_response)).collect()
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

fn row_peaks(image: &Image, rows: &[Vec<f32>], r: usize, min_response: f32) -> Vec<[usize; 2]> {
    const MIN_RESPONSE_RATIO: f32 = 2.0;
    const MIN_DISTANCE: usize = 3;
    let row = &rows[r];
    let is_peak = |x: usize| {
        let value = row[x];
        (r.saturating_sub(MIN_DISTANCE)..(r + MIN_DISTANCE + 1).min(rows.len())).all(|s| {
            let (from, to) = (x.saturating_sub(MIN_DISTANCE), (x + MIN_DISTANCE + 1).min(row.len()));
            // The first of equal ones is used.
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
    let peaks = (0..row.len()).filter(|x| {
        row[*x] > MIN_RESPONSE_RATIO * min_response && {
            let contrast = contrast(*x);
            contrast > min_response && row[*x] > MIN_RESPONSE_RATIO * contrast && is_peak(*x)
        }
    });
    peaks.map(|x| [x + RING_PX, r + RING_PX]).collect()
}

/// Refines the corner near `start` (raster coordinates) with the pixels within `radius` px; `None` if there is none within
/// `reach` px, or the window leaves the image.
pub(super) fn refine_corner(image: &Image, start: DVec2, radius: f64, reach: f64) -> Option<DVec2> {
    const STEPS: usize = 30;
    const CONVERGED_PX: f64 = 1e-4;
    let patch = GradientPatch::around(image, start, radius + reach)?;
    let mut at = start;
    for _ in 0..STEPS {
        let next = patch.step(at, radius)?;
        if (next - start).length() > reach {
            return None;
        }
        let moved = (next - at).length();
        at = next;
        if moved < CONVERGED_PX {
            return Some(at);
        }
    }
    // It oscillates within noise: the last position is as good as any.
    Some(at)
}

/// Taps of the Gaussian on each side.
const TAPS: usize = 3;
/// exp(−n²/2), n = 0 … 3, over their sum: 1 + 2 (0.606 53 + 0.135 34 + 0.011 11).
const GAUSSIAN: [f64; TAPS + 1] = [0.399_050_28, 0.242_036_23, 0.054_005_58, 0.004_433_05];

/// The gradient of a square of the image.
struct GradientPatch {
    left: usize,
    top: usize,
    side: usize,
    gradients: Vec<DVec2>,
}

impl GradientPatch {
    /// The pixels within `reach` of a position; `None` if their gradients need pixels outside the image.
    fn around(image: &Image, place: DVec2, reach: f64) -> Option<Self> {
        let margin = TAPS + 1;
        let half = reach.ceil() as usize;
        let first = |c: f64| (c.floor() as usize).checked_sub(half + margin);
        let (left, top) = (first(place.x)?, first(place.y)?);
        let window = 2 * (half + margin) + 1;
        if left + window > image.width() || top + window > image.height() {
            return None;
        }
        let pixel = |x: usize, y: usize| f64::from(image.samples()[(top + y) * image.width() + left + x]);
        let side = window - 2 * TAPS;
        let rows: Vec<f64> = (0..window)
            .flat_map(|y| (0..side).map(move |x| (x, y)))
            .map(|(x, y)| blurred(|n| pixel(x + n, y)))
            .collect();
        let blurred_at = |x: usize, y: usize| blurred(|n| rows[(y + n) * side + x]);
        let smooth: Vec<f64> =
            (0..side).flat_map(|y| (0..side).map(move |x| (x, y))).map(|(x, y)| blurred_at(x, y)).collect();
        let inner = side - 2;
        let at = |x: usize, y: usize| smooth[y * side + x];
        let gradient =
            |(x, y): (usize, usize)| DVec2::new(at(x + 2, y + 1) - at(x, y + 1), at(x + 1, y + 2) - at(x + 1, y)) * 0.5;
        let gradients = (0..inner).flat_map(|y| (0..inner).map(move |x| (x, y))).map(gradient).collect();
        Some(Self { left: left + margin, top: top + margin, side: inner, gradients })
    }

    /// The corner from the window around a position; `None` if only edges of one direction cross the window.
    fn step(&self, at: DVec2, radius: f64) -> Option<DVec2> {
        let origin = DVec2::new(self.left as f64 + 0.5, self.top as f64 + 0.5) - at;
        let (mut a, mut b, mut c, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
        for (i, g) in self.gradients.iter().enumerate() {
            let from = origin + DVec2::new((i % self.side) as f64, (i / self.side) as f64);
            let rest = 1.0 - from.length_squared() / (radius * radius);
            if rest > 0.0 {
                let weight = rest * rest;
                a += weight * g.x * g.x;
                b += weight * g.x * g.y;
                c += weight * g.y * g.y;
                right += weight * g.dot(from) * *g;
            }
        }
        let matrix = DMat2::from_cols(DVec2::new(a, b), DVec2::new(b, c));
        let crossed = matrix.determinant() > 1e-3 * (a + c) * (a + c);
        crossed.then(|| at + matrix.inverse() * right)
    }
}

fn blurred(value: impl Fn(usize) -> f64) -> f64 {
    GAUSSIAN[0] * value(TAPS) + (1..=TAPS).map(|n| GAUSSIAN[n] * (value(TAPS - n) + value(TAPS + n))).sum::<f64>()
}
