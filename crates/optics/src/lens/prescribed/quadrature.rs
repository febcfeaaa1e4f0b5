//! Integrals over a bundle, clipped at its edge.
//!
//! Rows run along the line of symmetry, each from edge to edge as found by bisection, with Gauss's rule along it. Rows are at equal steps of an angle
//! whose sine is their height, which removes the root at the bundle's ends. For a smooth edge convergence is faster than any power of the number of
//! rows; for an edge with corners it is quadratic.

use core::f64::consts::PI;

use etendue_core::maths::f64::sin_cos;
use glam::DVec2;

use super::bundles::{Bundle, Cell};
use crate::overlap::GAUSS;

/// Minimum number of steps of the edge search along a row; otherwise twice the number of rows.
const SCAN: usize = 48;
const HALVINGS: usize = 26;
/// The golden section, and the number of iterations.
const GOLDEN: f64 = 0.618_033_988_749_894_8;
const GOLDEN_STEPS: usize = 24;

/// A ray with its part of the bundle's area; zero for points of the edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BundleNode {
    pub(super) q: DVec2,
    pub(super) area: f64,
}

/// The maximum of a unimodal function between two positions.
fn golden(mut ends: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..GOLDEN_STEPS {
        let width = GOLDEN * (ends[1] - ends[0]);
        let [a, b] = [ends[1] - width, ends[0] + width];
        if f(a) > f(b) { ends[1] = b } else { ends[0] = a }
    }
    0.5 * (ends[0] + ends[1])
}

/// One of the bundles of a plane.
pub(super) struct Area<'a, F> {
    scan: usize,
    bundles: &'a [Bundle],
    /// Index of the bundle.
    own: usize,
    /// Filling of the clear apertures by a ray; see [`super::bundles`].
    filling: F,
}

impl<'a, F: Fn(DVec2) -> Option<f64>> Area<'a, F> {
    pub(super) fn new(bundles: &'a [Bundle], own: usize, filling: F) -> Self {
        Self { scan: SCAN, bundles, own, filling }
    }

    /// Nodes of some rows; their areas cover both sides of the line of symmetry.
    pub(super) fn nodes(&mut self, rows: usize) -> Vec<BundleNode> {
        self.scan = SCAN.max(2 * rows);
        let Some([low, high]) = self.ends() else { return Vec::new() };
        // The angle runs from 0 on the line of symmetry, otherwise from −π/2.
        let (middle, half, start) =
            if low == 0.0 { (0.0, high, 0.0) } else { (0.5 * (low + high), 0.5 * (high - low), -0.5 * PI) };
        let step = (0.5 * PI - start) / rows as f64;
        let mut nodes = Vec::new();
        for row in 0..rows {
            let (sine, cosine) = sin_cos(start + step * (row as f64 + 0.5));
            self.row(middle + half * sine, 2.0 * half * cosine * step, &mut nodes);
        }
        nodes
    }

    /// The point of the edge at which `f` is largest, near a point of it and between the adjacent rows: the edge has a corner where two clear
    /// apertures meet.
    pub(super) fn highest(&self, near: DVec2, rows: usize, f: impl Fn(DVec2) -> f64) -> f64 {
        let Cell { low, high } = self.bundles[self.own].bounds();
        let step = 2.0 * (high.y - low.y) / rows as f64;
        let along = |y: f64| self.intervals(y).into_iter().flatten().map(|x| f(DVec2::new(x, y))).fold(0.0, f64::max);
        let y = golden([(near.y - step).max(0.0), near.y + step], along);
        along(y).max(f(near))
    }

    /// Filling of the apertures by the ray; infinite if it is lost.
    fn fullness(&self, x: f64, y: f64) -> f64 {
        (self.filling)(DVec2::new(x, y)).unwrap_or(f64::INFINITY)
    }

    fn row(&self, y: f64, height: f64, nodes: &mut Vec<BundleNode>) {
        for [a, b] in self.intervals(y) {
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            nodes.extend([a, b].map(|x| BundleNode { q: DVec2::new(x, y), area: 0.0 }));
            for [x, weight] in GAUSS {
                let node = |x: f64| BundleNode { q: DVec2::new(x, y), area: weight * half * height };
                nodes.extend([middle - half * x, middle + half * x].map(node));
            }
        }
    }

    /// Intervals of a row inside this bundle.
    fn intervals(&self, y: f64) -> Vec<[f64; 2]> {
        let Cell { low, high } = self.search_cell();
        let at = |i: usize| low.x + (high.x - low.x) * i as f64 / self.scan as f64;
        let fullness: Vec<f64> = (0..=self.scan).map(|i| self.fullness(at(i), y)).collect();
        let (mut list, mut begun) = (Vec::new(), (fullness[0] <= 1.0).then_some(low.x));
        for i in 1..=self.scan {
            match (fullness[i - 1] <= 1.0, fullness[i] <= 1.0) {
                (false, true) => begun = Some(self.edge(at(i), at(i - 1), y)),
                (true, false) => list.extend(begun.take().map(|begin| [begin, self.edge(at(i - 1), at(i), y)])),
                _ => {}
            }
        }
        list.extend(begun.map(|begin| [begin, high.x]));
        if list.is_empty() {
            let best = (0..=self.scan).min_by(|a, b| fullness[*a].total_cmp(&fullness[*b])).unwrap_or(0);
            list.extend(self.narrow(at(best.saturating_sub(1)), at(best + 1), y));
        }
        list.retain(|[a, b]| self.is_own(DVec2::new(0.5 * (a + b), y)));
        list
    }

