//! Numerical tools for traced lenses: searches for the edges of open regions, and an integration rule.

use core::f64::consts::TAU;

use etendue_core::maths::f64::sin_cos;
use glam::DVec2;

/// The last open position between an open and a closed one, by a number of bisections.
pub(super) fn last_open(mut bracket: [f64; 2], halvings: usize, is_open: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..halvings {
        let middle = 0.5 * (bracket[0] + bracket[1]);
        bracket[usize::from(!is_open(middle))] = middle;
    }
    bracket[0]
}

/// The largest distance up to `reach_mm` below which all steps are lit; `None` if the first is dark.
pub(super) fn max_lit_radius(reach_mm: f64, steps: usize, is_lit: impl Fn(f64) -> bool) -> Option<f64> {
    let at = |i: usize| reach_mm * i as f64 / steps as f64;
    let Some(dark) = (0..=steps).find(|i| !is_lit(at(*i))) else { return Some(reach_mm) };
    Some(last_open([at(dark.checked_sub(1)?), at(dark)], 30, is_lit))
}

/// The unit vector at an angle.
pub(super) fn unit(angle_rad: f64) -> DVec2 {
    let (sin, cos) = sin_cos(angle_rad);
    DVec2::new(cos, sin)
}

/// The unit vector of one of a number of directions around the circle.
pub(super) fn towards(i: usize, directions: usize) -> DVec2 {
    unit(TAU * i as f64 / directions as f64)
}

/// Gauss–Legendre abscissae and weights on [0, 1], five points.
pub(super) const GAUSS: [[f64; 2]; 5] = [
    [0.046_910_077_030_668, 0.118_463_442_528_094_5],
    [0.230_765_344_947_158_5, 0.239_314_335_249_683_2],
    [0.5, 0.284_444_444_444_444_4],
    [0.769_234_655_052_841_5, 0.239_314_335_249_683_2],
    [0.953_089_922_969_332, 0.118_463_442_528_094_5],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_found_between_steps() {
        assert!((last_open([1.0, 2.0], 40, |x| x < 1.3) - 1.3).abs() < 1e-10);
        let lit = max_lit_radius(10.0, 96, |x| x < 7.03).expect("lit at 0");
        assert!((lit - 7.03).abs() < 1e-6, "{lit}");
        assert_eq!(max_lit_radius(10.0, 96, |_| true), Some(10.0));
        assert_eq!(max_lit_radius(10.0, 96, |_| false), None);
        assert!((towards(1, 4) - DVec2::Y).length() < 1e-15);
    }
}
