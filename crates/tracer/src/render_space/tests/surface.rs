//! Points of surfaces: place, normals, texture coordinates, materials.

use crate::MaterialId;
use crate::accel::WorldBuilder;
use crate::accel::tests::shapes::{Random, icosphere, instance, world_of};
use crate::geometry::{Mesh, Shape, SurfacePoint};
use crate::render_space::RenderSpace;
use etendue_core::Ray;
use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};

fn point(view: &RenderSpace<'_>, ray: Ray) -> SurfacePoint {
    let hit = view.closest(&ray).expect("a hit");
    view.surface(&ray, &hit)
}

/// A square 2 m wide at z = 0, its texture once across, with normals and slots.
fn square(normals: Vec<Vec3>) -> Mesh {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec2::new(x, y));
    let positions = corners.map(|c| c.extend(0.0)).to_vec();
    let uvs = corners.map(|c| c * 0.5 + 0.5).to_vec();
    Mesh::new(positions, normals, uvs, vec![[0, 1, 2], [0, 2, 3]], vec![0, 1]).expect("legal").0
}

fn placed(mesh: Mesh, to_world: DAffine3) -> crate::accel::World {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(mesh);
    let mut one = instance(Shape::Mesh(id), to_world);
    one.materials = vec![MaterialId(4), MaterialId(9)];
    builder.add_instance(one);
    builder.build().expect("legal")
}

#[test]
fn a_point_of_a_square_is_where_its_texture_says() {
    let world = placed(square(vec![]), DAffine3::from_scale(DVec3::splat(10.0)));
    let view = world.render_space(DVec3::new(0.0, 0.0, 5.0));
    let mut random = Random::new(1);
    for _ in 0..500 {
        let (x, y) = (random.between(-10.0, 10.0) as f32, random.between(-10.0, 10.0) as f32);
        let p = point(&view, Ray::new(Vec3::ZERO, Vec3::new(x, y, -5.0), 0.0));
        // Barycentric weights are f32: a few roundings of 6e-8, times 20 m.
        assert!((p.position - Vec3::new(x, y, -5.0)).length() < 2e-5);
        assert!((p.uv - (Vec2::new(x, y) / 20.0 + 0.5)).length() < 1e-6);
        let footprint = view.footprint(&p);
        assert!((footprint.uv_per_m - 0.05).abs() < 1e-7 && (footprint.local_per_m - 0.1).abs() < 1e-7);
        assert!((p.local * 10.0 - Vec3::new(x, y, 0.0)).length() < 2e-5);
        assert_eq!((p.local_normal, view.tangents(&p)), (Vec3::Z, Some([Vec3::X, Vec3::Y])));
        assert_eq!(p.material, MaterialId(if p.primitive == 0 { 4 } else { 9 }));
        assert_eq!((p.geometric_normal, p.shading_normal), (Vec3::Z, Vec3::Z), "as wound, though seen from any side");
        assert!(p.position_error.min_element() > 0.0 && p.position_error.max_element() < 1e-5);
    }
}

#[test]
fn shading_normals_are_on_the_side_of_the_surface_and_fall_back_to_it() {
    let down = Ray::new(Vec3::new(0.3, 0.1, 5.0), Vec3::NEG_Z, 0.0);
    let tilted = Vec3::new(0.6, 0.0, 0.8);
    let shading = |normals, to_world| {
        let world = placed(square(normals), to_world);
        point(&world.render_space(DVec3::ZERO), down).shading_normal
    };
    assert!((shading(vec![tilted * 3.0; 4], DAffine3::IDENTITY) - tilted).length() < 1e-6);
    assert!((shading(vec![-tilted; 4], DAffine3::IDENTITY) - tilted).length() < 1e-6);
    for bad in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        assert_eq!(shading(vec![bad; 4], DAffine3::IDENTITY), Vec3::Z);
    }
    // A stretch by 2 along x rotates normals by the inverse: (0.3, 0, 0.8).
    let stretched = shading(vec![tilted; 4], DAffine3::from_scale(DVec3::new(2.0, 1.0, 1.0)));
    assert!((stretched - Vec3::new(0.3, 0.0, 0.8).normalize()).length() < 1e-6);
}

