//! Lights close to the surfaces that they light: a strip in a recess, a few centimetres from its walls.

use super::*;

const ALBEDO: f64 = 0.8;

/// A strip of 2.4 m × 1 cm, 2 cm above a floor.
fn strip() -> [DVec3; 4] {
    let (x, y, z) = ([0.03, 0.04], [-1.2, 1.2], 0.02);
    [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])].map(|(x, y)| DVec3::new(x, y, z))
}

fn under_a_strip() -> BuiltScene {
    let mut scene = Scene::default();
    let floor = scene.material(diffuse_surface(ALBEDO), None);
    let lamp = scene.material(Surface::Absorber, Some(TestEmission { radiance: 1.0, sides: EmissionSides::Both }));
    scene.square(Vec3::ZERO, 5.0, floor);
    scene.mesh(strip().map(|p| p.as_vec3()).to_vec(), vec![[0, 1, 2], [0, 2, 3]], lamp);
    scene.ready()
}

/// Irradiance at a point of the floor from a polygon of radiance 1 above it (Lambert 1760).
fn polygon_irradiance(point: DVec3, corners: &[DVec3]) -> f64 {
    let rays: Vec<DVec3> = corners.iter().map(|corner| *corner - point).collect();
    let edge = |i: usize| {
        let (a, b) = (rays[i], rays[(i + 1) % rays.len()]);
        let across = a.cross(b);
        maths::f64::atan2(across.length(), a.dot(b)) * across.normalize().z
    };
    0.5 * (0..rays.len()).map(edge).sum::<f64>().abs()
}

fn measure(at: [f32; 3], strategies: Strategies, samples: u32) -> ReplicateEstimate {
    let settings = PathSettings { max_bounces: 1, strategies, ..PathSettings::default() };
    under_a_strip().measure(&ray([-0.5, at[1], 1.0], at), samples, settings)
}

#[test]
fn a_strip_close_by_gives_its_closed_form_with_little_noise() {
    for at in [[0.0, 0.1, 0.0], [0.02, 1.15, 0.0]] {
        let expected = ALBEDO / PI * polygon_irradiance(Vec3::from(at).as_dvec3(), &strip());
        for strategies in [Strategies::Both, Strategies::Lights] {
            let estimate = measure(at, strategies, 64);
            agrees(&estimate, expected);
            // Sampled by area, 3.7 % at the first of them.
            assert!(estimate.standard_error() < 0.002 * expected, "{at:?} {strategies:?}: {estimate:?}");
        }
        agrees(&measure(at, Strategies::Scattering, 1024), expected);
    }
}
