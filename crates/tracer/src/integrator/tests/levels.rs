//! The levels of rendering against closed forms.

use super::*;
use crate::lights::{Lamp, Profile};
use etendue_core::Integrator;
use glam::DMat3;

/// A white floor under a sky of radiance 1 and a lamp at 2 m, with a black block between lamp and origin; seen next to it.
fn floor(integrator: Integrator, x: f32) -> ReplicateEstimate {
    let lamp = Lamp::new(DVec3::Z * 2.0, DMat3::IDENTITY, Spectrum::constant(8.0), Profile::Isotropic).expect("a lamp");
    let environment = Some(Environment::Uniform(Spectrum::constant(1.0)));
    let mut scene =
        Scene { sources: Sources { lamps: vec![lamp], environment, ..Sources::default() }, ..Scene::default() };
    let (white, black) = (scene.material(diffuse_surface(1.0), None), scene.material(Surface::Absorber, None));
    scene.square(Vec3::ZERO, 50.0, white);
    scene.square(Vec3::new(0.0, 0.0, 1.0), 0.5, black);
    let settings = PathSettings { integrator, max_bounces: 7, ..PathSettings::default() };
    scene.ready().measure(&ray([x, 2.0, 0.9], [x, 0.0, 0.0]), 1024, settings)
}

/// Fraction of the sky that a square of half side 0.5 at height 1 hides from the point below its centre, weighted by the cosine: 4/π ·
/// (a/√(1+a²)) · atan(a/√(1+a²)) with a = 0.5 (Howell, configuration C-11, four corners).
fn hidden() -> f64 {
    let s = 0.5 / 1.25_f64.sqrt();
    4.0 / PI * s * maths::f64::atan2(s, 1.0)
}

#[test]
fn flat_is_unshadowed_and_direct_is_shadowed() {
    agrees(&floor(Integrator::Flat, 0.0), 1.0 + 8.0 / 4.0 / PI);
    agrees(&floor(Integrator::Direct, 0.0), 1.0 - hidden());
    // Nothing reflects light back onto the floor, so the whole path is direct light.
    agrees(&floor(Integrator::Path, 0.0), 1.0 - hidden());
}

/// A white wall of a white box of radiance 1: its own emission, direct light, and all light.
#[test]
fn only_paths_gather_light_of_other_surfaces() {
    let measure = |integrator| {
        let mut scene = Scene::default();
        let glowing =
            scene.material(diffuse_surface(0.5), Some(TestEmission { radiance: 1.0, sides: EmissionSides::Both }));
        scene.sphere(DVec3::ZERO, 1.0, glowing);
        let settings = PathSettings { integrator, max_bounces: 64, roulette_start: 64, ..PathSettings::default() };
        scene.ready().measure(&ray([0.1, 0.2, 0.3], [1.0, 0.3, 0.2]), 64, settings)
    };
    agrees(&measure(Integrator::Flat), 1.5);
    agrees(&measure(Integrator::Direct), 1.5);
    agrees(&measure(Integrator::Path), 2.0);
}

#[test]
fn mirrors_show_the_surroundings_at_every_level_and_what_emits_from_direct_on() {
    let measure = |integrator, glows: bool| {
        let environment = Some(Environment::Uniform(Spectrum::constant(2.0)));
        let mut scene = Scene { sources: Sources { environment, ..Sources::default() }, ..Scene::default() };
        let mirror = scene.material(aluminium(0.0), None);
        scene.square(Vec3::ZERO, 1.0, mirror);
        if glows {
            let lamp =
                scene.material(Surface::Absorber, Some(TestEmission { radiance: 5.0, sides: EmissionSides::Both }));
            scene.square(Vec3::new(0.0, 0.0, 3.0), 1.0, lamp);
        }
        let settings = PathSettings { integrator, ..PathSettings::default() };
        scene.ready().measure(&ray([0.0, 0.0, 1.0], [0.0, 0.01, 0.0]), 1, settings).mean
    };
    let sky = measure(Integrator::Path, false);
    assert!(sky > 1.5, "aluminium reflects more than three quarters");
    for (level, expected) in [(Integrator::Flat, sky), (Integrator::Direct, 2.5 * sky), (Integrator::Path, 2.5 * sky)] {
        // Six roundings.
        assert!((measure(level, true) / expected - 1.0).abs() < 1e-6, "{level:?}");
        assert!((measure(level, false) / sky - 1.0).abs() < 1e-6, "{level:?}");
    }
}
