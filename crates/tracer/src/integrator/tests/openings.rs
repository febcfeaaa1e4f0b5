//! Lamps with an opening: against sums over their surface, against point lamps from afar, and each strategy of finding their light.

use super::*;
use crate::lights::{Cone, Lamp, LightHit, LightSampleContext, Opening, OpeningBody, Profile, head_lamp};
use etendue_stats::chi_square;
use glam::DMat3;

/// Axes of a lamp that points down: its x axis.
const DOWN: DMat3 = DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X);

fn spot() -> Profile {
    Profile::Cone(Cone::new(0.3, 1.2).expect("a spot"))
}

fn opening(body: OpeningBody, extents_m: [f64; 3]) -> Opening {
    Opening::new(body, extents_m).expect("an opening")
}

/// One of each shape, some 0.3 m large.
fn shapes() -> [Opening; 6] {
    [
        opening(OpeningBody::Box, [0.0, 0.3, 0.2]),
        opening(OpeningBody::Box, [0.1, 0.3, 0.2]),
        opening(OpeningBody::Cylinder(0), [0.0, 0.3, 0.3]),
        opening(OpeningBody::Cylinder(1), [0.05, 0.4, 0.05]),
        opening(OpeningBody::Ellipsoid, [0.3; 3]),
        opening(OpeningBody::Ellipsoid, [0.1, 0.3, 0.2]),
    ]
}

impl Scene {
    /// A lamp of unit intensity with an opening.
    fn open_lamp(&mut self, at: DVec3, axes: DMat3, opening: Opening, profile: Profile) {
        let black = self.material(Surface::Absorber, None);
        let lamp = Lamp::new(at, axes, Spectrum::constant(1.0), profile).expect("a lamp");
        let shape = match opening.mesh() {
            Some(mesh) => Shape::Mesh(self.builder.add_mesh(mesh)),
            None => Shape::Sphere { radius_m: 1.0 },
        };
        let instance = self.builder.add_instance(Instance {
            shape,
            to_world: lamp.opening_to_world(&opening),
            materials: vec![black],
            instance_id: 9,
            semantic_id: 0,
        });
        self.sources.lamps.push(lamp.opened(opening, instance).expect("not too bright"));
    }
}

/// Patches of an opening's surface in the world: place, and normal times area.
fn patches(opening: &Opening, to_world: DAffine3, n: usize) -> Vec<(DVec3, DVec3)> {
    let Some(mesh) = opening.mesh() else { return ball(to_world, 4 * n) };
    let triangles =
        (0..mesh.triangles().len() as u32).map(|p| mesh.corners(p).map(|c| to_world.transform_point3(c.as_dvec3())));
    let of_triangle = |[a, b, c]: [DVec3; 3]| {
        let area = (b - a).cross(c - a) * (0.5 / (n * n) as f64);
        let step = 1.0 / n as f64;
        let place = move |s: f64, t: f64| a + (b - a) * (s * step) + (c - a) * (t * step);
        let third = 1.0 / 3.0;
        let cells = (0..n).flat_map(move |i| (0..n - i).map(move |j| (i as f64, j as f64, i + j + 1 < n)));
        cells.flat_map(move |(i, j, total)| {
            let far = total.then(|| (place(i + 2.0 * third, j + 2.0 * third), area));
            [Some((place(i + third, j + third), area)), far].into_iter().flatten()
        })
    };
    triangles.flat_map(of_triangle).collect()
}

/// Patches of the image of a sphere of radius 1.
fn ball(to_world: DAffine3, n: usize) -> Vec<(DVec3, DVec3)> {
    let linear = to_world.matrix3;
    let cofactor = linear.inverse().transpose() * linear.determinant();
    let of = |k: usize| {
        let z = -1.0 + 2.0 * ((k / n) as f64 + 0.5) / n as f64;
        let (sin, cos) = maths::f64::sin_cos(2.0 * PI * ((k % n) as f64 + 0.5) / n as f64);
        let aside = (1.0 - z * z).sqrt();
        let normal = DVec3::new(aside * cos, aside * sin, z);
        (to_world.transform_point3(normal), cofactor * normal * (4.0 * PI / (n * n) as f64))
    };
    (0..n * n).map(of).collect()
}

/// True if it emits from both sides.
fn is_flat(opening: &Opening) -> bool {
    let flat = |mesh: &Mesh, axis: usize| mesh.positions().iter().all(|place| place[axis] == 0.0);
    opening.mesh().is_some_and(|mesh| (0..3).any(|axis| flat(&mesh, axis)))
}

