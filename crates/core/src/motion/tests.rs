//! Tests of chains against their tracks, boxes against many moments, and wheels against closed forms.

use super::Motion;
use crate::TimeInterval;
use crate::random::{philox4x32, unit_f64};
use crate::track::{Interpolation, Key, RollingError, Track};
use core::f64::consts::FRAC_PI_2;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Reproducible numbers.
struct Random(u32);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 += 1;
        let words = philox4x32([self.0, 0, 0, 0], [23, 0]);
        unit_f64(u64::from(words[0]) << 32 | u64::from(words[1]))
    }

    fn cube(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    fn track(&mut self, scales: bool) -> Track {
        let mut time_s = self.unit();
        let reach = [0.0, 1.0, 100.0][(self.unit() * 3.0) as usize];
        let key = |_| {
            time_s += 0.05 + self.unit();
            let scale = if scales { self.cube().abs() + 0.5 } else { DVec3::ONE };
            let rotation =
                DQuat::from_xyzw(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5, self.unit() + 1e-3);
            Key { time_s, position_m: self.cube() * reach, rotation, scale }
        };
        let keys: Vec<Key> = (0..4).map(key).collect();
        let how = if self.unit() < 0.5 { Interpolation::Linear } else { Interpolation::Smooth };
        Track::new(&keys, how).expect("legal")
    }

    fn shift(&mut self) -> Motion {
        let sheared = DMat3::from_cols(self.cube() + DVec3::X * 2.0, self.cube() + DVec3::Y * 2.0, DVec3::Z);
        Motion::constant(DAffine3::from_mat3_translation(sheared, self.cube() * 10.0))
    }
}

fn over(a: f64, b: f64) -> TimeInterval {
    TimeInterval::new(a.min(b), a.max(b)).expect("in order")
}

fn key(time_s: f64, position_m: DVec3, yaw_rad: f64) -> Key {
    let (sin, cos) = crate::maths::f64::sin_cos(0.5 * yaw_rad);
    Key { time_s, position_m, rotation: DQuat::from_xyzw(0.0, 0.0, sin, cos), scale: DVec3::ONE }
}

fn linear(keys: &[Key]) -> Motion {
    Track::new(keys, Interpolation::Linear).expect("legal").into()
}

/// Boxes, balls, lengths, inverses and angles of 3000 random chains of two to four motions, at 30 moments each.
#[test]
fn bounds_hold_what_is_carried() {
    let mut random = Random(0);
    for i in 0..3000 {
        let is_rigid = i % 3 == 0;
        let mut motion: Motion = random.track(!is_rigid).into();
        for _ in 0..1 + i % 3 {
            motion = if i % 4 == 0 && !is_rigid { motion.carrying(&random.shift()) } else { motion };
            motion = motion.carrying(&random.track(!is_rigid).into());
        }
        let interval = over(random.unit() * 4.0, random.unit() * 4.0);
        let (centre, half) = (random.cube() * 5.0, random.cube().abs());
        let (low, high) = motion.bounds_over(interval, (centre - half, centre + half));
        let ball = motion.bounds_of_ball(interval, centre, half.x);
        let rough = motion.rough_bounds(interval, (centre.abs() + half).length());
        let (minimum, maximum) = motion.stretch_over(interval);
        let reach = motion.local_reach(interval, (low, high));
        let turning = motion.turning_over(interval);
        let normal = random.cube();
        let turned = |to_world: DAffine3| (to_world.matrix3.inverse().transpose() * normal).normalize();
        let start = turned(motion.at(interval.start_s()));
        for moment in 0..30_u8 {
            let part = if moment < 2 { f64::from(moment) } else { random.unit() };
            let to_world = motion.at(interval.start_s() + interval.length_s() * part);
            let corner = to_world.transform_point3(centre + half * random.cube().signum());
            assert!(low.cmple(corner).all() && corner.cmple(high).all(), "{corner} {low} {high}");
            assert!(rough.0.cmple(corner).all() && corner.cmple(rough.1).all());
            let direction = random.cube().normalize();
            let edge_point = to_world.transform_point3(centre + direction * half.x * (1.0 - 1e-12));
            assert!(ball.0.cmple(edge_point).all() && edge_point.cmple(ball.1).all());
            let length = to_world.transform_vector3(direction).length();
            assert!(length >= minimum * (1.0 - 1e-12) && length <= maximum * (1.0 + 1e-12));
            let back = to_world.inverse().transform_point3(low + (high - low) * (random.cube() * 0.5 + 0.5));
            assert!(back.abs().max_element() <= reach * (1.0 + 1e-9));
            let end = turned(to_world);
            let angle = crate::maths::f64::atan2(start.cross(end).length(), start.dot(end));
            assert!(angle <= turning + 1e-9, "{angle} {turning}");
        }
        assert_eq!(motion.is_rigid(), is_rigid);
        assert!(!is_rigid || motion.keeps_areas());
    }
}

