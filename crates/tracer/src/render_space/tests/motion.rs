//! Points and ground truth of moving objects: those of the ray's own time.

use crate::accel::tests::shapes::{Random, tracked};
use crate::accel::{Simd, World, WorldBuilder};
use crate::geometry::{Mesh, Shape};
use etendue_core::track::{Interpolation, Key};
use etendue_core::{Ray, TimeInterval, Track, maths};
use glam::{DQuat, DVec3, Vec2, Vec3};

const SHUTTER: (f64, f64) = (1000.0, 1000.5);

fn shutter() -> TimeInterval {
    TimeInterval::new(SHUTTER.0, SHUTTER.1).expect("in order")
}

/// A square 40 m wide at z = 0, its texture once across.
fn square() -> Mesh {
    let corners = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)].map(|(x, y)| Vec2::new(x, y));
    let uvs = corners.map(|c| c / 40.0 + 0.5).to_vec();
    let positions = corners.map(|c| c.extend(0.0)).to_vec();
    Mesh::new(positions, vec![], uvs, vec![[0, 1, 2], [0, 2, 3]], vec![]).expect("legal").0
}

/// Rises from 1e5 m away from the world's origin by 12 m/s, tilts by up to 60°/s and grows.
fn rising(interpolation: Interpolation) -> Track {
    let tilt = |angle: f64| {
        let (sin, cos) = maths::f64::sin_cos(0.5 * angle);
        DQuat::from_xyzw(sin * 0.6, sin * 0.8, 0.0, cos)
    };
    let key = |i: f64| Key {
        time_s: SHUTTER.0 + i - 1.0,
        position_m: DVec3::new(1e5, -2.0, 12.0 * i - 40.0),
        rotation: tilt(0.3 * i * i - 0.6),
        scale: DVec3::new(1.0 + 0.25 * i, 1.0 + 0.25 * i, 1.0),
    };
    Track::new(&[0.0, 1.0, 2.0].map(key), interpolation).expect("legal")
}

const CAMERA: DVec3 = DVec3::new(1e5, 0.0, 0.0);

fn world_of(mesh: Mesh, to_world: Track) -> World {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(mesh);
    builder.add_instance(tracked(Shape::Mesh(id), to_world));
    builder.build().expect("legal")
}

/// In f64: coordinates of 1e5 m, thirty operations of 1.1e-16 each, over a cosine of a third at least.
#[test]
fn truth_of_a_moving_plane_is_exact_at_the_ray_s_time() {
    let mut random = Random::new(61);
    for interpolation in [Interpolation::Linear, Interpolation::Smooth] {
        let track = rising(interpolation);
        let world = world_of(square(), track.clone());
        let view = world.render_space_with(CAMERA, shutter(), Simd::Auto);
        for _ in 0..2000 {
            let time_s = random.between(0.0, 0.5) as f32;
            let to_world = track.at(SHUTTER.0 + f64::from(time_s));
            let direction = (DVec3::NEG_Z + random.cube() * 0.3).normalize();
            let normal = to_world.matrix3.z_axis.normalize();
            let expected = normal.dot(to_world.translation - CAMERA) / normal.dot(direction);
            let truth = view.truth(DVec3::ZERO, direction, time_s, |_| true).expect("the square");
            assert!((truth.distance_m - expected).abs() < 1e-9, "{} {expected}", truth.distance_m);
            assert!((truth.position_m - (CAMERA + direction * expected)).length() < 1e-9);
            assert!((truth.normal - normal).length() < 1e-12);
            assert_eq!((truth.instance_id, truth.semantic_id, truth.material), (11, 13, 7));
        }
    }
}

