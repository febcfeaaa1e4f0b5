//! Closed forms and conservation laws.

use super::*;
use crate::materials::MaterialTable;

#[test]
fn a_white_sphere_vanishes_in_a_uniform_environment() {
    for (surface, environment, expected) in [
        (diffuse_surface(1.0), Environment::Uniform(Spectrum::constant(1.0)), 1.0),
        (diffuse_surface(1.0), white_picture(), f64::from(upsample::emission([1.0; 3], &WAVELENGTHS)[1])),
        (paint(1.0, 0.0), Environment::Uniform(Spectrum::constant(1.0)), 1.0),
    ] {
        let mut scene =
            Scene { sources: Sources { environment: Some(environment), ..Sources::default() }, ..Scene::default() };
        let material = scene.material(surface, None);
        scene.sphere(DVec3::new(5.0, 0.0, 0.0), 1.0, material);
        let ready = scene.ready();
        for towards in [[5.0, 0.0, 0.0], [5.0, 0.7, 0.3], [5.0, 0.9, 0.0], [5.0, 5.0, 0.0]] {
            agrees(&ready.measure(&ray([0.0; 3], towards), 256, bounces(8)), expected);
        }
    }
}

#[test]
fn an_emitting_cavity_has_its_geometric_sum() {
    for albedo in [0.5, 0.9, 0.98] {
        let mut sphere = Scene::default();
        let glowing =
            sphere.material(diffuse_surface(albedo), Some(TestEmission { radiance: 1.0, sides: EmissionSides::Both }));
        sphere.sphere(DVec3::new(0.3, 0.0, 0.1), 2.0, glowing);
        let estimate = sphere.ready().measure(&ray([0.0; 3], [1.0, 0.5, 0.2]), 128, bounces(10_000));
        agrees(&estimate, 1.0 / (1.0 - albedo));

        let mut cube = Scene::default();
        let glowing =
            cube.material(diffuse_surface(albedo), Some(TestEmission { radiance: 1.0, sides: EmissionSides::Both }));
        let corner = |i: u32| Vec3::new((i & 1) as f32 - 0.4, (i >> 1 & 1) as f32 - 0.5, (i >> 2) as f32 - 0.6);
        let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        cube.mesh((0..8).map(corner).collect(), triangles, glowing);
        let estimate = cube.ready().measure(&ray([0.0; 3], [1.0, 0.5, 0.2]), 128, bounces(10_000));
        agrees(&estimate, 1.0 / (1.0 - albedo));
    }
}

/// Paths that do not branch, and paths that do.
fn branched(max_bounces: u32) -> [PathSettings; 2] {
    [1, 4].map(|branches| PathSettings { branches, ..bounces(max_bounces) })
}

#[test]
fn a_bounce_more_adds_its_term() {
    let mut scene = Scene::default();
    let glowing =
        scene.material(diffuse_surface(0.5), Some(TestEmission { radiance: 1.0, sides: EmissionSides::Both }));
    scene.sphere(DVec3::ZERO, 1.0, glowing);
    let ready = scene.ready();
    for (max_bounces, expected) in [(0, 1.0), (1, 1.5), (2, 1.75), (3, 1.875)] {
        for settings in branched(max_bounces) {
            agrees(&ready.measure(&ray([0.1, 0.0, 0.0], [1.0, 0.2, 0.3]), 128, settings), expected);
        }
    }
}

#[test]
fn a_sphere_lights_a_plane_by_its_closed_form() {
    // E = π L (r/d)² cos θ if the sphere is wholly above the horizon.
    for (centre, radius) in
        [(DVec3::new(0.0, 0.0, 2.0), 0.5), (DVec3::new(3.0, 0.0, 2.0), 1.5), (DVec3::new(4.0, 1.0, 9.0), 1e-3)]
    {
        let mut scene = Scene::default();
        let (floor, lamp) = (
            scene.material(diffuse_surface(0.6), None),
            scene.material(Surface::Absorber, Some(TestEmission { radiance: 7.0, sides: EmissionSides::Front })),
        );
        scene.square(Vec3::ZERO, 10.0, floor);
        scene.sphere(centre, radius, lamp);
        let d = centre.length();
        let irradiance = PI * 7.0 * (radius / d) * (radius / d) * centre.z / d;
        let ready = scene.ready();
        for settings in branched(1) {
            agrees(&ready.measure(&ray([-1.0, 0.5, 1.0], [0.0; 3]), 256, settings), 0.6 / PI * irradiance);
        }
    }
}

