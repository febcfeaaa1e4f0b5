//! The rule of Gauss and Legendre.

use std::sync::LazyLock;

/// Nodes of the rule.
const NODES: usize = 20;

/// Nodes on [0, 1] and their weights, which sum to 1: exact for polynomials up to degree 39.
pub(super) static GAUSS: LazyLock<[(f64, f64); NODES]> = LazyLock::new(|| core::array::from_fn(node));

/// Newton's steps from Tricomi's estimate of a root of the Legendre polynomial.
fn node(i: usize) -> (f64, f64) {
    let n = NODES as f64;
    let mut x = etendue_core::maths::f64::cos(core::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
    for _ in 0..8 {
        let (value, slope) = legendre(x);
        x -= value / slope;
    }
    let slope = legendre(x).1;
    (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
}

/// The Legendre polynomial and its derivative, by recurrence.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=NODES {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    (value, NODES as f64 * (x * value - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_integrated_exactly() {
        for power in [0, 1, 2, 11, 39] {
            let sum: f64 = GAUSS.iter().map(|(x, w)| w * (0..power).map(|_| x).product::<f64>()).sum();
            assert!((sum * f64::from(power + 1) - 1.0).abs() < 1e-13, "{power}: {sum}");
        }
    }
}
