//! A camera inside a transparent solid.

use super::*;
use crate::materials::Dielectric;
use etendue_core::Integrator;

const ABSORPTION: f64 = 3.0;

fn even_light() -> Scene {
    let sources = Sources { environment: Some(Environment::Uniform(Spectrum::constant(1.0))), ..Sources::default() };
    Scene { sources, ..Scene::default() }
}

fn glass(absorption: Option<f64>) -> Surface {
    let absorption = absorption.map(Spectrum::constant);
    Surface::Dielectric(Box::new(Dielectric::new(1.5, 0.0, absorption).expect("glass")))
}

/// n² (1 − R) t/(1 − R t²) in the middle of a ball with the transmittance t over a radius.
fn middle(t: f64) -> f64 {
    let r = 0.04;
    2.25 * (1.0 - r) * t / (1.0 - r * t * t)
}

fn measure(scene: Scene, max_bounces: u32, integrator: Integrator) -> ReplicateEstimate {
    let settings = PathSettings { max_bounces, integrator, roulette_start: 64, ..PathSettings::default() };
    scene.ready().measure(&ray([0.0; 3], [0.3, -0.5, 0.8]), 1024, settings)
}

/// Corners of a cube about the origin.
fn corners(half: f32) -> impl Iterator<Item = Vec3> {
    (0..8).map(move |i: u32| (Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0) * half)
}

/// Its first `count` sides, normals outwards.
fn sides(count: usize) -> impl Iterator<Item = [u32; 3]> {
    let sides = [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];
    sides.into_iter().take(count).flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
}

fn cube(scene: &mut Scene, half: f32, material: MaterialId, count: usize) {
    scene.mesh(corners(half).collect(), sides(count).collect(), material);
}

#[test]
fn light_is_absorbed_on_its_way_to_a_camera_inside_a_ball() {
    let t = maths::f64::exp(-ABSORPTION);
    for (absorption, t) in [(None, 1.0), (Some(ABSORPTION), t)] {
        let mut scene = even_light();
        let ball = scene.material(glass(absorption), None);
        scene.sphere(DVec3::ZERO, 1.0, ball);
        agrees(&measure(scene, 64, Integrator::Path), middle(t));
    }
}

#[test]
fn the_other_levels_absorb_as_well() {
    // One scattering event: the light that the ball's surface refracts, n² (1 − R) t; reflected light is traced no further.
    for level in [Integrator::Flat, Integrator::Direct] {
        let mut scene = even_light();
        let ball = scene.material(glass(Some(ABSORPTION)), None);
        scene.sphere(DVec3::ZERO, 1.0, ball);
        let r = 0.04;
        let once = 2.25 * (1.0 - r) * maths::f64::exp(-ABSORPTION);
        let estimate = measure(scene, 1, level);
        // The flat level uses light of the surroundings for reflections too.
        let mirrored = if level == Integrator::Flat { r * maths::f64::exp(-ABSORPTION) } else { 0.0 };
        agrees(&estimate, once + mirrored);
    }
}

#[test]
fn the_innermost_of_nested_solids_surrounds_the_camera() {
    let solid = |inner: Option<f64>, outer: Option<f64>| {
        let mut scene = Scene::default();
        let (a, b) = (scene.material(glass(inner), None), scene.material(glass(outer), None));
        scene.sphere(DVec3::new(0.2, 0.1, -0.1), 1.0, a);
        cube(&mut scene, 3.0, b, 6);
        scene.sphere(DVec3::new(1.9, 0.0, 0.0), 0.5, b);
        let ready = scene.ready();
        Surroundings::from_view(&ready.world.render_space(DVec3::ZERO), &ready.material_table)
    };
    assert_eq!(solid(Some(1.0), None), Surroundings { solid: Some(MaterialId(0)), open_solid: None });
}

#[test]
fn a_hollow_holds_air() {
    let mut scene = Scene::default();
    let water = scene.material(glass(Some(1.0)), None);
    let other = scene.material(diffuse_surface(0.5), None);
    cube(&mut scene, 0.5, other, 6);
    // One body: its outside and the wall of the hollow are one mesh.
    let inwards = sides(6).map(|[a, b, c]| [a + 8, c + 8, b + 8]);
    scene.mesh(corners(2.0).chain(corners(1.0)).collect(), sides(6).chain(inwards).collect(), water);
    let ready = scene.ready();
    let around = |at: DVec3| Surroundings::from_view(&ready.world.render_space(at), &ready.material_table).solid;
    assert_eq!((around(DVec3::new(0.7, 0.0, 0.0)), around(DVec3::new(1.5, 0.1, 0.0))), (None, Some(water)));
    assert_eq!(around(DVec3::new(2.5, 0.1, 0.0)), None);
}

#[test]
fn a_body_with_a_hole_is_reported() {
    let mut scene = Scene::default();
    let water = scene.material(glass(Some(1.0)), None);
    cube(&mut scene, 1.0, water, 5);
    let ready = scene.ready();
    let around = |at: DVec3| Surroundings::from_view(&ready.world.render_space(at), &ready.material_table);
    assert_eq!(around(DVec3::ZERO), Surroundings { solid: Some(water), open_solid: Some(water) });
    assert_eq!(around(DVec3::X * 5.0).solid, None);
}

/// A thin body of glass about the camera, and a ball of light in it.
#[test]
fn a_lamp_in_the_same_water_is_dimmed_on_its_way() {
    let actual = |absorption: Option<f64>| {
        let mut scene = Scene::default();
        let water = scene.material(glass(absorption), None);
        cube(&mut scene, 2.0, water, 6);
        let emission =
            scene.material(Surface::Absorber, Some(TestEmission { radiance: 1.0, sides: EmissionSides::Front }));
        scene.sphere(DVec3::new(0.9, -1.5, 0.0), 0.2, emission);
        let towards = [0.9, -1.5, 0.0];
        scene.ready().measure(&ray([0.0; 3], towards), 64, bounces(4)).mean
    };
    let length_m = (0.81_f64 + 2.25).sqrt() - 0.2;
    assert!((actual(Some(1.0)) / actual(None) / maths::f64::exp(-length_m) - 1.0).abs() < 1e-5);
}
