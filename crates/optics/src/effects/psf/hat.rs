//! Weights of a patch along one axis.

/// Weights of a patch along one axis: linear to its neighbours, even outside of the outermost.
#[derive(Clone, Debug)]
pub(in crate::effects) struct Hat {
    pub(super) middle: f64,
    first: usize,
    pub(super) weights: Vec<f64>,
}

impl Hat {
    pub(super) fn new(index: usize, count: usize, picture: &core::ops::Range<usize>, size: usize) -> Self {
        let step = picture.len() as f64 / count as f64;
        let middle = picture.start as f64 + (index as f64 + 0.5) * step;
        let weight = |pixel: usize| {
            let away = (pixel as f64 + 0.5 - middle) / step;
            let outer = (index == 0 && away < 0.0) || (index + 1 == count && away > 0.0);
            if outer { 1.0 } else { (1.0 - away.abs()).max(0.0) }
        };
        let first = (0..size).find(|p| weight(*p) > 0.0).unwrap_or(0);
        let weights = (first..size).map(weight).take_while(|w| *w > 0.0).collect();
        Self { middle, first, weights }
    }

    pub(super) fn range(&self) -> core::ops::Range<usize> {
        self.first..self.first + self.weights.len()
    }

    /// The weight at a pixel.
    pub(in crate::effects) fn weight(&self, pixel: usize) -> f64 {
        pixel.checked_sub(self.first).and_then(|i| self.weights.get(i)).copied().unwrap_or(0.0)
    }
}
