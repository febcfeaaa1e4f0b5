//! A threshold that follows the light: half way between the darkest and the brightest nearby.
//!
//! The picture is cut into square blocks. A block's range is that of itself and its eight neighbours; where it is less
//! than a quarter of the ranges' 90th hundredth there is nothing to be parted. Between the blocks' middles the threshold is
//! interpolated.

use crate::Image;

/// Thresholds by block.
#[derive(Debug)]
pub(super) struct Threshold {
    block: usize,
    columns: usize,
    rows: usize,
    /// The middle of the range; `NEG_INFINITY` where there is nothing to be parted.
    middles: Vec<f32>,
}

impl Threshold {
    /// Of an image by blocks of `block` px.
    pub(super) fn of(image: &Image, block: usize) -> Self {
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

    /// The two blocks whose middles a pixel lies between, and where.
    fn between(&self, pixel: usize, count: usize) -> (usize, usize, f32) {
        let at = ((pixel as f32 + 0.5) / self.block as f32 - 0.5).clamp(0.0, count as f32 - 1.0);
        let first = at as usize;
        (first, (first + 1).min(count - 1), at - first as f32)
    }
}

/// Linear; where one is not there the other.
fn blend(a: f32, b: f32, t: f32) -> f32 {
    match (a.is_finite(), b.is_finite()) {
        (true, true) => a + t * (b - a),
        (true, false) => a,
        _ => b,
    }
}
