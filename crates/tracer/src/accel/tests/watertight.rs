//! No ray passes between triangles that share an edge or a corner.

use super::shapes::{Random, alone_and_merged, bumpy, icosphere, spindle, world_of};
use crate::accel::Simd;
use crate::geometry::Mesh;
use crate::render_space::RenderSpace;
use etendue_core::{Ray, TimeInterval};
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// The corner, the middle and a random point of each edge of each triangle.
fn targets(mesh: &Mesh, random: &mut Random) -> Vec<Vec3> {
    let edges = (0..mesh.triangles().len() as u32).flat_map(|p| {
        let [a, b, c] = mesh.corners(p);
        [(a, b), (b, c), (c, a)]
    });
    edges.flat_map(|(a, b)| [a, a + (b - a) * 0.5, a + (b - a) * random.unit() as f32]).collect()
}

/// Placements: none, a rotation with a stretch, and far away in the world.
fn placements(random: &mut Random) -> Vec<DAffine3> {
    let stretched = random.rotation() * DMat3::from_diagonal(DVec3::new(0.2, 3.0, 1.0));
    let mirrored = random.rotation() * DMat3::from_diagonal(DVec3::new(-40.0, 40.0, 40.0));
    vec![
        DAffine3::IDENTITY,
        DAffine3::from_mat3_translation(stretched, DVec3::new(3.0, -2.0, 1.0)),
        DAffine3::from_mat3_translation(mirrored, DVec3::new(4e6, -3e6, 5e5)),
    ]
}

/// Counts the rays from inside a closed mesh that hit nothing.
fn count_escapes(view: &RenderSpace<'_>, to_render: &DAffine3, inside: &[DVec3], targets: &[Vec3]) -> usize {
    let from = |o: &DVec3| to_render.transform_point3(*o).as_vec3();
    let at = |t: &Vec3| to_render.transform_point3(t.as_dvec3()).as_vec3();
    let rays = inside.iter().flat_map(|o| targets.iter().map(move |t| Ray::new(from(o), at(t) - from(o), 0.0)));
    let lost = |ray: &Ray| view.closest(ray).is_none() || !view.occluded(ray);
    rays.filter(lost).count()
}

/// Traces rays from points inside to every edge, in every placement, with the camera near and at some distance.
fn check_from_inside(mesh: &Mesh, inside: &[DVec3]) {
    let mut random = Random::new(3);
    let targets = targets(mesh, &mut random);
    for placement in placements(&mut random) {
        let centre = placement.transform_point3(inside[0]);
        let cameras = [centre, centre + DVec3::new(0.3, 0.2, -0.7)];
        let worlds = alone_and_merged(mesh.clone(), placement);
        for (world, camera) in worlds.iter().flat_map(|world| cameras.map(|camera| (world, camera))) {
            let mut to_render = placement;
            to_render.translation -= camera;
            for simd in [Simd::Auto, Simd::Scalar] {
                let lost = count_escapes(
                    &world.render_space_with(camera, TimeInterval::default(), simd),
                    &to_render,
                    inside,
                    &targets,
                );
                assert_eq!(lost, 0, "{simd:?} of {} rays in {placement}", inside.len() * targets.len());
            }
        }
    }
}

#[test]
fn nothing_escapes_from_a_sphere_of_triangles() {
    let mut random = Random::new(1);
    let inside: Vec<_> = (0..12).map(|_| random.cube() * 0.5).chain([DVec3::ZERO]).collect();
    check_from_inside(&icosphere(3), &inside);
}

#[test]
fn nothing_escapes_from_a_bumpy_body() {
    let mut random = Random::new(2);
    let inside: Vec<_> = (0..12)
        .map(|_| DVec3::new(random.between(0.5, 15.5), random.between(0.5, 15.5), random.between(-0.9, -0.1)))
        .chain([DVec3::new(8.0, 8.0, -0.5)])
        .collect();
    check_from_inside(&bumpy(16), &inside);
}

#[test]
fn nothing_escapes_from_a_spindle_of_needles() {
    let inside: Vec<_> = (-4..=4).map(|i| DVec3::X * (f64::from(i) * 10.0)).collect();
    let mesh = spindle();
    let targets = targets(&mesh, &mut Random::new(4));
    let world = world_of(mesh, DAffine3::IDENTITY);
    assert_eq!(count_escapes(&world.render_space(DVec3::ZERO), &DAffine3::IDENTITY, &inside, &targets), 0);
}

/// Grid points and edges are at integers, so these rays go exactly through corners and along edges.
#[test]
fn nothing_escapes_along_the_axes() {
    let world = world_of(bumpy(8), DAffine3::IDENTITY);
    let view = world.render_space(DVec3::ZERO);
    let directions = [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y];
    let tilts = [0.0, -0.0, 1e-20, -1e-20, 1e-38];
    let halves = (1..16).flat_map(|x| (1..16).map(move |y| Vec3::new(x as f32 / 2.0, y as f32 / 2.0, -0.5)));
    for origin in halves {
        for ray in directions.iter().flat_map(|d| tilts.map(|tilt| Ray::new(origin, *d + Vec3::splat(tilt), 0.0))) {
            assert!(view.closest(&ray).is_some() && view.occluded(&ray), "{ray:?}");
        }
    }
}

/// From outside, a ray aimed at an edge whose triangles both face it must not pass the surface there.
#[test]
fn nothing_enters_a_sphere_of_triangles() {
    let mesh = icosphere(3);
    let mut random = Random::new(9);
    let targets = targets(&mesh, &mut random);
    let world = world_of(mesh, DAffine3::IDENTITY);
    for distance in [2.0, 30.0, 1e4] {
        let camera = random.direction() * distance;
        let view = world.render_space(camera);
        for target in &targets {
            let to = target.as_dvec3() - camera;
            // Triangles of this sphere are tilted from its radius by up to 6°.
            if to.normalize().dot(target.as_dvec3()) > -0.2 {
                continue;
            }
            let hit = view.closest(&Ray::new(Vec3::ZERO, to.as_vec3(), 0.0));
            // The far side is at least 0.2 of the radius behind.
            assert!(hit.is_some_and(|h| f64::from(h.t) * to.length() < to.length() + 0.1), "{target} from {camera}");
        }
    }
}

/// Squares one behind the other, and rays from 200 m that are parallel to an axis 1e-5 m inside or outside their sides.
/// There are enough of them to need a tree with boxes.
#[test]
fn axis_parallel_rays_keep_to_their_side() {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let square = |i: u32| corners.map(|(y, z)| Vec3::new(i as f32, y, z));
    let faces = |i: u32| [[4 * i, 4 * i + 1, 4 * i + 2], [4 * i, 4 * i + 2, 4 * i + 3]];
    let mesh = super::shapes::mesh((0..40).flat_map(square).collect(), (0..40).flat_map(faces).collect());
    let world = world_of(mesh, DAffine3::IDENTITY);
    let view = world.render_space(DVec3::ZERO);
    for (y, expected) in [(1.0 - 1e-5, true), (1.0, true), (1.0 + 1e-5, false), (-1.0, true), (-1.0 - 1e-5, false)] {
        for z in [0.0, -0.0] {
            let ray = Ray::new(Vec3::new(-200.0, y, 0.25), Vec3::new(1.0, z, -0.0), 0.0);
            assert_eq!(view.closest(&ray).map(|h| h.t), expected.then_some(200.0), "{y}");
        }
    }
}
