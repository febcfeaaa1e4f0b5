//! Surfaces at the same place: the least identity is hit, whatever the tree.

use super::shapes::{Random, instance, mesh};
use crate::accel::WorldBuilder;
use crate::geometry::{Mesh, Shape};
use etendue_core::Ray;
use glam::{DAffine3, DVec3, Vec3};

/// Squares of many sizes in one plane, about one point.
fn stacked(count: u32) -> Mesh {
    let corners = |i: u32| {
        let r = 1.0 + i as f32 * 0.25;
        [Vec3::new(-r, -r, 4.0), Vec3::new(r, -r, 4.0), Vec3::new(r, r, 4.0), Vec3::new(-r, r, 4.0)]
    };
    let faces = |i: u32| [[4 * i, 4 * i + 1, 4 * i + 2], [4 * i, 4 * i + 2, 4 * i + 3]];
    mesh((0..count).flat_map(corners).collect(), (0..count).flat_map(faces).collect())
}

#[test]
fn coplanar_triangles_yield_to_the_least_primitive() {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(stacked(50));
    builder.add_instance(instance(Shape::Mesh(id), DAffine3::IDENTITY));
    let world = builder.build().expect("legal");
    let view = world.render_space(DVec3::ZERO);
    let mut random = Random::new(6);
    for _ in 0..2000 {
        let (x, y) = (random.between(-13.0, 13.0) as f32, random.between(-13.0, 13.0) as f32);
        let hit = view.closest(&Ray::new(Vec3::new(x, y, 0.0), Vec3::Z, 0.0)).expect("the largest square");
        let square = ((x.abs().max(y.abs()) - 1.0) / 0.25).ceil().max(0.0) as u32;
        // The lower triangle of each square lies where x ≥ y.
        assert_eq!(hit.primitive, 2 * square + u32::from(x < y), "{x} {y}");
    }
    let diagonal = view.closest(&Ray::new(Vec3::new(0.5, 0.5, 0.0), Vec3::Z, 0.0));
    assert_eq!(diagonal.map(|h| h.primitive), Some(0), "a shared edge belongs to the lesser triangle");
}

#[test]
fn instances_at_one_place_yield_to_the_least() {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(stacked(3));
    let shapes = [Shape::Sphere { radius_m: 2.0 }, Shape::Mesh(id), Shape::Sphere { radius_m: 2.0 }, Shape::Mesh(id)];
    for shape in shapes.into_iter().cycle().take(40) {
        builder.add_instance(instance(shape, DAffine3::from_translation(DVec3::new(0.0, 0.0, 1.0))));
    }
    let world = builder.build().expect("legal");
    let view = world.render_space(DVec3::ZERO);
    let mut random = Random::new(8);
    for _ in 0..500 {
        let d = random.direction().as_vec3();
        let upwards = Ray::new(Vec3::new(d.x * 0.9, d.y * 0.9, 3.5), Vec3::Z, 0.0);
        assert_eq!(view.closest(&upwards).map(|h| h.instance), Some(1));
        assert_eq!(view.closest(&Ray::new(Vec3::Z, d, 0.0)).map(|h| h.instance), Some(0));
    }
}
