//! Irradiance from uniform lights and behind a round pupil: closed forms, and numerical sums that verify them.
//!
//! Lengths are in units of the distance from the sensor to the pupil. A uniform radiance of 1 is seen through the pupil.

use core::f64::consts::PI;

use etendue_core::maths::f64::{acos, sin_cos};
use glam::DVec3;

/// Irradiance at `point` on a surface of unit `normal` from a sphere of uniform radiance 1 that is entirely above the surface: π
/// (r/d)² cos θ.
#[must_use]
pub fn sphere(point: DVec3, normal: DVec3, centre: DVec3, radius: f64) -> f64 {
    let to_centre = centre - point;
    PI * radius * radius * to_centre.dot(normal) / (to_centre.length_squared() * to_centre.length())
}

/// Irradiance of a surface below a parallel disc of `radius` and uniform radiance 1, at the distance `height` from its plane and
/// `aside` from its axis: π/2 (1 − (a² + h² − r²)/√((a² + h² + r²)² − 4 r² a²)) (Hottel and Sarofim 1967); on the axis π r²/(r² +
/// h²).
#[must_use]
pub fn disc(height: f64, offset: f64, radius: f64) -> f64 {
    let (h2, a2, r2) = (height * height, offset * offset, radius * radius);
    let sum = a2 + h2 + r2;
    0.5 * PI * (1.0 - (sum - 2.0 * r2) / (sum * sum - 4.0 * r2 * a2).sqrt())
}

/// Irradiance at `point` on a surface of unit `normal` from a polygon of uniform radiance 1 that is entirely above the surface: ½
/// |Σ βᵢ n·(Rᵢ × Rᵢ₊₁)/|Rᵢ × Rᵢ₊₁||, βᵢ the angle between corners (Lambert 1760).
#[must_use]
pub fn polygon(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let rays: Vec<DVec3> = corners.iter().map(|c| (*c - point).normalize()).collect();
    let edge = |i: usize| {
        let (a, b) = (rays[i], rays[(i + 1) % rays.len()]);
        acos(a.dot(b).clamp(-1.0, 1.0)) * a.cross(b).normalize().dot(normal)
    };
    0.5 * (0..rays.len()).map(edge).sum::<f64>().abs()
}

/// Irradiance at `point` from a parallelogram of uniform radiance 1, as the sum of cos θ cos θ′/d² dA over n² patches: verifies
/// [`polygon`].
#[must_use]
pub fn parallelogram_by_sum(point: DVec3, normal: DVec3, corner: DVec3, sides: [DVec3; 2], n: usize) -> f64 {
    let area = sides[0].cross(sides[1]);
    let at = |i: usize| (i as f64 + 0.5) / n as f64;
    let patch = |i: usize, j: usize| {
        let ray = corner + sides[0] * at(i) + sides[1] * at(j) - point;
        let squared = ray.length_squared();
        (ray.dot(normal) * ray.dot(area).abs() / (squared * squared)).max(0.0)
    };
    (0..n * n).map(|k| patch(k / n, k % n)).sum::<f64>() / (n * n) as f64
}

/// Irradiance/π at the tangent `t` off the axis behind a disc of radius `a` parallel to the sensor (Foote 1915):
/// ½ [1 − (1 + t² − a²)/√((1 + t² + a²)² − 4 t² a²)].
#[must_use]
pub fn foote(t: f64, a: f64) -> f64 {
    let (tt, aa) = (t * t, a * a);
    let sum = 1.0 + tt + aa;
    0.5 * (1.0 - (1.0 + tt - aa) / (sum * sum - 4.0 * tt * aa).sqrt())
}

/// Irradiance/π behind a disc of radius `a` as the sum of cos² θ/d² over rings and sectors, over the points that `open` transmits
/// (coordinates in units of `a`, x along the tangent `t`).
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
    // dA = π a²/n, and the result is a fraction of π.
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

