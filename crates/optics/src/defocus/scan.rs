//! Coverage of each pixel by a polygon, row by row, as differences between neighbours.
//!
//! A row's coverage is stored as differences: their running sum is the coverage. The cost of a wide blur then depends on its perimeter and not on its
//! area. Rows are cut into lines, more of them for small polygons; along a line coverage is exact. A polygon smaller than a pixel becomes a pixel's
//! square about its centre, which changes nothing in its own pixel and elsewhere interpolates. Of large polygons only the requested rows are scanned.

use core::ops::Range;

use glam::DVec2;

use super::footprint::{Polygon, VERTICES, area};

/// Minimum number of lines across a polygon, where a row has several.
const LINES: f64 = 48.0;
/// Maximum number of lines per row.
const LINES_A_ROW: f64 = 16.0;
/// Number of lines above which the sum of their lengths is taken as the polygon's area; the two differ by less than LINES^−1.5, 3e-4.
const MANY_LINES: i64 = 256;
/// Shifts below this leave a small footprint on its pixel, px.
const STILL_PX: f64 = 0.02;
/// The minimum side of a polygon, px, before it is widened to a pixel.
const MIN_PX: f64 = 1e-3;

/// A change of the coverage in a row, as a fraction of the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CoverageStep {
    /// Column relative to the pixel.
    pub(super) column: i64,
    pub(super) fraction: f64,
}

/// The requested pixels, relative to the pixel that spreads its light.
#[derive(Clone, Debug)]
pub(super) struct Window {
    pub(super) columns: Range<i64>,
    pub(super) rows: Range<i64>,
}

impl Window {
    /// True if light between two corners (px) can reach the window; a coverage change in a row affects everything to its right.
    fn is_reached(&self, low: DVec2, high: DVec2) -> bool {
        let before = |limit: i64, value: f64| value < limit as f64 + 2.0;
        let after = |limit: i64, value: f64| value > limit as f64 - 2.0;
        before(self.rows.end, low.y)
            && after(self.rows.start, high.y)
            && before(self.columns.end, low.x)
            && after(self.columns.start, high.x)
    }
}

/// Reusable buffers for scanning.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// Left and right end of each line.
    lines: Vec<[f64; 2]>,
    /// Differences of one row.
    row: Vec<f64>,
    steps: Vec<CoverageStep>,
}

impl Scan {
    /// Calls `emit` with each row (relative to the pixel's) of a window and the coverage steps of a pixel spread over `polygon` (px, from the pixel's
    /// centre). Fractions over all rows sum to one.
    pub(super) fn spread(&mut self, polygon: &Polygon, window: &Window, mut emit: impl FnMut(i64, &[CoverageStep])) {
        let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        if !window.is_reached(low, high) {
            return;
        }
        let (size, centre) = (high - low, 0.5 * (low + high));
        if size.max_element() < 1.0 {
            return self.shift(if centre.length() < STILL_PX { DVec2::ZERO } else { centre }, emit);
        }
        let growth = size.max(DVec2::splat(MIN_PX)).recip().max(DVec2::ONE);
        let grown = polygon.map(|v| centre + (v - centre) * growth + 0.5);
        let half = 0.5 * size.max(DVec2::ONE).y;
        let rows = (LINES / (2.0 * half)).ceil().clamp(1.0, LINES_A_ROW);
        let first = ((centre.y + 0.5 - half) * rows).floor() as i64;
        let last = ((centre.y + 0.5 + half) * rows).floor() as i64;
        if last - first < MANY_LINES {
            let full_coverage = self.cut(&grown, rows, first, last);
            self.rows(rows as i64, first, full_coverage, window, &mut emit);
        } else {
            let first = first.max(window.rows.start);
            self.cut(&grown, 1.0, first, last.min(window.rows.end - 1));
            self.rows(1, first, area(&grown), window, &mut emit);
        }
    }

    /// Emits a pixel's square shifted by less than a footprint.
    fn shift(&mut self, by: DVec2, mut emit: impl FnMut(i64, &[CoverageStep])) {
        let top = by.y.floor();
        for (row, fraction) in [(top, 1.0 - (by.y - top)), (top + 1.0, by.y - top)] {
            if fraction > 0.0 {
                let first = self.clear(by.x, by.x + 1.0);
                self.add(first, [by.x, by.x + 1.0], fraction);
                emit(row as i64, self.stepped(first));
            }
        }
    }

