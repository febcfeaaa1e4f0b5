//! The path tracer against closed forms, conservation laws and itself.
//!
//! Estimates are means of independently scrambled replicates; "agrees" is three standard errors of Student's t with
//! 31 degrees of freedom (0.5 %), plus 1e-5 for the rounding of f32.

use super::*;
use crate::MaterialId;
use crate::accel::{World, WorldBuilder};
use crate::geometry::{Instance, Mesh, Shape};
use crate::lights::{Environment, ImageEnvironment, Sun};
use crate::materials::{Coated, Conductor, Emission, Glow, Material, Reflectance, Surface};
use core::f64::consts::PI;
use etendue_core::Track;
use etendue_core::random::{Pixel, PixelAddress};
use etendue_spectra::{Spectrum, metal, upsample};
use etendue_stats::ReplicateEstimate;
use glam::{DAffine3, DVec3, Vec2, Vec3};

const WAVELENGTHS: Wavelengths<4> = Wavelengths { nm: [450.0, 520.0, 600.0, 680.0], pdf: [1.0 / 400.0; 4] };

/// What a test asks: surfaces, and what shines from infinity.
#[derive(Default)]
struct Scene {
    builder: WorldBuilder,
    materials: Vec<Material>,
    suns: Vec<Sun>,
    environment: Option<Environment>,
}

impl Scene {
    fn material(&mut self, surface: Surface, glow: Option<(f64, Glow)>) -> MaterialId {
        let emission =
            glow.map(|(radiance, glow)| Emission { radiance: Spectrum::constant(radiance), factor: None, glow });
        self.materials.push(Material { surface, emission });
        MaterialId(self.materials.len() as u32 - 1)
    }

    fn place(&mut self, shape: Shape, to_world: DAffine3, material: MaterialId) {
        let to_world = Track::still(to_world);
        self.builder.add_instance(Instance {
            shape,
            to_world,
            materials: vec![material],
            instance_id: 1,
            semantic_id: 1,
        });
    }

    fn sphere(&mut self, centre: DVec3, radius_m: f64, material: MaterialId) {
        self.place(Shape::Sphere { radius_m }, DAffine3::from_translation(centre), material);
    }

    fn mesh(&mut self, positions: Vec<Vec3>, triangles: Vec<[u32; 3]>, material: MaterialId) {
        self.mesh_with_normals(positions, vec![], triangles, material);
    }

    fn mesh_with_normals(&mut self, at: Vec<Vec3>, normals: Vec<Vec3>, triangles: Vec<[u32; 3]>, m: MaterialId) {
        let (mesh, _) = Mesh::new(at, normals, vec![], triangles, vec![]).expect("a mesh");
        let id = self.builder.add_mesh(mesh);
        self.place(Shape::Mesh(id), DAffine3::IDENTITY, m);
    }

    /// A square of side 2·`half` about `centre`, facing up (anticlockwise seen from above).
    fn square(&mut self, centre: Vec3, half: f32, material: MaterialId) {
        let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
        let positions = corners.map(|(x, y)| centre + Vec3::new(x, y, 0.0)).to_vec();
        self.mesh(positions, vec![[0, 1, 2], [0, 2, 3]], material);
    }

    fn ready(self) -> Ready {
        let palette = Palette::new(self.materials, vec![]).expect("materials");
        let world = self.builder.build().expect("a world");
        Ready { world, palette, suns: self.suns, environment: self.environment }
    }
}

struct Ready {
    world: World,
    palette: Palette,
    suns: Vec<Sun>,
    environment: Option<Environment>,
}

impl Ready {
    /// Radiance along a ray, from 32 replicates of `samples`, at the second wavelength.
    fn look(&self, ray: &Ray, samples: u32, settings: PathSettings) -> ReplicateEstimate {
        let view = self.world.view(DVec3::ZERO);
        let lights = Lights::new(&view, &self.palette, self.suns.clone(), self.environment.clone(), (380.0, 780.0))
            .expect("lights");
        let tracer = PathTracer::new(&view, &self.palette, &lights, settings);
        let means: Vec<_> = (0..32).map(|r| replicate(&tracer, ray, samples, r)).collect();
        ReplicateEstimate::of(&means).expect("replicates")
    }
}

