//! Degenerate worlds and rays.

use super::shapes::{Random, instance, mesh, world_of};
use crate::MaterialId;
use crate::accel::{WorldBuilder, WorldError};
use crate::geometry::{DroppedTriangles, Mesh, MeshId, Shape};
use etendue_core::{Motion, Ray, TimeInterval};
use glam::{DAffine3, DMat3, DVec3, Vec3};

#[test]
fn an_empty_world_is_hit_by_nothing() {
    let mut builder = WorldBuilder::new();
    let (empty, _) = Mesh::new(vec![], vec![], vec![], vec![], vec![]).expect("legal");
    let id = builder.add_mesh(empty);
    let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0);
    for instances in 0..2 {
        let mut builder = builder.clone();
        for _ in 0..instances {
            builder.add_instance(instance(Shape::Mesh(id), DAffine3::IDENTITY));
        }
        let world = builder.build().expect("legal");
        let view = world.render_space(DVec3::ZERO);
        assert!(
            view.closest(&ray).is_none()
                && !view.occluded(&ray)
                && view.truth(DVec3::ZERO, DVec3::X, 0.0, |_| true).is_none()
        );
        assert_eq!(view.bounds(), (Vec3::ZERO, 0.0));
    }
}

#[test]
fn twenty_thousand_coincident_triangles_are_one() {
    let positions = vec![Vec3::new(1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, -1.0), Vec3::new(1.0, 0.0, 1.0)];
    let (mesh, dropped) = Mesh::new(positions, vec![], vec![], vec![[0, 1, 2]; 20_000], vec![]).expect("legal");
    assert_eq!(dropped, DroppedTriangles { zero_area: 0, duplicate: 19_999 });
    let world = world_of(mesh, DAffine3::IDENTITY);
    assert_eq!(world.render_space(DVec3::ZERO).closest(&Ray::new(Vec3::ZERO, Vec3::X, 0.0)).map(|h| h.t), Some(1.0));
}

/// Nested boxes, which no tree can separate, 20 000 deep.
#[test]
fn nested_triangles_overflow_nothing() {
    let count = 20_000_u32;
    let corners = |i: u32| {
        let r = 1.0 + i as f32 * 1e-6;
        [Vec3::new(1.0, -r, -r), Vec3::new(1.0, r, -r), Vec3::new(1.0, 0.0, r)]
    };
    let faces = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let (mesh, _) =
        Mesh::new((0..count).flat_map(corners).collect(), vec![], vec![], faces.collect(), vec![]).expect("legal");
    let world = world_of(mesh, DAffine3::IDENTITY);
    let view = world.render_space(DVec3::ZERO);
    let hit = view.closest(&Ray::new(Vec3::ZERO, Vec3::X, 0.0));
    assert_eq!(hit.map(|h| (h.t, h.primitive)), Some((1.0, 0)));
}

#[test]
fn a_hundred_thousand_instances_are_found() {
    let mut builder = WorldBuilder::new();
    let triangle = vec![Vec3::new(0.1, 0.1, 0.0), Vec3::new(0.9, 0.1, 0.0), Vec3::new(0.1, 0.9, 0.0)];
    let id = builder.add_mesh(mesh(triangle, vec![[0, 1, 2]]));
    let side = 316_u32;
    let place = |i: u32| DAffine3::from_translation(DVec3::new(f64::from(i % side), f64::from(i / side), 0.0));
    for i in 0..side * side {
        builder.add_instance(instance(Shape::Mesh(id), place(i)));
    }
    let world = builder.build().expect("legal");
    let view = world.render_space(DVec3::new(0.0, 0.0, 10.0));
    let mut random = Random::new(2);
    for _ in 0..1000 {
        let i = random.between(0.0, f64::from(side * side)) as u32;
        let over = place(i).translation.as_vec3() + Vec3::new(0.25, 0.25, 0.0);
        let hit = view.closest(&Ray::new(over, Vec3::NEG_Z, 0.0)).expect("a triangle");
        // A mean of three depths of 10 m, by weights of f32.
        assert!(hit.instance == i && (hit.t - 10.0).abs() < 4e-6, "{hit:?}");
    }
}

