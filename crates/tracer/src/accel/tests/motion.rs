//! Moving instances: against brute force at each ray's own time, by every instruction set, without gaps.

use super::agreement::brute_force;
use super::shapes::{Random, bumpy, icosphere, instance, mesh, soup, spindle, tracked};
use crate::accel::{Simd, World, WorldBuilder, WorldError};
use crate::geometry::{Hit, Mesh, Shape, sphere};
use crate::render_space::RenderSpace;
use etendue_core::track::{Interpolation, Key};
use etendue_core::{Motion, Ray, TimeInterval, Track};
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

fn interval(start_s: f64, end_s: f64) -> TimeInterval {
    TimeInterval::new(start_s, end_s).expect("in order")
}

fn key(time_s: f64, position_m: DVec3) -> Key {
    Key { time_s, position_m, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
}

/// Two to four keys from about −1 s to 3 s.
fn track(random: &mut Random, reach: f64) -> Track {
    let count = 2 + (random.unit() * 3.0) as usize;
    let mut time_s = random.between(-1.0, 0.0);
    let mirror = if random.unit() < 0.3 { -1.0 } else { 1.0 };
    let centre = random.cube() * reach;
    let key = |_| {
        time_s += random.between(0.3, 1.0);
        let scale = DVec3::new(random.between(0.7, 1.3), random.between(0.7, 1.3), mirror * random.between(0.7, 1.3));
        let rotation = DQuat::from_mat3(&random.rotation());
        Key { time_s, position_m: centre + random.cube() * 2.0, rotation, scale }
    };
    let keys: Vec<Key> = (0..count).map(key).collect();
    let interpolation = if random.unit() < 0.5 { Interpolation::Linear } else { Interpolation::Smooth };
    Track::new(&keys, interpolation).expect("a legal track")
}

/// Soups and spheres, most of which rotate, grow and move; every fifth is static.
fn mixed_world(seed: u32) -> World {
    let mut random = Random::new(seed);
    let mut builder = WorldBuilder::new();
    let meshes = [soup(120, 1), soup(40, 2), icosphere(2), soup(1, 3)].map(|m| builder.add_mesh(m));
    for i in 0..25 {
        let shape = match i % 6 {
            k @ 0..4 => Shape::Mesh(meshes[k]),
            _ => Shape::Sphere { radius_m: random.between(0.1, 1.0) },
        };
        let placed = if i % 5 == 0 {
            instance(shape, DAffine3::from_mat3_translation(random.rotation(), random.cube() * 4.0))
        } else {
            tracked(shape, track(&mut random, 4.0))
        };
        builder.add_instance(placed);
    }
    builder.build().expect("a legal world")
}

/// Rays of random times within an interval.
fn rays(count: u32, reach: f64, seed: u32, interval: TimeInterval) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(seed);
    (0..count).map(move |_| {
        let (origin, target) = (random.cube() * reach, random.cube() * reach * 0.7);
        let time_s = (random.unit() * interval.length_s()) as f32;
        Ray::new(origin.as_vec3(), (target - origin).normalize().as_vec3(), time_s)
    })
}

/// The hit of a ray on a primitive: all in the world and in f64, by the instance's own track.
fn oracle(world: &World, interval: TimeInterval, origin_m: DVec3, ray: &Ray) -> Option<(f64, u32, u32)> {
    let (o, d) = (ray.origin.as_dvec3() + origin_m, ray.direction.as_dvec3());
    let mut best: Option<(f64, u32, u32)> = None;
    for (index, instance) in (0..).zip(world.instances()) {
        let to_world = instance.to_world.at(interval.moment(ray.time_s));
        let mut offer = |t: f64, primitive: u32| {
            if t > 0.0 && best.is_none_or(|(minimum, ..)| t < minimum) {
                best = Some((t, index, primitive));
            }
        };
        match instance.shape {
            Shape::Sphere { radius_m } => {
                let back = to_world.inverse();
                let t = sphere::nearest(radius_m, back.transform_point3(o), back.transform_vector3(d));
                t.into_iter().for_each(|t| offer(t, 0));
            }
            Shape::Mesh(id) => {
                for primitive in 0..world.mesh(id).triangles().len() as u32 {
                    let corners = world.mesh(id).corners(primitive).map(|p| to_world.transform_point3(p.as_dvec3()));
                    cramer(corners, o, d).into_iter().for_each(|t| offer(t, primitive));
                }
            }
        }
    }
    best
}