fn replicate(tracer: &PathTracer<'_>, ray: &Ray, samples: u32, replicate: u32) -> f64 {
    let pixel = Pixel { x: 3, y: 4 };
    let address = PixelAddress { seed: 5, camera: 0, frame: 0, capture: 0, pixel, replicate };
    let stream = PathStream::new(&address, 0);
    let sum: f64 = (0..samples).map(|s| f64::from(tracer.radiance(ray, &WAVELENGTHS, &stream.with_sample(s))[1])).sum();
    sum / f64::from(samples)
}

fn agrees(estimate: &ReplicateEstimate, expected: f64) {
    let allowed = 3.0 * estimate.standard_error() + 1e-5 * expected.abs();
    assert!((estimate.mean - expected).abs() <= allowed, "{} ± {} is not {expected}", estimate.mean, allowed);
}

fn agree(a: &ReplicateEstimate, b: &ReplicateEstimate) {
    let allowed = 3.5 * (a.variance_of_mean + b.variance_of_mean).sqrt() + 1e-5 * b.mean.abs();
    assert!((a.mean - b.mean).abs() <= allowed, "{} and {} differ by more than {allowed}", a.mean, b.mean);
}

fn matt(reflectance: f64) -> Surface {
    Surface::Diffuse(Reflectance::Spectrum(Spectrum::constant(reflectance)))
}

fn paint(base: f64, alpha: f64) -> Surface {
    let base = Reflectance::Spectrum(Spectrum::constant(base));
    Surface::Coated(Box::new(Coated::new(base, 1.5, alpha).expect("a paint")))
}

fn aluminium(alpha: f64) -> Surface {
    let index = metal::named("Al").expect("aluminium").clone();
    Surface::Conductor(Box::new(Conductor::new(index, alpha).expect("a metal")))
}

fn bounces(max_bounces: u32) -> PathSettings {
    PathSettings { max_bounces, ..PathSettings::default() }
}

fn ray(origin: [f32; 3], towards: [f32; 3]) -> Ray {
    let origin = Vec3::from(origin);
    Ray::new(origin, (Vec3::from(towards) - origin).normalize(), 0.0)
}

fn white_picture() -> Environment {
    Environment::Image(ImageEnvironment::new((16, 8), vec![[1.0; 3]; 128], 1.0, 0.3).expect("surroundings"))
}

#[test]
fn a_white_sphere_vanishes_in_a_uniform_environment() {
    for (surface, environment, expected) in [
        (matt(1.0), Environment::Uniform(Spectrum::constant(1.0)), 1.0),
        (matt(1.0), white_picture(), f64::from(upsample::emission([1.0; 3], &WAVELENGTHS)[1])),
        (paint(1.0, 0.0), Environment::Uniform(Spectrum::constant(1.0)), 1.0),
    ] {
        let mut scene = Scene { environment: Some(environment), ..Scene::default() };
        let material = scene.material(surface, None);
        scene.sphere(DVec3::new(5.0, 0.0, 0.0), 1.0, material);
        let ready = scene.ready();
        for towards in [[5.0, 0.0, 0.0], [5.0, 0.7, 0.3], [5.0, 0.9, 0.0], [5.0, 5.0, 0.0]] {
            agrees(&ready.look(&ray([0.0; 3], towards), 256, bounces(8)), expected);
        }
    }
}

#[test]
fn a_glowing_cavity_has_its_geometric_sum() {
    for albedo in [0.5, 0.9, 0.98] {
        let mut sphere = Scene::default();
        let glowing = sphere.material(matt(albedo), Some((1.0, Glow::Both)));
        sphere.sphere(DVec3::new(0.3, 0.0, 0.1), 2.0, glowing);
        let estimate = sphere.ready().look(&ray([0.0; 3], [1.0, 0.5, 0.2]), 128, bounces(10_000));
        agrees(&estimate, 1.0 / (1.0 - albedo));

        let mut cube = Scene::default();
        let glowing = cube.material(matt(albedo), Some((1.0, Glow::Both)));
        let corner = |i: u32| Vec3::new((i & 1) as f32 - 0.4, (i >> 1 & 1) as f32 - 0.5, (i >> 2) as f32 - 0.6);
        let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        cube.mesh((0..8).map(corner).collect(), triangles, glowing);
        let estimate = cube.ready().look(&ray([0.0; 3], [1.0, 0.5, 0.2]), 128, bounces(10_000));
        agrees(&estimate, 1.0 / (1.0 - albedo));
    }
}