/// Irradiance at (x, 0, 0), of normal +z, as the sum over patches of L cos θ cos θ′ dA/d² with L = I/A; `visible` is true for patches that
/// are not shaded.
fn irradiance_by_sum(opening: &Opening, at: DVec3, profile: &Profile, x: f64, visible: impl Fn(DVec3) -> bool) -> f64 {
    let lamp = Lamp::new(at, DOWN, Spectrum::constant(1.0), profile.clone()).expect("a lamp");
    let flat = is_flat(opening);
    let receiver = DVec3::new(x, 0.0, 0.0);
    let of = |(place, area): (DVec3, DVec3)| {
        let offset = receiver - place;
        let direction = offset.normalize();
        let own = (DOWN.transpose() * direction).as_vec3();
        let leaving = if flat { area.dot(direction).abs() } else { area.dot(direction).max(0.0) };
        let radiance = f64::from(profile.value(own)) / f64::from(opening.projected_area_m2(own));
        let visibility = if visible(place) { 1.0 } else { 0.0 };
        visibility * radiance * leaving * (-direction.z).max(0.0) / offset.length_squared()
    };
    patches(opening, lamp.opening_to_world(opening).at(0.0), 48).into_iter().map(of).sum()
}

fn above(height_m: f64) -> DVec3 {
    DVec3::new(0.1, 0.05, height_m)
}

#[test]
fn irradiance_near_and_far_is_the_sum_over_the_surface() {
    for shape in shapes() {
        for (height_m, x) in [(0.2, 0.0), (0.3, 0.5), (1.0, 0.3), (6.0, 3.0)] {
            for profile in [Profile::Isotropic, spot()] {
                let expected = irradiance_by_sum(&shape, above(height_m), &profile, x, |_| true) / PI;
                let mut scene = Scene::default();
                let floor = scene.material(diffuse_surface(1.0), None);
                scene.square(Vec3::ZERO, 50.0, floor);
                scene.open_lamp(above(height_m), DOWN, shape, profile);
                let from = ray([x as f32 - 2.0, 1.0, 0.05], [x as f32, 0.0, 0.0]);
                let estimate = scene.ready().measure(&from, 256, bounces(1));
                // Patches of 1/48 of each triangle, on which a body's horizon is cut to a patch.
                let allowed = 3.5 * estimate.standard_error() + 2e-3 * expected;
                assert!(
                    (estimate.mean - expected).abs() < allowed,
                    "{shape:?} {height_m} {x}: {estimate:?} {expected}"
                );
                assert!(estimate.standard_error() < 0.02 * expected, "{shape:?} {height_m} {x}: {estimate:?}");
            }
        }
    }
}

#[test]
fn from_afar_it_is_the_lamp_without_an_opening() {
    for shape in shapes() {
        for x in [0.0, 70.0] {
            let measure = |open: bool| {
                let mut scene = Scene::default();
                let floor = scene.material(diffuse_surface(1.0), None);
                scene.square(Vec3::ZERO, 1000.0, floor);
                let at = DVec3::new(0.0, 0.0, 200.0);
                if open {
                    scene.open_lamp(at, DOWN, shape, spot());
                } else {
                    scene.sources.lamps.push(Lamp::new(at, DOWN, Spectrum::constant(1.0), spot()).expect("a lamp"));
                }
                scene.ready().measure(&ray([x - 3.0, 1.0, 1.0], [x, 0.0, 0.0]), 64, bounces(1))
            };
            let (open, point) = (measure(true), measure(false));
            // Size over distance, 0.3/200, as sides that face past the receiver are not seen there; 1.5e-3 of the silhouette of 48 sides.
            let allowed = 3.5 * open.standard_error() + 2e-3 * point.mean;
            assert!((open.mean - point.mean).abs() < allowed, "{shape:?} {x}: {open:?} {point:?}");
        }
    }
}

#[test]
fn each_strategy_gives_the_same_on_glossy_planes() {
    for shape in shapes() {
        for surface in [paint(0.3, 0.15), aluminium(0.3)] {
            let mut scene = Scene::default();
            let floor = scene.material(surface, None);
            scene.square(Vec3::ZERO, 10.0, floor);
            scene.open_lamp(DVec3::new(0.8, 0.1, 0.7), DOWN, shape, spot());
            let ready = scene.ready();
            let measure = |strategies, samples| {
                let settings = PathSettings { max_bounces: 1, strategies, ..PathSettings::default() };
                ready.measure(&ray([-0.9, 0.0, 0.8], [0.0; 3]), samples, settings)
            };
            let both = measure(Strategies::Both, 512);
            agree(&measure(Strategies::Scattering, 2048), &both);
            agree(&measure(Strategies::Lights, 1024), &both);
            assert!(both.mean > 0.0 && both.standard_error() < 0.02 * both.mean, "{shape:?}: {both:?}");
        }
    }
}

