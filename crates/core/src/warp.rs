//! Maps from the unit square to shapes, with their densities.

use core::f32::consts::{FRAC_PI_4, PI, TAU};

use glam::{Vec2, Vec3};

use crate::maths::f32::{cos, sin};

/// Maps the unit square to the unit disc, area-preserving and continuous (Shirley and Chiu 1997). Density 1/π by area.
#[must_use]
pub fn concentric_disc(u: Vec2) -> Vec2 {
    ring(u).0
}

/// Samples a direction of the upper hemisphere (z ≥ 0) with density cos θ / π by solid angle.
#[must_use]
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let (d, r) = ring(u);
    Vec3::new(d.x, d.y, ((1.0 - r) * (1.0 + r)).sqrt())
}

/// Maps a point of the unit square to the disc; also returns its distance from the centre. Squares about the centre become circles; along them the angle from
/// the nearer axis grows linearly, to π/4 at the corners.
#[inline]
fn ring(u: Vec2) -> (Vec2, f32) {
    let p = u * 2.0 - Vec2::ONE;
    let upright = p.y.abs() >= p.x.abs();
    let (long, short) = if upright { (p.y, p.x) } else { (p.x, p.y) };
    // Any angle is valid at the centre.
    let t = short / if long == 0.0 { 1.0 } else { long };
    let (along, across) = (long * cos_quarter(t), long * sin_quarter(t));
    (if upright { Vec2::new(across, along) } else { Vec2::new(along, across) }, long.abs())
}

/// cos(π t/4) for t of −1 to 1, by Taylor's series, whose next term is 4e-10 at most. In f32, as only rounding matters here.
#[inline]
fn cos_quarter(t: f32) -> f32 {
    let z = t * t;
    1.0 + z * (C[0] + z * (C[1] + z * (C[2] + z * (C[3] + z * C[4]))))
}

/// sin(π t/4) likewise; the next term is 2e-9 at most.
#[inline]
fn sin_quarter(t: f32) -> f32 {
    let z = t * t;
    t * (FRAC_PI_4 + z * (S[0] + z * (S[1] + z * (S[2] + z * S[3]))))
}

/// (π/4)².
const Q: f64 = core::f64::consts::FRAC_PI_4 * core::f64::consts::FRAC_PI_4;
/// −x²/2!, x⁴/4!, … for x = π/4.
const C: [f32; 5] = [
    (-Q / 2.0) as f32,
    (Q * Q / 24.0) as f32,
    (-Q * Q * Q / 720.0) as f32,
    (Q * Q * Q * Q / 40_320.0) as f32,
    (-Q * Q * Q * Q * Q / 3_628_800.0) as f32,
];
/// −x³/3!, x⁵/5!, …
const S: [f32; 4] = [
    (-core::f64::consts::FRAC_PI_4 * Q / 6.0) as f32,
    (core::f64::consts::FRAC_PI_4 * Q * Q / 120.0) as f32,
    (-core::f64::consts::FRAC_PI_4 * Q * Q * Q / 5_040.0) as f32,
    (core::f64::consts::FRAC_PI_4 * Q * Q * Q * Q / 362_880.0) as f32,
];

/// Density of [`cosine_hemisphere`] by solid angle, 1/sr; 0 below the horizon.
#[must_use]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) / PI
}

/// Samples a direction of the unit sphere, uniform by solid angle (density 1/4π).
#[must_use]
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let phi = TAU * u.y;
    Vec3::new(r * cos(phi), r * sin(phi), z)
}

/// Samples a direction of the cone about +z with half angle acos(1 − `one_minus_cos_max`), uniform by solid angle (density 1/(2π · `one_minus_cos_max`)). The
/// argument is 1 − cos θ so that a narrow cone (the sun) keeps its precision.
#[must_use]
pub fn uniform_cone(u: Vec2, one_minus_cos_max: f32) -> Vec3 {
    let one_minus_cos = u.x * one_minus_cos_max;
    let z = 1.0 - one_minus_cos;
    let r = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    let phi = TAU * u.y;
    Vec3::new(r * cos(phi), r * sin(phi), z)
}

/// Samples barycentric coordinates (of the second and third vertex) of a point of a triangle, uniform by area.
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
    use glam::DVec2;

    fn grid() -> impl Iterator<Item = Vec2> {
        (0..64 * 64).map(|i| Vec2::new(((i % 64) as f32 + 0.5) / 64.0, ((i / 64) as f32 + 0.5) / 64.0))
    }

    #[test]
    fn circles_are_round_and_angles_grow_evenly() {
        for u in grid() {
            let p = (u * 2.0 - Vec2::ONE).as_dvec2();
            let r = p.abs().max_element();
            let (near, far) = if p.x.abs() > p.y.abs() { (p.y / p.x, 0.0) } else { (-p.x / p.y, 0.5) };
            let turned = (near * 0.25 + far) * core::f64::consts::PI;
            let (sin, cos) = crate::maths::f64::sin_cos(turned);
            let exact = DVec2::new(cos, sin) * if far == 0.0 { p.x } else { p.y };
            // Five roundings of numbers below one.
            assert!((concentric_disc(u).as_dvec2() - exact).abs().max_element() < 3e-7, "{u}");
            let direction = cosine_hemisphere(u);
            assert!((f64::from(direction.z) - (1.0 - r * r).sqrt()).abs() < 1e-7, "{u}");
            assert!((direction.length() - 1.0).abs() < 3e-7, "{u}");
        }
        assert_eq!(cosine_hemisphere(Vec2::splat(0.5)), Vec3::Z);
        assert_eq!(cosine_hemisphere(Vec2::ZERO).z, 0.0, "on the horizon, and no NaN");
    }

    #[test]
    fn the_mean_of_a_cosine_hemisphere_is_two_thirds_up() {
        let mean = grid().map(cosine_hemisphere).sum::<Vec3>() / 4096.0;
        // The midpoint rule on 64 rings overestimates a mean with a vertical tangent at the edge by about 0.5·64^-1.5.
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