#[test]
fn a_bounce_more_adds_its_term() {
    let mut scene = Scene::default();
    let glowing = scene.material(matt(0.5), Some((1.0, Glow::Both)));
    scene.sphere(DVec3::ZERO, 1.0, glowing);
    let ready = scene.ready();
    for (max_bounces, expected) in [(0, 1.0), (1, 1.5), (2, 1.75), (3, 1.875)] {
        agrees(&ready.look(&ray([0.1, 0.0, 0.0], [1.0, 0.2, 0.3]), 128, bounces(max_bounces)), expected);
    }
}

#[test]
fn a_sphere_lights_a_plane_by_its_closed_form() {
    // E = π L (r/d)² cos θ where the sphere is wholly above the horizon.
    for (centre, radius) in
        [(DVec3::new(0.0, 0.0, 2.0), 0.5), (DVec3::new(3.0, 0.0, 2.0), 1.5), (DVec3::new(4.0, 1.0, 9.0), 1e-3)]
    {
        let mut scene = Scene::default();
        let (floor, lamp) =
            (scene.material(matt(0.6), None), scene.material(Surface::Absorber, Some((7.0, Glow::Front))));
        scene.square(Vec3::ZERO, 10.0, floor);
        scene.sphere(centre, radius, lamp);
        let d = centre.length();
        let irradiance = PI * 7.0 * (radius / d) * (radius / d) * centre.z / d;
        agrees(&scene.ready().look(&ray([-1.0, 0.5, 1.0], [0.0; 3]), 256, bounces(1)), 0.6 / PI * irradiance);
    }
}

#[test]
fn a_sun_lights_a_plane_by_its_irradiance() {
    let direction = DVec3::new(1.0, 0.5, 1.0);
    let sun = Sun::of_irradiance(direction, 0.5338, &Spectrum::constant(1.4)).expect("a sun");
    let towards = sun.direction().to_array();
    let seen = f64::from(sun.radiance().at(520.0));
    let mut scene = Scene { suns: vec![sun], ..Scene::default() };
    let floor = scene.material(matt(0.3), None);
    scene.square(Vec3::new(0.0, 0.0, -1.0), 10.0, floor);
    let ready = scene.ready();
    let expected = 0.3 / PI * 1.4 * direction.normalize().z;
    agrees(&ready.look(&ray([0.0; 3], [0.3, 0.1, -1.0]), 64, bounces(1)), expected);
    agrees(&ready.look(&ray([0.0; 3], towards), 1, bounces(1)), seen);
}

/// A floor and a block under lights of every kind.
fn mixed(floor: Surface) -> Ready {
    let picture = (0..128).map(|i| [0.2 + (i % 5) as f32, 0.5, (i % 3) as f32]).collect();
    let mut scene = Scene {
        suns: vec![Sun::of_radiance(DVec3::new(-1.0, 0.3, 1.0), 20.0, Spectrum::constant(0.02)).expect("a sun")],
        environment: Some(Environment::Image(ImageEnvironment::new((16, 8), picture, 1.0, 1.0).expect("a picture"))),
        ..Scene::default()
    };
    let floor = scene.material(floor, None);
    let lamp = scene.material(matt(0.2), Some((0.05, Glow::Both)));
    let block = scene.material(matt(0.7), None);
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
fn drawn_light_and_met_light_agree() {
    for floor in [matt(0.8), aluminium(0.4), paint(0.6, 0.3), paint(0.6, 0.0)] {
        let ready = mixed(floor);
        let look = |strategies, samples| {
            let settings = PathSettings { max_bounces: 3, strategies, ..PathSettings::default() };
            ready.look(&ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]), samples, settings)
        };
        let both = look(Strategies::Both, 512);
        agree(&look(Strategies::Scattering, 2048), &both);
        agree(&look(Strategies::Lights, 1024), &both);
        assert!(both.standard_error() < 0.02 * both.mean, "{both:?}");
    }
}

