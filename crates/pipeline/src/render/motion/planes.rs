//! Planes of what was found of each pixel.

use etendue_core::Plane;
use etendue_core::quantity::Quantity;

/// A plane of one property of `pixels`, `width` a row.
pub(super) fn plane<T, Q: Quantity>(pixels: &[T], width: usize, of: impl Fn(&T) -> Q::Sample) -> Plane<Q> {
    Plane::from_samples(width, pixels.len() / width, pixels.iter().map(of).collect()).expect("one sample a pixel")
}