#[test]
fn one_track_answers_as_it_does_by_itself() {
    let mut random = Random(9000);
    for _ in 0..300 {
        let track = random.track(true);
        let motion = Motion::constant(DAffine3::IDENTITY).carrying(&track.clone().into());
        assert_eq!(motion, track.clone().into());
        let interval = over(random.unit() * 4.0, random.unit() * 4.0);
        let corners = (-random.cube().abs(), random.cube().abs());
        assert_eq!(motion.bounds_over(interval, corners), track.bounds_over(interval, corners));
        assert_eq!(motion.bounds_of_ball(interval, corners.0, 2.0), track.bounds_of_ball(interval, corners.0, 2.0));
        assert_eq!(motion.stretch_over(interval), track.stretch_over(interval));
        assert_eq!(motion.local_reach(interval, corners), track.local_reach(interval, corners));
        assert_eq!(motion.turning_over(interval), track.turning_over(interval));
        assert_eq!(motion.constant_over(interval), track.constant_over(interval));
        assert_eq!(motion.at(1.5), track.at(1.5));
    }
}

#[test]
fn what_stands_still_in_a_moving_frame_is_part_of_its_track() {
    let car = linear(&[key(0.0, DVec3::ZERO, 0.0), key(2.0, DVec3::X * 30.0, FRAC_PI_2)]);
    let mirror = DAffine3::from_translation(DVec3::new(1.0, 0.9, 1.1));
    let mounted = car.carrying(&Motion::constant(mirror)).carrying(&Motion::constant(mirror));
    assert_eq!(mounted, car.after(&mirror).after(&mirror));
    assert_eq!(Motion::constant(mirror).carrying(&Motion::constant(mirror)), Motion::constant(mirror * mirror));
    assert_eq!(mounted.motion_interval(), Some(over(0.0, 2.0)));
    assert_eq!(Motion::constant(mirror).motion_interval(), None);
    let arm = linear(&[key(1.0, DVec3::ZERO, 0.0), key(3.0, DVec3::Y, 0.0)]);
    let carried = car.carrying(&arm);
    assert_eq!(carried.at(1.7), car.at(1.7) * arm.at(1.7));
    assert_eq!(carried.motion_interval(), Some(over(0.0, 3.0)));
    assert_eq!(carried.constant_over(over(3.0, 9.0)), Some(carried.at(9.0)));
    assert!(carried.constant_over(over(2.5, 2.6)).is_none() && carried.as_constant().is_none());
}

/// A wheel of 0.3 m on a car at 15 m/s, over a shutter of 30 ms: the car goes 0.45 m and the wheel turns by 1.5 rad. A mesh's box of half side 0.3 stays within
/// the circle about its corners, 0.3 √2.
#[test]
fn a_wheel_has_the_box_of_its_way_and_no_more() {
    let car = linear(&[key(0.0, DVec3::ZERO, 0.0), key(10.0, DVec3::X * 150.0, 0.3)]);
    let hub = car.carrying(&Motion::constant(DAffine3::from_translation(DVec3::new(1.4, 0.8, 0.3))));
    let wheel = hub.carrying(&hub.rolling(0.3).expect("it moves"));
    let half = DVec3::new(0.3, 0.1, 0.3);
    let (low, high) = wheel.bounds_over(over(2.0, 2.03), (-half, half));
    let circle = 0.3 * 2.0_f64.sqrt();
    // The hub yaws by 0.061 rad in all until then: x and y of the box are mixed by its sine, 0.061.
    let mixed = 0.061 * (circle + 0.1 + 0.45);
    let maximum = DVec3::new(0.45 + 2.0 * circle + 2.0 * mixed, 0.2 + 2.0 * mixed, 2.0 * circle) * 1.01;
    assert!((high - low).cmple(maximum).all() && high.x - low.x > 0.45 + 0.6, "{}", high - low);
}