#[test]
fn roulette_leaves_the_mean() {
    let ready = mixed(matt(0.8));
    let look = |roulette_start| {
        let settings = PathSettings { max_bounces: 6, roulette_start, ..PathSettings::default() };
        ready.look(&ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]), 512, settings)
    };
    agree(&look(0), &look(100));
}

#[test]
fn each_side_glows_as_stated() {
    for (glow, above, below) in [(Glow::Front, 3.0, 0.0), (Glow::Both, 3.0, 3.0)] {
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
    let (floor, lamp) = (scene.material(matt(0.9), None), scene.material(Surface::Absorber, Some((3.0, Glow::Front))));
    scene.square(Vec3::ZERO, 5.0, floor);
    scene.square(Vec3::new(0.0, 0.0, 1.0), 1.0, lamp);
    let estimate = scene.ready().look(&ray([-2.0, 0.0, 0.5], [0.0, 0.0, 0.0]), 256, bounces(4));
    assert_eq!(estimate.mean, 0.0, "the lamp faces up");
}

#[test]
fn a_wall_with_leaning_normals_lets_no_light_through() {
    let mut scene = Scene::default();
    let (wall, lamp) = (scene.material(matt(0.9), None), scene.material(Surface::Absorber, Some((3.0, Glow::Both))));
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
    let mut scene = Scene { environment: Some(Environment::Uniform(Spectrum::constant(1.0))), ..Scene::default() };
    let wall = scene.material(matt(1.0), None);
    let positions = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    scene.mesh_with_normals(positions, vec![Vec3::new(0.94, 0.0, 0.342); 4], vec![[0, 1, 2], [0, 2, 3]], wall);
    // Seen from the side that the normals lean away from.
    let estimate = scene.ready().look(&ray([-3.0, 0.0, 0.2], [0.0; 3]), 256, bounces(4));
    assert!(estimate.mean > 0.4 && estimate.mean <= 1.0, "{estimate:?}");
}

#[test]
fn a_mirror_shows_the_lamp_by_fresnel() {
    let mut scene = Scene::default();
    let (mirror, lamp) =
        (scene.material(aluminium(0.0), None), scene.material(Surface::Absorber, Some((5.0, Glow::Both))));
    scene.square(Vec3::ZERO, 1.0, mirror);
    scene.square(Vec3::new(0.0, 0.0, 10.0), 1.0, lamp);
    let estimate = scene.ready().look(&ray([0.0, 0.0, 5.0], [0.0; 3]), 4, bounces(1));
    let al = metal::named("Al").expect("aluminium");
    let (n, k) = (f64::from(al.n.at(520.0)), f64::from(al.k.at(520.0)));
    agrees(&estimate, 5.0 * ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k));
}

#[test]
fn lights_are_counted_by_kind() {
    let ready = mixed(matt(0.5));
    let view = ready.world.view(DVec3::ZERO);
    let lights = Lights::new(&view, &ready.palette, ready.suns.clone(), ready.environment.clone(), (380.0, 780.0));
    let census = lights.expect("lights").census();
    assert_eq!((census.triangles, census.spheres, census.suns), (2, 2, 1));
    assert!(census.image_environment && !census.uniform_environment);
}

#[test]
fn radiance_keeps_its_digits_over_the_whole_range() {
    for scale in [1e-9, 1e12] {
        let mut scene = Scene::default();
        let (floor, lamp) = (scene.material(matt(0.6), None), scene.material(matt(0.5), Some((scale, Glow::Front))));
        scene.square(Vec3::ZERO, 10.0, floor);
        scene.sphere(DVec3::new(0.0, 0.0, 2.0), 0.5, lamp);
        let estimate = scene.ready().look(&ray([-1.0, 0.5, 1.0], [0.0; 3]), 64, bounces(1));
        agrees(&estimate, 0.6 * scale / 16.0);
    }
}

