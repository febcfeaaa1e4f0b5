//! A picture at halved resolutions, averaged by area in linear light.

use glam::Vec3;

use super::texels::Store;
use super::wrap::Wrap;

/// One resolution of a picture.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub(super) width: u32,
    pub(super) height: u32,
    store: Store,
}

impl Level {
    pub(super) fn new(width: u32, height: u32, store: Store) -> Self {
        Self { width, height, store }
    }

    pub(super) fn texel(&self, x: usize, y: usize) -> Vec3 {
        self.store.get(y * self.width as usize + x)
    }

    /// Bilinear interpolation at `s` (to the right) and `t` (downwards), both folded into [0, 1].
    pub(super) fn bilinear(&self, s: f32, t: f32, wrap: [Wrap; 2]) -> Vec3 {
        let (x0, x1, fx) = neighbours(s, self.width, wrap[0]);
        let (y0, y1, fy) = neighbours(t, self.height, wrap[1]);
        let top = self.texel(x0, y0).lerp(self.texel(x1, y0), fx);
        let bottom = self.texel(x0, y1).lerp(self.texel(x1, y1), fx);
        top.lerp(bottom, fy)
    }

    /// Half as wide and as high (at least 1); every texel the mean of the area it covers, so that the mean is kept for
    /// odd sizes too.
    fn halved(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let columns = overlaps(x, width, self.width);
                let texel: Vec3 = overlaps(y, height, self.height)
                    .map(|(j, wy)| wy * columns.clone().map(|(i, wx)| wx * self.texel(i, j)).sum::<Vec3>())
                    .sum();
                texels.push(texel.to_array());
            }
        }
        Self { width, height, store: Store::Float(texels) }
    }
}

/// The texels on both sides of a coordinate in [0, 1], and the weight of the second.
fn neighbours(x: f32, count: u32, wrap: Wrap) -> (usize, usize, f32) {
    let x = x * count as f32 - 0.5;
    let low = x.floor();
    let i = low as i32;
    (wrap.neighbour(i, count), wrap.neighbour(i + 1, count), x - low)
}

/// The fine texels that coarse texel `j` covers along one axis, with their shares of it.
fn overlaps(j: u32, coarse: u32, fine: u32) -> impl Iterator<Item = (usize, f32)> + Clone {
    let ratio = f64::from(fine) / f64::from(coarse);
    let (low, high) = (f64::from(j) * ratio, f64::from(j + 1) * ratio);
    let last = (high.ceil() as usize).min(fine as usize);
    (low.floor() as usize..last).filter_map(move |i| {
        let share = ((i as f64 + 1.0).min(high) - (i as f64).max(low)) / ratio;
        (share > 0.0).then_some((i, share as f32))
    })
}

/// A picture and all its halvings, down to one texel.
pub(super) fn pyramid(base: Level) -> Vec<Level> {
    let mut levels = vec![base];
    while let Some(last) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
        let next = last.halved();
        levels.push(next);
    }
    levels
}
