//! Moving lights: every ray sees and is lit by the world of its own time.

use super::*;
use crate::lights::{LightHit, LightSampleContext};
use etendue_core::track::{Interpolation, Key};
use glam::{DMat3, DQuat};

const SHUTTER: (f64, f64) = (50.0, 50.4);

pub(super) fn shutter() -> TimeInterval {
    TimeInterval::new(SHUTTER.0, SHUTTER.1).expect("in order")
}

/// A track through `centre`, with rotation and growth.
fn track(centre: DVec3, velocity: DVec3) -> Track {
    let key = |part: f64| {
        let (sin, cos) = maths::f64::sin_cos(0.4 * part);
        Key {
            time_s: SHUTTER.0 + part,
            position_m: centre + velocity * part,
            rotation: DQuat::from_xyzw(0.8 * sin, 0.0, 0.6 * sin, cos),
            scale: DVec3::new(1.0 + 0.5 * part, 1.0 + 0.5 * part, 1.0 + 0.2 * part),
        }
    };
    Track::new(&[-1.0, 0.1, 0.9].map(key), Interpolation::Smooth).expect("legal")
}

/// Emitters: a square, a lone triangle, a ball, and a stretched one; each on its own path.
fn moving(floor: Surface, sides: EmissionSides) -> Scene {
    let mut scene = Scene::default();
    let floor = scene.material(floor, None);
    let lamp = scene.material(diffuse_surface(0.2), Some(TestEmission { radiance: 0.05, sides }));
    let block = scene.material(diffuse_surface(0.7), None);
    scene.square(Vec3::ZERO, 5.0, floor);
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| Vec3::new(x, y, 0.0));
    let square = shape(&mut scene, corners.to_vec(), vec![[0, 2, 1], [0, 3, 2]]);
    let triangle = shape(&mut scene, corners[..3].to_vec(), vec![[0, 2, 1]]);
    let ball = Shape::Sphere { radius_m: 0.4 };
    let stretch = DAffine3::from_scale(DVec3::new(0.5, 1.5, 1.0));
    let objects = [
        (square, lamp, track(DVec3::new(1.0, 0.0, 1.5), DVec3::new(-3.0, 0.5, 0.3))),
        (triangle, lamp, track(DVec3::new(-1.0, 0.3, 1.2), DVec3::new(2.0, 1.5, 0.0))),
        (ball, lamp, track(DVec3::new(0.5, 1.0, 0.8), DVec3::new(0.0, -4.0, 0.5))),
        (ball, lamp, track(DVec3::new(0.0, -1.5, 0.9), DVec3::new(1.0, 1.0, 1.0)).after(&stretch)),
        (ball, block, track(DVec3::new(-0.8, 0.0, 0.6), DVec3::new(3.0, 0.0, 0.0))),
    ];
    for (shape, material, to_world) in objects {
        let materials = vec![material];
        scene.builder.add_instance(Instance {
            shape,
            to_world: to_world.into(),
            materials,
            instance_id: 1,
            semantic_id: 1,
        });
    }
    scene
}

fn shape(scene: &mut Scene, positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Shape {
    let (mesh, _) = Mesh::new(positions, vec![], vec![], triangles, vec![]).expect("a mesh");
    Shape::Mesh(scene.builder.add_mesh(mesh))
}

/// As [`Ready::look`], through the shutter.
pub(super) fn measure(
    ready: &BuiltScene,
    interval: TimeInterval,
    ray: &Ray,
    settings: PathSettings,
    samples: u32,
) -> ReplicateEstimate {
    let view = ready.world.render_space_for_few(DVec3::ZERO, interval);
    let lights = ready.lights(&view);
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, settings);
    let means: Vec<_> = (0..32).map(|r| replicate(&tracer, ray, samples, r)).collect();
    ReplicateEstimate::from_replicates(&means).expect("replicates")
}

/// Rays of a time within the shutter see the same as in a world frozen at that time, by every strategy of finding light.
#[test]
fn light_in_motion_is_that_of_the_frozen_world() {
    for (floor, sides) in [(diffuse_surface(0.8), EmissionSides::Front), (paint(0.6, 0.3), EmissionSides::Both)] {
        let ready = moving(floor, sides).ready();
        for time_s in [0.0, 0.15, 0.4] {
            let mut ray = ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]);
            let frozen = TimeInterval::at(SHUTTER.0 + f64::from(time_s)).expect("finite");
            let settings = |strategies| PathSettings { max_bounces: 3, strategies, ..PathSettings::default() };
            let expected = measure(&ready, frozen, &ray, settings(Strategies::Both), 256);
            ray.time_s = time_s;
            for (strategies, samples) in
                [(Strategies::Both, 256), (Strategies::Scattering, 1024), (Strategies::Lights, 512)]
            {
                agree(&measure(&ready, shutter(), &ray, settings(strategies), samples), &expected);
            }
            assert!(expected.standard_error() < 0.05 * expected.mean, "{expected:?}");
        }
    }
}

