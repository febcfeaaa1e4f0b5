//! Moving lamps: every ray is lit by the lamp of its own time.

use super::motion::{measure, shutter};
use super::*;
use crate::lights::{Cone, Lamp, LightHit, LightSampleContext, Opening, OpeningBody, Profile, head_lamp};
use etendue_core::TimeInterval;
use etendue_core::track::{Interpolation, Key};
use glam::{DMat3, DQuat};

/// Axes of lamps that point down: their x axis.
const DOWN: DMat3 = DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X);

/// A car in a curve at about 15 m/s, and a frame on it that sways by `sway` rad about x.
fn carried(place: DVec3, sway: f64) -> Motion {
    let turn = |angle: f64, axis: DVec3| {
        let (sin, cos) = maths::f64::sin_cos(0.5 * angle);
        DQuat::from_vec4((axis * sin).extend(cos))
    };
    let key = |part: f64, position_m: DVec3, rotation: DQuat| Key {
        time_s: shutter().start_s() + part,
        position_m,
        rotation,
        scale: DVec3::ONE,
    };
    let car = [-0.5, 0.5].map(|part| key(part, DVec3::new(4.0 * part, 6.0 * part * part, 0.0), turn(part, DVec3::Z)));
    let arm = [-0.5, 0.2, 0.5].map(|part| key(part, place, turn(sway * part, DVec3::X)));
    let car = Track::new(&car, Interpolation::Linear).expect("legal");
    let arm = Track::new(&arm, Interpolation::Smooth).expect("legal");
    Motion::from(car).carrying(&arm.into()).carrying(&Motion::constant(DAffine3::from_mat3(DOWN)))
}

/// Points and openings of every kind of surface.
fn openings() -> [Option<Opening>; 6] {
    let open = |body, extents_m| Some(Opening::new(body, extents_m).expect("an opening"));
    [
        None,
        open(OpeningBody::Box, [0.0, 0.3, 0.2]),
        open(OpeningBody::Cylinder(0), [0.0, 0.3, 0.3]),
        open(OpeningBody::Cylinder(1), [0.1, 0.5, 0.1]),
        open(OpeningBody::Ellipsoid, [0.3; 3]),
        open(OpeningBody::Ellipsoid, [0.1, 0.3, 0.2]),
    ]
}

/// A floor under those lamps.
fn scene(floor: Surface, openings: &[Option<Opening>]) -> BuiltScene {
    let mut scene = Scene::default();
    let floor = scene.material(floor, None);
    let black = scene.material(Surface::Absorber, None);
    scene.square(Vec3::ZERO, 8.0, floor);
    for (i, opening) in (0_u32..).zip(openings) {
        let place = DVec3::new(0.8 * f64::from(i) - 2.0, 0.7 * f64::from(i % 3) - 0.5, 1.6 + 0.1 * f64::from(i));
        let profile = match i % 3 {
            0 => Profile::Cone(Cone::new(0.4, 1.3).expect("a spot")),
            1 => Profile::Isotropic,
            _ => Profile::PhotometricGrid(head_lamp::high_beam()),
        };
        let lamp =
            Lamp::moving(carried(place, 1.5), Spectrum::constant(1.0 / profile.peak()), profile).expect("a lamp");
        let Some(opening) = opening else {
            scene.sources.lamps.push(lamp);
            continue;
        };
        let shape = match opening.mesh() {
            Some(mesh) => Shape::Mesh(scene.builder.add_mesh(mesh)),
            None => Shape::Sphere { radius_m: 1.0 },
        };
        let to_world = lamp.opening_to_world(opening);
        let materials = vec![black];
        let instance =
            scene.builder.add_instance(Instance { shape, to_world, materials, instance_id: 9, semantic_id: 0 });
        scene.sources.lamps.push(lamp.opened(*opening, instance).expect("not too bright"));
    }
    scene.ready()
}