#[test]
fn rays_that_are_none_meet_nothing() {
    let world = super::shapes::mixed_world();
    let view = world.render_space(DVec3::ZERO);
    let bad = [Vec3::NAN, Vec3::INFINITY, Vec3::new(0.0, f32::NAN, 1.0)];
    let rays = bad.iter().flat_map(|b| [Ray::new(*b, Vec3::X, 0.0), Ray::new(Vec3::ZERO, *b, 0.0)]);
    for ray in rays.chain([Ray::new(Vec3::ZERO, Vec3::ZERO, 0.0)]) {
        assert!(view.closest(&ray).is_none() && !view.occluded(&ray), "{ray:?}");
    }
    let ended = Ray { t_max: 0.0, ..Ray::new(Vec3::ZERO, Vec3::X, 0.0) };
    assert!(view.closest(&ended).is_none() && !view.occluded(&ended));
}

#[test]
fn worlds_that_are_none_are_refused() {
    let build = |shape, to_world, materials: usize| {
        let mut builder = WorldBuilder::new();
        let id = builder.add_mesh(super::shapes::icosphere(0));
        assert_eq!(id, MeshId(0));
        let mut one = instance(shape, to_world);
        one.materials = vec![MaterialId(0); materials];
        one.to_world = Motion::constant(to_world);
        builder.add_instance(one);
        builder.build().err()
    };
    let still = DAffine3::IDENTITY;
    assert_eq!(build(Shape::Mesh(MeshId(0)), still, 1), None);
    assert_eq!(
        build(Shape::Mesh(MeshId(1)), still, 1),
        Some(WorldError::UnknownMesh { instance: 0, mesh: 1, meshes: 1 })
    );
    assert_eq!(
        build(Shape::Mesh(MeshId(0)), still, 0),
        Some(WorldError::MissingMaterials { instance: 0, actual: 0, expected: 1 })
    );
    let flat = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)));
    assert_eq!(build(Shape::Mesh(MeshId(0)), flat, 1), Some(WorldError::Transform { instance: 0 }));
    let nowhere = DAffine3::from_translation(DVec3::NAN);
    assert_eq!(build(Shape::Mesh(MeshId(0)), nowhere, 1), Some(WorldError::Transform { instance: 0 }));
    for radius_m in [0.0, -1.0, f64::INFINITY] {
        let error = build(Shape::Sphere { radius_m }, still, 1);
        assert_eq!(error, Some(WorldError::Radius { instance: 0, radius_m }));
    }
}

/// A triangle of 1 m about (0, 0, `away_m`), from a mesh whose unit is `unit_m`.
fn triangle_world(unit_m: f64, away_m: f64) -> crate::accel::World {
    let half = (0.5 / unit_m) as f32;
    let corners = vec![Vec3::new(-half, -half, 0.0), Vec3::new(half, -half, 0.0), Vec3::new(0.0, half, 0.0)];
    let placement = DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(unit_m)), DVec3::Z * away_m);
    world_of(mesh(corners, vec![[0, 1, 2]]), placement)
}

#[test]
fn rays_that_would_overflow_are_refused_and_all_others_meet() {
    let along = Ray::new(Vec3::ZERO, Vec3::Z, 0.0);
    for (unit_m, away_m) in [(1.0, 1e3), (1e-6, 9e5), (1e-11, 9.0), (1e9, 1e6)] {
        let world = triangle_world(unit_m, away_m);
        assert_eq!(world.check_reach(DVec3::ZERO, TimeInterval::default()), Ok(()));
        let t = world.render_space(DVec3::ZERO).closest(&along).map(|hit| hit.t);
        // A few roundings of f32.
        assert!(t.is_some_and(|t| (f64::from(t) / away_m - 1.0).abs() < 1e-6), "{unit_m} {away_m}: {t:?}");
    }
    for (unit_m, away_m) in [(1e-11, 11.0), (1e-9, 1e5)] {
        let refused = triangle_world(unit_m, away_m).check_reach(DVec3::ZERO, TimeInterval::default());
        assert!(matches!(refused, Err(WorldError::Reach { instance: 0, .. })), "{refused:?}");
    }
    let here = triangle_world(1e-11, 0.0);
    assert_eq!(here.check_reach(DVec3::X, TimeInterval::default()), Ok(()));
    assert!(here.check_reach(DVec3::X * 20.0, TimeInterval::default()).is_err(), "the camera is too far away");
}

