//! Meshes whose vertices move: against f64 at each ray's own time, by every instruction set, without gaps.

use super::agreement::brute_force;
use super::shapes::{Random, bumpy, icosphere, instance, soup, spindle, tracked};
use crate::accel::{Simd, World, WorldBuilder};
use crate::geometry::{Hit, Instance, Mesh, Repeat, Shape, VertexAnimation, VertexFrame};
use crate::render_space::RenderSpace;
use etendue_core::track::{Interpolation, Key};
use etendue_core::{Ray, TimeInterval, Track};
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

fn interval(start_s: f64, end_s: f64) -> TimeInterval {
    TimeInterval::new(start_s, end_s).expect("in order")
}

/// A mesh whose vertices move to other places near their own, frame by frame; `times_s` includes that of a loop's return.
fn deformed(mesh: &Mesh, reach: f64, times_s: &[f64], repeat: Repeat, seed: u32) -> Mesh {
    let mut random = Random::new(seed);
    let frames = times_s.len() - usize::from(repeat == Repeat::Loop);
    let mut moved = |number: usize| {
        let by = if number == 0 { 0.0 } else { reach };
        let positions = mesh.positions().iter().map(|p| *p + (random.cube() * by).as_vec3()).collect();
        VertexFrame { positions, normals: vec![] }
    };
    let frames = (0..frames).map(&mut moved).collect();
    let animation = VertexAnimation::new(frames, times_s.to_vec(), repeat).expect("legal");
    Mesh::animated(animation, vec![], mesh.triangles().to_vec(), vec![]).expect("legal").0
}

fn flight(random: &mut Random) -> Track {
    let key = |time_s: f64, random: &mut Random| Key {
        time_s,
        position_m: random.cube() * 4.0,
        rotation: DQuat::from_mat3(&random.rotation()),
        scale: DVec3::ONE,
    };
    let keys = [-1.0, 0.3, 2.0].map(|time_s| key(time_s, random));
    Track::new(&keys, Interpolation::Smooth).expect("a legal track")
}

/// Soups and spheres that deform; some are static, some move, one has no animation.
fn mixed_world(seed: u32) -> World {
    let mut random = Random::new(seed);
    let mut builder = WorldBuilder::new();
    let [hold, turns] = [(vec![-0.2, 0.4, 0.9, 1.3], Repeat::Hold), (vec![0.1, 0.35, 0.5, 0.8], Repeat::Loop)];
    let meshes = [
        deformed(&soup(120, 1), 0.6, &hold.0, hold.1, seed),
        deformed(&soup(40, 2), 0.3, &turns.0, turns.1, seed + 1),
        deformed(&icosphere(2), 0.1, &turns.0, turns.1, seed + 2),
        soup(60, 3),
    ]
    .map(|mesh| builder.add_mesh(mesh));
    for i in 0..16 {
        let shape = Shape::Mesh(meshes[i % 4]);
        builder.add_instance(match i % 3 {
            0 => instance(shape, DAffine3::from_mat3_translation(random.rotation(), random.cube() * 4.0)),
            _ => tracked(shape, flight(&mut random)),
        });
    }
    builder.build().expect("a legal world")
}

fn rays(count: u32, seed: u32, interval: TimeInterval) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(seed);
    (0..count).map(move |_| {
        let (origin, target) = (random.cube() * 8.0, random.cube() * 5.0);
        let time_s = (random.unit() * interval.length_s()) as f32;
        Ray::new(origin.as_vec3(), (target - origin).normalize().as_vec3(), time_s)
    })
}

/// The first hit of a ray on a triangle, all in f64: vertices interpolated between the two frames around the time, by an independent
/// formula.
fn oracle(world: &World, interval: TimeInterval, ray: &Ray) -> Option<(f64, u32, u32)> {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let time_s = interval.moment(ray.time_s);
    let mut best: Option<(f64, u32, u32)> = None;
    for (index, instance) in (0..).zip(world.instances()) {
        let Shape::Mesh(id) = instance.shape else { continue };
        let (mesh, to_world) = (world.mesh(id), instance.to_world.at(time_s));
        for (primitive, triangle) in (0..).zip(mesh.triangles()) {
            let corners = triangle.map(|v| to_world.transform_point3(vertex(mesh, v as usize, time_s)));
            let Some(t) = cramer(corners, o, d).filter(|t| *t > 0.0) else { continue };
            if best.is_none_or(|(minimum, ..)| t < minimum) {
                best = Some((t, index, primitive));
            }
        }
    }
    best
}