fn cramer([a, b, c]: [DVec3; 3], o: DVec3, d: DVec3) -> Option<f64> {
    let [u, v, t] = (DMat3::from_cols(b - a, c - a, -d).inverse() * (o - a)).to_array();
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some(t)
}

/// The accelerator and f64 differ where a ray passes an edge within 1e-4 of a triangle's size, or hits two surfaces within 1e-4 of its
/// length: of some 800 triangles, a few rays in ten thousand.
#[test]
fn what_moves_is_hit_where_it_is_at_the_ray_s_time() {
    let (mut differences, mut hits) = (0, 0);
    for seed in 0..4 {
        let world = mixed_world(seed);
        let origin_m = DVec3::new(0.3, -0.2, 0.1);
        let interval = interval(0.1 * f64::from(seed), 0.1 + 0.5 * f64::from(seed));
        let view = world.render_space_with(origin_m, interval, Simd::Auto);
        for ray in rays(1500, 8.0, 100 + seed, interval) {
            let expected = oracle(&world, interval, origin_m, &ray);
            let actual = view.closest(&ray);
            let same = match (expected, actual) {
                (Some((t, instance, primitive)), Some(hit)) => {
                    (instance, primitive) == (hit.instance, hit.primitive) && (t - f64::from(hit.t)).abs() < 1e-4 * t
                }
                (a, b) => a.is_none() && b.is_none(),
            };
            assert_eq!(view.occluded(&ray), actual.is_some());
            differences += u32::from(!same);
            hits += u32::from(actual.is_some());
        }
    }
    assert!(differences <= 6 && hits > 1500 && hits < 6000, "{differences} of 6000 rays differ, {hits} hit");
}

/// Every primitive in turn with the ray in its own frame: the boxes over the instances lose nothing, to the bit.
#[test]
fn boxes_of_the_interval_lose_nothing() {
    for seed in 10..14 {
        let world = mixed_world(seed);
        let interval = interval(-0.5, [-0.5, 0.0, 0.7, 4.0][seed as usize - 10]);
        let view = world.render_space_for_few(DVec3::ZERO, interval);
        for ray in rays(500, 8.0, seed, interval) {
            let hit = view.closest(&ray);
            assert_eq!(hit, brute_force(&view, &ray), "{ray:?}");
            let Some(hit) = hit else { continue };
            let until = |t_max| Ray { t_max, ..ray };
            assert!(!view.occluded(&until(hit.t)) && view.occluded(&until(hit.t.next_up())));
        }
    }
}

/// On a machine without AVX2 both are the plain lanes, and the test has no effect.
#[test]
fn instruction_sets_give_the_same_bits_in_motion() {
    let bits = |h: Hit| (h.t.to_bits(), h.u.to_bits(), h.v.to_bits(), h.instance, h.primitive);
    let (world, interval) = (mixed_world(20), interval(0.0, 1.5));
    let [auto, scalar] = [Simd::Auto, Simd::Scalar].map(|simd| world.render_space_with(DVec3::ZERO, interval, simd));
    for ray in rays(20_000, 8.0, 31, interval) {
        assert_eq!(auto.closest(&ray).map(bits), scalar.closest(&ray).map(bits), "{ray:?}");
        let short = Ray { t_max: 4.0, ..ray };
        assert_eq!(auto.occluded(&short), scalar.occluded(&short), "{ray:?}");
    }
}

/// At a single time, before the first key and after the last, moving instances are hit as static ones at the same place.
#[test]
fn a_moment_of_motion_is_a_still_world() {
    let world = mixed_world(30);
    for (start_s, end_s) in [(0.4, 0.4), (-9.0, -2.0), (50.0, 60.0)] {
        let mut frozen = WorldBuilder::new();
        world.meshes().iter().for_each(|mesh| _ = frozen.add_mesh(mesh.clone()));
        for instance in world.instances() {
            let to_world = Motion::constant(instance.to_world.at(end_s));
            frozen.add_instance(crate::geometry::Instance { to_world, ..instance.clone() });
        }
        let frozen = frozen.build().expect("legal");
        let interval = interval(start_s, end_s);
        let [moving, still] = [&world, &frozen].map(|world| world.render_space_with(DVec3::ZERO, interval, Simd::Auto));
        for ray in rays(2000, 8.0, 33, interval) {
            assert_eq!(moving.closest(&ray), still.closest(&ray));
        }
    }
}