    /// The last passing position on the way to a clipped one.
    fn edge(&self, passes: f64, clipped: f64, y: f64) -> f64 {
        let mut bracket = [passes, clipped];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (bracket[0] + bracket[1]);
            bracket[usize::from(self.fullness(middle, y) > 1.0)] = middle;
        }
        bracket[0]
    }

    /// An interval between two clipped positions, at a bundle's tip.
    fn narrow(&self, a: f64, b: f64, y: f64) -> Option<[f64; 2]> {
        let at = golden([a, b], |x| -self.fullness(x, y));
        (self.fullness(at, y) <= 1.0).then(|| [self.edge(at, a, y), self.edge(at, b, y)])
    }

    /// True if a point that passes belongs to this bundle.
    fn is_own(&self, q: DVec2) -> bool {
        if self.bundles.len() == 1 {
            return true;
        }
        let own = self.bundles[self.own].distance(q);
        self.bundles.iter().enumerate().all(|(i, other)| i == self.own || other.distance(q) >= own)
    }

    /// The bundle's box, slightly enlarged.
    fn search_cell(&self) -> Cell {
        let Cell { low, high } = self.bundles[self.own].bounds();
        let margin = 0.03 * (high - low);
        Cell { low: low - margin, high: high + margin }
    }

    /// The bundle's lowest and highest row; the lowest is 0 where it crosses the line of symmetry.
    fn ends(&self) -> Option<[f64; 2]> {
        let bounds = self.bundles[self.own].bounds();
        let margin = 0.03 * (bounds.high.y - bounds.low.y);
        let lit = |y: f64| !self.intervals(y).is_empty();
        let heights = (0..=SCAN).map(|i| bounds.low.y + (bounds.high.y - bounds.low.y) * i as f64 / SCAN as f64);
        let lit_rows: Vec<f64> = heights.filter(|y| lit(*y)).collect();
        let end = |mut inside: f64, mut outside: f64| {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inside + outside);
                if lit(middle) { inside = middle } else { outside = middle }
            }
            inside
        };
        let (first, last) = (*lit_rows.first()?, *lit_rows.last()?);
        let step = (bounds.high.y - bounds.low.y) / SCAN as f64;
        let beyond = |y: f64| if y + step > bounds.high.y { bounds.high.y + margin } else { y + step };
        let low = if first == 0.0 { 0.0 } else { end(first, (first - step).max(0.0)) };
        Some([low, end(last, beyond(last))])
    }
}

#[cfg(test)]
mod tests {
    use super::super::bundles::bundles;
    use super::*;

    fn integral(filling: impl Fn(DVec2) -> Option<f64>, rows: usize, f: impl Fn(DVec2) -> f64) -> f64 {
        let bounds = Cell { low: DVec2::new(-10.0, 0.0), high: DVec2::new(10.0, 10.0) };
        let actual = bundles(bounds, &filling);
        let mut area = Area::new(&actual, 0, filling);
        area.nodes(rows).iter().map(|node| node.area * f(node.q)).sum()
    }

    #[test]
    fn moments_of_a_disc_are_exact_with_a_dozen_rows() {
        let disc = |q: DVec2| Some((q - DVec2::new(0.7, 0.0)).length() / 3.0);
        assert!((integral(disc, 12, |_| 1.0) / (9.0 * PI) - 1.0).abs() < 1e-5);
        let about = |q: DVec2| (q - DVec2::new(0.7, 0.0)).length_squared();
        assert!((integral(disc, 12, about) / (81.0 * PI / 2.0) - 1.0).abs() < 1e-5);
        assert!((integral(disc, 12, |q| q.x) / (9.0 * PI) - 0.7).abs() < 1e-5);
    }

    #[test]
    fn a_cat_s_eye_with_corners_converges_with_the_square_of_its_rows() {
        // Two discs of radius 3, their centres 2 apart: 2 r² acos(d/2r) − d/2 √(4r² − d²).
        let eye = |q: DVec2| Some((q.length() / 3.0).max((q - DVec2::new(2.0, 0.0)).length() / 3.0));
        let exact = 18.0 * etendue_core::maths::f64::acos(1.0 / 3.0) - 32.0_f64.sqrt();
        let error = |rows: usize| (integral(eye, rows, |_| 1.0) / exact - 1.0).abs();
        assert!(error(24) < 1e-3 && error(96) < 1e-4, "{} {}", error(24), error(96));
    }

    #[test]
    fn a_pair_beside_the_line_of_symmetry_counts_twice() {
        let pair = |q: DVec2| Some((DVec2::new(q.x, q.y.abs()) - DVec2::new(-2.0, 5.0)).length() / 1.5);
        assert!((integral(pair, 24, |_| 1.0) / (2.0 * PI * 2.25) - 1.0).abs() < 1e-5);
    }
}
