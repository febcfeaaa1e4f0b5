//! Guided paths against paths that sample the surface alone.

use super::media::fog;
use super::sharing::{TARGETS, corner, estimates};
use super::*;
use crate::guiding::{Guide, Training};
use crate::materials::Leaf;
use crate::media::{Media, MediumRegion as Region, Phase};

/// Number of training paths.
const PATHS: u32 = 1 << 14;

fn settings(strategies: Strategies) -> PathSettings {
    PathSettings { max_bounces: 6, strategies, ..PathSettings::default() }
}

/// The `path`th path towards one of the targets, of a replicate that no image has.
fn field_ray(targets: &[[f32; 3]], path: u32) -> FieldRay {
    let pixel = Pixel { x: path % 64, y: path / 64 };
    let address = PixelAddress { frame: FrameAddress::default(), pixel, replicate: u32::MAX };
    let ray = ray([-2.0, -2.0, 2.0], targets[path as usize % targets.len()]);
    FieldRay { ray, stream: PathStream::new(&address, path), light_interval: TimeInterval::default() }
}

/// The radiance found by paths towards the targets, in the given order.
pub(super) fn trained_guide(tracer: &PathTracer<'_>, targets: &[[f32; 3]], paths: impl Iterator<Item = u32>) -> Guide {
    let training = Training::default();
    paths.for_each(|path| tracer.train(&field_ray(targets, path), &WAVELENGTHS, &training));
    training.guide()
}

/// Means of 32 replicates towards each target, guided or not.
fn measure_all(
    ready: &BuiltScene,
    targets: &[[f32; 3]],
    samples: u32,
    strategies: Strategies,
    guided: bool,
) -> Vec<ReplicateEstimate> {
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, settings(strategies));
    let guide = guided.then(|| trained_guide(&tracer, targets, 0..PATHS));
    assert!(guide.as_ref().is_none_or(|guide| guide.places() > 8));
    let tracer = tracer.with_guide(guide.as_ref());
    let towards = |target: &[f32; 3]| {
        let ray = ray([-2.0, -2.0, 2.0], *target);
        let means: Vec<_> = (0..32).map(|r| replicate(&tracer, &ray, samples, r)).collect();
        ReplicateEstimate::from_replicates(&means).expect("replicates")
    };
    targets.iter().map(towards).collect()
}

/// Diffuse, coated, translucent and mixed floors, with a sky, an emitting ball, a mirror and a pane, and an all-diffuse scene in the sun;
/// light sampled and hit, or sampled alone.
#[test]
fn a_guide_leaves_every_mean() {
    let half = || Reflectance::Spectrum(Spectrum::constant(0.45));
    let leaf = Surface::Leaf(Box::new(Leaf { reflectance: half(), transmittance: half() }));
    for (floor, glows) in
        [(diffuse_surface(0.7), true), (diffuse_surface(0.7), false), (paint(0.6, 0.2), true), (leaf, true)]
    {
        let ready = corner(floor, glows);
        for strategies in [Strategies::Both, Strategies::Lights] {
            let [guided, alone] = [true, false].map(|guided| measure_all(&ready, &TARGETS, 256, strategies, guided));
            guided.iter().zip(&alone).for_each(|(a, b)| agree(a, b));
        }
    }
}

/// Paths through a fog whose first diffuse surface lies before, between and behind scatterings in it.
#[test]
fn a_guide_leaves_every_mean_in_fog() {
    let ready = corner(diffuse_surface(0.7), false);
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let fog = [fog(0.1, 0.9, Phase::Isotropic, Region::Ball { radius_m: 6.0 })];
    let media = Media::new(&fog, DVec3::ZERO, TimeInterval::default());
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, settings(Strategies::Both)).with_media(&media);
    let guide = trained_guide(&tracer, &TARGETS, 0..PATHS);
    let guided = tracer.with_guide(Some(&guide));
    let (led, alone) = (estimates(&guided, &TARGETS, 256, false), estimates(&tracer, &TARGETS, 256, false));
    led.iter().zip(&alone).for_each(|(a, b)| agree(a, b));
    assert!(led.iter().zip(&alone).any(|(a, b)| a.mean != b.mean), "the guide leads paths");
}

/// An emitting ball and a sky that guided rays hit by chance alone, and together with sampled light: their weights include the guide's
/// density.
#[test]
fn light_that_is_hit_by_a_guided_path_is_weighed_by_its_density() {
    let mut ready = corner(diffuse_surface(0.7), true);
    ready.sources.suns.clear();
    let close: Vec<_> = (0..4).map(|i| [0.9 + 0.05 * i as f32, 0.5, 0.0]).collect();
    let alone = measure_all(&ready, &close, 512, Strategies::Both, false);
    for strategies in [Strategies::Both, Strategies::Scattering] {
        let guided = measure_all(&ready, &close, 512, strategies, true);
        guided.iter().zip(&alone).for_each(|(a, b)| agree(a, b));
        guided.iter().for_each(|e| assert!(e.standard_error() < 0.01 * e.mean, "{strategies:?} {e:?}"));
    }
}

/// Points in the shadow of the walls' corner, lit by a small part of their surroundings.
#[test]
fn a_guide_lowers_the_error_of_indirect_light() {
    let ready = corner(diffuse_surface(0.7), false);
    let close: Vec<_> = (0..16).map(|i| [1.6 + 0.01 * (i % 4) as f32, -1.4 + 0.01 * (i / 4) as f32, 0.0]).collect();
    let relative = |e: &ReplicateEstimate| e.variance_of_mean / (e.mean * e.mean);
    let error = |guided| measure_all(&ready, &close, 64, Strategies::Both, guided).iter().map(relative).sum::<f64>();
    let (alone, guided) = (error(false), error(true));
    assert!(guided < 0.8 * alone, "{guided} for {alone}");
}

#[test]
fn the_order_in_which_paths_are_followed_changes_no_bit() {
    let ready = corner(diffuse_surface(0.7), true);
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, settings(Strategies::Both));
    let measure = |guide: &Guide| {
        let tracer = tracer.with_guide(Some(guide));
        TARGETS.map(|target| replicate(&tracer, &ray([-2.0, -2.0, 2.0], target), 64, 0).to_bits())
    };
    let forwards = measure(&trained_guide(&tracer, &TARGETS, 0..2048));
    assert_eq!(forwards, measure(&trained_guide(&tracer, &TARGETS, (0..2048).rev())));
    assert_ne!(forwards, TARGETS.map(|target| replicate(&tracer, &ray([-2.0, -2.0, 2.0], target), 64, 0).to_bits()));
}

/// Paths that share their tails use directions whose densities include the guide's.
#[test]
fn tails_are_shared_under_a_guide() {
    let ready = corner(diffuse_surface(0.7), false);
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let tracer = PathTracer::new(
        &view,
        &ready.material_table,
        &lights,
        PathSettings { samples: 64, ..settings(Strategies::Both) },
    );
    let guide = trained_guide(&tracer, &TARGETS, 0..PATHS);
    let guided = tracer.with_guide(Some(&guide));
    let (shared, alone) = (estimates(&guided, &TARGETS, 64, true), estimates(&tracer, &TARGETS, 64, false));
    shared.iter().zip(&alone).for_each(|(a, b)| agree(a, b));
}
