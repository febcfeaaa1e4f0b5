//! Exchange with neighbouring pixels, for pixels of k × k.
//!
//! Each of the k² parts of a pixel exchanges with its own neighbours as before, and all parts have the same signal. Only the k parts beside a border give
//! signal to the pixel beyond it: the fraction h across the side and the fraction c across both corners of each part, except at the two corners of the border
//! that lead to diagonal pixels: h′ = (k h + 2 (k − 1) c)/k² and c′ = c/k².

use etendue_scene::record::sensor::exposure::Exchange;

/// Converts the fractions to those of pixels of k × k.
pub(super) fn enlarge(exchange: &mut Exchange, k: f64) {
    let corner = exchange.corner.as_ref().map_or(0.0, |corner| corner.value);
    let across = |share: f64| (k * share + 2.0 * (k - 1.0) * corner) / (k * k);
    exchange.horizontal.value = across(exchange.horizontal.value);
    exchange.vertical.value = across(exchange.vertical.value);
    exchange.corner.iter_mut().for_each(|corner| corner.value /= k * k);
}
