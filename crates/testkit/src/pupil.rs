//! Irradiance behind a round pupil, from closed forms and from sums over its area.
//!
//! Lengths are in units of the distance from the sensor to the pupil. A uniform radiance of 1 is seen through the pupil.

use core::f64::consts::PI;
use etendue_core::maths::f64::{acos, sin_cos};

/// Irradiance/π at the tangent `t` off the axis behind a disc of radius `a` parallel to the sensor (Foote 1915):
/// ½ [1 − (1 + t² − a²)/√((1 + t² + a²)² − 4 t² a²)].
#[must_use]
pub fn foote(t: f64, a: f64) -> f64 {
    let (tt, aa) = (t * t, a * a);
    let sum = 1.0 + tt + aa;
    0.5 * (1.0 - (1.0 + tt - aa) / (sum * sum - 4.0 * tt * aa).sqrt())
}

/// Irradiance/π behind a disc of radius `a` as the sum of cos² θ/d² over rings and sectors, of the points that `open`
/// lets through (coordinates in units of `a`, x along the tangent `t`).
#[must_use]
pub fn by_sum(t: f64, a: f64, rings: usize, open: impl Fn([f64; 2]) -> bool) -> f64 {
    let sectors = 4 * rings;
    let mut sum = 0.0;
    for i in 0..rings * sectors {
        // Rings of equal area, so that every point stands for the same area.
        let radius = (((i / sectors) as f64 + 0.5) / rings as f64).sqrt();
        let (sin, cos) = sin_cos(2.0 * PI * ((i % sectors) as f64 + 0.5) / sectors as f64);
        let (x, y) = (radius * cos, radius * sin);
        if open([x, y]) {
            let squared = 1.0 + (t - a * x) * (t - a * x) + a * a * y * y;
            sum += 1.0 / (squared * squared);
        }
    }
    // dA = π a²/n, and the result is a share of π.
    sum * a * a / (rings * sectors) as f64
}

/// Common area of two discs of radii `r` and `s` whose centres are `d` apart.
#[must_use]
pub fn lens_area(r: f64, s: f64, d: f64) -> f64 {
    if d >= r + s {
        return 0.0;
    }
    if d <= (r - s).abs() {
        return PI * r.min(s) * r.min(s);
    }
    let (rr, ss, dd) = (r * r, s * s, d * d);
    let kite = ((r + s - d) * (d + r - s) * (d - r + s) * (d + r + s)).sqrt();
    rr * acos((dd + rr - ss) / (2.0 * d * r)) + ss * acos((dd + ss - rr) / (2.0 * d * s)) - 0.5 * kite
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closed_form_is_the_sum_over_the_disc() {
        for (t, a) in [(0.0, 0.5), (0.3, 0.357), (0.84, 0.25), (0.84, 0.01)] {
            let sum = by_sum(t, a, 200, |_| true);
            // The midpoint rule on 200 rings of equal area: 1e-6.
            assert!((foote(t, a) / sum - 1.0).abs() < 1e-5, "{t} {a}: {} {sum}", foote(t, a));
        }
    }

    #[test]
    fn the_common_area_is_the_sum_over_the_disc() {
        for (s, d) in [(1.0, 0.4), (0.7, 0.9), (1.5, 1.1), (0.2, 0.3), (1.0, 2.5)] {
            let (tiny, n) = (1e-6, 1000);
            let open = by_sum(0.0, tiny, n, |[x, y]| (x - d) * (x - d) + y * y <= s * s) / (tiny * tiny);
            // Points cut at the rim: of the order of 1/n.
            assert!((lens_area(1.0, s, d) / PI - open).abs() < 1e-3, "{s} {d}: {open}");
        }
    }

    #[test]
    fn the_check_values_of_the_finite_aperture() {
        let excess = |n: f64, degrees: f64| {
            let (a, (sin, cos)) = (0.5 / n, sin_cos(degrees.to_radians()));
            foote(sin / cos, a) / (foote(0.0, a) * cos * cos * cos * cos) - 1.0
        };
        // Against on-axis × cos⁴, told to two digits: +2.5 % at f/2 and 20°, +1.3 % at f/4 and 30°.
        assert!((excess(2.0, 20.0) - 0.025).abs() < 5e-4, "{}", excess(2.0, 20.0));
        assert!((excess(4.0, 30.0) - 0.013).abs() < 5e-4, "{}", excess(4.0, 30.0));
    }
}
