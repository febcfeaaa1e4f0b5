//! Rays through drops.

use super::*;
use crate::precipitation::near::{DropRay, refracted};
use core::f64::consts::PI;
use etendue_core::maths::f64::{acos, asin, cos, sin};
use etendue_core::random::{philox4x32, unit_f64};
use etendue_spectra::Spectrum;
use etendue_stats::chi_square::goodness_of_fit;

const WATER: f64 = 1.333;

/// Uniform numbers in [0, 1).
fn number(i: u32, k: u32) -> f64 {
    let [a, b, ..] = philox4x32([i, k, 0, 0], [77, 5]);
    unit_f64(u64::from(a) << 32 | u64::from(b))
}

/// The hit of a ray along +x on a ball of radius 1, `b` off its axis.
fn at(b: f64, turn: f64) -> DVec3 {
    DVec3::new(-(1.0 - b * b).max(0.0).sqrt(), b * cos(turn), b * sin(turn))
}

fn at_place(place_m: DVec3, direction: DVec3) -> DropRay {
    DropRay { place_m, direction }
}

/// Light that goes straight through a ball is deflected by 2 (i − r), and a ball sees 165.57° of the world.
#[test]
fn light_through_a_ball_is_turned_as_snell_says() {
    let through = |b: f64| refracted(1.0, 1.0, WATER, at_place(at(b, 1.0), DVec3::X), |_| 1.0 - 1e-12).direction;
    for b in [0.0, 0.3, 0.7, 0.95, 0.9999] {
        let turned = acos(through(b).x.min(1.0));
        assert!((turned - 2.0 * (asin(b) - asin(b / WATER))).abs() < 1e-7, "{b}: {turned}");
    }
    // Linear extrapolation to grazing rays from two cosines of incidence; the remainder is 1.1 times their product.
    let turned = |cosine: f64| acos(through((1.0 - cosine * cosine).sqrt()).x).to_degrees();
    let field_deg = 2.0 * (2.0 * turned(0.004) - turned(0.008));
    assert!((field_deg - 165.57).abs() < 0.01, "{field_deg}");
}

/// The image in a ball is upside down.
#[test]
fn a_drop_shows_the_world_upside_down() {
    let actual = |b: f64, half_m: [f64; 2]| {
        refracted(half_m[0], half_m[1], WATER, at_place(at(b, 0.0) * DVec3::new(1.0, half_m[0], 1.0), DVec3::X), |_| {
            0.999
        })
    };
    for half_m in [[1.0, 1.0], [1.0, 1.0 - 1e-9]] {
        assert!(actual(0.5, half_m).direction.y < -0.2 && actual(-0.5, half_m).direction.y > 0.2);
    }
}

/// Single drops and the medium beyond them scatter equally: χ² over 12 bins of the angle, at the level 10⁻⁴.
#[test]
fn drops_scatter_as_the_phase_function_of_the_medium() {
    const RAYS: u32 = 40_000;
    const BINS: usize = 12;
    let table = crate::media::SpectralTable::from_large_balls(&Spectrum::constant(WATER));
    let phase = crate::media::Phase::Table(table);
    let wavelengths = etendue_core::Wavelengths { nm: [550.0], pdf: [1.0] };
    let density = |angle: f64| {
        let to = DVec3::new(cos(angle), sin(angle), 0.0).as_vec3();
        f64::from(phase.density(glam::Vec3::X, to, &wavelengths))
    };
    const STEPS: u32 = 4000;
    let mut expected = [0.0; BINS];
    for i in 0..STEPS * BINS as u32 {
        let step = PI / f64::from(STEPS * BINS as u32);
        let angle = (f64::from(i) + 0.5) * step;
        expected[(i / STEPS) as usize] += 2.0 * PI * sin(angle) * step * density(angle) * f64::from(RAYS);
    }
    let mut counts = [0_u64; BINS];
    for i in 0..RAYS {
        let (b, turn) = (number(i, 100).sqrt(), 2.0 * PI * number(i, 101));
        let out = refracted(1.0, 1.0, WATER, at_place(at(b, turn), DVec3::X), |k| number(i, k));
        counts[((acos(out.direction.x.clamp(-1.0, 1.0)) / PI * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let total: f64 = expected.iter().sum();
    assert!((total / f64::from(RAYS) - 1.0).abs() < 1e-4, "{total}");
    let test = goodness_of_fit(&counts, &expected).expect("bins");
    assert!(test.p > 1e-4, "{test:?}: {counts:?} {expected:?}");
}

/// Fresnel reflectance of an interface, of both planes.
fn planes(i: f64, r: f64) -> [f64; 2] {
    let (ci, cr) = (cos(i), cos(r));
    let of = |a: f64, b: f64| ((a - b) / (a + b)) * ((a - b) / (a + b));
    [of(ci, WATER * cr), of(WATER * ci, cr)]
}

/// Fraction of a cone about an axis `up` above the horizon that lies above it.
fn above(up: f64, turned: f64) -> f64 {
    let x = -(cos(turned) * sin(up)) / (sin(turned) * cos(up)).max(1e-12);
    acos(x.clamp(-1.0, 1.0)) / PI
}

/// The mean of a ball's disc under a sky of 1 above the horizon and 0 below, seen upwards by `up`: light transmitted from its field of
/// 165.57°, and light reflected outside and inside. Van de Hulst's sum, by sixty passages.
fn half_bright(up: f64) -> f64 {
    const STEPS: u32 = 5000;
    let at = |k: u32| {
        let b = (f64::from(k) + 0.5) / f64::from(STEPS);
        let (i, r) = (asin(b), asin(b / WATER));
        let of = |mirrored: f64| {
            let mut sum = mirrored * above(up, PI - 2.0 * i);
            let mut left = (1.0 - mirrored) * (1.0 - mirrored);
            for p in 1..60 {
                let turned = 2.0 * (i - r) + f64::from(p - 1) * (PI - 2.0 * r);
                sum += left * above(up, acos(cos(turned)));
                left *= mirrored;
            }
            sum
        };
        let [s, p] = planes(i, r);
        b * (of(s) + of(p)) / f64::from(STEPS)
    };
    (0..STEPS).map(at).sum()
}

/// A falling drop under a half-bright sky, against the sum of its passages: within four standard errors.
#[test]
fn a_drop_under_a_half_bright_sky_is_as_bright_as_its_passages() {
    const RAYS: u32 = 40_000;
    for (round, up_deg) in [0.0_f64, 25.0, 60.0].into_iter().enumerate() {
        let up = up_deg.to_radians();
        let towards = DVec3::new(cos(up), 0.0, sin(up));
        let turn = glam::DQuat::from_rotation_arc(DVec3::X, towards);
        let bright = (0..RAYS)
            .filter(|i| {
                let j = i + RAYS * round as u32;
                let place = turn * at(number(j, 100).sqrt(), 2.0 * PI * number(j, 101));
                refracted(1.0, 1.0, WATER, at_place(place, towards), |k| number(j, k)).direction.z > 0.0
            })
            .count();
        let (actual, expected) = (bright as f64 / f64::from(RAYS), half_bright(up));
        let error = (expected * (1.0 - expected) / f64::from(RAYS)).sqrt();
        assert!((actual - expected).abs() < 4.0 * error, "{up_deg}°: {actual} {expected}");
    }
    assert!((half_bright(0.0) - 0.5).abs() < 1e-3, "upside down and as it is are alike on the horizon");
}
