//! Irradiance from uniform lights: closed forms, and the sums that prove them.

use core::f64::consts::PI;
use etendue_core::maths::f64::acos;
use glam::DVec3;

/// Irradiance at `point` on a surface of unit `normal` from a sphere of uniform radiance 1 that stands wholly above the
/// surface: π (r/d)² cos θ.
#[must_use]
pub fn sphere(point: DVec3, normal: DVec3, centre: DVec3, radius: f64) -> f64 {
    let to_centre = centre - point;
    PI * radius * radius * to_centre.dot(normal) / (to_centre.length_squared() * to_centre.length())
}

/// Irradiance of a surface that a disc of `radius` and uniform radiance 1 faces, parallel to it, at the `height` of the
/// disc and at `aside` from its axis: π/2 (1 − (a² + h² − r²)/√((a² + h² + r²)² − 4 r² a²)) (Hottel and Sarofim 1967); on
/// the axis π r²/(r² + h²).
#[must_use]
pub fn disc(height: f64, aside: f64, radius: f64) -> f64 {
    let (h2, a2, r2) = (height * height, aside * aside, radius * radius);
    let sum = a2 + h2 + r2;
    0.5 * PI * (1.0 - (sum - 2.0 * r2) / (sum * sum - 4.0 * r2 * a2).sqrt())
}

/// Irradiance at `point` on a surface of unit `normal` from a polygon of uniform radiance 1 that stands wholly above the
/// surface: ½ |Σ βᵢ n·(Rᵢ × Rᵢ₊₁)/|Rᵢ × Rᵢ₊₁||, βᵢ the angle between corners (Lambert 1760).
#[must_use]
pub fn polygon(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let rays: Vec<DVec3> = corners.iter().map(|c| (*c - point).normalize()).collect();
    let edge = |i: usize| {
        let (a, b) = (rays[i], rays[(i + 1) % rays.len()]);
        acos(a.dot(b).clamp(-1.0, 1.0)) * a.cross(b).normalize().dot(normal)
    };
    0.5 * (0..rays.len()).map(edge).sum::<f64>().abs()
}

/// Irradiance at `point` from a parallelogram of uniform radiance 1, as the sum of cos θ cos θ′/d² dA over n² patches:
/// the proof of [`polygon`].
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
        for aside in [0.0, 0.5, 3.0] {
            // The polygon lacks 2 π²/(3 n²) of the area, and the arc cosines of close corners lose some digits: 1e-6 in
            // all is far below what a wrong sign or square would do.
            let sum = polygon(DVec3::X * aside, DVec3::Z, &corners);
            assert!((disc(height, aside, radius) / sum - 1.0).abs() < 1e-6, "{aside}: {sum}");
        }
        assert!((disc(height, 0.0, radius) - PI * 0.64 / (0.64 + 2.25)).abs() < 1e-12);
    }

    #[test]
    fn a_far_sphere_is_a_point_of_its_intensity() {
        let (radius, distance) = (0.1_f64, 50.0_f64);
        let far = sphere(DVec3::ZERO, DVec3::Z, DVec3::Z * distance, radius);
        assert!((far - PI * radius * radius / (distance * distance)).abs() < 1e-15);
    }
}
