//! Maps from the unit square to shapes, with their densities.

use crate::maths::f32::{cos, sin, sin_cos};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};
use glam::{Vec2, Vec3};

/// From the unit square to the unit disc, area-preserving and continuous (Shirley and Chiu 1997). Density 1/π by area.
#[must_use]
pub fn concentric_disc(u: Vec2) -> Vec2 {
    let p = u * 2.0 - Vec2::ONE;
    if p == Vec2::ZERO {
        return Vec2::ZERO;
    }
    let (r, angle) =
        if p.x.abs() > p.y.abs() { (p.x, FRAC_PI_4 * (p.y / p.x)) } else { (p.y, FRAC_PI_2 - FRAC_PI_4 * (p.x / p.y)) };
    let (s, c) = sin_cos(angle);
    Vec2::new(r * c, r * s)
}

/// A direction of the upper hemisphere (z ≥ 0) with density cos θ / π by solid angle.
#[must_use]
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = concentric_disc(u);
    Vec3::new(d.x, d.y, (1.0 - d.length_squared()).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] by solid angle, 1/sr; 0 below the horizon.
#[must_use]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) / PI
}

/// A direction of the unit sphere, uniform by solid angle (density 1/4π).
#[must_use]
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let phi = TAU * u.y;
    Vec3::new(r * cos(phi), r * sin(phi), z)
}

/// A direction of the cone about +z with half angle acos(1 − `one_minus_cos_max`), uniform by solid angle (density
/// 1/(2π · `one_minus_cos_max`)). The argument is 1 − cos θ so that a narrow cone (the sun) keeps its digits.
#[must_use]
pub fn uniform_cone(u: Vec2, one_minus_cos_max: f32) -> Vec3 {
    let one_minus_cos = u.x * one_minus_cos_max;
    let z = 1.0 - one_minus_cos;
    let r = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    let phi = TAU * u.y;
    Vec3::new(r * cos(phi), r * sin(phi), z)
}

/// Barycentric coordinates (of the second and third vertex) of a point of a triangle, uniform by area.
#[must_use]
pub fn uniform_triangle(u: Vec2) -> Vec2 {
    if u.x < u.y {
        let a = u.x / 2.0;
        Vec2::new(a, u.y - a)
    } else {
        let b = u.y / 2.0;
        Vec2::new(u.x - b, b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> impl Iterator<Item = Vec2> {
        (0..64 * 64).map(|i| Vec2::new(((i % 64) as f32 + 0.5) / 64.0, ((i / 64) as f32 + 0.5) / 64.0))
    }

    #[test]
    fn the_mean_of_a_cosine_hemisphere_is_two_thirds_up() {
        let mean = grid().map(cosine_hemisphere).sum::<Vec3>() / 4096.0;
        // The midpoint rule on 64 rings overstates a mean with a vertical tangent at the rim by about 0.5·64^-1.5.
        assert!((mean - Vec3::new(0.0, 0.0, 2.0 / 3.0)).length() < 1.2e-3, "{mean}");
    }

    #[test]
    fn a_sphere_and_a_cone_have_their_means() {
        assert!((grid().map(uniform_sphere).sum::<Vec3>() / 4096.0).length() < 1e-5);
        let mean = grid().map(|u| uniform_cone(u, 0.5)).sum::<Vec3>() / 4096.0;
        assert!((mean.z - 0.75).abs() < 1e-5);
    }

    #[test]
    fn a_triangle_is_covered_evenly() {
        let mean = grid().map(uniform_triangle).sum::<Vec2>() / 4096.0;
        assert!((mean - Vec2::splat(1.0 / 3.0)).length() < 1e-3);
        assert!(grid().map(uniform_triangle).all(|b| b.x >= 0.0 && b.y >= 0.0 && b.x + b.y <= 1.0 + 1e-6));
    }
}