/// The fast f32 code against that of ground truth in f64, under rotations, non-uniform scales, mirrors, and normals of all lengths.
#[test]
fn normals_are_those_of_ground_truth() {
    let mut random = Random::new(7);
    for i in 0..24 {
        let stretch = DVec3::new(if i % 2 == 0 { -1.0 } else { 1.0 }, 1.0, if i % 3 == 0 { 1.0 } else { 4.0 });
        let scale = [1e-6, 1.0, 1e7][i % 3];
        let matrix = random.rotation() * DMat3::from_diagonal(stretch * scale);
        let length = [1e-12, 1e-3, 1.0, 1e15][i % 4] as f32;
        let normals = (0..4).map(|_| (Vec3::Z + random.cube().as_vec3() * 0.5) * length).collect();
        let world = placed(square(normals), DAffine3::from_mat3(matrix));
        let aim = matrix * DVec3::new(random.between(-0.9, 0.9), random.between(-0.9, 0.9), 0.0);
        let above = aim + matrix.inverse().transpose() * DVec3::Z.normalize() * (scale * scale);
        let view = world.render_space(above);
        let direction = (aim - above).normalize();
        let p = point(&view, Ray::new(Vec3::ZERO, direction.as_vec3(), 0.0));
        let truth = view.truth(DVec3::ZERO, direction, 0.0, |_| true).expect("the same surface");
        // Some ten roundings of 6e-8; the ray hits the triangle at positions in f32.
        assert!((p.shading_normal.as_dvec3() - truth.normal).length() < 2e-6, "{i}: {p:?} {truth:?}");
        assert!(p.shading_normal.dot(p.geometric_normal) > 0.0);
        assert!((p.local_normal.length() - 1.0).abs() < 1e-6 && (p.geometric_normal.length() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn normals_that_hardly_lean_make_a_flat_triangle() {
    for (lean, is_flat) in [(0.0, true), (5e-6, true), (3e-5, false)] {
        let mesh = square(vec![Vec3::new(0.0, lean, -2.0); 4]);
        assert_eq!([mesh.facet(0).is_flat, mesh.facet(1).is_flat], [is_flat; 2], "{lean}");
    }
    let mut mixed = vec![Vec3::Z; 4];
    mixed[2] = Vec3::NEG_Z;
    assert!(!square(mixed).facet(0).is_flat);
}

#[test]
fn normals_point_outwards_even_where_an_instance_mirrors() {
    let mut random = Random::new(2);
    for sign in [1.0, -1.0] {
        let matrix = random.rotation() * DMat3::from_diagonal(DVec3::new(sign, 1.0, 1.0));
        let placement = DAffine3::from_mat3_translation(matrix, random.cube() * 5.0);
        let world = world_of(icosphere(2), placement);
        let view = world.render_space(DVec3::ZERO);
        let centre = placement.translation.as_vec3();
        for _ in 0..200 {
            let p = point(&view, Ray::new(centre, random.direction().as_vec3(), 0.0));
            assert!(p.geometric_normal.dot((p.position - centre).normalize()) > 0.9);
            let [a, b, c] = view.triangle(0, p.primitive, 0.0);
            assert!((b - a).cross(c - a).normalize().dot(p.geometric_normal) > 0.999);
        }
    }
}

#[test]
fn lights_learn_where_spheres_and_everything_are() {
    let mut builder = WorldBuilder::new();
    let to_world = DAffine3::from_scale_rotation_translation(
        DVec3::splat(3.0),
        glam::DQuat::from_xyzw(0.6, 0.0, 0.0, 0.8),
        DVec3::new(1e6, 0.0, 2.0),
    );
    builder.add_instance(instance(Shape::Sphere { radius_m: 0.5 }, to_world));
    let uneven = DAffine3::from_scale(DVec3::new(1.0, 1.0, 2.0));
    builder.add_instance(instance(Shape::Sphere { radius_m: 0.5 }, uneven));
    let world = builder.build().expect("legal");
    let view = world.render_space(DVec3::new(1e6, 1.0, 0.0));
    let (centre, radius) = view.sphere(0, 0.0).expect("a sphere");
    assert!((centre - Vec3::new(0.0, -1.0, 2.0)).length() < 1e-6 && (radius - 1.5).abs() < 1e-6);
    assert_eq!((view.sphere(1, 0.0), view.primitive_count(0)), (None, 1));
    let (centre, radius) = view.bounds();
    assert!((centre.x + 5e5).abs() < 2.0 && (radius - 5e5).abs() < 5.0);
}

#[test]
fn a_sphere_has_the_texture_of_a_globe() {
    let mut builder = WorldBuilder::new();
    builder.add_instance(instance(Shape::Sphere { radius_m: 2.0 }, DAffine3::IDENTITY));
    let world = builder.build().expect("legal");
    let view = world.render_space(DVec3::ZERO);
    let p = point(&view, Ray::new(Vec3::ZERO, Vec3::Y, 0.0));
    assert!((p.position - Vec3::Y * 2.0).length() < 1e-6 && (p.uv - Vec2::new(0.25, 0.5)).length() < 1e-6);
    assert_eq!((p.geometric_normal, p.shading_normal, p.local_normal), (Vec3::Y, Vec3::Y, Vec3::Y));
    assert!((p.local - Vec3::Y * 2.0).length() < 1e-6);
    assert_eq!(view.tangents(&p), Some([Vec3::NEG_X, Vec3::Z]), "east and north");
}

#[test]
fn tangents_follow_the_texture_through_mirrors_and_stretches() {
    let stretch = DAffine3::from_scale(DVec3::new(-2.0, 1.0, 3.0));
    let mirrored_uv = |square: Mesh| {
        let uvs = square.uvs().iter().map(|uv| Vec2::new(1.0 - uv.x, uv.y)).collect();
        Mesh::new(square.positions().to_vec(), vec![], uvs, square.triangles().to_vec(), vec![0, 1]).expect("legal").0
    };
    for (mesh, sign) in [(square(vec![]), -1.0), (mirrored_uv(square(vec![])), 1.0)] {
        let world = placed(mesh, stretch);
        let view = world.render_space(DVec3::new(0.0, 0.0, 5.0));
        let p = point(&view, Ray::new(Vec3::ZERO, Vec3::new(0.3, 0.2, -5.0), 0.0));
        assert_eq!(view.tangents(&p), Some([Vec3::X * sign, Vec3::Y]));
    }
}

#[test]
fn without_texture_coordinates_that_span_it_a_triangle_has_no_tangents() {
    let flat = |uvs: Vec<Vec2>| {
        let mesh = square(vec![]);
        let mesh = Mesh::new(mesh.positions().to_vec(), vec![], uvs, mesh.triangles().to_vec(), vec![0, 1]);
        let world = placed(mesh.expect("legal").0, DAffine3::IDENTITY);
        let view = world.render_space(DVec3::new(0.0, 0.0, 5.0));
        let p = point(&view, Ray::new(Vec3::ZERO, Vec3::new(0.3, 0.2, -5.0), 0.0));
        (view.tangents(&p), view.footprint(&p).uv_per_m)
    };
    assert_eq!(flat(vec![]), (None, 0.0));
    assert_eq!(flat(vec![Vec2::ONE; 4]), (None, 0.0));
}

#[test]
fn texture_coordinates_change_as_they_do_between_neighbours() {
    let stretch = DAffine3::from_mat3_translation(
        Random::new(3).rotation() * DMat3::from_diagonal(DVec3::new(2.0, 3.0, 0.5)),
        DVec3::new(1.0, -2.0, 0.5),
    );
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(square(vec![]));
    let mut flat = instance(Shape::Mesh(id), stretch);
    flat.materials = vec![MaterialId(0); 2];
    builder.add_instance(flat);
    builder.add_instance(instance(Shape::Sphere { radius_m: 0.7 }, DAffine3::from_translation(DVec3::splat(9.0))));
    let world = builder.build().expect("legal");
    for (centre, aim) in
        [(stretch.translation, DVec3::new(0.3, 0.2, 0.0)), (DVec3::splat(9.0), DVec3::new(0.3, 0.5, 0.2))]
    {
        let is_flat = centre == stretch.translation;
        let target = if is_flat { stretch.transform_point3(aim) } else { centre + aim.normalize() * 0.7 };
        let normal = if is_flat { stretch.matrix3.inverse().transpose() * DVec3::Z } else { aim }.normalize();
        let view = world.render_space(target + normal * 0.25);
        let at = |offset: DVec3| point(&view, Ray::new(Vec3::ZERO, (offset - normal * 0.25).as_vec3(), 0.0));
        let middle = at(DVec3::ZERO);
        for along in [normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector())] {
            let step = 1e-2;
            let (ahead, behind) = (at(along * step), at(along * -step));
            let (uv, local) = view.change_along(&middle, (along * (2.0 * step)).as_vec3());
            // Coordinates are rounded at 1e-7 of steps of 1e-2; the sphere curves by a ten-thousandth of them.
            assert!((ahead.uv - behind.uv - uv).length() < 3e-3 * uv.length() + 1e-6, "{} {uv}", ahead.uv - behind.uv);
            assert!((ahead.local - behind.local - local).length() < 3e-3 * local.length() + 1e-6);
        }
    }
}
