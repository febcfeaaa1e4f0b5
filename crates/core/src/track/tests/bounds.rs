use super::{Random, about_z, key};
use crate::TimeInterval;
use crate::track::{Interpolation, Key, Track};
use core::f64::consts::{FRAC_PI_2, PI};
use glam::{DAffine3, DMat3, DVec3};

fn interval(a: f64, b: f64) -> TimeInterval {
    TimeInterval::new(a.min(b), a.max(b)).expect("in order")
}

fn holds((low, high): (DVec3, DVec3), p: DVec3) -> bool {
    low.cmple(p).all() && p.cmple(high).all()
}

/// Boxes and balls of 10⁴ random tracks, at 40 moments each, without any tolerance.
#[test]
fn bounds_hold_what_moves() {
    let mut random = Random(11, 0);
    for i in 0..10_000 {
        let (mut track, _) = random.track();
        if i % 4 == 0 {
            let sheared = DMat3::from_cols(random.cube() + DVec3::X * 2.0, random.cube() + DVec3::Y * 2.0, DVec3::Z);
            track = track.after(&DAffine3::from_mat3_translation(sheared, random.cube() * 1e3));
        }
        let interval = interval(random.between(-0.5, 4.0), random.between(-0.5, 4.0));
        let (centre, half) = (random.cube() * random.between(0.0, 10.0), random.cube().abs());
        let corners = (centre - half, centre + half);
        let bounds = track.bounds_over(interval, corners);
        let ball = track.bounds_of_ball(interval, centre, half.x);
        let (minimum, maximum) = track.stretch_over(interval);
        let reach = track.local_reach(interval, bounds);
        for moment in 0..40 {
            let part = [0.0, 1.0][moment % 2] * f64::from(u8::from(moment < 2))
                + f64::from(u8::from(moment >= 2)) * random.unit();
            let transform = track.at(interval.start_s() + interval.length_s() * part);
            let within = centre + half * random.cube();
            let corner = centre + half * random.cube().signum();
            assert!(
                holds(bounds, transform.transform_point3(within)) && holds(bounds, transform.transform_point3(corner))
            );
            let direction = random.cube().normalize();
            assert!(holds(ball, transform.transform_point3(centre + direction * half.x * (1.0 - 1e-12))));
            let length = transform.transform_vector3(direction).length();
            assert!(length >= minimum * (1.0 - 1e-12) && length <= maximum * (1.0 + 1e-12));
            let anywhere = bounds.0 + (bounds.1 - bounds.0) * (random.cube() * 0.5 + 0.5);
            let local = transform.inverse().transform_point3(anywhere).abs().max_element();
            assert!(local <= reach * (1.0 + 1e-9), "{local} {reach}");
        }
    }
}

const CUBE: (DVec3, DVec3) = (DVec3::NEG_ONE, DVec3::ONE);

#[test]
fn a_box_that_goes_straight_has_the_box_of_its_travel() {
    for how in [Interpolation::Linear, Interpolation::Smooth] {
        let keys = [key(0.0, DVec3::ZERO, about_z(0.0)), key(2.0, DVec3::new(8.0, -4.0, 0.0), about_z(0.0))];
        let track = Track::new(&keys, how).expect("legal");
        let (low, high) = track.bounds_over(interval(0.5, 1.0), CUBE);
        assert!((low - DVec3::new(1.0, -3.0, -1.0)).length() < 1e-12, "{low}");
        assert!((high - DVec3::new(5.0, 0.0, 1.0)).length() < 1e-12, "{high}");
        let (low, high) = track.bounds_of_ball(interval(1.0, 7.0), DVec3::ZERO, 0.5);
        assert!((low - DVec3::new(3.5, -4.5, -0.5)).length() < 1e-12, "{low}");
        assert!((high - DVec3::new(8.5, -1.5, 0.5)).length() < 1e-12, "{high}");
    }
}

/// A rod from (1, 0, 0) to (2, 0, 0) turned by 90° about z stays in the quarter ring: x and y from 0 to 2. Each chord of sixteen
/// is off by (π/32)²/8 · 2 = 0.0024 at most. The smooth curve through three keys of that turn is the same, its bound is not.
#[test]
fn a_turn_by_90_degrees_loses_little() {
    let stray = (PI / 32.0) * (PI / 32.0) / 8.0 * 2.0;
    let half = [0.0, 0.5, 1.0].map(|part| key(part, DVec3::ZERO, about_z(part * FRAC_PI_2)));
    let even = Track::new(&[half[0], half[2]], Interpolation::Linear).expect("legal");
    let smooth = Track::new(&half, Interpolation::Smooth).expect("legal");
    for (track, loss) in [(even, stray), (smooth, 3.0 * stray)] {
        let (low, high) = track.bounds_over(interval(0.0, 1.0), (DVec3::X, DVec3::X * 2.0));
        let exact = (DVec3::ZERO, DVec3::new(2.0, 2.0, 0.0));
        let out = (exact.0 - low).max(high - exact.1);
        assert!(out.min_element() >= 0.0 && out.max_element() <= loss * 1.0001, "{low} {high}");
    }
}

