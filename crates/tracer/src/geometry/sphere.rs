//! Rays and spheres about the origin, in f64.
//!
//! The quadratic is solved without cancellation, however far or small the sphere (Haines, Günther, Akenine-Möller 2019,
//! "Precision improvements for ray/sphere intersection", Ray Tracing Gems, chapter 7).

use core::f64::consts::{PI, TAU};

use etendue_core::maths;
use glam::{DVec2, DVec3};

/// The two parameters at which a line hits a sphere of radius `radius` about the origin, lesser first; `direction` need not be of unit
/// length. `None` if it misses.
pub(crate) fn roots(radius: f64, origin: DVec3, direction: DVec3) -> Option<[f64; 2]> {
    let a = direction.length_squared();
    let b = -origin.dot(direction);
    let aside = origin + direction * (b / a);
    let reduced = radius * radius - aside.length_squared();
    // Written so that NaN is a miss.
    if !(reduced >= 0.0 && a > 0.0) {
        return None;
    }
    let q = b + (reduced * a).sqrt().copysign(b);
    let c = (origin.length() - radius) * (origin.length() + radius);
    let (t0, t1) = (if q == 0.0 { 0.0 } else { c / q }, q / a);
    Some(if t0 <= t1 { [t0, t1] } else { [t1, t0] })
}

/// The lesser positive parameter at which a ray hits the sphere.
pub(crate) fn nearest(radius: f64, origin: DVec3, direction: DVec3) -> Option<f64> {
    roots(radius, origin, direction)?.into_iter().find(|t| *t > 0.0)
}

/// Texture coordinates of a direction from the sphere's centre: longitude from +x towards +y in turns, and latitude
/// from the south pole (0) to the north pole (1), z up.
pub(crate) fn uv(unit: DVec3) -> DVec2 {
    let turn = maths::f64::atan2(unit.y, unit.x) / TAU;
    let latitude = maths::f64::asin(unit.z.clamp(-1.0, 1.0)) / PI;
    DVec2::new(if turn < 0.0 { turn + 1.0 } else { turn }, latitude + 0.5)
}

/// Texture units per metre on a sphere, as the root of the ratio of the whole areas.
pub(crate) fn uv_per_m(radius_m: f64) -> f64 {
    1.0 / (radius_m * (2.0 * TAU).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_sphere_far_away_is_hit_where_it_is() {
        let (distance, radius) = (1e6, 1e-3);
        let [near, far] = roots(radius, DVec3::new(-distance, 0.0, 0.0), DVec3::X).expect("a hit");
        // One rounding of the distance is 1.2e-10 m.
        assert!((near - (distance - radius)).abs() < 5e-10 && (far - (distance + radius)).abs() < 5e-10);
    }

    #[test]
    fn a_huge_sphere_just_below_is_hit_at_its_height() {
        let radius = 6.371e6;
        let height = 0.5;
        let t = nearest(radius, DVec3::new(0.0, 0.0, radius + height), DVec3::NEG_Z).expect("a hit");
        assert!((t - height).abs() < 1e-8, "{t}");
    }

    #[test]
    fn rays_from_inside_meet_the_far_side_and_rays_beyond_nothing() {
        assert_eq!(nearest(2.0, DVec3::ZERO, DVec3::Y * 4.0), Some(0.5));
        assert_eq!(nearest(2.0, DVec3::new(0.0, 3.0, 0.0), DVec3::Y), None);
        assert_eq!(nearest(2.0, DVec3::new(0.0, 3.0, 0.0), DVec3::X), None);
        assert_eq!(nearest(2.0, DVec3::splat(f64::NAN), DVec3::X), None);
        assert_eq!(nearest(2.0, DVec3::X, DVec3::ZERO), None);
    }

    #[test]
    fn texture_coordinates_have_their_axes() {
        assert_eq!(uv(DVec3::X), DVec2::new(0.0, 0.5));
        assert!((uv(DVec3::NEG_Y) - DVec2::new(0.75, 0.5)).length() < 1e-12);
        assert!((uv(DVec3::Z).y - 1.0).abs() < 1e-12 && uv(DVec3::NEG_Z).y.abs() < 1e-12);
    }
}
