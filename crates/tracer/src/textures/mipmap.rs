//! An image at halved resolutions, averaged by area in linear light.
//!
//! If an image has an alpha channel, colours are weighted by it too: invisible texels do not affect the colour of visible ones.

use glam::Vec3;

use super::projection::Wrap;
use super::texels::{Store, Texel};

/// One resolution of an image, in memory or in tiles.
pub(super) trait TexelLevel<T> {
    /// Bilinear interpolation at `s` (to the right) and `t` (downwards), both folded into [0, 1].
    fn bilinear(&self, s: f32, t: f32, wrap: [Wrap; 2]) -> T;
}

/// One resolution of an image in memory.
#[derive(Clone, Debug)]
pub(super) struct Level<T: Texel> {
    pub(super) width: u32,
    pub(super) height: u32,
    store: Store<T>,
}

impl<T: Texel> Level<T> {
    pub(super) fn new(width: u32, height: u32, store: Store<T>) -> Self {
        Self { width, height, store }
    }

    /// Memory of the texels, bytes.
    pub(super) fn bytes(&self) -> usize {
        self.store.bytes()
    }

    pub(super) fn texel(&self, x: usize, y: usize) -> T {
        self.store.get(y * self.width as usize + x)
    }

    /// Half as wide and as high (at least 1); every texel is the mean of the area it covers, so that the mean is preserved for odd sizes
    /// too.
    fn halved(&self) -> Self {
        self.coarser(|fraction| fraction.mean(|i, j| self.texel(i, j)))
    }

    /// A level of half the size, each texel computed from the area of this one that it covers.
    fn coarser(&self, texel: impl Fn(TexelArea<'_>) -> T) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let columns: Vec<Vec<_>> = (0..width).map(|x| overlaps(x, width, self.width).collect()).collect();
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            let rows: Vec<_> = overlaps(y, height, self.height).collect();
            texels.extend(columns.iter().map(|columns| texel(TexelArea { columns, rows: &rows })));
        }
        Self { width, height, store: Store::Float(texels) }
    }
}

impl<T: Texel> TexelLevel<T> for Level<T> {
    fn bilinear(&self, s: f32, t: f32, wrap: [Wrap; 2]) -> T {
        let (x0, x1, fx) = neighbours(s, self.width, wrap[0]);
        let (y0, y1, fy) = neighbours(t, self.height, wrap[1]);
        let top = self.texel(x0, y0).towards(self.texel(x1, y0), fx);
        let bottom = self.texel(x0, y1).towards(self.texel(x1, y1), fx);
        top.towards(bottom, fy)
    }
}

/// The columns and rows that a coarse texel covers, with their weights.
#[derive(Clone, Copy)]
pub(super) struct TexelArea<'a> {
    pub(super) columns: &'a [(usize, f32)],
    pub(super) rows: &'a [(usize, f32)],
}

impl TexelArea<'_> {
    pub(super) fn mean<V: Texel>(self, value: impl Fn(usize, usize) -> V) -> V {
        let row = |j: usize| self.columns.iter().fold(V::NOTHING, |sum, (i, wx)| sum + value(*i, j) * *wx);
        self.rows.iter().fold(V::NOTHING, |sum, (j, wy)| sum + row(*j) * *wy)
    }
}

/// The texels on both sides of a coordinate in [0, 1], and the weight of the second.
pub(super) fn neighbours(x: f32, count: u32, wrap: Wrap) -> (usize, usize, f32) {
    let x = x * count as f32 - 0.5;
    let low = x.floor();
    let i = low as i32;
    (wrap.neighbour(i, count), wrap.neighbour(i + 1, count), x - low)
}

/// The fine texels that coarse texel `j` covers along one axis, with their weights.
pub(super) fn overlaps(j: u32, coarse: u32, fine: u32) -> impl Iterator<Item = (usize, f32)> {
    let ratio = f64::from(fine) / f64::from(coarse);
    let (low, high) = (f64::from(j) * ratio, f64::from(j + 1) * ratio);
    let last = (high.ceil() as usize).min(fine as usize);
    (low.floor() as usize..last).filter_map(move |i| {
        let fraction = ((i as f64 + 1.0).min(high) - (i as f64).max(low)) / ratio;
        (fraction > 0.0).then_some((i, fraction as f32))
    })
}

/// An image and all its halvings, down to one texel.
pub(super) fn pyramid<T: Texel>(base: Level<T>) -> Vec<Level<T>> {
    let mut levels = vec![base];
    while let Some(last) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
        let next = last.halved();
        levels.push(next);
    }
    levels
}

/// The same for colours weighted by the alpha of a pyramid of the same size.
pub(super) fn weighted_pyramid(base: Level<Vec3>, alpha: &[Level<f32>]) -> Vec<Level<Vec3>> {
    let mut levels = vec![base];
    for visible in &alpha[..alpha.len() - 1] {
        let last = &levels[levels.len() - 1];
        let next = last.coarser(|fraction| {
            let weight = fraction.mean(|i, j| visible.texel(i, j));
            if weight > 0.0 {
                fraction.mean(|i, j| last.texel(i, j) * visible.texel(i, j)) * (1.0 / weight)
            } else {
                fraction.mean(|i, j| last.texel(i, j))
            }
        });
        levels.push(next);
    }
    levels
}
