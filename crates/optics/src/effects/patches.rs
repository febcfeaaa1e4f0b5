//! A function that varies over the image: one function per patch.
//!
//! Each pixel is a weighted mean of the film spread by the functions of the nearest patches. The weights are linear between the patches and sum to
//! one: a uniform irradiance stays uniform. The light of a point is preserved where the centroids of the functions are at the centre and the weights
//! are linear across it. The variance is that mean for the squared functions, which does not underestimate it.

use std::borrow::Borrow;

use glam::DVec2;

use super::convolve::{Convolver, NumberField, Region};
use super::{canvas::Canvas, kernel::Kernel};

/// Patches over the image in a film, row by row.
#[derive(Clone, Debug)]
pub(super) struct Patches {
    columns: Vec<PatchWeights>,
    rows: Vec<PatchWeights>,
    size: [usize; 2],
}

impl Patches {
    /// Creates this number of patches across and down.
    pub(super) fn new([across, down]: [usize; 2], layout: PatchLayout, canvas: &Canvas) -> Self {
        let (region, size) = (canvas.image_region(), canvas.size());
        let columns = (0..across).map(|i| PatchWeights::new(layout, i, across, &region.x, size[0])).collect();
        let rows = (0..down).map(|i| PatchWeights::new(layout, i, down, &region.y, size[1])).collect();
        Self { columns, rows, size }
    }

    pub(super) fn count(&self) -> usize {
        self.columns.len() * self.rows.len()
    }

    fn hats(&self, index: usize) -> [&PatchWeights; 2] {
        [&self.columns[index % self.columns.len()], &self.rows[index / self.columns.len()]]
    }

    /// Position in the film at which the function of a patch holds, px.
    pub(super) fn middle_px(&self, index: usize) -> DVec2 {
        let [x, y] = self.hats(index);
        DVec2::new(x.middle, y.middle)
    }

    /// The pixels of the film that use the function of a patch.
    pub(super) fn region(&self, index: usize) -> Region {
        let [x, y] = self.hats(index);
        Region { x: x.range(), y: y.range() }
    }

    /// The weights across and down.
    pub(super) fn into_hats(self) -> [Vec<PatchWeights>; 2] {
        [self.columns, self.rows]
    }

    /// The film's light and variance, spread by the kernels of the patches.
    pub(super) fn apply<K: Borrow<Kernel>>(
        &self,
        light: &NumberField,
        variance: Option<&NumberField>,
        kernel: impl Fn(usize) -> K,
    ) -> (NumberField, Option<NumberField>) {
        let mut spread = NumberField::zeros(self.size[0], self.size[1]);
        let mut spread_variance = variance.map(|_| NumberField::zeros(self.size[0], self.size[1]));
        for index in 0..self.count() {
            let (kernel, region) = (kernel(index), self.region(index));
            let kernel = kernel.borrow();
            self.add(&Convolver::new(kernel, self.size, region.clone()).apply(light), index, &mut spread);
            if let (Some(from), Some(to)) = (variance, &mut spread_variance) {
                self.add(&Convolver::new(&kernel.squared(), self.size, region).apply(from), index, to);
            }
        }
        (spread, spread_variance)
    }

    /// Adds a patch's part by its weights.
    fn add(&self, part: &NumberField, index: usize, to: &mut NumberField) {
        let [x, y] = self.hats(index);
        for (row, (at, tall)) in y.range().zip(&y.weights).enumerate() {
            let target = &mut to.row_mut(at)[x.range()];
            for ((to, from), wide) in target.iter_mut().zip(part.row(row)).zip(&x.weights) {
                *to += tall * wide * from;
            }
        }
    }
}

/// Positions of the patches along an axis of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PatchLayout {
    /// At the centres of equal parts; the outermost hold to the edge.
    Centres,
    /// On both edges, and uniformly between; a single one at the centre.
    Edges,
}

/// Weights of a patch along one axis: linear to its neighbours, constant beyond the outermost.
#[derive(Clone, Debug)]
pub(super) struct PatchWeights {
    middle: f64,
    first: usize,
    weights: Vec<f64>,
}

impl PatchWeights {
    /// The patch `index` of `count` over the pixels `picture` of a film of `size`.
    fn new(layout: PatchLayout, index: usize, count: usize, image: &core::ops::Range<usize>, size: usize) -> Self {
        let (start, length, at) = (image.start as f64, image.len() as f64, index as f64);
        let (middle, step) = match layout {
            PatchLayout::Edges if count > 1 => {
                let step = length / (count - 1) as f64;
                (start + at * step, step)
            }
            _ => {
                let step = length / count as f64;
                (start + (at + 0.5) * step, step)
            }
        };
        let weight = |pixel: usize| {
            let away = (pixel as f64 + 0.5 - middle) / step;
            let outer = (index == 0 && away < 0.0) || (index + 1 == count && away > 0.0);
            if outer { 1.0 } else { (1.0 - away.abs()).max(0.0) }
        };
        let first = (0..size).find(|p| weight(*p) > 0.0).unwrap_or(0);
        let weights = (first..size).map(weight).take_while(|w| *w > 0.0).collect();
        Self { middle, first, weights }
    }

    fn range(&self) -> core::ops::Range<usize> {
        self.first..self.first + self.weights.len()
    }

    /// The weight at a pixel.
    pub(super) fn weight(&self, pixel: usize) -> f64 {
        pixel.checked_sub(self.first).and_then(|i| self.weights.get(i)).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use etendue_projection::Raster;

    use super::*;

    #[test]
    fn weights_sum_to_one_wherever_functions_stand() {
        let canvas = Canvas::new(&Raster::centred(40, 23, 0.01).expect("legal"), [5, 3]);
        for (layout, counts) in [
            (PatchLayout::Centres, [5, 3]),
            (PatchLayout::Edges, [5, 3]),
            (PatchLayout::Edges, [1, 2]),
            (PatchLayout::Centres, [1, 1]),
        ] {
            let patches = Patches::new(counts, layout, &canvas);
            let sum = |hats: &[PatchWeights], pixel: usize| hats.iter().map(|hat| hat.weight(pixel)).sum::<f64>();
            assert!((0..50).all(|x| (sum(&patches.columns, x) - 1.0).abs() < 1e-12), "{layout:?}");
            assert!((0..29).all(|y| (sum(&patches.rows, y) - 1.0).abs() < 1e-12), "{layout:?}");
        }
        let at = |layout, index| Patches::new([5, 3], layout, &canvas).middle_px(index);
        assert_eq!(at(PatchLayout::Edges, 0), DVec2::new(5.0, 3.0));
        assert_eq!(at(PatchLayout::Edges, 14), DVec2::new(45.0, 26.0));
        assert_eq!(at(PatchLayout::Centres, 7), DVec2::new(25.0, 14.5));
    }
}