fn vertex(mesh: &Mesh, v: usize, time_s: f64) -> DVec3 {
    let Some(animation) = mesh.animation() else { return mesh.positions()[v].as_dvec3() };
    let frames = animation.frames();
    let place = |i: usize| frames[i % frames.len()].positions[v].as_dvec3();
    let (times_s, time_s) = match frames.len() {
        4 => (vec![-0.2, 0.4, 0.9, 1.3], time_s.clamp(-0.2, 1.3)),
        _ => {
            let turns = ((time_s - 0.1) / 0.7).floor();
            (vec![0.1, 0.35, 0.5, 0.8], time_s - 0.7 * turns)
        }
    };
    let i = (0..2).rev().find(|i| times_s[i + 1] <= time_s).map_or(0, |i| i + 1);
    place(i).lerp(place(i + 1), (time_s - times_s[i]) / (times_s[i + 1] - times_s[i]))
}

fn cramer([a, b, c]: [DVec3; 3], o: DVec3, d: DVec3) -> Option<f64> {
    let [u, v, t] = (DMat3::from_cols(b - a, c - a, -d).inverse() * (o - a)).to_array();
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some(t)
}

/// As for rigid motion: f32 and f64 differ for few rays in ten thousand, which pass an edge or hit two surfaces at once.
#[test]
fn vertices_are_hit_where_they_are_at_the_ray_s_time() {
    let (mut differences, mut hits) = (0, 0);
    for seed in 0..4 {
        let world = mixed_world(10 * seed);
        let interval = interval(0.3 * f64::from(seed), 0.1 + 0.6 * f64::from(seed));
        let view = world.render_space_with(DVec3::ZERO, interval, Simd::Auto);
        for ray in rays(1000, 100 + seed, interval) {
            let (expected, actual) = (oracle(&world, interval, &ray), view.closest(&ray));
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
    assert!(differences <= 4 && hits > 1000 && hits < 4000, "{differences} of 4000 rays differ, {hits} hit");
}

/// Every primitive in turn with the ray in its own frame: the boxes of the interval lose nothing, to the bit.
#[test]
fn boxes_about_moving_vertices_lose_nothing() {
    for (seed, end_s) in [(10, -0.5), (11, 0.0), (12, 0.7), (13, 4.0)] {
        let (world, interval) = (mixed_world(seed), interval(-0.5, end_s));
        let view = world.render_space_for_few(DVec3::ZERO, interval);
        for ray in rays(400, seed, interval) {
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
fn instruction_sets_give_the_same_bits_of_moving_vertices() {
    let bits = |h: Hit| (h.t.to_bits(), h.u.to_bits(), h.v.to_bits(), h.instance, h.primitive);
    let (world, interval) = (mixed_world(20), interval(0.0, 1.5));
    let [auto, scalar] = [Simd::Auto, Simd::Scalar].map(|simd| world.render_space_with(DVec3::ZERO, interval, simd));
    for ray in rays(10_000, 31, interval) {
        assert_eq!(auto.closest(&ray).map(bits), scalar.closest(&ray).map(bits), "{ray:?}");
        let short = Ray { t_max: 4.0, ..ray };
        assert_eq!(auto.occluded(&short), scalar.occluded(&short), "{ray:?}");
    }
}

/// At a single time, and where the first or last frame holds, the result is the mesh of the vertices of that time.
#[test]
fn a_moment_of_deformation_is_a_still_mesh() {
    for (start_s, end_s) in [(0.4, 0.4), (0.61, 0.61), (-9.0, -2.0), (50.0, 60.0)] {
        let animated = deformed(&bumpy(6), 0.3, &[-0.2, 0.4, 0.9], Repeat::Hold, 3);
        let pose = animated.at(end_s);
        let positions = (0..animated.positions().len() as u32).map(|v| pose.exact_position(v).as_vec3()).collect();
        let still = Mesh::new(positions, vec![], vec![], animated.triangles().to_vec(), vec![]).expect("legal").0;
        for count in [1, 3] {
            let worlds = [&animated, &still].map(|mesh| {
                let mut builder = WorldBuilder::new();
                let id = builder.add_mesh(mesh.clone());
                (0..count).for_each(|i| {
                    let place = DAffine3::from_translation(DVec3::new(-3.0, -3.0, 20.0 * f64::from(i)));
                    builder.add_instance(instance(Shape::Mesh(id), place));
                });
                builder.build().expect("legal")
            });
            let interval = interval(start_s, end_s);
            let views = worlds.each_ref().map(|world| world.render_space_with(DVec3::ZERO, interval, Simd::Auto));
            // Several are merged, a single one is not.
            assert!(views.iter().all(|view| view.placed(0).is_merged() == (count > 1)));
            for ray in rays(1000, 33, interval) {
                let [a, b] = views.each_ref().map(|view| view.closest(&ray));
                assert_eq!(a, b);
                let Some(hit) = a else { continue };
                let [a, b] = views.each_ref().map(|view| view.surface(&ray, &hit));
                assert_eq!(a, b);
            }
        }
    }
}

/// Rays from inside a closed mesh that deforms, at its edges and corners as they are at the ray's time.
fn count_escapes(mesh: &Mesh, reach: f64, inside: &[DVec3], seed: u32) -> usize {
    let mut random = Random::new(seed);
    let animated = deformed(mesh, reach, &[0.1, 0.3, 0.5, 0.6], Repeat::Loop, seed);
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(animated.clone());
    builder.add_instance(instance(Shape::Mesh(id), DAffine3::from_translation(random.cube() * 1e3)));
    let world = builder.build().expect("legal");
    let to_world = world.instances()[0].to_world.at(0.0);
    let interval = interval(0.0, 0.45);
    let mut lost = 0;
    for simd in [Simd::Auto, Simd::Scalar] {
        let camera = to_world.transform_point3(inside[0]);
        let view = world.render_space_with(camera, interval, simd);
        for primitive in 0..mesh.triangles().len() as u32 {
            let time_s = random.between(0.0, 0.45) as f32;
            let pose = animated.at(interval.moment(time_s));
            let [a, b, c] = pose.corners(primitive).map(Vec3::as_dvec3);
            for (target, origin) in [a, (a + b) * 0.5, b + (c - b) * random.unit()].iter().zip(inside.iter().cycle()) {
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
fn nothing_escapes_from_closed_bodies_that_deform() {
    let mut random = Random::new(40);
    let inside: Vec<_> = (0..7).map(|_| random.cube() * 0.4).collect();
    let within: Vec<_> = (0..7)
        .map(|_| DVec3::new(random.between(1.0, 15.0), random.between(1.0, 15.0), random.between(-0.7, -0.3)))
        .collect();
    for seed in 0..6 {
        assert_eq!(count_escapes(&icosphere(3), 0.05, &inside, seed), 0);
        assert_eq!(count_escapes(&bumpy(16), 0.2, &within, 50 + seed), 0);
        assert_eq!(count_escapes(&spindle(), 0.0, &[DVec3::ZERO], 90 + seed), 0);
    }
}

/// A square that opens from lying (z up) to standing (x back) about the y axis within 1 s: its point, its normals and its texture are those
/// of the time, while the straight paths of its vertices shorten it in between.
#[test]
fn surfaces_follow_their_vertices() {
    let frame = |far: Vec3, normal: Vec3| VertexFrame {
        positions: vec![Vec3::NEG_Y, far - Vec3::Y, far + Vec3::Y, Vec3::Y],
        normals: vec![normal; 4],
    };
    let frames = vec![frame(Vec3::X, Vec3::Z), frame(Vec3::Z, Vec3::NEG_X)];
    let animation = VertexAnimation::new(frames, vec![0.0, 1.0], Repeat::Hold).expect("legal");
    let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(glam::Vec2::from_array).to_vec();
    let mesh = Mesh::animated(animation, uvs, vec![[0, 1, 2], [0, 2, 3]], vec![]).expect("legal").0;
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(mesh);
    builder.add_instance(instance(Shape::Mesh(id), DAffine3::IDENTITY));
    let world = builder.build().expect("legal");
    let view = world.render_space_with(DVec3::ZERO, interval(0.0, 1.0), Simd::Auto);
    for time_s in [0.0_f32, 0.25, 0.5, 0.75] {
        // Its far edge is at (1 − t, t); it is hit half-way, from above.
        let (x, z) = (0.5 * (1.0 - time_s), 0.5 * time_s);
        let ray = Ray::new(Vec3::new(x, 0.3, 5.0), Vec3::NEG_Z, time_s);
        let hit = view.closest(&ray).expect("a hit");
        let point = view.surface(&ray, &hit);
        let normal = Vec3::new(-time_s, 0.0, 1.0 - time_s).normalize();
        assert!((point.position - Vec3::new(x, 0.3, z)).length() < 1e-6, "{point:?}");
        assert!((point.geometric_normal - normal).length() < 1e-6 && (point.shading_normal - normal).length() < 1e-6);
        assert!((point.uv - glam::Vec2::new(0.5, 0.65)).length() < 1e-6);
        let [u, v] = view.tangents(&point).expect("texture coordinates");
        let along = Vec3::new(1.0 - time_s, 0.0, time_s).normalize();
        assert!((u - along).length() < 1e-6 && (v - Vec3::Y).length() < 1e-6);
        // Its area is 2 √((1 − t)² + t²), that of its texture 1.
        let side = glam::Vec2::new(1.0 - time_s, time_s).length();
        assert!((view.footprint(&point).uv_per_m - (0.5 / side).sqrt()).abs() < 1e-6);
        let truth = view.truth(ray.origin.as_dvec3(), DVec3::NEG_Z, time_s, |_| true).expect("a hit");
        assert!((truth.distance_m - (5.0 - f64::from(z))).abs() < 1e-7 && truth.primitive == hit.primitive);
        assert!((truth.normal - normal.as_dvec3()).length() < 1e-6);
    }
}

/// A triangle that opens in a later frame is kept from the first on; one that never has an area, and one of the same vertices, is dropped.
#[test]
fn triangles_are_dropped_by_all_frames() {
    let flat = vec![Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::Y];
    let open = vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Z, Vec3::Y];
    let frames = [flat, open].map(|positions| VertexFrame { positions, normals: vec![] }).to_vec();
    let animation = VertexAnimation::new(frames, vec![0.0, 1.0], Repeat::Hold).expect("legal");
    let triangles = vec![[0, 1, 2], [0, 0, 3], [0, 1, 3], [2, 0, 1]];
    let (mesh, dropped) = Mesh::animated(animation, vec![], triangles, vec![]).expect("legal");
    assert_eq!((mesh.triangles(), dropped.zero_area, dropped.duplicate), (&[[0, 1, 2], [0, 1, 3]][..], 1, 1));
    assert_eq!(mesh.bounds(), Some((Vec3::ZERO, Vec3::new(2.0, 1.0, 1.0))));
}

#[test]
fn instances_of_one_mesh_share_its_tree_and_move_by_themselves() {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(deformed(&icosphere(1), 0.2, &[0.0, 1.0], Repeat::Hold, 8));
    let place = |x: f64| instance(Shape::Mesh(id), DAffine3::from_translation(DVec3::X * x));
    let [a, b]: [Instance; 2] = [place(4.0), place(9.0)];
    builder.add_instance(a);
    builder.add_instance(b);
    let world = builder.build().expect("legal");
    let view = world.render_space_with(DVec3::ZERO, interval(0.0, 1.0), Simd::Auto);
    let at = |x: f32, time_s: f32| view.closest(&Ray::new(Vec3::new(x, 0.0, 0.0), Vec3::X, time_s)).expect("a hit");
    for time_s in [0.0, 0.3, 1.0] {
        let (near, far) = (at(0.0, time_s), at(5.5, time_s));
        assert!((near.instance, far.instance) == (0, 1) && near.primitive == far.primitive);
        assert!((near.t - (far.t + 0.5)).abs() < 1e-6);
    }
}
