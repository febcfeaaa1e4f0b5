//! Weights of a patch along one axis.

/// Where the functions of patches stand along an axis of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::effects) enum Stand {
    /// In the middles of equal parts; the outermost hold to the edge.
    Middles,
    /// On both edges, and evenly between; a single one in the middle.
    Edges,
}

/// Weights of a patch along one axis: linear to its neighbours, even outside of the outermost.
#[derive(Clone, Debug)]
pub(in crate::effects) struct Hat {
    pub(super) middle: f64,
    first: usize,
    pub(super) weights: Vec<f64>,
}

impl Hat {
    /// The patch `index` of `count` over the pixels `picture` of a film of `size`.
    pub(super) fn new(
        stand: Stand,
        index: usize,
        count: usize,
        picture: &core::ops::Range<usize>,
        size: usize,
    ) -> Self {
        let (start, length, at) = (picture.start as f64, picture.len() as f64, index as f64);
        let (middle, step) = match stand {
            Stand::Edges if count > 1 => {
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

    pub(super) fn range(&self) -> core::ops::Range<usize> {
        self.first..self.first + self.weights.len()
    }

    /// The weight at a pixel.
    pub(in crate::effects) fn weight(&self, pixel: usize) -> f64 {
        pixel.checked_sub(self.first).and_then(|i| self.weights.get(i)).copied().unwrap_or(0.0)
    }
}
