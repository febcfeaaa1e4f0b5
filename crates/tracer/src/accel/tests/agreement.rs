//! Trees against brute force, instruction sets against each other, any against closest.

use etendue_core::{Ray, TimeInterval};
use glam::{DAffine3, DVec3, Vec3};

use super::shapes::{Random, mixed_world, soup, world_of};
use crate::accel::lanes::Plain;
use crate::accel::packet::{HalfPacket, Packet, RayLanes};
use crate::accel::ray::LocalRay;
use crate::accel::{Simd, World};
use crate::geometry::{Hit, Shape, sphere};
use crate::render_space::RenderSpace;

fn rays(count: u32, reach: f64, seed: u32) -> impl Iterator<Item = Ray> {
    let mut random = Random::new(seed);
    (0..count).map(move |_| {
        let (origin, target) = (random.cube() * reach, random.cube() * reach * 0.7);
        Ray::new(origin.as_vec3(), (target - origin).normalize().as_vec3(), 0.0)
    })
}

/// All primitives in turn, last first.
pub(super) fn brute_force(view: &RenderSpace<'_>, ray: &Ray) -> Option<Hit> {
    let world = view.world();
    let mut best: Option<Hit> = None;
    for (instance, primitive) in
        (0..world.instances().len() as u32).rev().flat_map(|i| (0..view.primitive_count(i)).rev().map(move |p| (i, p)))
    {
        let hit = alone(view, ray, instance, primitive);
        if let Some(hit) = hit.filter(|h| h.t < best.map_or(ray.t_max, |b| b.t.next_up())) {
            best = Some(hit);
        }
    }
    best
}

fn alone(view: &RenderSpace<'_>, ray: &Ray, instance: u32, primitive: u32) -> Option<Hit> {
    let world = view.world();
    let (origin, direction) = view.placed(instance).ray_to_local(ray);
    match world.instances()[instance as usize].shape {
        Shape::Sphere { radius_m } => {
            let t = sphere::nearest(radius_m, origin, direction)? as f32;
            Some(Hit { t, instance, primitive, u: 0.0, v: 0.0 })
        }
        Shape::Mesh(id) => {
            let pose = world.mesh(id).at(view.interval().moment(ray.time_s));
            let halves: Vec<_> = HalfPacket::from_primitives(&[primitive], |p| pose.corners(p)).collect();
            let packet = Packet::new(&halves, 0, 0);
            let local = LocalRay::new(origin.as_vec3(), direction.as_vec3());
            let hit = packet.intersect(Plain, &RayLanes::new(Plain, &local), &local, f32::INFINITY)?.next()?;
            Some(Hit { t: hit.t, instance, primitive, u: hit.u, v: hit.v })
        }
    }
}

fn check_against_brute_force(world: &World, count: u32, reach: f64) {
    let view = world.render_space_for_few(DVec3::ZERO, TimeInterval::default());
    let mut hits = 0;
    for ray in rays(count, reach, 21) {
        let hit = view.closest(&ray);
        assert_eq!(hit, brute_force(&view, &ray), "{ray:?}");
        hits += u32::from(hit.is_some());
    }
    assert!(hits > count / 4 && hits < count, "{hits} of {count} rays hit: the test looks at too little");
}

#[test]
fn the_tree_finds_what_brute_force_finds() {
    check_against_brute_force(&world_of(soup(150, 4), DAffine3::IDENTITY), 4000, 3.0);
    check_against_brute_force(&mixed_world(), 2000, 8.0);
}

