//! Ground truth at every distance and incidence.

use crate::accel::WorldBuilder;
use crate::accel::tests::shapes::{Random, instance, mesh};
use crate::geometry::{Shape, SurfacePoint};
use crate::render_space::truth::plane;
use etendue_core::maths;
use glam::{DAffine3, DMat3, DVec3, Vec3};

const INCIDENCES_DEG: [f64; 6] = [0.0, 30.0, 60.0, 80.0, 89.0, 89.4];
/// Roundings of f64 (1.1e-16) in some thirty operations, of placements 1e6 m from the world's origin relative to metres (1e6), over the
/// cosine of 89.4° (95 times): 3e-7 in the worst case, as the camera's position itself is so coarse.
const TOLERANCE: f64 = 3e-7;

/// A square in its own plane z = 0, hit at `incidence` from `distance`: position, direction and normal known.
#[test]
fn planes_are_hit_where_they_are() {
    let mut random = Random::new(3);
    let mut worst: f64 = 0.0;
    for incidence in INCIDENCES_DEG.map(f64::to_radians) {
        for distance in [1.0, 17.0, 300.0, 5e3] {
            let half = 0.5 * distance as f32;
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let corners = corners.map(|(x, y)| Vec3::new(x * half, y * half, 0.0)).to_vec();
            let mut builder = WorldBuilder::new();
            let id = builder.add_mesh(mesh(corners, vec![[0, 1, 2], [0, 2, 3]]));
            let placement = DAffine3::from_mat3_translation(random.rotation(), random.cube() * 1e3);
            builder.add_instance(instance(Shape::Mesh(id), placement));
            let world = builder.build().expect("legal");
            for _ in 0..200 {
                let target = DVec3::new(random.between(-0.4, 0.4), random.between(-0.4, 0.4), 0.0) * distance;
                let (sine, cosine) = maths::f64::sin_cos(incidence);
                let (s, c) = maths::f64::sin_cos(random.between(0.0, core::f64::consts::TAU));
                let from = target + DVec3::new(s * sine, c * sine, cosine) * distance;
                let [from, target] = [from, target].map(|p| placement.transform_point3(p));
                let view = world.render_space(from);
                let truth = view.truth(DVec3::ZERO, target - from, 0.0, |_| true).expect("the square");
                worst = worst.max((truth.distance_m / distance - 1.0).abs());
                assert!((truth.position_m - target).length() < 1e-6 * distance);
                assert!((truth.normal - placement.matrix3.z_axis).length() < 1e-12);
                assert_eq!((truth.instance_id, truth.semantic_id, truth.material), (11, 13, 7));
            }
        }
    }
    assert!(worst < TOLERANCE, "{worst}");
}

/// A sphere whose radius is a fifth of the distance, hit at `incidence`.
#[test]
fn spheres_are_hit_where_they_are() {
    let mut random = Random::new(4);
    let mut worst: f64 = 0.0;
    for incidence in INCIDENCES_DEG.map(f64::to_radians) {
        for distance in [1.0, 17.0, 300.0, 5e3] {
            let mut builder = WorldBuilder::new();
            let centre = random.cube() * 1e3;
            let placement = DAffine3::from_mat3_translation(random.rotation(), centre);
            builder.add_instance(instance(Shape::Sphere { radius_m: distance / 5.0 }, placement));
            let world = builder.build().expect("legal");
            for _ in 0..200 {
                let frame: DMat3 = random.rotation();
                let (sine, cosine) = maths::f64::sin_cos(incidence);
                let target = centre + frame.z_axis * (distance / 5.0);
                let from = target + (frame.z_axis * cosine + frame.x_axis * sine) * distance;
                let view = world.render_space(from);
                let truth = view.truth(DVec3::ZERO, target - from, 0.0, |_| true).expect("the sphere");
                worst = worst.max((truth.distance_m / distance - 1.0).abs());
                assert!((truth.normal - frame.z_axis).length() < 1e-6);
            }
        }
    }
    assert!(worst < TOLERANCE, "{worst}");
}