/// At a box of 2e8 m, the camera 1.7 m above it was once treated as inside, and saw its bottom.
#[test]
fn a_mesh_into_which_the_camera_would_be_rounded_is_refused() {
    let down = Ray::new(Vec3::ZERO, Vec3::NEG_Z, 0.0);
    let (camera, top) = (DVec3::Z * 1.7, DVec3::ZERO);
    for half in [1e3_f32, 1e6, 1e7] {
        // A corner below and a face above define the box.
        let corners = vec![
            Vec3::splat(-half),
            Vec3::new(half, 0.0, half),
            Vec3::new(-half, half, half),
            Vec3::new(-half, -half, half),
        ];
        let triangles = vec![[1, 2, 3], [0, 1, 2]];
        let world = world_of(mesh(corners, triangles), DAffine3::from_translation(top - DVec3::Z * f64::from(half)));
        assert_eq!(world.check_reach(camera, TimeInterval::default()), Ok(()));
        let t = world.render_space(camera).closest(&down).map(|hit| hit.t);
        assert!(t.is_some_and(|t| (t - 1.7).abs() < 0.9), "{half}: {t:?}");
    }
    let corners =
        vec![Vec3::splat(-1e8), Vec3::new(1e8, 0.0, 1e8), Vec3::new(-1e8, 1e8, 1e8), Vec3::new(-1e8, -1e8, 1e8)];
    let world = world_of(mesh(corners, vec![[1, 2, 3], [0, 1, 2]]), DAffine3::from_translation(DVec3::NEG_Z * 1e8));
    assert!(matches!(
        world.check_reach(camera, TimeInterval::default()),
        Err(WorldError::Rounding { instance: 0, .. })
    ));
    assert_eq!(world.check_reach(DVec3::Z * 100.0, TimeInterval::default()), Ok(()), "from farther away it is right");
    let ground =
        mesh(vec![Vec3::new(-1e9, -1e9, 0.0), Vec3::new(1e9, -1e9, 0.0), Vec3::new(0.0, 1e9, 0.0)], vec![[0, 1, 2]]);
    assert_eq!(
        world_of(ground, DAffine3::IDENTITY).check_reach(DVec3::new(5e8, 0.0, 1.7), TimeInterval::default()),
        Ok(()),
        "level ground is met at its height"
    );
}

#[test]
fn spheres_are_held_to_where_distances_are_right() {
    let planet = |radius_m: f64| {
        let mut builder = WorldBuilder::new();
        let placement = DAffine3::from_translation(DVec3::NEG_Z * radius_m);
        builder.add_instance(instance(Shape::Sphere { radius_m }, placement));
        builder.build().expect("legal")
    };
    let camera = DVec3::Z * 1.7;
    for radius_m in [1.0, 6.4e6, 1e9, 4e11] {
        let world = planet(radius_m);
        assert_eq!(world.check_reach(camera, TimeInterval::default()), Ok(()));
        let t = world.render_space(camera).closest(&Ray::new(Vec3::ZERO, Vec3::NEG_Z, 0.0)).map(|hit| hit.t);
        assert!(t.is_some_and(|t| (t - 1.7).abs() < 2e-4), "{radius_m}: {t:?}");
    }
    for radius_m in [1e12, 1e18, 1e300] {
        assert!(
            matches!(
                planet(radius_m).check_reach(camera, TimeInterval::default()),
                Err(WorldError::Sphere { instance: 0, .. })
            ),
            "{radius_m}"
        );
    }
}

#[test]
fn rays_that_start_on_another_surface_are_within_reach_too() {
    let mut builder = WorldBuilder::new();
    let corners = vec![Vec3::ZERO, Vec3::X * 1e10, Vec3::Y * 1e10];
    let id = builder.add_mesh(mesh(corners, vec![[0, 1, 2]]));
    builder.add_instance(instance(Shape::Mesh(id), DAffine3::from_scale(DVec3::splat(1e-11))));
    assert_eq!(builder.clone().build().expect("legal").check_reach(DVec3::ZERO, TimeInterval::default()), Ok(()));
    let away = DAffine3::from_translation(DVec3::X * 100.0);
    builder.add_instance(instance(Shape::Sphere { radius_m: 1.0 }, away));
    let refused = builder.build().expect("legal").check_reach(DVec3::ZERO, TimeInterval::default());
    assert!(matches!(refused, Err(WorldError::Reach { instance: 0, .. })), "{refused:?}");
}