/// Openings of every shape with spots, a headlamp's beam and isotropic lamps, some close to the floor.
fn many() -> BuiltScene {
    let mut scene = Scene::default();
    let floor = scene.material(paint(0.5, 0.3), None);
    scene.square(Vec3::ZERO, 20.0, floor);
    let shapes = shapes();
    for i in 0..24_u32 {
        let (x, y) = (f64::from(i % 6) - 2.5, f64::from(i / 6) - 1.5);
        let at = DVec3::new(1.5 * x, 2.0 * y, 0.35 + 0.05 * f64::from(i));
        let profile = match i % 3 {
            0 => Profile::Isotropic,
            1 => Profile::Cone(Cone::new(0.1, 0.15).expect("a spot")),
            _ => Profile::masked(Profile::PhotometricGrid(head_lamp::low_beam(head_lamp::Traffic::Right)), spot()),
        };
        scene.open_lamp(at, DOWN, shapes[i as usize % shapes.len()], profile);
    }
    scene.ready()
}

#[test]
fn many_openings_agree_in_both_ways_of_finding_them() {
    let ready = many();
    for at in [[0.3, 0.2, 0.0], [-1.0, 1.1, 0.0]] {
        let measure = |strategies, samples, branches| {
            let settings = PathSettings { max_bounces: 2, strategies, branches, ..PathSettings::default() };
            ready.measure(&ray([at[0] - 0.6, at[1] - 0.4, 0.3], at), samples, settings)
        };
        let both = measure(Strategies::Both, 1024, 1);
        agree(&measure(Strategies::Scattering, 8192, 1), &both);
        agree(&measure(Strategies::Lights, 2048, 1), &both);
        agree(&measure(Strategies::Both, 512, 3), &both);
        agree(&measure(Strategies::Scattering, 2048, 4), &both);
    }
}

/// Receivers: near, far, grazing and lateral.
const RECEIVERS: [Vec3; 4] =
    [Vec3::new(0.0, 0.0, 0.3), Vec3::new(0.4, 0.1, 0.95), Vec3::new(2.0, -1.0, 0.4), Vec3::new(-0.25, 0.0, 0.7)];

/// Samples for each of them.
const SAMPLES: u32 = 10_000;

/// More than the triangles of any shape.
const CELLS: usize = 256;

#[test]
fn points_are_sampled_by_the_densities_stated() {
    for shape in shapes() {
        let mut scene = Scene::default();
        scene.open_lamp(DVec3::new(0.0, 0.0, 1.0), DOWN, shape, Profile::Isotropic);
        let ready = scene.ready();
        let view = ready.world.render_space(DVec3::ZERO);
        let lights = ready.lights(&view);
        let flat = is_flat(&shape);
        let to_world = ready.world.instances()[0].to_world.as_constant().expect("still");
        // A triangle of the mesh; for a sphere by halves and sixteen sectors.
        let cell = |primitive: u32, local: Vec3| match shape.mesh() {
            Some(_) => primitive as usize,
            None => {
                let turn = maths::f32::atan2(local.y, local.x) / core::f32::consts::TAU + 0.5;
                usize::from(local.z > 0.0) * 16 + (16.0 * turn) as usize % 16
            }
        };
        for from in RECEIVERS {
            let receiver = LightSampleContext::diffuse(from, Vec3::ZERO);
            // The density of the light hit in a direction, its cell and the cosine of the hit; `None` if nothing is hit.
            let density_at = |direction: Vec3| {
                let hit_ray = Ray::new(from, direction, 0.0);
                let hit = view.closest(&hit_ray)?;
                let point = view.surface(&hit_ray, &hit);
                let light_hit = LightHit { receiver: &receiver, point: &point, direction, distance_m: hit.t };
                let cos = point.geometric_normal.dot(direction).abs();
                Some((lights.light_pdf(&light_hit), cell(point.primitive, point.local), cos))
            };
            let (mut counts, mut expected) = (vec![0_u64; CELLS], vec![0.0; CELLS]);
            for k in 0..SAMPLES {
                let u = Vec2::new(
                    ((f64::from(k) * 0.754_877_666_246_69) % 1.0) as f32,
                    ((f64::from(k) * 0.569_840_290_998_05) % 1.0) as f32,
                );
                let Some(sample) =
                    lights.sample(&receiver, 0.5, u, 0.0, &ready.material_table, query(&TimeInterval::default()))
                else {
                    continue;
                };
                // At the edge a ray may miss by rounding.
                let Some((pdf, cell, cos)) = density_at(sample.direction) else { continue };
                counts[cell] += 1;
                // At 0.3 m positions have 24 bits, directions to the limb of a ball of 5 cm 18, over the cosine twice.
                assert!(
                    (pdf / sample.pdf - 1.0).abs() < 4e-6 / (cos * cos) + 2e-5,
                    "{shape:?} {from} {k}: {pdf} {}",
                    sample.pdf
                );
            }
            let cuts = shape.mesh().map_or(60, |mesh| 1 + (5000 / mesh.triangles().len()).isqrt());
            for (place, area) in patches(&shape, to_world, cuts) {
                let offset = place.as_vec3() - from;
                let cos = area.normalize().dot(offset.as_dvec3().normalize());
                let Some((pdf, cell, ..)) = density_at(offset.normalize()).filter(|_| flat || cos < 0.0) else {
                    continue;
                };
                let sr = area.length() * cos.abs() / f64::from(offset.length_squared());
                expected[cell] += f64::from(pdf) * sr * f64::from(SAMPLES);
            }
            let (sum, count) = (expected.iter().sum::<f64>(), counts.iter().sum::<u64>());
            // Patches near a horizon are cut as a whole. The far side of ellipsoids, which are sampled by area, is not hit.
            let scale = count as f64 / sum;
            assert!((scale - 1.0).abs() < 0.02, "{shape:?} {from}: {count} met for densities of {sum}");
            let covers_all = shape.mesh().is_none() || count > 9_950;
            assert!(covers_all, "{shape:?} {from}: {count}");
            expected.iter_mut().for_each(|e| *e *= scale);
            let test = chi_square::goodness_of_fit(&counts, &expected);
            assert!(test.as_ref().is_none_or(|test| test.p > 1e-3), "{shape:?} {from}: {test:?}");
        }
    }
}

