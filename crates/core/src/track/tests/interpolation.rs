use super::{Random, about_z, key};
use crate::maths;
use crate::track::{Interpolation, Key, Track, TrackError, slerp};
use core::f64::consts::{FRAC_PI_2, PI};
use glam::{DAffine3, DMat3, DQuat, DVec3};

const HOW: [Interpolation; 2] = [Interpolation::Linear, Interpolation::Smooth];

/// Largest difference between the numbers of two transforms.
fn apart(a: DAffine3, b: DAffine3) -> f64 {
    a.to_cols_array().iter().zip(b.to_cols_array()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn static_at(key: &Key) -> DAffine3 {
    DAffine3::from_scale_rotation_translation(key.scale, key.rotation.normalize(), key.position_m)
}

#[test]
fn a_still_track_keeps_its_matrix_bit_for_bit() {
    let sheared = DAffine3::from_mat3_translation(
        DMat3::from_cols(DVec3::new(1.0, 0.1, 0.0), DVec3::new(0.3, 1.0, 0.0), DVec3::Z),
        DVec3::new(1e6, 0.1, 0.3),
    );
    let track = Track::constant(sheared);
    assert_eq!([track.at(-1e9), track.at(0.0), track.at(f64::NAN)], [sheared; 3]);
    assert_eq!(track.as_constant(), Some(sheared));
}

#[test]
fn one_key_and_equal_keys_stand_still() {
    let one = Key { time_s: 3.0, position_m: DVec3::X, rotation: about_z(1.0), scale: DVec3::splat(2.0) };
    for how in HOW {
        for keys in
            [&[one][..], &[one, Key { time_s: 4.0, ..one }, Key { time_s: 5.0, rotation: -one.rotation, ..one }]]
        {
            let track = Track::new(keys, how).expect("legal");
            assert_eq!(track.as_constant(), Some(static_at(&one)), "{how:?}");
        }
    }
}

/// Numbers up to 1e6 and a dozen roundings of 1.1e-16.
#[test]
fn a_track_passes_through_its_keys_and_holds_still_beyond() {
    let mut random = Random(1, 0);
    for _ in 0..200 {
        let (track, keys) = random.track();
        for key in &keys {
            assert!(apart(track.at(key.time_s), static_at(key)) < 2e-9);
        }
        let (first, last) = (&keys[0], &keys[keys.len() - 1]);
        assert_eq!(track.at(first.time_s - 5.0), track.at(first.time_s));
        assert_eq!(track.at(last.time_s + 1e9), track.at(last.time_s));
        assert_eq!([track.at(f64::NEG_INFINITY), track.at(f64::INFINITY)], [first, last].map(|k| track.at(k.time_s)));
    }
}

/// Shoemake 1985: (sin((1 − u) θ) q₀ + sin(u θ) q₁)/sin θ with θ the angle between the quaternions, q₁ the nearer of ±q₁.
#[test]
fn linear_rotation_is_slerp_the_short_way() {
    let mut random = Random(2, 0);
    for _ in 0..2000 {
        let (a, b) = (random.rotation(), random.rotation());
        let near = if a.dot(b) < 0.0 { -b } else { b };
        let angle = maths::f64::acos(a.dot(near).min(1.0));
        let track = Track::new(&[key(2.0, DVec3::ZERO, a), key(4.0, DVec3::ZERO, b)], Interpolation::Linear);
        let track = track.expect("legal");
        let u = random.unit();
        let weight = |part: f64| maths::f64::sin(part * angle) / maths::f64::sin(angle);
        let expected = a * weight(1.0 - u) + near * weight(u);
        // Roundings of the closed form are divided by sin θ ≥ 1e-3.
        for turned in [track.at(2.0 + 2.0 * u), DAffine3::from_quat(slerp(a * 3.0, b * 0.5, u))] {
            let apart = apart(turned, DAffine3::from_quat(expected.normalize()));
            assert!(apart < 1e-12 / maths::f64::sin(angle).max(1e-3), "{apart} {angle}");
        }
    }
}

#[test]
fn linear_motion_is_even_and_a_half_turn_is_as_given() {
    let keys = [
        Key { time_s: 1.0, position_m: DVec3::X, rotation: DQuat::IDENTITY, scale: DVec3::ONE },
        Key { time_s: 5.0, position_m: DVec3::Y * 3.0, rotation: about_z(PI), scale: DVec3::new(3.0, 1.0, 2.0) },
    ];
    for how in HOW {
        let track = Track::new(&keys, how).expect("legal");
        let expected = DAffine3::from_scale_rotation_translation(
            DVec3::new(1.5, 1.0, 1.25),
            about_z(0.25 * PI),
            DVec3::new(0.75, 0.75, 0.0),
        );
        assert!(apart(track.at(2.0), expected) < 1e-15, "{how:?}");
    }
}

#[test]
fn quaternions_of_any_length_and_sign_are_rotations() {
    let a = key(0.0, DVec3::ZERO, DQuat::IDENTITY);
    let b = key(1.0, DVec3::ZERO, about_z(FRAC_PI_2));
    let other = Key { rotation: about_z(FRAC_PI_2) * -1e-3, ..b };
    for how in HOW {
        let [one, same] = [b, other].map(|b| Track::new(&[a, b], how).expect("legal"));
        assert!(apart(one.at(0.3), same.at(0.3)) < 1e-15);
    }
}

/// p = 3 t² − t, with irregular keys: the parabola's derivatives make the cubics that parabola.
#[test]
fn smooth_motion_keeps_an_even_acceleration_and_an_even_turn() {
    let at = |t: f64| Key {
        time_s: t,
        position_m: DVec3::new(3.0 * t * t - t, 2.0, t),
        rotation: about_z(0.7 * t),
        scale: DVec3::new(1.0 + t * t, 1.0, 2.0),
    };
    let track = Track::new(&[0.0, 0.3, 1.0, 1.1, 3.0].map(at), Interpolation::Smooth).expect("legal");
    for i in 0..=300 {
        let t = 0.01 * f64::from(i);
        assert!(apart(track.at(t), static_at(&at(t))) < 1e-13, "{t}");
    }
}

/// Finite differences on both sides of a key: for a step h the error is h/2 · |p̈| ≲ 1e-6 · 1e4 m·s⁻² and by roundings 1e-16 / h.
#[test]
fn smooth_motion_has_one_velocity_at_a_key() {
    let mut random = Random(5, 0);
    let step_s = 1e-6;
    for _ in 0..300 {
        let mut time_s = 0.0;
        let key = |_| {
            time_s += random.between(0.2, 1.0);
            let scale = DVec3::ONE + random.cube() * 0.5;
            Key { time_s, position_m: random.cube(), rotation: random.rotation(), scale }
        };
        let keys: Vec<Key> = (0..5).map(key).collect();
        let track = Track::new(&keys, Interpolation::Smooth).expect("legal");
        for key in &keys[1..4] {
            let [before, here, after] = [-1.0, 0.0, 1.0].map(|k| track.at(key.time_s + k * step_s));
            let rate = |a: DAffine3, b: DAffine3| DAffine3 {
                matrix3: (b.matrix3 - a.matrix3) * (1.0 / step_s),
                translation: (b.translation - a.translation) / step_s,
            };
            let jump = apart(rate(before, here), rate(here, after));
            assert!(jump < 2e-3, "{jump}");
        }
    }
}

#[test]
fn what_comes_first_is_applied_first() {
    let mut random = Random(6, 0);
    let first = DAffine3::from_scale_rotation_translation(DVec3::new(1.0, 2.0, 3.0), about_z(1.0), DVec3::X);
    for _ in 0..20 {
        let (track, _) = random.track();
        let t = random.between(0.0, 4.0);
        assert_eq!(track.after(&first).at(t), track.at(t) * DAffine3::IDENTITY * first);
    }
    assert_eq!(Track::constant(first).after(&first).as_constant(), Some(first * first));
}

#[test]
fn bad_keys_have_one_clear_error() {
    let good = |t: f64| key(t, DVec3::ZERO, DQuat::IDENTITY);
    let refused = |keys: &[Key]| Track::new(keys, Interpolation::Smooth).expect_err("refused");
    assert_eq!(refused(&[]), TrackError::Empty);
    assert_eq!(
        refused(&[good(0.0), good(1.0), good(0.5)]),
        TrackError::Unordered { key: 2, time_s: 0.5, before_s: 1.0 }
    );
    assert_eq!(refused(&[good(2.0), good(2.0)]), TrackError::Repeated { key: 1, time_s: 2.0 });
    assert_eq!(refused(&[good(0.0), good(f64::NAN)]), TrackError::NotFinite { key: 1 });
    assert_eq!(refused(&[Key { position_m: DVec3::INFINITY, ..good(0.0) }]), TrackError::NotFinite { key: 0 });
    assert_eq!(refused(&[Key { scale: DVec3::NAN, ..good(0.0) }]), TrackError::NotFinite { key: 0 });
    let none = Key { rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..good(0.0) };
    assert_eq!(refused(&[good(-1.0), none]), TrackError::NoRotation { key: 1 });
    let far = Key { position_m: DVec3::X * 1e308, ..good(1e-300) };
    assert_eq!(refused(&[good(0.0), far, good(1.0)]), TrackError::NotFinite { key: 0 });
    assert_eq!(
        refused(&[good(0.0), good(1.0), good(0.5)]).to_string(),
        "key 2 of the track is at 0.5 s, before key 1 at 1 s; give the keys in order of time"
    );
}
