//! The splines of an edge's profile, and least squares of edge and profile on the pixels.
//!
//! The splines are B-splines of degree 4 and their integral.

use super::{Edge, SfrError, SfrSettings};
use crate::{Image, linear::Normal};

/// Finest step of the splines, px.
pub(super) const MIN_STEP_PX: f64 = 0.25;
/// Maximum gap between distances. Steps are wider than gaps, as least squares on uniformly clustered distances requires: 0.58
/// pixels at this gap, where a fit of degree 5 at 0.5 cycles per pixel still keeps aliases below (0.29/0.71)⁶ = 0.5 % of the
/// response.
const MAX_GAP_PX: f64 = 0.46;
pub(super) const STEP_OVER_GAP: f64 = 1.25;
/// Default reach of the fine splines, px.
pub(super) const DEFAULT_REACH_PX: f64 = 10.0;
/// Step of the splines beyond, px, and their reach.
const COARSE_STEP_PX: f64 = 2.0;
pub(super) const MAX_PX: f64 = 100.0;
/// Part of the image's nearer side in which the profile may change; the rest is plateau, whose mean determines the response at 0.
const CHANGING_FRACTION: f64 = 0.65;
/// Maximum change in one refinement step, px.
const MAX_MOVE_PX: f64 = 2.0;

/// A pixel: its position in the image, its distance from the edge, its row, and its reading.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub pixel: usize,
    pub distance: f64,
    pub row: f64,
    pub reading: f64,
}

/// Coefficients on which a reading depends, with their weights.
pub(super) struct Row(pub Vec<(usize, f64)>);

impl Row {
    pub(super) fn dot(&self, values: &[f64]) -> f64 {
        self.0.iter().map(|(k, weight)| values[*k] * weight).sum()
    }
}

/// A step of the profile: position, width, and the levels on its two sides.
#[derive(Clone, Copy)]
pub(super) struct Step {
    pub at: f64,
    pub width: f64,
    pub left: usize,
    pub right: usize,
}

/// Positions of the splines.
pub(super) struct Knots {
    pub step_px: f64,
    pub reach_px: f64,
    count: usize,
    coarse: Vec<f64>,
}

impl Knots {
    pub(super) fn new(
        image: &Image,
        edge: &Edge,
        samples: &[Sample],
        settings: &SfrSettings,
    ) -> Result<Self, SfrError> {
        // Both plateaus must be visible beyond the reach, from some row.
        let widest = |sign: f64| samples.iter().map(|s| sign * s.distance).fold(0.0, f64::max) - 1.0;
        let max_reach = widest(1.0).min(widest(-1.0)).min(0.5 * image.width() as f64);
        let reach_px = settings.reach_px.unwrap_or(DEFAULT_REACH_PX).min(max_reach);
        if reach_px < 2.0 {
            return Err(SfrError::NoEdge("the edge is too near the image border"));
        }
        let gap_px = widest_gap(samples, reach_px);
        if gap_px > MAX_GAP_PX {
            return Err(SfrError::Gaps { gap_px, angle_deg: edge.angle_deg() });
        }
        let step_px = (STEP_OVER_GAP * gap_px).max(MIN_STEP_PX);
        let count = (2.0 * reach_px / step_px).floor() as usize + 1 - SUPPORT;
        if count < 2 * SUPPORT {
            return Err(SfrError::NoEdge("the edge is too near the image border"));
        }
        let reach_px = 0.5 * step_px * (count + SUPPORT - 1) as f64;
        Ok(Self { step_px, reach_px, count, coarse: coarse(reach_px, (CHANGING_FRACTION * max_reach).min(MAX_PX)) })
    }

    /// The coefficients of a reading, with their weights. The profile is a sum of levels, each of which extends from one step to
    /// the next: those of the fine splines of degree 5, and on either side those of the coarse steps, outwards; the last extends
    /// without limit.
    fn row(&self, distance: f64) -> Row {
        let u = (distance + self.reach_px) / self.step_px;
        let first = self.first(u);
        let rise = |k: usize| match k {
            0 => 1.0,
            k if k > self.count => 0.0,
            k => step(u - (k - 1) as f64 - 0.5 * SUPPORT as f64),
        };
        let mut terms = Vec::with_capacity(4 * SUPPORT);
        let mut above = rise(first);
        for k in first..=first + SUPPORT {
            let next = rise(k + 1);
            terms.push((k, above - next));
            above = next;
        }
        self.sides()
            .into_iter()
            .for_each(|(sign, end, levels)| self.coarse_terms(sign, end, levels, distance, &mut terms));
        terms.retain(|(_, value)| *value != 0.0);
        Row(terms)
    }

