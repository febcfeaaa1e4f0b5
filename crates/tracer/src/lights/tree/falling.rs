//! Which weight of a row a random number falls on.

use super::node::LANES;

/// The share of a lane in the sum.
pub(super) fn share(weights: &[f32; LANES], lane: usize) -> f32 {
    let total: f32 = weights.iter().sum();
    if total > 0.0 { weights[lane] / total } else { 0.0 }
}

/// The lane that `u` in [0, 1) falls on, its share, and where in it `u` lies, in [0, 1).
pub(super) fn draw(weights: &[f32; LANES], u: f64) -> Option<(usize, f32, f64)> {
    let (lane, within) = fall(weights, weights.iter().sum(), u)?;
    Some((lane, share(weights, lane), within))
}

/// The weight of a row of sum `total` that `u` in [0, 1) falls on, and where in it.
pub(super) fn fall(weights: &[f32], total: f32, u: f64) -> Option<(usize, f64)> {
    let mut rest = u * f64::from(total);
    let mut chosen = None;
    for (lane, weight) in weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
        let weight = f64::from(*weight);
        chosen = Some((lane, (rest / weight).min(ONE_BELOW)));
        if rest < weight {
            break;
        }
        rest -= weight;
    }
    chosen
}

/// The largest `f64` below one.
const ONE_BELOW: f64 = 1.0 - 0.5 * f64::EPSILON;