/// A ray of a time outside the view's interval sees the world at the nearer end.
#[test]
fn times_outside_the_interval_are_its_ends() {
    let (world, interval) = (mixed_world(31), interval(0.2, 0.9));
    let view = world.render_space_with(DVec3::ZERO, interval, Simd::Auto);
    for ray in rays(2000, 8.0, 34, interval) {
        let at = |time_s| view.closest(&Ray { time_s, ..ray });
        assert_eq!([at(-1.0), at(f32::NAN)], [at(0.0); 2]);
        assert_eq!(at(f32::INFINITY), at(0.7_f32.next_up()));
    }
}

#[test]
fn a_still_world_does_not_look_at_time() {
    let world = super::shapes::mixed_world();
    let view = world.render_space(DVec3::ZERO);
    let later = world.render_space_with(DVec3::ZERO, interval(3.0, 5.0), Simd::Auto);
    for ray in rays(5000, 8.0, 35, interval(0.0, 2.0)) {
        assert_eq!(view.closest(&ray), later.closest(&ray));
        assert_eq!(view.closest(&ray), view.closest(&Ray { time_s: 0.0, ..ray }));
    }
}

/// A ball that moves past at 30 m/s, 10 m ahead: hit at 10 m − √(r² − y²), y its height at that time. f32 rounds 10 m to 1e-6, and the root
/// near the ball's edge amplifies the rounding of the ray's height.
#[test]
fn a_flying_ball_is_hit_where_it_is() {
    let keys = [key(0.0, DVec3::new(10.0, -30.0, 0.0)), key(2.0, DVec3::new(10.0, 30.0, 0.0))];
    let mut builder = WorldBuilder::new();
    let fly = Track::new(&keys, Interpolation::Smooth).expect("legal");
    builder.add_instance(tracked(Shape::Sphere { radius_m: 0.5 }, fly));
    let world = builder.build().expect("legal");
    let view = world.render_space_with(DVec3::ZERO, interval(0.9, 1.1), Simd::Auto);
    for i in 0..=200 {
        let time_s = 0.001 * i as f32;
        let height = 30.0 * (f64::from(time_s) - 0.1);
        let hit = view.closest(&Ray::new(Vec3::ZERO, Vec3::X, time_s));
        assert_eq!(hit.is_some(), height.abs() < 0.5, "{time_s}");
        let Some(hit) = hit else { continue };
        let depth = (0.25 - height * height).sqrt();
        assert!((f64::from(hit.t) - 10.0 + depth).abs() < 1e-6 / depth.max(1e-3), "{time_s} {}", hit.t);
    }
}

/// Rays from inside a closed mesh in motion, at its edges and corners as they are at the ray's time.
fn count_escapes(mesh: &Mesh, inside: &[DVec3], seed: u32) -> usize {
    let mut random = Random::new(seed);
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(mesh.clone());
    let path = track(&mut random, 1e3);
    builder.add_instance(tracked(Shape::Mesh(id), path.clone()));
    let world = builder.build().expect("legal");
    let interval = interval(0.0, 0.8);
    let mut lost = 0;
    for simd in [Simd::Auto, Simd::Scalar] {
        let camera = path.at(0.4).transform_point3(inside[0]);
        let view = world.render_space_with(camera, interval, simd);
        for primitive in 0..mesh.triangles().len() as u32 {
            let [a, b, c] = mesh.corners(primitive).map(Vec3::as_dvec3);
            for (target, origin) in [a, (a + b) * 0.5, b + (c - b) * random.unit()].iter().zip(inside.iter().cycle()) {
                let time_s = random.between(0.0, 0.8) as f32;
                let to_world = path.at(interval.moment(time_s));
                let [from, to] = [origin, target].map(|p| (to_world.transform_point3(*p) - camera).as_vec3());
                lost += lost_ray(&view, &Ray::new(from, to - from, time_s));
            }
        }
    }
    lost
}

