//! What pictures of even surfaces share: is it saturated, how noisy is it.

use crate::Image;

/// The largest share of saturated pixels that a measurement lets pass.
pub(crate) const SATURATED_SHARE: f64 = 1e-3;

/// Share of pixels at or above full scale. Where full scale is unknown, share of pixels at the largest reading: a plateau tells of
/// clipping, unless the picture is all one value.
pub(crate) fn saturated_fraction(samples: &[f32], full_scale: Option<f64>) -> f64 {
    let count = |level: f64| samples.iter().filter(|s| f64::from(**s) >= level).count() as f64 / samples.len() as f64;
    if let Some(full) = full_scale {
        return count(full);
    }
    let most = samples.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let plateau = count(f64::from(most));
    // One pixel in a hundred at exactly the largest reading is no accident of noise.
    if plateau > 0.01 && plateau < 1.0 { plateau } else { 0.0 }
}

/// Percent of the pixels of parts of a picture, that of the worst part, at or above a known full scale, where that is more than a
/// measurement lets pass.
pub(crate) fn saturated_percent<'a>(
    parts: impl IntoIterator<Item = &'a Image>,
    full_scale: Option<f64>,
) -> Option<f64> {
    let full = full_scale?;
    let share = parts.into_iter().map(|part| saturated_fraction(part.samples(), Some(full))).fold(0.0, f64::max);
    (share > SATURATED_SHARE).then_some(100.0 * share)
}

/// A sixth of the squared second differences of neighbours in a row, at the middle one: unbiased for independent noise on a level
/// that changes evenly from pixel to pixel.
pub(crate) fn neighbour_variances(image: &Image) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    let rows = image.samples().chunks_exact(image.width()).enumerate();
    rows.flat_map(|(y, row)| {
        row.windows(3).enumerate().map(move |(x, three)| {
            let [a, b, c] = [three[0], three[1], three[2]].map(f64::from);
            let difference = a - 2.0 * b + c;
            (x + 1, y, difference * difference / 6.0)
        })
    })
}
