//! The equal-area map of the sphere to a square that pbrt's environments are stored in.
//!
//! Source: P. Clarberg, "Fast equal-area mapping of the (hemi)sphere using SIMD", JGT 13(3), 2008, as pbrt-v4 has it.

use etendue_core::maths::f64 as maths;
use glam::DVec3;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_4};

/// Where in the unit square a direction of length 1 lies; the second coordinate grows with rows.
pub(super) fn square_of(d: DVec3) -> [f64; 2] {
    let [x, y, z] = d.abs().to_array();
    let r = (1.0 - z).max(0.0).sqrt();
    let angle = if x == 0.0 && y == 0.0 { 0.0 } else { FRAC_2_PI * maths::atan2(y, x) };
    let (u, v) = (r - angle * r, angle * r);
    let (u, v) = if d.z < 0.0 { (1.0 - v, 1.0 - u) } else { (u, v) };
    [0.5 * (u.copysign(d.x) + 1.0), 0.5 * (v.copysign(d.y) + 1.0)]
}

/// The direction of a point of the unit square: the inverse of [`square_of`].
pub(super) fn direction_of([u, v]: [f64; 2]) -> DVec3 {
    let (u, v) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    // Of the inner half of the square above the horizon, of its corners below.
    let above = 1.0 - (u.abs() + v.abs());
    let r = 1.0 - above.abs();
    let azimuth = if r == 0.0 { 0.0 } else { FRAC_PI_4 * ((v.abs() - u.abs()) / r + 1.0) };
    let (sin, cos) = maths::sin_cos(azimuth);
    let level = r * (2.0 - r * r).max(0.0).sqrt();
    DVec3::new((cos * level).copysign(u), (sin * level).copysign(v), (1.0 - r * r).copysign(above))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_lie_where_the_paper_has_them() {
        let near = |d: DVec3, [u, v]: [f64; 2]| {
            let [a, b] = square_of(d);
            assert!((a - u).abs() < 1e-12 && (b - v).abs() < 1e-12, "{d}: {a} {b}");
        };
        near(DVec3::Z, [0.5, 0.5]);
        near(DVec3::X, [1.0, 0.5]);
        near(DVec3::NEG_Y, [0.5, 0.0]);
        near(DVec3::new(1.0, 1.0, 0.0).normalize(), [0.75, 0.75]);
    }

    #[test]
    fn points_of_the_square_lead_back_to_themselves() {
        for i in 0..400 {
            let point = [(f64::from(i % 20) + 0.3) / 20.0, (f64::from(i / 20) + 0.6) / 20.0];
            let direction = direction_of(point);
            let back = square_of(direction);
            assert!((direction.length() - 1.0).abs() < 1e-12, "{point:?}");
            assert!((0..2).all(|k| (back[k] - point[k]).abs() < 1e-9), "{point:?} {back:?}");
        }
    }

    /// Directions that are spread evenly fall evenly on the square.
    #[test]
    fn areas_are_kept() {
        const N: u32 = 400;
        let mut cells = [0_u32; 16];
        for i in 0..N * N {
            let (a, b) = ((f64::from(i % N) + 0.5) / f64::from(N), (f64::from(i / N) + 0.5) / f64::from(N));
            let z = 2.0 * a - 1.0;
            let (s, c) = maths::sin_cos(std::f64::consts::TAU * b);
            let r = (1.0 - z * z).sqrt();
            let [u, v] = square_of(DVec3::new(r * c, r * s, z));
            cells[((u * 4.0) as usize).min(3) + 4 * ((v * 4.0) as usize).min(3)] += 1;
        }
        // A grid of 160 000 over 16 cells: along their borders it is uneven by a line of 400 in 10 000, a quarter of which is allowed.
        assert!(cells.iter().all(|n| n.abs_diff(N * N / 16) < N * N / 1600), "{cells:?}");
    }
}
