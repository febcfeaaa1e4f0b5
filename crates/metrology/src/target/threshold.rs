//! A local threshold: half way between the darkest and the brightest pixel nearby.
//!
//! The image is divided into square blocks. A block's range is that of itself and its eight neighbours; if it is less than a
//! quarter of the 90th percentile of the ranges, there is nothing to segment. The threshold is interpolated between the centres
//! of the blocks.
//!
//! Dark regions of an image: pixels below the threshold that are connected by a side.
//!
//! One pass over the rows: each row's runs of dark pixels are joined with the runs of the row above that they touch (union by the
//! smaller number).

use crate::Image;

/// Thresholds by block.
#[derive(Debug)]
pub(super) struct Threshold {
    block: usize,
    columns: usize,
    rows: usize,
    /// The middle of the range; `NEG_INFINITY` if there is nothing to segment.
    middles: Vec<f32>,
}

impl Threshold {
    /// Thresholds of an image, by blocks of `block` px.
    pub(super) fn from_image(image: &Image, block: usize) -> Self {
        let (columns, rows) = (image.width().div_ceil(block), image.height().div_ceil(block));
        let mut ranges = vec![[f32::INFINITY, f32::NEG_INFINITY]; columns * rows];
        for (y, row) in image.samples().chunks_exact(image.width().max(1)).enumerate() {
            let line = &mut ranges[y / block * columns..][..columns];
            for (range, part) in line.iter_mut().zip(row.chunks(block)) {
                let (low, high) = part.iter().fold((range[0], range[1]), |(l, h), v| (l.min(*v), h.max(*v)));
                *range = [low, high];
            }
        }
        let around = |at: usize| {
            let (x, y) = (at % columns, at / columns);
            let mut range = [f32::INFINITY, f32::NEG_INFINITY];
            for v in y.saturating_sub(1)..(y + 2).min(rows) {
                for u in x.saturating_sub(1)..(x + 2).min(columns) {
                    let [low, high] = ranges[v * columns + u];
                    range = [range[0].min(low), range[1].max(high)];
                }
            }
            range
        };
        let wide: Vec<[f32; 2]> = (0..columns * rows).map(around).collect();
        let mut contrasts: Vec<f32> = wide.iter().map(|[l, h]| h - l).collect();
        contrasts.sort_by(f32::total_cmp);
        let typical = contrasts.get(contrasts.len() * 9 / 10).copied().unwrap_or(0.0);
        let middle = |[l, h]: &[f32; 2]| if h - l > 0.25 * typical { 0.5 * (l + h) } else { f32::NEG_INFINITY };
        Self { block, columns, rows, middles: wide.iter().map(middle).collect() }
    }

    /// The threshold at every pixel of row y.
    pub(super) fn row(&self, y: usize, width: usize) -> Vec<f32> {
        let (v0, v1, t) = self.between(y, self.rows);
        let column = |u: usize| {
            let (a, b) = (self.middles[v0 * self.columns + u], self.middles[v1 * self.columns + u]);
            blend(a, b, t)
        };
        let columns: Vec<f32> = (0..self.columns).map(column).collect();
        let at = |x: usize| {
            let (u0, u1, t) = self.between(x, self.columns);
            blend(columns[u0], columns[u1], t)
        };
        (0..width).map(at).collect()
    }

    /// The two blocks whose centres enclose a pixel, and the fraction between them.
    fn between(&self, pixel: usize, count: usize) -> (usize, usize, f32) {
        let at = ((pixel as f32 + 0.5) / self.block as f32 - 0.5).clamp(0.0, count as f32 - 1.0);
        let first = at as usize;
        (first, (first + 1).min(count - 1), at - first as f32)
    }
}

/// Linear; if one is missing the other.
fn blend(a: f32, b: f32, t: f32) -> f32 {
    match (a.is_finite(), b.is_finite()) {
        (true, true) => a + t * (b - a),
        (true, false) => a,
        _ => b,
    }
}

/// Pixels `from..to` of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowRun {
    pub(super) row: usize,
    pub(super) from: usize,
    pub(super) to: usize,
}

/// Regions, each as its runs, in the order of their first pixel.
pub(super) fn dark(image: &Image, threshold: &Threshold) -> Vec<Vec<RowRun>> {
    let mut runs: Vec<RowRun> = Vec::new();
    let mut parents: Vec<usize> = Vec::new();
    let mut above = 0..0;
    for (row, samples) in image.samples().chunks_exact(image.width().max(1)).enumerate() {
        let first = runs.len();
        add_runs(&mut runs, row, samples, &threshold.row(row, image.width()));
        parents.extend(first..runs.len());
        let mut other = above.start;
        for run in first..runs.len() {
            while other < above.end && runs[other].to <= runs[run].from {
                other += 1;
            }
            let mut touching = other;
            while touching < above.end && runs[touching].from < runs[run].to {
                join(&mut parents, run, touching);
                touching += 1;
            }
        }
        above = first..runs.len();
    }
    gathered(&runs, &mut parents)
}

fn add_runs(runs: &mut Vec<RowRun>, row: usize, samples: &[f32], thresholds: &[f32]) {
    let mut start = None;
    for (x, (value, threshold)) in samples.iter().zip(thresholds).enumerate() {
        match (value < threshold, start) {
            (true, None) => start = Some(x),
            (false, Some(from)) => {
                runs.push(RowRun { row, from, to: x });
                start = None;
            }
            _ => {}
        }
    }
    runs.extend(start.map(|from| RowRun { row, from, to: samples.len() }));
}

fn root(parents: &mut [usize], mut run: usize) -> usize {
    while parents[run] != run {
        parents[run] = parents[parents[run]];
        run = parents[run];
    }
    run
}

fn join(parents: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b)] = a.min(b);
}

fn gathered(runs: &[RowRun], parents: &mut [usize]) -> Vec<Vec<RowRun>> {
    let mut regions: Vec<Vec<RowRun>> = Vec::new();
    let mut numbers = vec![usize::MAX; runs.len()];
    for (i, run) in runs.iter().enumerate() {
        let root = root(parents, i);
        if numbers[root] == usize::MAX {
            numbers[root] = regions.len();
            regions.push(Vec::new());
        }
        regions[numbers[root]].push(*run);
    }
    regions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_that_close_below_are_one() {
        let rows_of_pixels = ["#.#..#", "#.#...", "###.##", "......", ".#.##."];
        let samples = rows_of_pixels.concat().bytes().map(|b| if b == b'#' { 0.0 } else { 1.0 }).collect();
        let image = Image::from_samples(6, 5, samples).expect("30 pixels");
        let regions = dark(&image, &Threshold::from_image(&image, 8));
        let areas: Vec<usize> = regions.iter().map(|r| r.iter().map(|run| run.to - run.from).sum()).collect();
        assert_eq!(areas, [7, 1, 2, 1, 2]);
    }
}
