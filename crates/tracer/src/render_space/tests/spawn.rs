//! Rays that leave a surface do not pass through it.

use crate::accel::World;
use crate::accel::WorldBuilder;
use crate::accel::tests::shapes::{Random, alone_and_merged, icosphere, instance, mesh, world_of};
use crate::geometry::{Shape, SurfacePoint};
use crate::render_space::RenderSpace;
use etendue_core::Ray;
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// A direction on the side of `normal`, at a sine of elevation between 1e-6 and 1.
fn leaving(normal: Vec3, random: &mut Random) -> Vec3 {
    let normal = normal.as_dvec3().normalize();
    let along = random.direction();
    let along = (along - normal * along.dot(normal)).normalize();
    let exponent = random.between(-6.0, 0.0);
    let sine = etendue_core::maths::f64::pow(10.0, exponent);
    (along * (1.0 - sine * sine).max(0.0).sqrt() + normal * sine).as_vec3()
}

fn next_point(view: &RenderSpace<'_>, origin: DVec3, target: DVec3) -> Option<SurfacePoint> {
    let ray = Ray::new(origin.as_vec3(), (target - origin).normalize().as_vec3(), 0.0);
    view.closest(&ray).map(|hit| view.surface(&ray, &hit))
}

/// The new origin must lie on the direction's side of the plane through a surface point, so that no flat surface is hit again.
fn check_plane(half_m: f32, placement: DAffine3, height: f64) {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = corners.map(|(x, y)| Vec3::new(x * half_m, y * half_m, 0.0)).to_vec();
    let over = placement.transform_point3(DVec3::Z * height);
    let worlds = alone_and_merged(mesh(corners, vec![[0, 1, 2], [0, 2, 3]]), placement);
    let [alone, merged] = worlds.each_ref().map(|world| world.render_space(over));
    assert!(!alone.placed(0).is_merged() && (merged.placed(0).is_merged() || half_m != 10.0));
    let mut random = Random::new(14);
    for view in [&alone, &merged].into_iter().flat_map(|view| core::iter::repeat_n(view, 3000)) {
        let reach = f64::from(half_m) * 0.99 * etendue_core::maths::f64::pow(10.0, random.between(-6.0, 0.0));
        let target =
            placement.transform_point3(DVec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.0) * reach);
        let point = next_point(view, DVec3::ZERO, target - over).expect("a point of the plane");
        for side in [1.0, -1.0] {
            let d = leaving(point.geometric_normal * side, &mut random);
            let (known, unknown) = (point.leave(d), Ray::new(point.spawn(d), d, 0.0));
            for ray in [known, unknown] {
                assert!(view.closest(&ray).is_none() && !view.occluded(&ray), "{point:?} {ray:?}");
            }
        }
    }
}

#[test]
fn a_plane_is_not_hit_again_from_either_side() {
    let mut random = Random::new(12);
    check_plane(10.0, DAffine3::IDENTITY, 2.0);
    check_plane(1e5, DAffine3::IDENTITY, 1.5);
    check_plane(1e5, DAffine3::from_mat3_translation(random.rotation(), random.cube() * 1e6), 1.5);
    let stretched = random.rotation() * DMat3::from_diagonal(DVec3::new(1e3, 1e-2, 7.0));
    check_plane(2.0, DAffine3::from_mat3_translation(stretched, random.cube() * 100.0), 30.0);
}

/// The primitive that a ray leaves saves work and changes no result: from both sides of balls of several sizes, each alone and merged, seen
/// from inside.
#[test]
fn what_a_ray_leaves_changes_no_answer() {
    let mut random = Random::new(15);
    let turn = random.rotation();
    let ball = |radius_m: f64, at: DVec3| DAffine3::from_mat3_translation(turn * radius_m, at);
    let placements =
        [ball(1.0, DVec3::ZERO), ball(0.7, DVec3::new(0.9, 0.1, 0.0)), ball(1e-3, DVec3::X), ball(30.0, DVec3::Y)];
    let mut met_again = 0;
    for placement in placements {
        for world in alone_and_merged(icosphere(2), placement) {
            let centre = placement.translation;
            let view = world.render_space(centre + DVec3::splat(1e-4));
            for _ in 0..3000 {
                let Some(point) = next_point(&view, DVec3::ZERO, random.direction()) else { continue };
                let d = leaving(
                    point.geometric_normal * if random.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 },
                    &mut random,
                );
                let (known, unknown) = (point.leave(d), Ray::new(point.spawn(d), d, 0.0));
                assert_eq!(view.closest(&known), view.closest(&unknown), "{point:?} {d}");
                assert_eq!(view.occluded(&known), view.occluded(&unknown), "{point:?} {d}");
                met_again += usize::from(view.occluded(&known));
            }
        }
    }
    assert!(met_again > 8000, "{met_again}");
}

/// A floor whose own frame has its origin 1e5 m away.
#[test]
fn a_plane_far_from_its_own_origin_is_not_hit_again() {
    let corners = vec![Vec3::new(1e5, 0.0, 3.0), Vec3::new(1e5 + 64.0, 0.0, 3.0), Vec3::new(1e5, 64.0, 3.0)];
    let mut random = Random::new(15);
    let placement = DAffine3::from_mat3_translation(random.rotation(), DVec3::ZERO);
    let world = world_of(mesh(corners, vec![[0, 1, 2]]), placement);
    let camera = placement.transform_point3(DVec3::new(1e5 + 10.0, 10.0, 8.0));
    let view = world.render_space(camera);
    for _ in 0..3000 {
        let at = DVec3::new(1e5 + random.between(1.0, 30.0), random.between(1.0, 30.0), 3.0);
        let point = next_point(&view, DVec3::ZERO, placement.transform_point3(at) - camera).expect("the floor");
        let d = leaving(point.geometric_normal, &mut random);
        assert!(view.closest(&Ray::new(point.spawn(d), d, 0.0)).is_none());
    }
}

/// Rays from a convex body's surface: outward ones hit nothing, inward ones always do.
fn check_convex(world: &World, camera: DVec3, random: &mut Random) {
    let view = world.render_space(camera);
    for _ in 0..3000 {
        let origin = random.direction() * 500.0;
        let point = next_point(&view, origin, random.cube() * 0.4 - camera).expect("the body");
        let normal = point.geometric_normal;
        let outward = leaving(normal, random);
        let ray = Ray::new(point.spawn(outward), outward, 0.0);
        assert!(view.closest(&ray).is_none() && !view.occluded(&ray), "{point:?} {ray:?}");
        let inward = leaving(-normal, random);
        let ray = Ray::new(point.spawn(inward), inward, 0.0);
        assert!(view.closest(&ray).is_some() && view.occluded(&ray), "{point:?} {ray:?}");
    }
}

#[test]
fn spheres_do_not_leak_and_are_not_hit_again() {
    let mut random = Random::new(16);
    let stretched = random.rotation() * DMat3::from_diagonal(DVec3::new(1.0, 0.8, 1.3));
    for matrix in [DMat3::IDENTITY, stretched] {
        for camera in [DVec3::ZERO, DVec3::new(30.0, -200.0, 11.0)] {
            let mut builder = WorldBuilder::new();
            builder.add_instance(instance(Shape::Sphere { radius_m: 1.0 }, DAffine3::from_mat3(matrix)));
            check_convex(&builder.build().expect("legal"), camera, &mut random);
            for world in alone_and_merged(icosphere(2), DAffine3::from_mat3(matrix)) {
                check_convex(&world, camera, &mut random);
            }
        }
    }
}