    /// Cuts the lines `first` to `last`, `a_row` of them per row, between the sides of a polygon; returns the sum of their lengths.
    fn cut(&mut self, polygon: &Polygon, a_row: f64, first: i64, last: i64) -> f64 {
        self.lines.clear();
        self.lines.resize((last - first + 1).max(0) as usize, [f64::INFINITY, f64::NEG_INFINITY]);
        for k in 0..VERTICES {
            let (a, b) = (polygon[k], polygon[(k + 1) % VERTICES]);
            let (upper, lower) = if a.y <= b.y { (a, b) } else { (b, a) };
            let from = (upper.y * a_row - 0.5).ceil() as i64;
            let to = (lower.y * a_row - 0.5).floor() as i64;
            let slope = (lower.x - upper.x) / (lower.y - upper.y);
            for j in from.max(first)..=to.min(last) {
                let y = (j as f64 + 0.5) / a_row;
                let x = if lower.y > upper.y { upper.x + slope * (y - upper.y) } else { upper.x };
                let [left, right] = &mut self.lines[(j - first) as usize];
                (*left, *right) = (left.min(x), right.max(x));
            }
        }
        self.lines.iter().map(|[left, right]| (right - left).max(0.0)).sum()
    }

    /// Emits the rows of a window from the cut lines.
    fn rows(
        &mut self,
        a_row: i64,
        first: i64,
        full_coverage: f64,
        window: &Window,
        emit: &mut impl FnMut(i64, &[CoverageStep]),
    ) {
        let last = first + self.lines.len() as i64 - 1;
        let (top, bottom) = (first.div_euclid(a_row), last.div_euclid(a_row));
        for row in top.max(window.rows.start)..(bottom + 1).min(window.rows.end) {
            let lines = (row * a_row).max(first)..=(row * a_row + a_row - 1).min(last);
            let of = |lines: &[[f64; 2]], j: i64| lines[(j - first) as usize];
            let (left, right) = lines.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(left, right), j| {
                let [a, b] = of(&self.lines, j);
                (left.min(a), right.max(b))
            });
            if left >= right {
                continue;
            }
            if a_row == 1 {
                emit(row, &ends([left, right], 1.0 / full_coverage));
                continue;
            }
            let column = self.clear(left, right);
            for j in lines {
                let line = of(&self.lines, j);
                if line[0] < line[1] {
                    self.add(column, line, 1.0 / full_coverage);
                }
            }
            emit(row, self.stepped(column));
        }
    }

    /// Makes room for a row between two columns; returns the first of them.
    fn clear(&mut self, left: f64, right: f64) -> i64 {
        let first = left.floor() as i64;
        self.row.clear();
        self.row.resize((right.floor() as i64 - first + 2) as usize, 0.0);
        first
    }

    /// Adds an interval with `share` per unit of pixel length.
    fn add(&mut self, first: i64, line: [f64; 2], fraction: f64) {
        for step in ends(line, fraction) {
            self.row[(step.column - first) as usize] += step.fraction;
        }
    }

    /// The steps of the accumulated row.
    fn stepped(&mut self, first: i64) -> &[CoverageStep] {
        let steps = self.row.iter().enumerate().filter(|(_, fraction)| **fraction != 0.0);
        self.steps.clear();
        self.steps.extend(steps.map(|(i, fraction)| CoverageStep { column: first + i as i64, fraction: *fraction }));
        &self.steps
    }
}