/// One light alone, so that its choice is certain: samples and densities are those of the frozen light, to the bit.
#[test]
fn a_moving_light_is_the_frozen_light_of_its_moment() {
    for number in 0..4 {
        let scene = moving(diffuse_surface(0.5), EmissionSides::Both).ready();
        let mut builder = crate::accel::WorldBuilder::new();
        scene.world.meshes().iter().for_each(|mesh| _ = builder.add_mesh(mesh.clone()));
        builder.add_instance(scene.world.instances()[1 + number].clone());
        let world = builder.build().expect("a world");
        let ready = BuiltScene { world, ..scene };
        let view = ready.world.render_space_for_few(DVec3::ZERO, shutter());
        let lights = ready.lights(&view);
        let mut sampled = 0;
        for i in 0..200_u32 {
            let time_s = 0.002 * i as f32;
            let moment = TimeInterval::at(shutter().moment(time_s)).expect("finite");
            let frozen_view = ready.world.render_space_for_few(DVec3::ZERO, moment);
            let frozen = ready.lights(&frozen_view);
            let at = |k: u32| ((i * 37 + k * 61) % 101) as f32 / 101.0;
            let still =
                LightSampleContext::diffuse(Vec3::new(4.0 * at(1) - 2.0, 4.0 * at(2) - 2.0, 0.3 * at(3)), Vec3::ZERO);
            let receiver = LightSampleContext { time_s, ..still };
            let ask = |lights: &Lights, receiver| {
                let (u, interval) = (Vec2::new(at(4), at(5)), TimeInterval::default());
                lights.sample(receiver, 0.5, u, 0.0, &ready.material_table, query(&interval))
            };
            let (sample, expected) = (ask(&lights, &receiver), ask(&frozen, &still));
            assert_eq!(sample, expected);
            let Some(sample) = sample else { continue };
            sampled += 1;
            let ray = Ray::new(receiver.position, sample.direction, time_s);
            let Some(hit) = view.closest(&ray) else { continue };
            let point = view.surface(&ray, &hit);
            let (direction, distance_m) = (ray.direction, hit.t);
            let density = |lights: &Lights| {
                lights.light_pdf(&LightHit { receiver: &receiver, point: &point, direction, distance_m })
            };
            assert_eq!(density(&lights), density(&frozen));
            // A ray to the far side of a stretched ball hits the near one.
            let relative = density(&lights) / sample.pdf;
            assert!((relative - 1.0).abs() < 0.02 || number > 1, "{relative}");
        }
        assert!(sampled > 100, "{sampled}");
    }
}

/// No light is estimated as dark where it is not: each light that reaches a receiver at a time has a positive probability.
#[test]
fn the_choice_among_moving_lights_leaves_none_out() {
    let ready = moving(diffuse_surface(0.5), EmissionSides::Front).ready();
    let view = ready.world.render_space_for_few(DVec3::ZERO, shutter());
    let lights = ready.lights(&view);
    let counts = lights.light_counts();
    assert_eq!((counts.triangles, counts.spheres), (3, 2));
    let mut hits = 0;
    for i in 0..20_000_u32 {
        let at = |k: u32| ((i * 97 + k * k * 61) % 1009) as f32 / 1009.0;
        let direction = DMat3::from_rotation_z(f64::from(at(4)) * 6.0) * DVec3::new(1.0, 0.0, f64::from(at(5)) * 2.0);
        let position = Vec3::new(4.0 * at(1) - 2.0, 4.0 * at(2) - 2.0, 0.01);
        let receiver = LightSampleContext { time_s: 0.4 * at(3), ..LightSampleContext::diffuse(position, Vec3::Z) };
        let ray = Ray::new(position, direction.normalize().as_vec3(), receiver.time_s);
        let Some(hit) = view.closest(&ray) else { continue };
        let point = view.surface(&ray, &hit);
        let Some(emission) = ready.material_table.emission(point.material) else { continue };
        if !emission.emits_towards(point.geometric_normal, -ray.direction) {
            continue;
        }
        hits += 1;
        let hit = LightHit { receiver: &receiver, point: &point, direction: ray.direction, distance_m: hit.t };
        assert!(lights.light_pdf(&hit) > 0.0, "{point:?}");
    }
    assert!(hits > 300, "{hits}");
}

/// Four rays of a group, two at one time and two at others: sharing tails among all of them would mix their times.
#[test]
fn tails_are_shared_at_one_time_only() {
    let ready = moving(diffuse_surface(0.8), EmissionSides::Both).ready();
    let view = ready.world.render_space_for_few(DVec3::ZERO, shutter());
    let lights = ready.lights(&view);
    let samples = 512;
    let settings = PathSettings { max_bounces: 3, samples, ..PathSettings::default() };
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, settings);
    let times_s = [0.0, 0.4, 0.0, 0.2];
    let stream = |x: usize, replicate: u32| {
        let pixel = Pixel { x: x as u32, y: 4 };
        let frame = FrameAddress { seed: 5, ..FrameAddress::default() };
        PathStream::new(&PixelAddress { frame, pixel, replicate }, 0)
    };
    let means = |replicate: u32, size: usize| {
        let mut sums = [0.0; 4];
        for sample in 0..samples {
            let of = |(x, time_s): (usize, &f32)| FieldRay {
                ray: Ray { time_s: *time_s, ..ray([-2.0, -2.0, 2.0], [0.2, 0.1 + 0.05 * x as f32, 0.0]) },
                stream: stream(x, replicate).with_sample(sample),
                light_interval: TimeInterval::default(),
            };
            let rays: Vec<_> = times_s.iter().enumerate().map(of).collect();
            let mut radiance = vec![];
            rays.chunks(size).for_each(|group| tracer.radiance_of_group(group, &WAVELENGTHS, &mut radiance));
            sums.iter_mut().zip(&radiance).for_each(|(sum, radiance)| *sum += f64::from(radiance[1]));
        }
        sums.map(|sum| sum / f64::from(samples))
    };
    let [alone, together] = [1, 4].map(|size| (0..32).map(|replicate| means(replicate, size)).collect::<Vec<_>>());
    for x in 0..4 {
        let of = |means: &[[f64; 4]]| {
            ReplicateEstimate::from_replicates(&means.iter().map(|m| m[x]).collect::<Vec<_>>()).expect("replicates")
        };
        agree(&of(&together), &of(&alone));
    }
}