#[test]
fn a_sun_lights_a_plane_by_its_irradiance() {
    let direction = DVec3::new(1.0, 0.5, 1.0);
    let sun = Sun::from_irradiance(direction, 0.5338, &Spectrum::constant(1.4)).expect("a sun");
    let towards = sun.direction().to_array();
    let actual = f64::from(sun.radiance().at(520.0));
    let mut scene = Scene { sources: Sources { suns: vec![sun], ..Sources::default() }, ..Scene::default() };
    let floor = scene.material(diffuse_surface(0.3), None);
    scene.square(Vec3::new(0.0, 0.0, -1.0), 10.0, floor);
    let ready = scene.ready();
    let expected = 0.3 / PI * 1.4 * direction.normalize().z;
    for settings in branched(1) {
        agrees(&ready.measure(&ray([0.0; 3], [0.3, 0.1, -1.0]), 64, settings), expected);
    }
    agrees(&ready.measure(&ray([0.0; 3], towards), 1, bounces(1)), actual);
}

#[test]
fn a_mirror_shows_the_lamp_by_fresnel() {
    let mut scene = Scene::default();
    let (mirror, lamp) = (
        scene.material(aluminium(0.0), None),
        scene.material(Surface::Absorber, Some(TestEmission { radiance: 5.0, sides: EmissionSides::Both })),
    );
    scene.square(Vec3::ZERO, 1.0, mirror);
    scene.square(Vec3::new(0.0, 0.0, 10.0), 1.0, lamp);
    let estimate = scene.ready().measure(&ray([0.0, 0.0, 5.0], [0.0; 3]), 4, bounces(1));
    let al = metal::by_name("Al").expect("aluminium");
    let (n, k) = (f64::from(al.n.at(520.0)), f64::from(al.k.at(520.0)));
    agrees(&estimate, 5.0 * ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k));
}

#[test]
fn radiance_keeps_its_digits_over_the_whole_range() {
    for scale in [1e-9, 1e12] {
        let mut scene = Scene::default();
        let (floor, lamp) = (
            scene.material(diffuse_surface(0.6), None),
            scene.material(diffuse_surface(0.5), Some(TestEmission { radiance: scale, sides: EmissionSides::Front })),
        );
        scene.square(Vec3::ZERO, 10.0, floor);
        scene.sphere(DVec3::new(0.0, 0.0, 2.0), 0.5, lamp);
        let estimate = scene.ready().measure(&ray([-1.0, 0.5, 1.0], [0.0; 3]), 64, bounces(1));
        agrees(&estimate, 0.6 * scale / 16.0);
    }
}

#[test]
fn a_texture_is_read_in_its_place() {
    use crate::textures::{ImageTexture, Sampling, Texels, TextureId};
    let texture =
        ImageTexture::new(2, 1, Texels::Linear8(vec![[51; 3], [204; 3]]), Sampling::default()).expect("texels");
    let surface = Surface::Diffuse(Reflectance::Texture(TextureId(0)));
    let material_table = MaterialTable::new(vec![Material::new(surface)], vec![texture]).expect("a material");
    let mut builder = WorldBuilder::new();
    let positions = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let (mesh, _) = Mesh::new(positions, vec![], uvs, vec![[0, 1, 2], [0, 2, 3]], vec![]).expect("a mesh");
    let shape = Shape::Mesh(builder.add_mesh(mesh));
    let to_world = Motion::constant(DAffine3::IDENTITY);
    builder.add_instance(Instance { shape, to_world, materials: vec![MaterialId(0)], instance_id: 1, semantic_id: 1 });
    let world = builder.build().expect("a world");
    let environment = Some(Environment::Uniform(Spectrum::constant(1.0)));
    let ready = BuiltScene { world, material_table, sources: Sources { environment, ..Sources::default() } };
    agrees(&ready.measure(&ray([-0.5, 0.3, 1.0], [-0.5, 0.3, 0.0]), 4, bounces(1)), 0.2);
    agrees(&ready.measure(&ray([0.5, 0.3, 1.0], [0.5, 0.3, 0.0]), 4, bounces(1)), 0.8);
}