/// An independent oracle: the f64 intersection by Cramer's rule. Where it and the accelerator differ, the ray must pass an edge within 1e-4
/// of a triangle's size or hit two surfaces within 1e-4 of its length (f32 rounds to 6e-8; rays that graze a triangle at 1e-3 multiply
/// that).
#[test]
fn the_tree_finds_what_f64_finds() {
    let mesh = soup(150, 8);
    let world = world_of(mesh.clone(), DAffine3::IDENTITY);
    let view = world.render_space(DVec3::ZERO);
    let mut differences = 0;
    for ray in rays(4000, 3.0, 5) {
        let expected =
            (0..150).filter_map(|p| cramer(mesh.corners(p), &ray).map(|t| (t, p))).min_by(|a, b| a.0.total_cmp(&b.0));
        let actual = view.closest(&ray).map(|h| (f64::from(h.t), h.primitive));
        let same = match (expected, actual) {
            (Some((t, p)), Some((u, q))) => p == q && (t - u).abs() < 1e-4 * t,
            (a, b) => a.is_none() && b.is_none(),
        };
        differences += u32::from(!same);
    }
    // Some 150 · 1e-4 of the rays pass an edge this closely.
    assert!(differences <= 4, "{differences} of 4000 rays differ");
}

fn cramer(corners: [Vec3; 3], ray: &Ray) -> Option<f64> {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let matrix = glam::DMat3::from_cols(b - a, c - a, -d);
    let [u, v, t] = (matrix.inverse() * (o - a)).to_array();
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

/// On a machine without AVX2 both are the plain lanes, and the test has no effect.
#[test]
fn instruction_sets_give_the_same_bits() {
    let bits = |h: Hit| (h.t.to_bits(), h.u.to_bits(), h.v.to_bits(), h.instance, h.primitive);
    for (world, reach) in [(world_of(soup(3000, 4), DAffine3::IDENTITY), 3.0), (mixed_world(), 8.0)] {
        let [auto, scalar] =
            [Simd::Auto, Simd::Scalar].map(|simd| world.render_space_with(DVec3::ZERO, TimeInterval::default(), simd));
        for ray in rays(50_000, reach, 31) {
            assert_eq!(auto.closest(&ray).map(bits), scalar.closest(&ray).map(bits), "{ray:?}");
            let short = Ray { t_max: 0.5 * reach as f32, ..ray };
            assert_eq!(auto.occluded(&short), scalar.occluded(&short), "{ray:?}");
        }
    }
}

#[test]
fn a_ray_is_occluded_where_it_meets_something_before_its_end() {
    let world = mixed_world();
    let view = world.render_space(DVec3::ZERO);
    for ray in rays(20_000, 8.0, 41) {
        let hit = view.closest(&ray);
        assert_eq!(view.occluded(&ray), hit.is_some());
        let Some(hit) = hit else { continue };
        let until = |t_max| Ray { t_max, ..ray };
        assert!(!view.occluded(&until(hit.t)) && view.closest(&until(hit.t)).is_none(), "the end is exclusive");
        assert!(view.occluded(&until(hit.t.next_up())));
        assert_eq!(view.closest(&until(hit.t.next_up())), Some(hit));
    }
}

/// Merged corners in the render frame are rounded by 6e-8 of 10 m: of 20 000 rays some pass an edge this closely, and distances differ by
/// that over the sine at which they hit the surface.
#[test]
fn instances_written_out_are_hit_as_instances_are() {
    let world = mixed_world();
    let (merged, apart) =
        (world.render_space(DVec3::ZERO), world.render_space_for_few(DVec3::ZERO, TimeInterval::default()));
    assert!((0..5).any(|instance| merged.placed(instance).is_merged()));
    let mut differences = 0;
    for ray in rays(20_000, 8.0, 51) {
        let same = match (merged.closest(&ray), apart.closest(&ray)) {
            (Some(a), Some(b)) => {
                let sine = ray.direction.dot(apart.surface(&ray, &b).geometric_normal).abs();
                let near = (a.t - b.t).abs() < 5e-6 / sine.max(1e-3);
                (a.instance, a.primitive) == (b.instance, b.primitive) && near
            }
            (a, b) => a.is_none() && b.is_none(),
        };
        differences += u32::from(!same);
    }
    assert!(differences <= 4, "{differences} of 20 000 rays differ");
}
