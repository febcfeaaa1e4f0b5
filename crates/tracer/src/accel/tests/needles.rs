//! A million needles and slivers against brute force, by every quality of tree; the same tree on any number of threads.

use etendue_core::Ray;
use glam::{DAffine3, DVec3};

use super::shapes::{Random, instance, soup};
use crate::accel::WorldBuilder;
use crate::accel::blas::Blas;
use crate::accel::lanes::Plain;
use crate::accel::packet::{HalfPacket, Packet, RayLanes};
use crate::accel::ray::LocalRay;
use crate::geometry::{Mesh, Shape};
use etendue_core::Accelerator;

/// Triangles of lengths from 1 mm to 10 m, a hundred to a hundred thousand times as long as wide, in a cube of 20 m.
fn needles(count: u32, seed: u32) -> Mesh {
    let mut random = Random::new(seed);
    let mut positions = Vec::with_capacity(3 * count as usize);
    for _ in 0..count {
        // Lengths and widths of all orders of magnitude.
        let length = 10.0 * etendue_core::maths::f64::pow(1e-4, random.unit());
        let width = length * 1e-2 * etendue_core::maths::f64::pow(1e-3, random.unit());
        let (tip, along) = (random.cube() * 10.0, random.direction());
        let across = along.cross(random.direction()).normalize_or(along.any_orthonormal_vector());
        // Slivers have their third corner anywhere along the long side.
        let fraction = random.unit();
        positions.extend(
            [tip, tip + along * length, tip + along * (fraction * length) + across * width].map(DVec3::as_vec3),
        );
    }
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    // Some are too thin for f32.
    Mesh::new(positions, vec![], vec![], triangles, vec![]).expect("legal").0
}

/// Rays to points of needles, from anywhere about them.
fn rays(mesh: &Mesh, count: u32) -> Vec<Ray> {
    let mut random = Random::new(77);
    let triangles = mesh.triangles().len() as f64;
    let mut ray = || {
        let [a, b, c] = mesh.corners((random.unit() * triangles) as u32);
        let (u, v) = (random.unit() as f32 * 0.5, random.unit() as f32 * 0.5);
        let (origin, target) = ((random.cube() * 15.0).as_vec3(), a + (b - a) * u + (c - a) * v);
        Ray::new(origin, (target - origin).normalize(), 0.0)
    };
    (0..count).map(|_| ray()).collect()
}

/// The least t at which a ray hits any triangle, and the least number of those it hits there.
fn brute_force(halves: &[HalfPacket], ray: &Ray) -> Option<(u32, u32)> {
    let local = LocalRay::new(ray.origin, ray.direction);
    let spread = RayLanes::new(Plain, &local);
    let packets = (0..halves.len()).step_by(2).map(|i| Packet::new(halves, i, (i + 1).min(halves.len() - 1)));
    let hits = packets.filter_map(|packet| packet.intersect(Plain, &spread, &local, f32::INFINITY)).flatten();
    hits.map(|hit| (hit.t.to_bits(), hit.primitive)).min()
}

fn check(mesh: &Mesh, quality: Accelerator, rays: &[Ray], expected: &[Option<(u32, u32)>]) {
    let mut builder = WorldBuilder::new().with_tree_quality(quality);
    let shape = Shape::Mesh(builder.add_mesh(mesh.clone()));
    builder.add_instance(instance(shape, DAffine3::IDENTITY));
    let world = builder.build().expect("legal");
    let view = world.render_space(DVec3::ZERO);
    for (ray, expected) in rays.iter().zip(expected) {
        let actual = view.closest(ray).map(|hit| (hit.t.to_bits(), hit.primitive));
        assert_eq!(actual, *expected, "{quality:?} {ray:?}");
        assert_eq!(view.occluded(ray), expected.is_some());
    }
}

fn agree(count: u32, ray_count: u32, qualities: &[Accelerator]) {
    let mesh = needles(count, 3);
    assert!(mesh.triangles().len() > count as usize * 9 / 10, "most needles have an area");
    let numbers: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    let halves: Vec<_> = HalfPacket::from_primitives(&numbers, |p| mesh.corners(p)).collect();
    let rays = rays(&mesh, ray_count);
    let expected: Vec<_> = rays.iter().map(|ray| brute_force(&halves, ray)).collect();
    let hits = expected.iter().flatten().count();
    assert!(hits > ray_count as usize / 4, "{hits} of {ray_count} rays meet something: the test looks at too little");
    qualities.iter().for_each(|quality| check(&mesh, *quality, &rays, &expected));
}

#[test]
fn a_million_needles_are_found_as_by_brute_force() {
    agree(1_000_000, 100, &[Accelerator::Default]);
}

#[test]
fn every_quality_of_tree_gives_the_same_answers() {
    agree(30_000, 2000, &[Accelerator::Fast, Accelerator::Default, Accelerator::Best]);
}

#[test]
fn a_tree_is_the_same_on_any_number_of_threads() {
    let mesh = soup(20_000, 9);
    let tree = |threads: usize, quality| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        format!("{:?}", pool.install(|| Blas::new(&mesh, quality)))
    };
    for quality in [Accelerator::Fast, Accelerator::Default, Accelerator::Best] {
        assert!(tree(1, quality) == tree(3, quality), "{quality:?}");
    }
}