/// Simpson's rule with `intervals` (even) equal parts: exact for cubics.
///
/// # Panics
/// If the number of intervals is odd or zero.
#[must_use]
pub fn simpson(low: f64, high: f64, intervals: usize, f: impl Fn(f64) -> f64) -> f64 {
    assert!(intervals > 0 && intervals.is_multiple_of(2), "Simpson's rule needs pairs of intervals");
    let step = (high - low) / intervals as f64;
    let weight = |i: usize| match i {
        0 => 1.0,
        i if i == intervals => 1.0,
        i if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=intervals).map(|i| weight(i) * f(low + step * i as f64)).sum::<f64>() * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_contour_is_the_sum_over_patches() {
        let (corner, sides) = (DVec3::new(0.3, -1.0, 1.5), [DVec3::new(1.0, 0.2, 0.4), DVec3::new(-0.1, 1.5, 0.0)]);
        let corners = [corner, corner + sides[0], corner + sides[0] + sides[1], corner + sides[1]];
        for point in [DVec3::ZERO, DVec3::new(-2.0, 1.0, 0.1)] {
            let sum = parallelogram_by_sum(point, DVec3::Z, corner, sides, 400);
            // The midpoint rule's error falls with n²: about 1e-6 here.
            assert!((polygon(point, DVec3::Z, &corners) / sum - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn a_disc_is_a_polygon_of_many_sides() {
        const SIDES: u32 = 20_000;
        let (height, radius) = (1.5, 0.8);
        let corner = |i: u32| {
            let (s, c) = etendue_core::maths::f64::sin_cos(2.0 * PI * f64::from(i) / f64::from(SIDES));
            DVec3::new(radius * c, radius * s, height)
        };
        let corners: Vec<DVec3> = (0..SIDES).map(corner).collect();
        for offset in [0.0, 0.5, 3.0] {
            // The polygon lacks 2 π²/(3 n²) of the area, and the arc cosines of close corners lose some digits: 1e-6 in all is far
            // below the effect of a wrong sign or square.
            let sum = polygon(DVec3::X * offset, DVec3::Z, &corners);
            assert!((disc(height, offset, radius) / sum - 1.0).abs() < 1e-6, "{offset}: {sum}");
        }
        assert!((disc(height, 0.0, radius) - PI * 0.64 / (0.64 + 2.25)).abs() < 1e-12);
    }

    #[test]
    fn a_far_sphere_is_a_point_of_its_intensity() {
        let (radius, distance) = (0.1_f64, 50.0_f64);
        let far = sphere(DVec3::ZERO, DVec3::Z, DVec3::Z * distance, radius);
        assert!((far - PI * radius * radius / (distance * distance)).abs() < 1e-15);
    }

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
            // Points clipped at the edge: of the order of 1/n.
            assert!((lens_area(1.0, s, d) / PI - open).abs() < 1e-3, "{s} {d}: {open}");
        }
    }

    #[test]
    fn the_check_values_of_the_finite_aperture() {
        let excess = |n: f64, degrees: f64| {
            let (a, (sin, cos)) = (0.5 / n, sin_cos(degrees.to_radians()));
            foote(sin / cos, a) / (foote(0.0, a) * cos * cos * cos * cos) - 1.0
        };
        // Relative to on-axis × cos⁴, to two digits: +2.5 % at f/2 and 20°, +1.3 % at f/4 and 30°.
        assert!((excess(2.0, 20.0) - 0.025).abs() < 5e-4, "{}", excess(2.0, 20.0));
        assert!((excess(4.0, 30.0) - 0.013).abs() < 5e-4, "{}", excess(4.0, 30.0));
    }

    #[test]
    fn cubics_are_exact() {
        let integral = simpson(-1.0, 3.0, 2, |x| 2.0 * x * x * x - x + 1.0);
        assert!((integral - 40.0).abs() < 1e-13, "{integral}");
    }
}