/// The point lies on the plane of its time to within its error bound, its texture as in the transform of that time.
#[test]
fn points_normals_and_footprints_are_those_of_the_ray_s_time() {
    let mut random = Random::new(62);
    let track = rising(Interpolation::Smooth);
    let world = world_of(square(), track.clone());
    let view = world.render_space_with(CAMERA, shutter(), Simd::Auto);
    for _ in 0..2000 {
        let time_s = random.between(0.0, 0.5) as f32;
        let to_world = track.at(SHUTTER.0 + f64::from(time_s));
        let direction = (DVec3::NEG_Z + random.cube() * 0.3).normalize();
        let ray = Ray::new(Vec3::ZERO, direction.as_vec3(), time_s);
        let point = view.surface(&ray, &view.closest(&ray).expect("the square"));
        assert_eq!(point.time_s, time_s);
        let normal = to_world.matrix3.z_axis.normalize();
        let off = normal.dot(point.position.as_dvec3() + CAMERA - to_world.translation).abs();
        assert!(off <= normal.abs().dot(point.position_error.as_dvec3()), "{off}");
        assert!((point.geometric_normal.as_dvec3() - normal).length() < 1e-6);
        let local = to_world.inverse().transform_point3(point.position.as_dvec3() + CAMERA);
        assert!((point.local.as_dvec3() - local).length() < 1e-5);
        assert!((point.uv.as_dvec2() - (local.truncate() / 40.0 + 0.5)).length() < 1e-6);
        let scale = to_world.matrix3.x_axis.length();
        let footprint = view.footprint(&point);
        assert!((f64::from(footprint.uv_per_m) * 40.0 * scale - 1.0).abs() < 1e-5);
        let [u, _] = view.tangents(&point).expect("texture coordinates");
        let along = to_world.matrix3.x_axis / scale;
        assert!((u.as_dvec3() - along).length() < 1e-6);
        let (uv, _) = view.change_along(&point, along.as_vec3());
        assert!((uv.x * 40.0 * scale as f32 - 1.0).abs() < 1e-5 && uv.y.abs() < 1e-6);
        let corners =
            view.triangle(0, point.primitive, time_s).map(|p| normal.dot(p.as_dvec3() + CAMERA - to_world.translation));
        assert!(corners.iter().all(|off| off.abs() < 1e-5), "{corners:?}");
    }
}

/// Rays that leave a moving plane do not hit it again, from either side, at any angle.
#[test]
fn a_moving_plane_is_not_hit_again_at_the_time_of_the_point() {
    let mut random = Random::new(63);
    let world = world_of(square(), rising(Interpolation::Smooth));
    let view = world.render_space_with(CAMERA, shutter(), Simd::Auto);
    for _ in 0..5000 {
        let time_s = random.between(0.0, 0.5) as f32;
        let direction = (DVec3::NEG_Z + random.cube() * 0.3).normalize();
        let ray = Ray::new(Vec3::ZERO, direction.as_vec3(), time_s);
        let point = view.surface(&ray, &view.closest(&ray).expect("the square"));
        let normal = point.geometric_normal.as_dvec3();
        for side in [1.0, -1.0] {
            let along = random.direction();
            let along = (along - normal * along.dot(normal)).normalize();
            let sine = maths::f64::pow(10.0, random.between(-6.0, 0.0));
            let away = (along * (1.0 - sine * sine).max(0.0).sqrt() + normal * side * sine).as_vec3();
            let onward = Ray::new(point.spawn(away), away, time_s);
            assert!(view.closest(&onward).is_none() && !view.occluded(&onward), "{point:?} {onward:?}");
        }
    }
}

#[test]
fn the_bounds_hold_the_whole_motion() {
    let mut random = Random::new(64);
    let track = rising(Interpolation::Smooth);
    let world = world_of(square(), track.clone());
    let view = world.render_space_with(CAMERA, shutter(), Simd::Auto);
    let (centre, radius) = view.bounds();
    for _ in 0..2000 {
        let corner = DVec3::new(20.0, -20.0, 0.0);
        let place = track.at(random.between(SHUTTER.0, SHUTTER.1)).transform_point3(corner) - CAMERA;
        assert!((place - centre.as_dvec3()).length() <= f64::from(radius));
    }
}
