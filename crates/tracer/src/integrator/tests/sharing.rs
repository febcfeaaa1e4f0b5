//! Paths that share their tails against paths that do not.

use super::*;
use crate::materials::{Factor, Leaf, Mix, ThinSheet};

/// Rays of a group, which hit different surfaces.
pub(super) const TARGETS: [[f32; 3]; 7] = [
    [0.2, 0.1, 0.0],
    [0.25, 0.1, 0.0],
    [-0.8, 0.0, 0.5],
    [0.0, 1.96, 0.4],
    [-0.4, 1.97, 0.02],
    [0.5, 0.5, 0.3],
    [1.97, 1.2, 0.6],
];

/// A floor and two walls under the sun, with balls and a pane; with a sky, an emitting ball, a mirror, walls of two materials with gaps and
/// a cellar, or all diffuse.
pub(super) fn corner(floor: Surface, glows: bool) -> BuiltScene {
    let mut scene = Scene::default();
    let sky = Environment::Uniform(Spectrum::constant(0.3));
    let sun = Sun::from_radiance(DVec3::new(-1.0, -0.6, 1.2), 2.0, Spectrum::constant(300.0)).expect("a sun");
    scene.sources = Sources { suns: vec![sun], lamps: vec![], environment: glows.then_some(sky) };
    let floor = scene.material(floor, None);
    let plaster = scene.material(diffuse_surface(0.8), None);
    let wall = if glows { spotted(&mut scene, plaster) } else { plaster };
    let bright = scene
        .material(diffuse_surface(0.6), glows.then_some(TestEmission { radiance: 0.2, sides: EmissionSides::Both }));
    let mirror = scene.material(if glows { aluminium(0.0) } else { diffuse_surface(0.5) }, None);
    let clear = ThinSheet::new(1.5, Reflectance::Spectrum(Spectrum::constant(0.9))).expect("a pane");
    let pane = scene.material(if glows { Surface::ThinSheet(Box::new(clear)) } else { diffuse_surface(0.5) }, None);
    scene.square(Vec3::ZERO, 2.0, floor);
    let upright = |x0: f32, y0: f32, x1: f32, y1: f32, height: f32| {
        vec![Vec3::new(x0, y0, 0.0), Vec3::new(x1, y1, 0.0), Vec3::new(x1, y1, height), Vec3::new(x0, y0, height)]
    };
    let quad = vec![[0, 1, 2], [0, 2, 3]];
    scene.mesh(upright(2.0, -2.0, 2.0, 2.0, 2.0), quad.clone(), wall);
    scene.mesh(upright(2.0, 2.0, -2.0, 2.0, 2.0), quad.clone(), wall);
    scene.mesh(upright(-0.2, 1.2, 0.4, 1.2, 0.7), quad.clone(), pane);
    scene.sphere(DVec3::new(0.5, 0.5, 0.3), 0.3, bright);
    scene.sphere(DVec3::new(-0.8, 0.0, 0.5), 0.4, wall);
    scene.sphere(DVec3::new(1.2, -0.4, 0.35), 0.35, mirror);
    scene.ready()
}

/// A material of two parts, partly transparent.
fn spotted(scene: &mut Scene, a: MaterialId) -> MaterialId {
    let b = scene.material(aluminium(0.3), None);
    let wall = scene.material(Surface::Mix(Mix { a, b, weight: Factor::Number(0.4) }), None);
    scene.materials[wall.0 as usize].opacity = Some(Factor::Number(0.7));
    scene.square(Vec3::new(0.0, 0.0, -0.7), 4.0, a);
    wall
}

/// Means of `replicates` of each ray, shared or not.
fn measure_all(ready: &BuiltScene, targets: &[[f32; 3]], samples: u32, shared: bool) -> Vec<ReplicateEstimate> {
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let tracer = PathTracer::new(
        &view,
        &ready.material_table,
        &lights,
        PathSettings { max_bounces: 6, samples, ..PathSettings::default() },
    );
    estimates(&tracer, targets, samples, shared)
}

/// The same by a path tracer.
pub(super) fn estimates(
    tracer: &PathTracer<'_>,
    targets: &[[f32; 3]],
    samples: u32,
    shared: bool,
) -> Vec<ReplicateEstimate> {
    let means: Vec<Vec<f64>> =
        (0..32).map(|replicate| trace_group(tracer, targets, samples, replicate, shared)).collect();
    let of_ray = |ray: usize| means.iter().map(|group| group[ray]).collect::<Vec<_>>();
    (0..targets.len()).map(|ray| ReplicateEstimate::from_replicates(&of_ray(ray)).expect("replicates")).collect()
}

fn trace_group(tracer: &PathTracer<'_>, targets: &[[f32; 3]], samples: u32, replicate: u32, shared: bool) -> Vec<f64> {
    let stream = |x| {
        let pixel = Pixel { x, y: 4 };
        PathStream::new(
            &PixelAddress { frame: FrameAddress { seed: 5, ..FrameAddress::default() }, pixel, replicate },
            0,
        )
    };
    let streams: Vec<_> = (0..targets.len()).map(|x| stream(x as u32)).collect();
    let mut sums = vec![0.0; targets.len()];
    for sample in 0..samples {
        let rays = targets.iter().zip(&streams);
        let rays: Vec<_> = rays
            .map(|(at, stream)| FieldRay {
                ray: ray([-2.0, -2.0, 2.0], *at),
                stream: stream.with_sample(sample),
                light_interval: TimeInterval::default(),
            })
            .collect();
        let mut radiance = vec![];
        if shared {
            tracer.radiance_of_group(&rays, &WAVELENGTHS, &mut radiance);
        } else {
            rays.chunks(1).for_each(|one| tracer.radiance_of_group(one, &WAVELENGTHS, &mut radiance));
        }
        sums.iter_mut().zip(&radiance).for_each(|(sum, radiance)| *sum += f64::from(radiance[1]));
    }
    sums.into_iter().map(|sum| sum / f64::from(samples)).collect()
}

#[test]
fn sharing_leaves_every_mean() {
    let half = || Reflectance::Spectrum(Spectrum::constant(0.45));
    let leaf = Surface::Leaf(Box::new(Leaf { reflectance: half(), transmittance: half() }));
    for floor in [diffuse_surface(0.7), aluminium(0.3), paint(0.6, 0.2), paint(0.6, 0.0), leaf] {
        let ready = corner(floor, true);
        let (alone, together) = (measure_all(&ready, &TARGETS, 256, false), measure_all(&ready, &TARGETS, 512, true));
        for (index, (a, b)) in alone.iter().zip(&together).enumerate() {
            agree(b, a);
            assert!(a.standard_error() < 0.01 * a.mean, "ray {index}: {a:?}");
        }
    }
}

#[test]
fn what_neighbours_find_lowers_the_error() {
    let ready = corner(diffuse_surface(0.7), false);
    let close: Vec<_> = (0..16).map(|i| [1.6 + 0.01 * (i % 4) as f32, -1.4 + 0.01 * (i / 4) as f32, 0.0]).collect();
    let relative = |e: &ReplicateEstimate| e.variance_of_mean / (e.mean * e.mean);
    let error = |shared| measure_all(&ready, &close, 64, shared).iter().map(relative).sum::<f64>();
    let (alone, together) = (error(false), error(true));
    // In the sun, away from all shadows, their errors come from the second surface on, and each of the sixteen receives four tails per
    // sample instead of one. A quarter is expected; the rest is a margin for the error of the errors (31 degrees of freedom).
    assert!(together < 0.4 * alone, "{together} for {alone}");
}