#[test]
fn a_penumbra_is_as_wide_as_the_opening_says() {
    // A disc of 0.3 m at x = 0.1, 4 m above the floor; a plate at half the height covers the region beyond x = 0.1: the penumbra is as wide
    // as the disc, about x = 0.1.
    let disc = opening(OpeningBody::Cylinder(0), [0.0, 0.3, 0.3]);
    let at = above(4.0);
    for (x, full) in [(-0.06, Some(1.0)), (0.0, None), (0.1, None), (0.2, None), (0.26, Some(0.0))] {
        let is_lit = |place: DVec3| 0.5 * (place.x + x) < 0.1;
        let open = irradiance_by_sum(&disc, at, &Profile::Isotropic, x, |_| true);
        let expected = irradiance_by_sum(&disc, at, &Profile::Isotropic, x, is_lit);
        let mut scene = Scene::default();
        let (floor, plate) = (scene.material(diffuse_surface(1.0), None), scene.material(Surface::Absorber, None));
        scene.square(Vec3::ZERO, 50.0, floor);
        scene.square(Vec3::new(5.1, 0.0, 2.0), 5.0, plate);
        scene.open_lamp(at, DOWN, disc, Profile::Isotropic);
        let estimate = scene.ready().measure(&ray([x as f32 - 2.0, 1.0, 0.5], [x as f32, 0.0, 0.0]), 512, bounces(1));
        // The edge of the shadow cuts whole patches.
        let allowed = 3.5 * estimate.standard_error() + 4e-3 * open / PI;
        assert!((estimate.mean - expected / PI).abs() < allowed, "{x}: {estimate:?} for {expected} of {open}");
        assert!(full.is_none_or(|full| expected == full * open), "{x}: {expected} of {open}");
    }
}

#[test]
fn the_camera_sees_the_intensity_over_the_seen_area() {
    for shape in shapes() {
        let mut scene = Scene::default();
        scene.open_lamp(DVec3::new(0.0, 0.0, 1.0), DOWN, shape, spot());
        let ready = scene.ready();
        for from in [[0.3_f32, 0.1, -1.0], [0.05, 0.0, -0.5], [0.2, 0.3, 3.0]] {
            let towards = ray(from, [0.01, 0.02, 1.0]);
            let own = DOWN.as_mat3().transpose() * -towards.direction;
            let expected = f64::from(spot().value(own) / shape.projected_area_m2(own));
            agrees(&ready.measure(&towards, 1, bounces(1)), expected);
        }
    }
}

#[test]
fn a_mirror_shows_the_opening() {
    let mut scene = Scene::default();
    let mirror = scene.material(aluminium(0.0), None);
    scene.square(Vec3::ZERO, 10.0, mirror);
    scene.open_lamp(DVec3::new(1.0, 0.0, 1.0), DOWN, shapes()[4], spot());
    let ready = scene.ready();
    let actual = ready.measure(&ray([-1.0, 0.0, 1.0], [0.0; 3]), 4, bounces(2)).mean;
    let own = Vec3::new(0.5_f32.sqrt(), 0.0, -(0.5_f32.sqrt()));
    let bare = f64::from(spot().value(own) / shapes()[4].projected_area_m2(own));
    // Aluminium reflects some nine tenths.
    assert!((0.85..0.95).contains(&(actual / bare)), "{actual} {bare}");
}
