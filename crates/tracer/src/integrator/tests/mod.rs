//! The path tracer against closed forms, conservation laws and itself.
//!
//! Estimates are means of independently scrambled replicates; "agrees" is three standard errors of Student's t with
//! 31 degrees of freedom (0.5 %), plus 1e-5 for the rounding of f32.

mod agreement;
mod branching;
mod closed_forms;
mod glossy;
mod guided;
mod inside;
mod lamps;
mod levels;
mod media;
mod modulation;
mod motion;
mod moving_lamps;
mod near_lights;
mod openings;
mod passages;
mod precipitation;
mod sharing;
mod sides;

use super::*;
use crate::MaterialId;
use crate::accel::{World, WorldBuilder};
use crate::geometry::{Instance, Mesh, Shape};
use crate::lights::Lights;
use crate::lights::{Environment, ImageEnvironment, Sources, Sun};
use crate::materials::MaterialTable;
use crate::materials::{
    CoatedDiffuse, Conductor, Emission, EmissionQuery, EmissionSides, Material, Reflectance, Surface,
};
use crate::render_space::RenderSpace;
use core::f64::consts::PI;
use etendue_core::random::{FrameAddress, PathStream, Pixel, PixelAddress};
use etendue_core::{FieldRay, RadianceField, Ray, TimeInterval, WavelengthRange, Wavelengths};
use etendue_core::{Motion, Track, maths};
use etendue_spectra::{Spectrum, metal, upsample};
use etendue_stats::ReplicateEstimate;
use glam::{DAffine3, DVec3, Vec2, Vec3};

const WAVELENGTHS: Wavelengths<4> = Wavelengths { nm: [450.0, 520.0, 600.0, 680.0], pdf: [1.0 / 400.0; 4] };

/// The wavelengths of light selection.
const VISIBLE: WavelengthRange = WavelengthRange { low_nm: 380.0, high_nm: 780.0 };

/// Arguments for the evaluation of lights, averaged over an interval.
fn query(interval: &TimeInterval) -> EmissionQuery<'_, 4> {
    EmissionQuery { wavelengths: &WAVELENGTHS, interval }
}

/// An emission of one radiance at all wavelengths.
#[derive(Clone, Copy)]
struct TestEmission {
    radiance: f64,
    sides: EmissionSides,
}

/// Scene of a test: surfaces, and light from infinity.
#[derive(Default)]
struct Scene {
    builder: WorldBuilder,
    materials: Vec<Material>,
    sources: Sources,
}

impl Scene {
    fn material(&mut self, surface: Surface, emitted: Option<TestEmission>) -> MaterialId {
        let emission = emitted.map(|emitted| Emission {
            radiance: Spectrum::constant(emitted.radiance),
            factor: None,
            sides: emitted.sides,
            modulation: None,
        });
        self.materials.push(Material { emission, ..Material::new(surface) });
        MaterialId(self.materials.len() as u32 - 1)
    }

    fn place(&mut self, shape: Shape, to_world: DAffine3, material: MaterialId) {
        let to_world = Motion::constant(to_world);
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

    fn ready(self) -> BuiltScene {
        let material_table = MaterialTable::new(self.materials, vec![]).expect("materials");
        let world = self.builder.build().expect("a world");
        BuiltScene { world, material_table, sources: self.sources }
    }
}

struct BuiltScene {
    world: World,
    material_table: MaterialTable,
    sources: Sources,
}

impl BuiltScene {
    fn lights(&self, view: &RenderSpace<'_>) -> Lights {
        Lights::new(view, &self.material_table, self.sources.clone(), VISIBLE).expect("lights")
    }

    /// Radiance along a ray, from 32 replicates of `samples`, at the second wavelength.
    fn measure(&self, ray: &Ray, samples: u32, settings: PathSettings) -> ReplicateEstimate {
        let view = self.world.render_space(DVec3::ZERO);
        let lights = self.lights(&view);
        let tracer = PathTracer::new(&view, &self.material_table, &lights, settings);
        let means: Vec<_> = (0..32).map(|r| replicate(&tracer, ray, samples, r)).collect();
        ReplicateEstimate::from_replicates(&means).expect("replicates")
    }
}

fn replicate(tracer: &PathTracer<'_>, ray: &Ray, samples: u32, replicate: u32) -> f64 {
    replicate_over(tracer, ray, TimeInterval::default(), samples, replicate)
}

/// The same with lights averaged over an interval.
fn replicate_over(
    tracer: &PathTracer<'_>,
    ray: &Ray,
    light_interval: TimeInterval,
    samples: u32,
    replicate: u32,
) -> f64 {
    let pixel = Pixel { x: 3, y: 4 };
    let address = PixelAddress { frame: FrameAddress { seed: 5, ..FrameAddress::default() }, pixel, replicate };
    let stream = PathStream::new(&address, 0);
    let field_ray = |s| FieldRay { ray: *ray, stream: stream.with_sample(s), light_interval };
    let sum: f64 = (0..samples).map(|s| f64::from(tracer.radiance(&field_ray(s), &WAVELENGTHS)[1])).sum();
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

fn diffuse_surface(reflectance: f64) -> Surface {
    Surface::Diffuse(Reflectance::Spectrum(Spectrum::constant(reflectance)))
}

fn paint(base: f64, alpha: f64) -> Surface {
    let base = Reflectance::Spectrum(Spectrum::constant(base));
    Surface::Coated(Box::new(CoatedDiffuse::new(base, 1.5, alpha).expect("a paint")))
}

fn aluminium(alpha: f64) -> Surface {
    let index = metal::by_name("Al").expect("aluminium").clone();
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
    Environment::Image(ImageEnvironment::new(16, 8, vec![[1.0; 3]; 128], 1.0, 0.3).expect("surroundings"))
}
