//! Sides of surfaces: what glows, what leaks, what is seen.

use super::*;

#[test]
fn each_side_glows_as_stated() {
    for (glow, above, below) in [(EmissionSides::Front, 3.0, 0.0), (EmissionSides::Both, 3.0, 3.0)] {
        let mut scene = Scene::default();
        let lamp = scene.material(Surface::Absorber, Some((3.0, glow)));
        scene.square(Vec3::new(0.0, 0.0, 1.0), 1.0, lamp);
        let ready = scene.ready();
        agrees(&ready.look(&ray([0.0, 0.2, 2.0], [0.1, 0.0, 1.0]), 1, bounces(0)), above);
        agrees(&ready.look(&ray([0.0, 0.2, 0.0], [0.1, 0.0, 1.0]), 1, bounces(0)), below);
    }
}

#[test]
fn a_dark_side_lights_nothing() {
    let mut scene = Scene::default();
    let (floor, lamp) =
        (scene.material(matt(0.9), None), scene.material(Surface::Absorber, Some((3.0, EmissionSides::Front))));
    scene.square(Vec3::ZERO, 5.0, floor);
    scene.square(Vec3::new(0.0, 0.0, 1.0), 1.0, lamp);
    let estimate = scene.ready().look(&ray([-2.0, 0.0, 0.5], [0.0, 0.0, 0.0]), 256, bounces(4));
    assert_eq!(estimate.mean, 0.0, "the lamp faces up");
}

#[test]
fn a_wall_with_leaning_normals_lets_no_light_through() {
    let mut scene = Scene::default();
    let (wall, lamp) =
        (scene.material(matt(0.9), None), scene.material(Surface::Absorber, Some((3.0, EmissionSides::Both))));
    // Shading normals that lean 70° to one side: half of the lamp is above their horizon.
    let leaning = Vec3::new(0.94, 0.0, 0.342);
    let positions = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    scene.mesh_with_normals(positions, vec![leaning; 4], vec![[0, 1, 2], [0, 2, 3]], wall);
    scene.sphere(DVec3::new(2.0, 0.0, -0.5), 0.4, lamp);
    let ready = scene.ready();
    for from in [[1.0, 0.0, 2.0], [-3.0, 0.0, 0.2]] {
        let estimate = ready.look(&ray(from, [0.0; 3]), 256, bounces(4));
        assert_eq!(estimate.mean, 0.0, "the lamp is behind the wall");
    }
}

#[test]
fn a_viewer_below_the_shading_horizon_sees_no_black_seam() {
    let environment = Some(Environment::Uniform(Spectrum::constant(1.0)));
    let mut scene = Scene { sources: Sources { environment, ..Sources::default() }, ..Scene::default() };
    let wall = scene.material(matt(1.0), None);
    let positions = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    scene.mesh_with_normals(positions, vec![Vec3::new(0.94, 0.0, 0.342); 4], vec![[0, 1, 2], [0, 2, 3]], wall);
    // Seen from the side that the normals lean away from.
    let estimate = scene.ready().look(&ray([-3.0, 0.0, 0.2], [0.0; 3]), 256, bounces(4));
    assert!(estimate.mean > 0.4 && estimate.mean <= 1.0, "{estimate:?}");
}