fn angle_about_y(of: &Motion, hub: &Motion, time_s: f64) -> f64 {
    let turned = hub.at(time_s).inverse() * of.at(time_s);
    crate::maths::f64::atan2(-turned.matrix3.x_axis.z, turned.matrix3.x_axis.x)
}

/// The difference of two angles, wrapped.
fn off(a: f64, b: f64) -> f64 {
    let turn = core::f64::consts::TAU;
    ((a - b) / turn - ((a - b) / turn).round()) * turn
}

/// φ = s/r: at constant speed, at constant acceleration, on a circle (by the path of the wheel, not of the car), and for a hub that turns away from a straight
/// path (φ = (v / (r ω)) sin ωt). No rotation before the first key or after the last.
#[test]
fn wheels_turn_by_the_way_that_they_go() {
    let r = 0.31;
    let check = |hub: &Motion, exact: &dyn Fn(f64) -> f64, tolerance: f64| {
        let wheel = hub.carrying(&hub.rolling(r).expect("it moves"));
        for i in 0..=100_u8 {
            let time_s = 0.04 * f64::from(i);
            let actual = angle_about_y(&wheel, hub, time_s);
            assert!(off(actual, exact(time_s)).abs() <= tolerance, "{time_s} {actual} {}", exact(time_s));
        }
    };
    let even = linear(&[key(0.0, DVec3::ZERO, 0.0), key(4.0, DVec3::X * 60.0, 0.0)]);
    check(&even, &|t| 15.0 * t / r, 1e-12);
    let sideways = linear(&[key(0.0, DVec3::ZERO, FRAC_PI_2), key(4.0, DVec3::X * 60.0, FRAC_PI_2)]);
    check(&sideways, &|_| 0.0, 1e-12);
    let accelerated: Vec<Key> = [0.0, 1.0, 2.5, 4.0].map(|t: f64| key(t, DVec3::X * (1.5 * t * t), 0.0)).into();
    let accelerated: Motion = Track::new(&accelerated, Interpolation::Smooth).expect("legal").into();
    check(&accelerated, &|t| 1.5 * t * t / r, 1e-6);
    // The car turns to the left on the spot; the right wheel travels forward on a circle of 0.8 m.
    let spot = linear(&[key(0.0, DVec3::ZERO, 0.0), key(4.0, DVec3::ZERO, 3.0)]);
    let right = spot.carrying(&Motion::constant(DAffine3::from_translation(DVec3::new(0.0, -0.8, r))));
    check(&right, &|t| 0.75 * 0.8 * t / r, 1e-12);
    let skids = linear(&[key(0.0, DVec3::ZERO, 0.0), key(4.0, DVec3::X * 40.0, 2.0)]);
    check(&skids, &|t| 10.0 / (r * 0.5) * crate::maths::f64::sin(0.5 * t), 1e-6);
    let parked = linear(&[key(1.0, DVec3::ZERO, 0.0), key(3.0, DVec3::X * 2.0, 0.0)]);
    check(&parked, &|t| (t - 1.0).clamp(0.0, 2.0) / r, 1e-12);
    assert_eq!(Motion::constant(DAffine3::IDENTITY).rolling(r), Err(RollingError::Still));
}

/// Rates from which wheels are integrated, compared with finite differences of positions: a fourth-order formula with h = 0.1 ms, whose error is h⁴/30 of the
/// fifth derivative; rounding of positions of 1 m adds some 1e-12.
#[test]
fn velocities_are_those_of_the_places() {
    let mut random = Random(77_000);
    for _ in 0..300 {
        let motion = Motion::from(random.track(true)).carrying(&random.track(true).into());
        let moves = motion.motion_interval().expect("it moves");
        let time_s = moves.start_s() + moves.length_s() * random.unit();
        let h = 1e-4;
        let times_s = motion.times_s();
        if times_s.iter().any(|key_s| (key_s - time_s).abs() < 4.0 * h) {
            continue;
        }
        let point = random.cube();
        let place = |t: f64| motion.at(t).transform_point3(point);
        let steep = (place(time_s + h) - place(time_s - h)) * 8.0 - (place(time_s + 2.0 * h) - place(time_s - 2.0 * h));
        let velocity = motion.velocity_at(time_s, point);
        let expected = steep / (12.0 * h);
        assert!(
            (velocity - expected).length() <= 1e-6 * (1.0 + velocity.length() + place(time_s).length()),
            "{velocity} {expected}"
        );
    }
}