/// The steps of an interval with `share` per unit of pixel length.
fn ends(line: [f64; 2], fraction: f64) -> [CoverageStep; 4] {
    let end = |at: f64, fraction: f64| {
        let (column, part) = (at.floor() as i64, at - at.floor());
        [
            CoverageStep { column, fraction: fraction * (1.0 - part) },
            CoverageStep { column: column + 1, fraction: fraction * part },
        ]
    };
    let ([a, b], [c, d]) = (end(line[0], fraction), end(line[1], -fraction));
    [a, b, c, d]
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use etendue_core::maths::f64::sin_cos;

    /// Coverage of the pixels about one, `reach` to each side.
    fn coverage(polygon: &Polygon, reach: i64) -> Vec<f64> {
        let side = 2 * reach + 1;
        let mut steps = vec![0.0; (side * side) as usize];
        let window = Window { columns: -reach..reach + 1, rows: -reach..reach + 1 };
        Scan::default().spread(polygon, &window, |row, row_steps| {
            for step in row_steps.iter().filter(|s| s.column <= reach) {
                steps[((row + reach) * side + step.column.max(-reach) + reach) as usize] += step.fraction;
            }
        });
        for row in steps.chunks_exact_mut(side as usize) {
            (1..row.len()).for_each(|i| row[i] += row[i - 1]);
        }
        steps
    }

    fn disc(centre: DVec2, radius: DVec2) -> Polygon {
        core::array::from_fn(|k| {
            let (s, c) = sin_cos(2.0 * PI * k as f64 / VERTICES as f64);
            centre + DVec2::new(c, s) * radius
        })
    }

    /// Sum, mean and variance along x and y of a coverage.
    fn moments(coverage: &[f64], reach: i64) -> (f64, DVec2, DVec2) {
        let side = 2 * reach + 1;
        let at = |i: usize| DVec2::new((i as i64 % side - reach) as f64, (i as i64 / side - reach) as f64);
        let sum: f64 = coverage.iter().sum();
        let mean = coverage.iter().enumerate().map(|(i, c)| at(i) * *c).sum::<DVec2>() / sum;
        let spread = |(i, c): (usize, &f64)| (at(i) - mean) * (at(i) - mean) * *c;
        (sum, mean, coverage.iter().enumerate().map(spread).sum::<DVec2>() / sum)
    }

    #[test]
    fn shares_sum_to_one_and_lie_where_the_polygon_is() {
        for (x, y, rx, ry) in
            [(0.0, 0.0, 5.0, 5.0), (0.3, -0.2, 2.0, 0.7), (3.1, 2.7, 0.01, 4.0), (-4.4, 1.0, 0.2, 0.2)]
        {
            let c = coverage(&disc(DVec2::new(x, y), DVec2::new(rx, ry)), 12);
            let (sum, mean, _) = moments(&c, 12);
            assert!((sum - 1.0).abs() < 1e-12, "{sum}");
            // Lines are placed to within a 48th of the height, and pixels count at their centres.
            assert!((mean - DVec2::new(x, y)).length() < 0.05, "{mean}");
            assert!(c.iter().all(|coverage| *coverage > -1e-15));
        }
    }

    #[test]
    fn a_disc_has_the_variance_of_a_disc() {
        // A quarter of the radius squared, and a twelfth for the pixels' square. The rim of a small disc meets few pixels and lines, which leaves an
        // error of the order of that twelfth.
        for radius in [1.5, 4.0, 9.5] {
            let (_, _, variance) = moments(&coverage(&disc(DVec2::ZERO, DVec2::splat(radius)), 12), 12);
            let expected = radius * radius / 4.0 + 1.0 / 12.0;
            assert!((variance - expected).abs().max_element() < 0.1, "{radius}: {variance} {expected}");
        }
    }

    #[test]
    fn what_is_smaller_than_a_pixel_stays_in_it() {
        let mut scanned = Vec::new();
        let window = Window { columns: -1..2, rows: -1..2 };
        Scan::default()
            .spread(&disc(DVec2::ZERO, DVec2::splat(0.49)), &window, |row, steps| scanned.push((row, steps.to_vec())));
        let one = |column, fraction| CoverageStep { column, fraction };
        assert_eq!(scanned, [(0, vec![one(0, 1.0), one(1, -1.0)])]);
    }

    /// The centre of a disc of thousands of pixels, cut out of the whole: uniform, by the polygon's own area.
    #[test]
    fn a_window_into_a_large_disc_is_even() {
        for radius in [60.0, 700.0, 5000.0] {
            let c = coverage(&disc(DVec2::new(0.3, -7.2), DVec2::splat(radius)), 20);
            // 48 vertices leave 0.3 % of the circle's area.
            let even = 1.0 / (PI * radius * radius);
            assert!(c.iter().all(|coverage| (coverage / even - 1.0).abs() < 4e-3), "{radius}: {:?} {even}", &c[..3]);
        }
    }

    #[test]
    fn what_lies_beside_a_window_is_left_out() {
        let window = Window { columns: 40..50, rows: 0..10 };
        let mut count = 0;
        Scan::default().spread(&disc(DVec2::ZERO, DVec2::splat(30.0)), &window, |_, _| count += 1);
        assert_eq!(count, 0);
        Scan::default().spread(&disc(DVec2::new(30.0, 0.0), DVec2::splat(30.0)), &window, |_, _| count += 1);
        assert_eq!(count, 10);
    }
}