    /// The coarse levels of a side, and the part that the first step takes from the fine splines' end.
    fn coarse_terms(&self, sign: f64, end: usize, levels: usize, distance: f64, terms: &mut Vec<(usize, f64)>) {
        let Some(first) = self.coarse.first() else { return };
        let u = (sign * distance - first) / COARSE_STEP_PX;
        let half = 0.5 * SUPPORT as f64;
        if u <= -half {
            return;
        }
        let height_at = |k: usize| if k < self.coarse.len() { step(u - k as f64) } else { 0.0 };
        let rise = height_at(0);
        match terms.iter_mut().find(|(k, _)| *k == end) {
            Some((_, value)) => *value -= rise,
            None => terms.push((end, -rise)),
        }
        // Steps below this one are complete.
        let from = ((u - half).floor().max(0.0) as usize).min(self.coarse.len() - 1);
        let mut below = height_at(from);
        for k in (from..self.coarse.len()).take(SUPPORT + 2) {
            let next = height_at(k + 1);
            terms.push((levels + k, below - next));
            below = next;
        }
    }

    /// Coefficients of each sample's reading.
    pub(super) fn rows(&self, samples: &[Sample]) -> Vec<Row> {
        samples.iter().map(|sample| self.row(sample.distance)).collect()
    }

    /// Left and right: the sign of distances, the fine splines' last level, and the first coarse one.
    fn sides(&self) -> [(f64, usize, usize); 2] {
        [(-1.0, 0, self.count + 1), (1.0, self.count, self.count + 1 + self.coarse.len())]
    }

    /// Number of coefficients.
    fn unknowns(&self) -> usize {
        self.count + 1 + 2 * self.coarse.len()
    }

    /// The profile's steps, from one level to the next on the right of it.
    pub(super) fn steps(&self) -> Vec<Step> {
        let place = |j: usize| -self.reach_px + (j as f64 + 0.5 * SUPPORT as f64) * self.step_px;
        let fine = (1..=self.count).map(|k| Step { at: place(k - 1), width: self.step_px, left: k - 1, right: k });
        let coarse = self.sides().into_iter().flat_map(|(sign, end, levels)| {
            self.coarse.iter().enumerate().map(move |(k, at)| {
                let (inner, outer) = (if k == 0 { end } else { levels + k - 1 }, levels + k);
                let (left, right) = if sign < 0.0 { (outer, inner) } else { (inner, outer) };
                Step { at: sign * at, width: COARSE_STEP_PX, left, right }
            })
        });
        fine.chain(coarse).collect()
    }

    /// The level that extends outwards from the last step on the left.
    pub(super) fn leftmost(&self) -> usize {
        self.coarse.len().checked_sub(1).map_or(0, |last| self.count + 1 + last)
    }

    fn first(&self, u: f64) -> usize {
        ((u - SUPPORT as f64).ceil().max(0.0) as usize).min(self.count - SUPPORT)
    }

    /// The normal equations of the levels.
    pub(super) fn normal(&self, samples: &[Sample], rows: &[Row]) -> Normal {
        let mut normal = Normal::new(self.unknowns());
        for (sample, row) in samples.iter().zip(rows) {
            let (places, values): (Vec<usize>, Vec<f64>) = row.0.iter().copied().unzip();
            normal.add_at(&places, &values, sample.reading, 1.0);
        }
        normal
    }

    /// Change of the edge's coefficients by one step of Gauss–Newton on edge and profile together. The position of the edge is
    /// degenerate with the profile (a shifted profile is a profile). It is therefore set from the middle of the profile's rise,
    /// which keeps it among the fine splines; if it is far from them, only the edge is shifted.
    pub(super) fn correction(
        &self,
        samples: &[Sample],
        edge: &Edge,
        degree: usize,
    ) -> Result<(f64, Vec<f64>), SfrError> {
        let failed = || SfrError::NoEdge("the edge crosses too few rows");
        let rows = self.rows(samples);
        let levels = self.normal(samples, &rows).solve().ok_or_else(failed)?;
        let mut by = vec![0.0; degree + 1];
        by[0] = self.middle_px(&levels);
        if by[0].abs() > MAX_MOVE_PX {
            return Ok((f64::INFINITY, by));
        }
        let linear = levels.len();
        let mut normal = Normal::new(linear + degree);
        let mut squares = 0.0;
        for (sample, row) in samples.iter().zip(&rows) {
            let (mut places, mut values): (Vec<usize>, Vec<f64>) = row.0.iter().copied().unzip();
            if sample.distance.abs() < self.reach_px {
                let slope = self.slope(sample.distance, &levels);
                places.extend(linear..linear + degree);
                values.extend(edge.sensitivities(sample.row, degree)[1..].iter().map(|s| s * slope));
            }
            let residual = sample.reading - row.dot(&levels);
            squares += residual * residual;
            normal.add_at(&places, &values, residual, 1.0);
        }
        let moves = normal.solve().ok_or_else(failed)?;
        let bounded = |v: &f64| v.clamp(-MAX_MOVE_PX, MAX_MOVE_PX);
        by[1..].iter_mut().zip(moves[linear..].iter().map(bounded)).for_each(|(b, v)| *b = v);
        Ok((squares, by))
    }

