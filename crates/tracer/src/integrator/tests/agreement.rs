//! The path tracer against itself: strategies of finding light, roulette, wavelengths, repetition.

use super::*;
use crate::integrator::path_tracer::SceneEffects;
use crate::lights::Lights;

/// A floor and a block under lights of every kind.
fn mixed(floor: Surface) -> BuiltScene {
    let image = (0..128).map(|i| [0.2 + (i % 5) as f32, 0.5, (i % 3) as f32]).collect();
    let sources = Sources {
        suns: vec![Sun::from_radiance(DVec3::new(-1.0, 0.3, 1.0), 20.0, Spectrum::constant(0.02)).expect("a sun")],
        lamps: vec![],
        environment: Some(Environment::Image(ImageEnvironment::new(16, 8, image, 1.0, 1.0).expect("a picture"))),
    };
    let mut scene = Scene { sources, ..Scene::default() };
    let floor = scene.material(floor, None);
    let lamp = scene.material(diffuse_surface(0.2), Some(TestEmission { radiance: 0.05, sides: EmissionSides::Both }));
    let block = scene.material(diffuse_surface(0.7), None);
    scene.square(Vec3::ZERO, 5.0, floor);
    scene.square(Vec3::new(1.0, 0.0, 1.5), 0.5, lamp);
    scene.sphere(DVec3::new(0.5, 1.0, 0.6), 0.5, lamp);
    let flat = DAffine3::from_scale_rotation_translation(
        DVec3::new(0.3, 0.8, 0.4),
        glam::DQuat::from_rotation_z(0.4),
        DVec3::new(0.0, -1.5, 0.8),
    );
    scene.place(Shape::Sphere { radius_m: 1.0 }, flat, lamp);
    scene.sphere(DVec3::new(-0.8, 0.0, 0.5), 0.4, block);
    scene.ready()
}

#[test]
fn sampled_light_and_hit_light_agree() {
    for floor in [diffuse_surface(0.8), aluminium(0.4), paint(0.6, 0.3), paint(0.6, 0.0)] {
        let ready = mixed(floor);
        let measure = |strategies, samples| {
            let settings = PathSettings { max_bounces: 3, strategies, ..PathSettings::default() };
            ready.measure(&ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]), samples, settings)
        };
        let both = measure(Strategies::Both, 512);
        agree(&measure(Strategies::Scattering, 2048), &both);
        agree(&measure(Strategies::Lights, 1024), &both);
        assert!(both.standard_error() < 0.02 * both.mean, "{both:?}");
    }
}

/// Surroundings with a sun that is brighter than them, and one that is not: uniform ones, which are then not sampled at all, and some with
/// a bright patch.
#[test]
fn surroundings_beside_a_sun_are_found_however_they_are_sampled() {
    for (texel, radiance) in [(1.0, 2e3), (1.0, 2.0), (400.0, 2e3), (400.0, 2.0)] {
        let mut texels = vec![[1.0; 3]; 32 * 16];
        texels[3 * 32 + 5] = [texel; 3];
        let image = ImageEnvironment::new(32, 16, texels, 1.0, 0.0).expect("a picture");
        let sun =
            Sun::from_radiance(DVec3::new(1.0, 0.0, 1.0), 2.0, Spectrum::constant(radiance * 1e-3)).expect("a sun");
        let sources = Sources { suns: vec![sun], lamps: vec![], environment: Some(Environment::Image(image)) };
        let mut scene = Scene { sources, ..Scene::default() };
        let (floor, ball) = (scene.material(diffuse_surface(0.8), None), scene.material(paint(0.5, 0.3), None));
        scene.square(Vec3::ZERO, 5.0, floor);
        scene.sphere(DVec3::new(0.0, 0.0, 0.6), 0.5, ball);
        let ready = scene.ready();
        // Below the ball, and its side that faces away from the sun.
        for to in [[0.1, 0.2, 0.0], [-0.4, -0.1, 0.5]] {
            let measure = |strategies, samples| {
                let settings = PathSettings { max_bounces: 3, strategies, ..PathSettings::default() };
                ready.measure(&ray([-2.0, -1.0, 1.0], to), samples, settings)
            };
            let both = measure(Strategies::Both, 1024);
            agree(&measure(Strategies::Scattering, 4096), &both);
            agree(&measure(Strategies::Lights, 4096), &both);
            assert!(both.standard_error() < 0.02 * both.mean, "{texel} {radiance}: {both:?}");
        }
    }
}

#[test]
fn roulette_leaves_the_mean() {
    let ready = mixed(diffuse_surface(0.8));
    let measure = |roulette_start| {
        let settings = PathSettings { max_bounces: 6, roulette_start, ..PathSettings::default() };
        ready.measure(&ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]), 512, settings)
    };
    agree(&measure(0), &measure(100));
}

#[test]
fn lights_are_counted_by_kind() {
    let ready = mixed(diffuse_surface(0.5));
    let view = ready.world.render_space(DVec3::ZERO);
    let counts = ready.lights(&view).light_counts();
    assert_eq!((counts.triangles, counts.spheres, counts.suns), (2, 2, 1));
    assert!(counts.image_environment && !counts.uniform_environment);
}

