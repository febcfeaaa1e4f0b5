//! Which weight of a row a random number falls on.

/// The share of a weight in the sum of its row.
pub(super) fn share(weights: &[f32], index: usize) -> f32 {
    let total: f32 = weights.iter().sum();
    if total > 0.0 { weights[index] / total } else { 0.0 }
}

/// The weight of a row that `u` in [0, 1) falls on, its share, and where in it `u` lies, in [0, 1); `None` where the row has none.
pub(super) fn draw(weights: &[f32], u: f64) -> Option<(usize, f32, f64)> {
    // As f64, in which no sum of these loses a weight that the share would count: the sum of f32 may differ by some roundings.
    let mut rest = u * weights.iter().map(|weight| f64::from(*weight)).sum::<f64>();
    let mut chosen = None;
    for (index, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
        let weight = f64::from(*weight);
        chosen = Some((index, (rest / weight).min(ONE_BELOW)));
        if rest < weight {
            break;
        }
        rest -= weight;
    }
    chosen.map(|(index, within)| (index, share(weights, index), within))
}

/// The largest `f64` below one.
const ONE_BELOW: f64 = 1.0 - 0.5 * f64::EPSILON;
