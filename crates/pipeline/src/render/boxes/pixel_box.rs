//! A box in the raster.

use glam::DVec2;

/// A box with upright edges in raster coordinates, px: a pixel (x, y) fills x to x + 1 and y to y + 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelBox {
    /// Left and upper edge.
    pub low: DVec2,
    /// Right and lower edge.
    pub high: DVec2,
}

impl PixelBox {
    pub(super) fn of_pixel(x: usize, y: usize) -> Self {
        let low = DVec2::new(x as f64, y as f64);
        Self { low, high: low + 1.0 }
    }

    /// About all pixels of a picture.
    pub(super) fn of_picture(width_px: usize, height_px: usize) -> Self {
        Self { low: DVec2::ZERO, high: DVec2::new(width_px as f64, height_px as f64) }
    }

    /// Whether the other box lies within this.
    pub(super) fn holds(&self, other: &Self) -> bool {
        (self.low.cmple(other.low) & self.high.cmpge(other.high)).all()
    }

    /// Of a box about pixels, that about their centres.
    pub(super) fn of_centres(&self) -> Self {
        Self { low: self.low + 0.5, high: self.high - 0.5 }
    }

    /// Of a box about pixels of a picture, that about their centres, but up to the border where the box ends there and `whole` reaches beyond; `None`
    /// reaches without end.
    pub(super) fn to_border(self, whole: Option<&Self>, picture: &Self) -> Self {
        let centres = self.of_centres();
        let whole = whole.copied().unwrap_or(Self { low: DVec2::NEG_INFINITY, high: DVec2::INFINITY });
        let low = self.low.cmple(picture.low) & whole.low.cmple(picture.low);
        let high = self.high.cmpge(picture.high) & whole.high.cmpge(picture.high);
        Self {
            low: DVec2::select(low, picture.low, centres.low),
            high: DVec2::select(high, picture.high, centres.high),
        }
    }

    /// The least box about both.
    #[must_use]
    pub fn about(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    pub(super) fn union(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(a.about(&b)),
            (a, b) => a.or(b),
        }
    }

    /// The part within a picture; `None` where it lies outside.
    #[must_use]
    pub fn within(&self, width_px: usize, height_px: usize) -> Option<Self> {
        let picture = Self::of_picture(width_px, height_px);
        let (low, high) = (self.low.max(picture.low), self.high.min(picture.high));
        low.cmplt(high).all().then_some(Self { low, high })
    }

    /// Its area, px².
    #[must_use]
    pub fn area_px2(&self) -> f64 {
        (self.high - self.low).element_product()
    }

    /// Left, upper, right and lower edge, px.
    #[must_use]
    pub fn edges_px(&self) -> [f64; 4] {
        [self.low.x, self.low.y, self.high.x, self.high.y]
    }
}
