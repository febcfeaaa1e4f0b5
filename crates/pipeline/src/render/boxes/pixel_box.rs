//! A box in the raster.

use glam::DVec2;

/// An axis-aligned box in raster coordinates, px: a pixel (x, y) covers x to x + 1 and y to y + 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelBox {
    /// Left and upper edge.
    pub low: DVec2,
    /// Right and lower edge.
    pub high: DVec2,
}

impl PixelBox {
    pub(super) fn from_pixel(x: usize, y: usize) -> Self {
        let low = DVec2::new(x as f64, y as f64);
        Self { low, high: low + 1.0 }
    }

    /// Box of all pixels of an image.
    pub(super) fn from_image_size(width_px: usize, height_px: usize) -> Self {
        Self { low: DVec2::ZERO, high: DVec2::new(width_px as f64, height_px as f64) }
    }

    /// Returns true if the other box lies within this one.
    pub(super) fn contains(&self, other: &Self) -> bool {
        (self.low.cmple(other.low) & self.high.cmpge(other.high)).all()
    }

    /// Converts a box around pixels to the box around their centres.
    pub(super) fn pixel_centres(&self) -> Self {
        Self { low: self.low + 0.5, high: self.high - 0.5 }
    }

    /// Converts a box around pixels of an image to the box around their centres, extended to the border where the box ends at the border and `whole` extends
    /// beyond; `None` is unbounded.
    pub(super) fn to_border(self, box_of_all: Option<&Self>, image_bounds: &Self) -> Self {
        let centres = self.pixel_centres();
        let box_of_all = box_of_all.copied().unwrap_or(Self { low: DVec2::NEG_INFINITY, high: DVec2::INFINITY });
        let low = self.low.cmple(image_bounds.low) & box_of_all.low.cmple(image_bounds.low);
        let high = self.high.cmpge(image_bounds.high) & box_of_all.high.cmpge(image_bounds.high);
        Self {
            low: DVec2::select(low, image_bounds.low, centres.low),
            high: DVec2::select(high, image_bounds.high, centres.high),
        }
    }

    /// Smallest box that contains both.
    #[must_use]
    pub fn union_with(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    pub(super) fn union(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(a.union_with(&b)),
            (a, b) => a.or(b),
        }
    }

    /// Part within an image; `None` if it lies outside.
    #[must_use]
    pub fn within(&self, width_px: usize, height_px: usize) -> Option<Self> {
        let image_bounds = Self::from_image_size(width_px, height_px);
        let (low, high) = (self.low.max(image_bounds.low), self.high.min(image_bounds.high));
        low.cmplt(high).all().then_some(Self { low, high })
    }

    /// Area, px².
    #[must_use]
    pub fn area_px2(&self) -> f64 {
        (self.high - self.low).element_product()
    }

    /// Left, upper, right and lower edges, px.
    #[must_use]
    pub fn edges_px(&self) -> [f64; 4] {
        [self.low.x, self.low.y, self.high.x, self.high.y]
    }
}