    /// Maximum extent of changes of the profile, px.
    fn extent_px(&self) -> f64 {
        self.coarse.last().map_or(self.reach_px, |at| at + COARSE_STEP_PX)
    }

    /// The profile's readings on both sides.
    pub(super) fn plateaus(&self, levels: &[f64]) -> [f64; 2] {
        [-self.extent_px(), self.extent_px()].map(|distance| self.value(distance, levels))
    }

    fn value(&self, distance: f64, levels: &[f64]) -> f64 {
        self.row(distance).dot(levels)
    }

    /// Position of the half-way rise of the profile, from the fraction of it that is nearer to the left plateau; zero below half a
    /// pixel.
    fn middle_px(&self, levels: &[f64]) -> f64 {
        let [left, right] = self.plateaus(levels);
        let (extent, step) = (self.extent_px(), MIN_STEP_PX);
        let count = (2.0 * extent / step).floor() as usize;
        let at = |i: usize| -extent + (i as f64 + 0.5) * step;
        let nearer = |d: &f64| (self.value(*d, levels) - left) / (right - left) < 0.5;
        let middle = (0..count).map(at).filter(nearer).count() as f64 * step - extent;
        if middle.abs() < 0.5 { 0.0 } else { middle }
    }

    fn slope(&self, distance: f64, levels: &[f64]) -> f64 {
        let u = (distance + self.reach_px) / self.step_px;
        let first = self.first(u);
        let term = |j: usize| (levels[j + 1] - levels[j]) * bell(u - j as f64 - 0.5 * SUPPORT as f64);
        (first..first + SUPPORT).map(term).sum::<f64>() / self.step_px
    }
}

/// Positions of the coarse steps beyond the fine splines on either side: those whose support leaves the fine splines' range, so
/// that no coarse step is a sum of fine ones (Kraft 1997), as far as there are pixels.
fn coarse(reach_px: f64, max_px: f64) -> Vec<f64> {
    let first = reach_px - 1.5 * COARSE_STEP_PX;
    (0..).map(|i| first + f64::from(i) * COARSE_STEP_PX).take_while(|at| at + COARSE_STEP_PX <= max_px).collect()
}

/// The widest gap between neighbouring distances within the reach.
fn widest_gap(samples: &[Sample], reach_px: f64) -> f64 {
    let mut distances: Vec<f64> = samples.iter().map(|s| s.distance).filter(|d| d.abs() <= reach_px).collect();
    distances.sort_unstable_by(f64::total_cmp);
    distances.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
}

/// Number of step functions that differ from 0 and 1 at a position: the support of β⁴ in steps.
const SUPPORT: usize = 5;

/// β⁴(u), the cardinal B-spline of degree 4, unit area, zero beyond |u| = 5/2 (Schoenberg 1946).
pub(super) fn bell(u: f64) -> f64 {
    let u = u.abs();
    if u < 0.5 {
        let v = u * u;
        115.0 / 192.0 - 5.0 / 8.0 * v + 0.25 * v * v
    } else if u < 1.5 {
        let v = u * u;
        (55.0 + 20.0 * u - 120.0 * v + 80.0 * v * u - 16.0 * v * v) / 96.0
    } else if u < 2.5 {
        let w = 2.5 - u;
        w * w * w * w / 24.0
    } else {
        0.0
    }
}

/// ∫ β⁴ from −∞ to u: from 0 to 1.
pub(super) fn step(u: f64) -> f64 {
    if u > 0.0 { 1.0 - lower(-u) } else { lower(u) }
}

/// The integral for u ≤ 0.
fn lower(u: f64) -> f64 {
    let a = -u;
    if a >= 2.5 {
        0.0
    } else if a >= 1.5 {
        let w = 2.5 - a;
        w * w * w * w * w / 120.0
    } else if a >= 0.5 {
        let at = |a: f64| a * (55.0 + a * (10.0 + a * (-40.0 + a * (20.0 - 3.2 * a)))) / 96.0;
        1.0 / 120.0 + at(1.5) - at(a)
    } else {
        let v = a * a;
        0.5 - a * (115.0 / 192.0 + v * (-5.0 / 24.0 + 0.05 * v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_is_the_integral_of_the_bell() {
        let (mut sum, fine) = (0.0, 1e-4);
        for i in -30_000..30_000 {
            let u = f64::from(i) * fine;
            if i % 1000 == 0 {
                assert!((step(u) - sum).abs() < 1e-8, "{u}: {} {sum}", step(u));
            }
            sum += fine * bell(u + 0.5 * fine);
        }
        assert!((sum - 1.0).abs() < 1e-8);
        // A partition of unity.
        let total: f64 = (-4..5).map(|k| bell(0.3 - f64::from(k))).sum();
        assert!((total - 1.0).abs() < 1e-14);
    }
}