/// Floors in the light of all of them, by every strategy of finding it.
#[test]
fn lamps_in_motion_are_those_of_the_frozen_world() {
    for (floor, open) in [(diffuse_surface(0.8), &openings()[..]), (paint(0.6, 0.3), &openings()[1..])] {
        let ready = scene(floor, open);
        assert!(ready.sources.lamps.iter().all(|lamp| lamp.to_world().as_constant().is_none()));
        for time_s in [0.0, 0.15, 0.4] {
            let mut ray = ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]);
            let frozen = TimeInterval::at(shutter().start_s() + f64::from(time_s)).expect("finite");
            let settings = |strategies| PathSettings { max_bounces: 2, strategies, ..PathSettings::default() };
            let expected = measure(&ready, frozen, &ray, settings(Strategies::Both), 256);
            ray.time_s = time_s;
            agree(&measure(&ready, shutter(), &ray, settings(Strategies::Both), 256), &expected);
            agree(&measure(&ready, shutter(), &ray, settings(Strategies::Lights), 512), &expected);
            if open.iter().all(Option::is_some) {
                agree(&measure(&ready, shutter(), &ray, settings(Strategies::Scattering), 2048), &expected);
            }
            assert!(expected.mean > 0.0 && expected.standard_error() < 0.03 * expected.mean, "{expected:?}");
        }
    }
}

/// One lamp alone, so that its choice is certain: samples, radiances and densities are those of a static lamp at that place, to the
/// rounding of f32 of places some 10 m away seen from 0.3 m. The ray of a sample hits the lamp, and nothing before it.
#[test]
fn a_moving_lamp_is_the_frozen_lamp_of_its_moment() {
    for opening in openings() {
        let ready = scene(diffuse_surface(0.5), &[opening]);
        let view = ready.world.render_space_for_few(DVec3::ZERO, shutter());
        let lights = ready.lights(&view);
        let counts = lights.light_counts();
        assert_eq!((counts.lamps, counts.openings), if opening.is_some() { (0, 1) } else { (1, 0) });
        let mut sampled = 0;
        for i in 0..400_u32 {
            let time_s = 0.001 * i as f32;
            let moment = TimeInterval::at(shutter().moment(time_s)).expect("finite");
            let frozen_view = ready.world.render_space_for_few(DVec3::ZERO, moment);
            let frozen = ready.lights(&frozen_view);
            let at = |k: u32| ((i * 37 + k * 61) % 101) as f32 / 101.0;
            let place = Vec3::new(8.0 * at(1) - 6.0, 4.0 * at(2) - 2.0, 0.3 * at(3));
            let still = LightSampleContext::diffuse(place, Vec3::ZERO);
            let receiver = LightSampleContext { time_s, ..still };
            let ask = |lights: &Lights, receiver| {
                lights.sample(
                    receiver,
                    0.5,
                    Vec2::new(at(4), at(5)),
                    0.0,
                    &ready.material_table,
                    query(&TimeInterval::default()),
                )
            };
            let (Some(sample), Some(expected)) = (ask(&lights, &receiver), ask(&frozen, &still)) else { continue };
            // The cone of a ball is sampled about a basis that does not rotate with the lamp.
            if opening.is_none_or(|opening| opening.mesh().is_some()) {
                assert!((sample.direction - expected.direction).length() < 1e-4, "{sample:?} {expected:?}");
                let [value, other] = [sample, expected].map(|sample| sample.radiance[1] / sample.pdf);
                assert!((value - other).abs() <= 1e-2 * other, "{value} {other}");
            }
            let Some(target) = sample.target.filter(|_| opening.is_some()) else {
                sampled += 1;
                continue;
            };
            let to_target = target - place;
            let blocked = Ray { t_max: to_target.length(), ..Ray::new(place, to_target.normalize(), time_s) };
            assert!(!view.occluded(&blocked), "the opening hides its own point");
            let ray = Ray::new(place, sample.direction, time_s);
            let Some(hit) = view.closest(&ray) else { continue };
            sampled += 1;
            let point = view.surface(&ray, &hit);
            let light_hit =
                LightHit { receiver: &receiver, point: &point, direction: ray.direction, distance_m: hit.t };
            let actual =
                lights.opening_radiance(&point, ray.direction, query(&TimeInterval::default())).expect("it shines");
            assert!((actual[1] - sample.radiance[1]).abs() <= 1e-3 * sample.radiance[1], "{actual:?} {sample:?}");
            // A ray to the far side of a stretched ball hits the near one.
            let relative = lights.light_pdf(&light_hit) / sample.pdf;
            let stretched = opening.is_some_and(|opening| opening == openings()[5].expect("an opening"));
            assert!((relative - 1.0).abs() < 0.02 || stretched, "{relative}");
        }
        assert!(sampled > 200, "{sampled}");
    }
}