#[test]
fn a_lamp_far_from_the_origin_of_its_mesh_still_shines() {
    // The camera is at the origin; the lamp's own frame is 100 km away, where f32 resolves 8 mm.
    let mut scene = Scene::default();
    let (floor, lamp) = (
        scene.material(diffuse_surface(0.5), None),
        scene.material(Surface::Absorber, Some(TestEmission { radiance: 1.0, sides: EmissionSides::Both })),
    );
    scene.square(Vec3::new(0.0, 0.0, -1.0), 50.0, floor);
    let far = Vec3::new(1e5, 0.0, 0.0);
    let positions =
        [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)].map(|(x, y)| far + Vec3::new(x, y, 0.0)).to_vec();
    let (mesh, _) = Mesh::new(positions, vec![], vec![], vec![[0, 1, 2], [0, 2, 3]], vec![]).expect("a mesh");
    let id = scene.builder.add_mesh(mesh);
    scene.place(Shape::Mesh(id), DAffine3::from_translation(DVec3::new(-1e5, 0.0, 1.0)), lamp);
    let ready = scene.ready();
    let measure = |strategies| {
        let settings = PathSettings { max_bounces: 1, strategies, ..PathSettings::default() };
        ready.measure(&ray([0.0; 3], [0.5, 0.2, -1.0]), 512, settings)
    };
    let sampled = measure(Strategies::Lights);
    agree(&measure(Strategies::Scattering), &sampled);
    assert!(sampled.mean > 0.1);
}

#[test]
fn answers_are_the_same_bits_when_asked_again() {
    let ready = mixed(paint(0.6, 0.3));
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, PathSettings::default());
    let r = ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]);
    let ask = || replicate(&tracer, &r, 64, 7).to_bits();
    assert_eq!(ask(), ask());
}

#[test]
fn paths_of_one_four_and_eight_wavelengths_agree_where_nothing_disperses() {
    let ready = mixed(diffuse_surface(0.7));
    let view = ready.world.render_space(DVec3::ZERO);
    let sources = Sources { environment: None, ..ready.sources.clone() };
    let lights = Lights::new(&view, &ready.material_table, sources, VISIBLE).expect("lights");
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, bounces(2));
    let address = PixelAddress {
        frame: FrameAddress { seed: 1, ..FrameAddress::default() },
        pixel: Pixel { x: 0, y: 0 },
        replicate: 0,
    };
    let stream = PathStream::new(&address, 3);
    let r = ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]);
    let field_ray = FieldRay { ray: r, stream, light_interval: TimeInterval::default() };
    let one = tracer.radiance(&field_ray, &Wavelengths::<1>::uniform(400.0, 700.0, 0.3))[0];
    let four = tracer.radiance(&field_ray, &Wavelengths::<4>::uniform(400.0, 700.0, 0.3));
    let eight = tracer.radiance(&field_ray, &Wavelengths::<8>::uniform(400.0, 700.0, 0.3));
    // Every spectrum of this scene is constant.
    assert!(one > 0.0 && four.0.iter().chain(&eight.0).all(|v| (v - one).abs() <= 1e-6 * one), "{one} {four:?}");
}

/// One scene by the code of every row that has the effects it needs: diffuse surfaces, sun, sky and lamps; alone and sharing tails.
#[test]
fn code_made_for_a_scene_gives_the_same_bits() {
    let ready = mixed(diffuse_surface(0.8));
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, PathSettings::default());
    assert_eq!(tracer.effects, SceneEffects::DiffuseOnly);
    let by = |effects| {
        let tracer = PathTracer { effects, ..tracer };
        let alone = (0..64).map(|replicate| replicate_bits(&tracer, replicate));
        let bits: Vec<[u32; 4]> = alone.chain(group_bits(&tracer)).collect();
        assert!(bits.iter().flatten().any(|b| *b != 0), "light is seen");
        bits
    };
    let diffuse_only = by(SceneEffects::DiffuseOnly);
    assert_eq!(by(SceneEffects::NoMedia), diffuse_only);
    // With possible media, no path shares anything.
    assert_eq!(by(SceneEffects::All)[..64], diffuse_only[..64]);
}

#[test]
fn a_scene_takes_the_code_that_has_what_it_needs() {
    let effects = |surface: Surface, settings| {
        let ready = mixed(surface);
        let view = ready.world.render_space(DVec3::ZERO);
        let lights = ready.lights(&view);
        PathTracer::new(&view, &ready.material_table, &lights, settings).effects
    };
    let path = PathSettings::default();
    assert_eq!(effects(diffuse_surface(0.8), path), SceneEffects::DiffuseOnly);
    assert_eq!(effects(Surface::Absorber, path), SceneEffects::DiffuseOnly);
    assert_eq!(effects(aluminium(0.4), path), SceneEffects::NoMedia);
    assert_eq!(effects(diffuse_surface(0.8), PathSettings { only_airlight: true, ..path }), SceneEffects::All);
}

fn field_ray(replicate: u32) -> FieldRay {
    let frame = FrameAddress { seed: 5, ..FrameAddress::default() };
    let address = PixelAddress { frame, pixel: Pixel { x: 3, y: 4 }, replicate };
    let ray = ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]);
    FieldRay { ray, stream: PathStream::new(&address, 0), light_interval: TimeInterval::default() }
}

fn replicate_bits(tracer: &PathTracer<'_>, replicate: u32) -> [u32; 4] {
    tracer.radiance(&field_ray(replicate), &WAVELENGTHS).0.map(f32::to_bits)
}

fn group_bits(tracer: &PathTracer<'_>) -> Vec<[u32; 4]> {
    let rays: Vec<_> = (0..16).map(field_ray).collect();
    let mut radiance = Vec::new();
    tracer.radiance_of_group(&rays, &WAVELENGTHS, &mut radiance);
    radiance.iter().map(|spectral| spectral.0.map(f32::to_bits)).collect()
}