#[test]
fn a_lamp_far_from_the_origin_of_its_mesh_still_shines() {
    // The camera stands at the origin; the lamp's own frame is 100 km away, where f32 resolves 8 mm.
    let mut scene = Scene::default();
    let (floor, lamp) = (scene.material(matt(0.5), None), scene.material(Surface::Absorber, Some((1.0, Glow::Both))));
    scene.square(Vec3::new(0.0, 0.0, -1.0), 50.0, floor);
    let far = Vec3::new(1e5, 0.0, 0.0);
    let positions =
        [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)].map(|(x, y)| far + Vec3::new(x, y, 0.0)).to_vec();
    let (mesh, _) = Mesh::new(positions, vec![], vec![], vec![[0, 1, 2], [0, 2, 3]], vec![]).expect("a mesh");
    let id = scene.builder.add_mesh(mesh);
    scene.place(Shape::Mesh(id), DAffine3::from_translation(DVec3::new(-1e5, 0.0, 1.0)), lamp);
    let ready = scene.ready();
    let look = |strategies| {
        let settings = PathSettings { max_bounces: 1, strategies, ..PathSettings::default() };
        ready.look(&ray([0.0; 3], [0.5, 0.2, -1.0]), 512, settings)
    };
    let drawn = look(Strategies::Lights);
    agree(&look(Strategies::Scattering), &drawn);
    assert!(drawn.mean > 0.1);
}

#[test]
fn answers_are_the_same_bits_when_asked_again() {
    let ready = mixed(paint(0.6, 0.3));
    let view = ready.world.view(DVec3::ZERO);
    let lights = Lights::new(&view, &ready.palette, ready.suns.clone(), ready.environment.clone(), (380.0, 780.0))
        .expect("lights");
    let tracer = PathTracer::new(&view, &ready.palette, &lights, PathSettings::default());
    let r = ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]);
    let ask = || replicate(&tracer, &r, 64, 7).to_bits();
    assert_eq!(ask(), ask());
}

#[test]
fn paths_of_one_four_and_eight_wavelengths_agree_where_nothing_disperses() {
    let ready = mixed(matt(0.7));
    let view = ready.world.view(DVec3::ZERO);
    let lights = Lights::new(&view, &ready.palette, ready.suns.clone(), None, (380.0, 780.0)).expect("lights");
    let tracer = PathTracer::new(&view, &ready.palette, &lights, bounces(2));
    let address = PixelAddress { seed: 1, camera: 0, frame: 0, capture: 0, pixel: Pixel { x: 0, y: 0 }, replicate: 0 };
    let stream = PathStream::new(&address, 3);
    let r = ray([-2.0, -2.0, 2.0], [0.2, 0.1, 0.0]);
    let one = tracer.radiance(&r, &Wavelengths::<1>::uniform(400.0, 700.0, 0.3), &stream)[0];
    let four = tracer.radiance(&r, &Wavelengths::<4>::uniform(400.0, 700.0, 0.3), &stream);
    let eight = tracer.radiance(&r, &Wavelengths::<8>::uniform(400.0, 700.0, 0.3), &stream);
    // Every spectrum of this scene is constant.
    assert!(one > 0.0 && four.0.iter().chain(&eight.0).all(|v| (v - one).abs() <= 1e-6 * one), "{one} {four:?}");
}

#[test]
fn a_texture_is_read_in_its_place() {
    use crate::textures::{ImageTexture, Sampling, Texels, TextureId};
    let texture =
        ImageTexture::new(2, 1, Texels::Linear8(vec![[51; 3], [204; 3]]), Sampling::default()).expect("texels");
    let surface = Surface::Diffuse(Reflectance::Texture(TextureId(0)));
    let palette = Palette::new(vec![Material { surface, emission: None }], vec![texture]).expect("a material");
    let mut builder = WorldBuilder::new();
    let positions = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let (mesh, _) = Mesh::new(positions, vec![], uvs, vec![[0, 1, 2], [0, 2, 3]], vec![]).expect("a mesh");
    let shape = Shape::Mesh(builder.add_mesh(mesh));
    let to_world = Track::still(DAffine3::IDENTITY);
    builder.add_instance(Instance { shape, to_world, materials: vec![MaterialId(0)], instance_id: 1, semantic_id: 1 });
    let world = builder.build().expect("a world");
    let environment = Some(Environment::Uniform(Spectrum::constant(1.0)));
    let ready = Ready { world, palette, suns: vec![], environment };
    agrees(&ready.look(&ray([-0.5, 0.3, 1.0], [-0.5, 0.3, 0.0]), 4, bounces(1)), 0.2);
    agrees(&ready.look(&ray([0.5, 0.3, 1.0], [0.5, 0.3, 0.0]), 4, bounces(1)), 0.8);
}