/// A triangle of a centimetre, seen at a slope of a tenth from 100 km. The accelerator's ray is up to 4 mm per axis (half a unit in the
/// last place of 1e5 m) off the exact one, whose intersection with the plane would be decimetres away.
#[test]
fn a_silhouette_is_hit_where_the_triangle_is() {
    let mut random = Random::new(5);
    let (side, distance) = (1e-2, 1e5);
    let corners = [Vec3::ZERO, Vec3::new(1e-2, 0.0, 1e-3), Vec3::new(0.0, 1e-2, 0.0)];
    let from = DVec3::X * -distance;
    let (mut hits, mut beyond) = (0, 0);
    for _ in 0..40 {
        let mut builder = WorldBuilder::new();
        let id = builder.add_mesh(mesh(corners.to_vec(), vec![[0, 1, 2]]));
        let placement = DAffine3::from_mat3_translation(random.rotation(), random.cube());
        builder.add_instance(instance(Shape::Mesh(id), placement));
        let world = builder.build().expect("legal");
        let view = world.render_space(placement.transform_point3(from));
        for _ in 0..500 {
            let about = DVec3::new(0.0, random.between(-side, 2.0 * side), random.between(-side, side));
            let target = placement.transform_point3(about) - view.origin_m();
            let Some(truth) = view.truth(DVec3::ZERO, target, 0.0, |_| true) else { continue };
            let exact = plane(corners.map(Vec3::as_dvec3), from, about - from);
            hits += 1;
            beyond += usize::from(exact.is_none_or(|(_, u, v)| u.min(v).min(1.0 - u - v) < -0.1));
            // The triangle is 1e-2 m long; its own frame adds √3 · 4 mm.
            let along = placement.inverse().transform_point3(truth.position_m).x;
            assert!(along > -7e-3 && along < side + 7e-3, "{along}");
        }
    }
    assert!(hits > 100 && beyond > 50, "{hits} met, {beyond} by an exact ray that is clear of the triangle");
}

#[test]
fn the_background_has_no_truth() {
    let mut builder = WorldBuilder::new();
    builder.add_instance(instance(Shape::Sphere { radius_m: 1.0 }, DAffine3::from_translation(DVec3::X * 5.0)));
    let world = builder.build().expect("legal");
    let view = world.render_space(DVec3::ZERO);
    assert!(
        view.truth(DVec3::ZERO, DVec3::NEG_X, 0.0, |_| true).is_none()
            && view.truth(DVec3::ZERO, DVec3::ZERO, 0.0, |_| true).is_none()
    );
    let truth = view.truth(DVec3::ZERO, DVec3::X * 100.0, 0.0, |_| true).expect("the sphere");
    assert!((truth.distance_m - 4.0).abs() < 1e-12 && (truth.normal - DVec3::NEG_X).length() < 1e-12);
}

/// A sphere behind 30 squares, the first 30, 20 … of which are passed; then both sides of the sphere.
#[test]
fn what_is_not_accepted_is_passed_and_the_rest_is_as_exact() {
    let mut random = Random::new(6);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(mesh(corners, vec![[0, 1, 2], [0, 2, 3]]));
    let placement = DAffine3::from_mat3_translation(random.rotation(), random.cube() * 1e3);
    for i in 1..=30 {
        let along = DAffine3::from_translation(DVec3::Z * f64::from(i));
        builder.add_instance(instance(Shape::Mesh(id), placement * along));
    }
    let centre = DAffine3::from_translation(DVec3::Z * 40.0);
    builder.add_instance(instance(Shape::Sphere { radius_m: 1.0 }, placement * centre));
    let world = builder.build().expect("legal");
    let view = world.render_space(placement.translation);
    let along = placement.matrix3.z_axis;
    for from in 0..30 {
        let truth = view.truth(DVec3::ZERO, along, 0.0, |p| p.instance >= from).expect("a square");
        assert!((truth.distance_m - f64::from(from + 1)).abs() < TOLERANCE);
        assert!((truth.normal - along).length() < 1e-12);
    }
    let sphere = |accept: &dyn Fn(&SurfacePoint) -> bool| view.truth(DVec3::ZERO, along, 0.0, accept);
    assert!((sphere(&|p| p.instance == 30).expect("near side").distance_m - 39.0).abs() < TOLERANCE);
    let inside = |p: &SurfacePoint| p.instance == 30 && p.geometric_normal.as_dvec3().dot(along) > 0.0;
    assert!((sphere(&inside).expect("far side").distance_m - 41.0).abs() < TOLERANCE);
    assert_eq!(sphere(&|_| false), None);
}