/// Points on the axis of a rotation do not move.
#[test]
fn a_turn_moves_nothing_on_its_axis() {
    let keys = [key(0.0, DVec3::X, about_z(0.0)), key(1.0, DVec3::X, about_z(3.0))];
    let track = Track::new(&keys, Interpolation::Linear).expect("legal");
    let (low, high) = track.bounds_over(interval(0.0, 1.0), (DVec3::Z * -5.0, DVec3::Z * 5.0));
    assert!((low - DVec3::new(1.0, 0.0, -5.0)).length() < 1e-12 && (high - DVec3::new(1.0, 0.0, 5.0)).length() < 1e-12);
}

/// Tracks of keys with one scale, by any interpolation; tracks that change scale are bounded by π.
#[test]
fn turning_bounds_the_angles_of_normals() {
    let mut random = Random(17, 0);
    for _ in 0..1000 {
        let (_, keys) = random.track();
        let scale = keys[0].scale;
        let same: Vec<Key> = keys.iter().map(|key| Key { scale, ..*key }).collect();
        for (keys, how) in
            [(&same, Interpolation::Linear), (&same, Interpolation::Smooth), (&keys, Interpolation::Linear)]
        {
            let track = Track::new(keys, how).expect("legal");
            let interval = interval(random.between(0.0, 2.0), random.between(0.0, 2.0));
            let bound = track.turning_over(interval);
            let normal = random.cube();
            let at = |time_s| (track.at(time_s).matrix3.inverse().transpose() * normal).normalize();
            let start = at(interval.start_s());
            for _ in 0..20 {
                let end = at(interval.start_s() + interval.length_s() * random.unit());
                let angle = crate::maths::f64::atan2(start.cross(end).length(), start.dot(end));
                assert!(angle <= bound + 1e-9, "{angle} {bound}");
            }
        }
    }
    let turn = [key(0.0, DVec3::ZERO, about_z(0.0)), key(2.0, DVec3::X, about_z(1.0))];
    let track = Track::new(&turn, Interpolation::Linear).expect("legal");
    assert!((track.turning_over(interval(0.5, 1.0)) - 0.25).abs() < 1e-15);
}

#[test]
fn a_moment_and_a_time_beyond_the_keys_have_the_box_itself() {
    let mut random = Random(13, 0);
    for _ in 0..200 {
        let (track, keys) = random.track();
        let last_s = keys[keys.len() - 1].time_s;
        let moment = random.between(0.0, last_s);
        for interval in [interval(moment, moment), interval(last_s, last_s + 3.0), interval(-4.0, keys[0].time_s)] {
            let transform = track.constant_over(interval).expect("nothing moves");
            assert_eq!(transform, track.at(interval.end_s()));
            let (low, high) = track.bounds_over(interval, CUBE);
            let (exact_low, exact_high) = Track::constant(transform).bounds_over(interval, CUBE);
            // Tolerance for rounding: 1e-14 of coordinates to 1e6.
            assert!((low - exact_low).length() < 1e-7 && (high - exact_high).length() < 1e-7);
        }
        assert_eq!(track.constant_over(interval(keys[0].time_s, last_s)), None);
    }
}

#[test]
fn a_parked_interval_stands_still() {
    let away = DVec3::X * 9.0;
    let keys = [(0.0, DVec3::ZERO), (1.0, away), (2.0, away), (3.0, away), (4.0, DVec3::ZERO)];
    let keys = keys.map(|(time_s, place)| key(time_s, place, about_z(1.0)));
    let track = Track::new(&keys, Interpolation::Linear).expect("legal");
    assert_eq!(track.constant_over(interval(1.0, 3.0)), Some(track.at(2.5)));
    assert_eq!(track.constant_over(interval(0.999, 3.0)), None);
    assert_eq!(track.constant_over(interval(1.0, 3.001)), None);
}

#[test]
fn a_scale_through_zero_has_no_inverse() {
    let scaled =
        |time_s: f64, z: f64| Key { scale: DVec3::new(1.0, -1.0, z), ..key(time_s, DVec3::ZERO, about_z(1.0)) };
    let track = |heights: &[f64], how| {
        let keys: Vec<Key> = (0..).zip(heights).map(|(i, z)| scaled(f64::from(i), *z)).collect();
        Track::new(&keys, how).expect("legal").is_invertible()
    };
    assert!(track(&[1.0, 2.0], Interpolation::Linear) && track(&[-1.0, -2.0, -0.1], Interpolation::Linear));
    assert!(!track(&[1.0, 0.0], Interpolation::Linear) && !track(&[1.0, -1.0], Interpolation::Linear));
    // The curve's slopes at the second and third key take it below zero between them.
    let steep = [10.0, 1.0, 0.1, 10.0];
    assert!(track(&steep, Interpolation::Linear) && !track(&steep, Interpolation::Smooth));
    assert!(!Track::constant(DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))).is_invertible());
}
