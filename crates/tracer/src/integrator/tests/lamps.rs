//! Lamps without extent against closed forms.

use super::*;
use crate::lights::{Cone, Lamp, Profile};
use glam::DMat3;

/// A lamp of `intensity` that points down (its x axis) from a height above the origin.
fn lamp(height_m: f64, intensity: f64, profile: Profile) -> Lamp {
    let axes = DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X);
    Lamp::new(DVec3::new(0.0, 0.0, height_m), axes, Spectrum::constant(intensity), profile).expect("a lamp")
}

/// Radiance of a white floor under lamps, at a distance `x` from the origin.
fn below(lamps: Vec<Lamp>, x: f32) -> f64 {
    let mut scene = Scene { sources: Sources { lamps, ..Sources::default() }, ..Scene::default() };
    let floor = scene.material(diffuse_surface(1.0), None);
    scene.square(Vec3::ZERO, 50.0, floor);
    scene.ready().measure(&ray([x, 1.0, 2.0], [x, 0.0, 0.0]), 16, bounces(1)).mean
}

#[test]
fn irradiance_falls_by_distance_squared_and_cosine() {
    for (height_m, x) in [(3.0, 0.0), (3.0, 4.0), (0.5, 6.0)] {
        let d2 = height_m * height_m + f64::from(x * x);
        let expected = 7.0 / d2 * (height_m / d2.sqrt()) / PI;
        let actual = below(vec![lamp(height_m, 7.0, Profile::Isotropic)], x);
        // Some ten roundings of f32.
        assert!((actual / expected - 1.0).abs() < 2e-6, "{actual} {expected}");
        let attenuated = lamp(height_m, 7.0, Profile::Isotropic).attenuated(0.1).expect("an attenuation");
        let actual = below(vec![attenuated], x);
        assert!((actual * (1.0 + 0.1 * d2.sqrt()) / expected - 1.0).abs() < 2e-6, "attenuated: {actual} {expected}");
    }
}

#[test]
fn a_spot_lights_its_field_alone() {
    let spot = |x| below(vec![lamp(2.0, 1.0, Profile::Cone(Cone::new(0.5, 0.5).expect("a spot")))], x);
    let edge = 2.0 * maths::f32::tan(0.5);
    assert!((spot(0.0) - 0.25 / PI).abs() < 1e-6);
    assert!(spot(0.999 * edge) > 0.1 / PI && spot(1.001 * edge) == 0.0);
}

#[test]
fn lamps_add_up_and_a_block_shades_them() {
    let mut scene = Scene::default();
    for (x, intensity) in [(-2.0, 3.0), (2.0, 5.0), (0.0, 1e3)] {
        let axes = DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X);
        let at = DVec3::new(x, 0.0, if x == 0.0 { 4.0 } else { 2.0 });
        let lamp = Lamp::new(at, axes, Spectrum::constant(intensity), Profile::Isotropic).expect("a lamp");
        scene.sources.lamps.push(lamp);
    }
    let (floor, block) = (scene.material(diffuse_surface(1.0), None), scene.material(Surface::Absorber, None));
    scene.square(Vec3::ZERO, 50.0, floor);
    scene.square(Vec3::new(0.0, 0.0, 3.0), 0.3, block);
    let estimate = scene.ready().measure(&ray([0.0, 0.5, 1.0], [0.0; 3]), 256, bounces(1));
    // Each from the distance √8 at 45°.
    agrees(&estimate, (3.0 + 5.0) / 8.0 * 0.5_f64.sqrt() / PI);
}

/// A room of many emitting surfaces of different strengths, with a sun and an image of the surroundings.
fn many() -> BuiltScene {
    let mut scene = Scene::default();
    scene.sources.suns =
        vec![Sun::from_radiance(DVec3::new(-1.0, 0.3, 1.0), 20.0, Spectrum::constant(0.5)).expect("a sun")];
    scene.sources.environment = Some(white_picture());
    let floor = scene.material(diffuse_surface(0.8), None);
    scene.square(Vec3::ZERO, 20.0, floor);
    for i in 0..30 {
        let (x, y) = ((i % 6) as f32 - 2.5, (i / 6) as f32 - 2.0);
        let emission = if i % 2 == 0 { EmissionSides::Both } else { EmissionSides::Front };
        let lamp =
            scene.material(Surface::Absorber, Some(TestEmission { radiance: 0.5 + f64::from(i % 4), sides: emission }));
        scene.square(Vec3::new(3.0 * x, 3.0 * y, 0.6 + 0.1 * i as f32), 0.15, lamp);
        scene.sphere(DVec3::new(f64::from(3.0 * x + 1.0), f64::from(3.0 * y), 0.5), 0.1, lamp);
    }
    scene.ready()
}

#[test]
fn many_lights_agree_in_both_ways_of_finding_them() {
    let ready = many();
    for from in [[-2.0, -2.0, 2.0], [4.0, 1.0, 0.4]] {
        let measure = |strategies, samples| {
            let settings = PathSettings { max_bounces: 2, strategies, ..PathSettings::default() };
            ready.measure(&ray(from, [from[0] + 0.7, from[1] + 0.5, 0.0]), samples, settings)
        };
        let both = measure(Strategies::Both, 512);
        agree(&measure(Strategies::Scattering, 4096), &both);
        agree(&measure(Strategies::Lights, 1024), &both);
        assert!(both.standard_error() < 0.01 * both.mean, "{both:?}");
    }
}

#[test]
fn many_lamps_give_the_sum_of_their_irradiances() {
    let axes = DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X);
    let spot = std::sync::Arc::new(Profile::Cone(Cone::new(0.6, 0.6).expect("a spot")));
    let (mut lamps, mut expected) = (vec![], 0.0);
    let at = DVec3::new(1.0, 2.0, 0.0);
    for i in 0..400 {
        let place = DVec3::new(f64::from(i % 20) * 5.0 - 48.0, f64::from(i / 20) * 5.0 - 47.0, 3.0 + f64::from(i % 7));
        let intensity = 1.0 + f64::from(i % 11);
        let offset = place - at;
        let cos = offset.z / offset.length();
        let inside = i % 3 != 0 || cos >= maths::f64::cos(0.6);
        expected += if inside { intensity * cos / offset.length_squared() / PI } else { 0.0 };
        let profile = if i % 3 == 0 { spot.clone() } else { std::sync::Arc::new(Profile::Isotropic) };
        lamps.push(Lamp::new(place, axes, Spectrum::constant(intensity), profile).expect("a lamp"));
    }
    let mut scene = Scene { sources: Sources { lamps, ..Sources::default() }, ..Scene::default() };
    let floor = scene.material(diffuse_surface(1.0), None);
    scene.square(Vec3::ZERO, 200.0, floor);
    let estimate = scene.ready().measure(&ray([1.0, 1.0, 1.0], [1.0, 2.0, 0.0]), 1024, bounces(1));
    agrees(&estimate, expected);
    assert!(estimate.standard_error() < 2e-3 * estimate.mean, "{estimate:?}");
}