fn lost_ray(view: &RenderSpace<'_>, ray: &Ray) -> usize {
    usize::from(view.closest(ray).is_none() || !view.occluded(ray))
}

#[test]
fn nothing_escapes_from_closed_bodies_in_motion() {
    let mut random = Random::new(40);
    let inside: Vec<_> = (0..7).map(|_| random.cube() * 0.5).collect();
    let within: Vec<_> = (0..7)
        .map(|_| DVec3::new(random.between(0.5, 15.5), random.between(0.5, 15.5), random.between(-0.9, -0.1)))
        .collect();
    for seed in 0..8 {
        assert_eq!(count_escapes(&icosphere(3), &inside, seed), 0);
        assert_eq!(count_escapes(&bumpy(16), &within, 50 + seed), 0);
        assert_eq!(count_escapes(&spindle(), &[DVec3::ZERO], 90 + seed), 0);
    }
}

/// Static instances are merged as usual; a moving one is not.
#[test]
fn what_moves_is_not_written_out() {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(icosphere(1));
    for i in 0..3 {
        builder.add_instance(instance(Shape::Mesh(id), DAffine3::from_translation(DVec3::X * 3.0 * f64::from(i))));
    }
    let keys = [key(0.0, DVec3::Y * 4.0), key(1.0, DVec3::Y * 5.0)];
    builder.add_instance(tracked(Shape::Mesh(id), Track::new(&keys, Interpolation::Linear).expect("legal")));
    let world = builder.build().expect("legal");
    let merged = |interval| {
        let view = world.render_space_with(DVec3::ZERO, interval, Simd::Auto);
        [0, 1, 2, 3].map(|instance| view.placed(instance).is_merged())
    };
    assert_eq!(merged(interval(0.0, 0.5)), [true, true, true, false]);
    assert_eq!(merged(interval(0.5, 0.5)), [true; 4]);
}

#[test]
fn motion_through_a_flat_shape_is_refused() {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(icosphere(0));
    let keys = [key(0.0, DVec3::ZERO), Key { scale: DVec3::new(1.0, -0.5, 1.0), ..key(1.0, DVec3::X) }];
    builder.add_instance(tracked(Shape::Mesh(id), Track::new(&keys, Interpolation::Linear).expect("legal")));
    assert_eq!(builder.build().err(), Some(WorldError::Flattened { instance: 0 }));
}

/// A mesh of a unit of 1e-11 m that moves from 5 m to 20 m away, and a small sphere that moves to 2e12 m: within reach for one interval,
/// not for another.
#[test]
fn reach_holds_over_the_interval() {
    let tiny = Key { scale: DVec3::splat(1e-11), ..key(0.0, DVec3::X * 5.0) };
    let away = Key { time_s: 1.0, position_m: DVec3::X * 20.0, ..tiny };
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(mesh(vec![Vec3::ZERO, Vec3::X * 1e10, Vec3::Y * 1e10], vec![[0, 1, 2]]));
    builder.add_instance(tracked(Shape::Mesh(id), Track::new(&[tiny, away], Interpolation::Linear).expect("legal")));
    let world = builder.build().expect("legal");
    assert_eq!(world.check_reach(DVec3::ZERO, interval(-1.0, 0.1)), Ok(()));
    assert!(matches!(world.check_reach(DVec3::ZERO, interval(0.0, 1.0)), Err(WorldError::Reach { instance: 0, .. })));
    let keys = [key(0.0, DVec3::ZERO), key(1.0, DVec3::Y * 2e12)];
    let mut builder = WorldBuilder::new();
    let leave = Track::new(&keys, Interpolation::Linear).expect("legal");
    builder.add_instance(tracked(Shape::Sphere { radius_m: 1.0 }, leave));
    let world = builder.build().expect("legal");
    assert_eq!(world.check_reach(DVec3::ZERO, interval(0.0, 0.4)), Ok(()));
    assert!(matches!(world.check_reach(DVec3::ZERO, interval(0.4, 0.6)), Err(WorldError::Sphere { instance: 0, .. })));
}
