//! Star and dead leaves.

use super::{normals, test_image};
use crate::coverage::assert_coverage;
use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::{atan2, exp, hypot, sin_cos};
use etendue_metrology::texture::leaves::measure_texture;
use etendue_metrology::texture::{Star, measure_star};

/// A star blurred by a Gaussian, sampled at points.
#[test]
fn star() {
    const CYCLES: u32 = 48;
    let blur = |f: f64| exp(-2.0 * PI * PI * 0.25 * f * f);
    assert_coverage("star", |seed| {
        let mut normal = normals(seed, 0);
        let image = test_image(120, 120, |i| {
            let (dx, dy) = ((i % 120) as f64 + 0.5 - 60.3, (i / 120) as f64 + 0.5 - 59.8);
            let f = f64::from(CYCLES) / (TAU * hypot(dx, dy).max(1.0));
            let wave = sin_cos(f64::from(CYCLES) * atan2(dy, dx)).1;
            1000.0 * (1.0 + 0.8 * blur(f) * wave) + 60.0 * normal()
        });
        let star = Star {
            centre_px: (60.0, 60.0),
            cycles: CYCLES,
            inner_px: 18.0,
            outer_px: 55.0,
            black: 0.0,
            full_scale: None,
        };
        let (points, _) = measure_star(&image, &star).expect("a star");
        let truth = |f: f64| blur(f) / blur(points[0].frequency);
        let at = |name, k: usize| (name, points[k].response, truth(points[k].frequency));
        vec![at("response at 0.16 cycles/px", 8), at("response at 0.22", 20), at("response at 0.31", 30)]
    });
}

/// White texture filtered by a 3 × 3 kernel that wraps, with noise.
#[test]
fn leaves() {
    const SIDE: usize = 128;
    let kernel = |d: i64| if d == 0 { 0.6 } else { 0.2 };
    assert_coverage("texture", |seed| {
        let mut normal = normals(seed, 0);
        let reference = test_image(SIDE, SIDE, |_| 500.0 + 100.0 * normal());
        let soft = |i: usize| {
            let at = |dx: i64, dy: i64| {
                let wrap = |c: usize, d: i64| (c as i64 + d).rem_euclid(SIDE as i64) as usize;
                kernel(dx) * kernel(dy) * f64::from(reference.at(wrap(i % SIDE, dx), wrap(i / SIDE, dy)))
            };
            (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))).map(|(dx, dy)| at(dx, dy)).sum::<f64>()
        };
        let image = test_image(SIDE, SIDE, |i| soft(i) + 20.0 * normal());
        let points = measure_texture(&image, &reference, None, None).expect("a texture").points;
        // |S_xy|/S_xx of a band is the modulus of the mean transfer over its bins, all equally probable.
        let transfer = |k: usize| {
            let signed = |b: i64| b as f64;
            let (mut sum, mut bins) = (0.0, 0.0);
            for (u, v) in (-32..32).flat_map(|u| (-32..32).map(move |v| (u, v))) {
                if (hypot(signed(u), signed(v)) + 0.5) as usize == k {
                    let one = |b: i64| 0.6 + 0.4 * sin_cos(TAU * b as f64 / 64.0).1;
                    sum += one(u) * one(v);
                    bins += 1.0;
                }
            }
            sum / bins
        };
        let at = |name, k: usize| (name, points[k - 1].response, transfer(k) / transfer(1));
        vec![at("response at 0.13 cycles/px", 8), at("response at 0.25", 16), at("response at 0.38", 24)]
    });
}
