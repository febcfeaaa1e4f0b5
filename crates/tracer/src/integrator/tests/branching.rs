//! Paths that branch at their first surface against paths that do not.

use super::guided::trained_guide;
use super::media::fog;
use super::sharing::{TARGETS, corner, estimates};
use super::*;
use crate::lights::LightSampleContext;
use crate::materials::Leaf;
use crate::media::{Media, MediumRegion as Region, Phase};
use glam::Vec2;

fn settings(branches: u32, strategies: Strategies) -> PathSettings {
    PathSettings { max_bounces: 6, branches, strategies, ..PathSettings::default() }
}

/// Means of 32 replicates towards each target.
fn measure_all(
    ready: &BuiltScene,
    targets: &[[f32; 3]],
    samples: u32,
    settings: PathSettings,
) -> Vec<ReplicateEstimate> {
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    estimates(&PathTracer::new(&view, &ready.material_table, &lights, settings), targets, samples, false)
}

/// Diffuse, coated (smooth and rough), translucent and mirroring floors, with a sky, an emitting ball, a mirror, gaps and a pane, and an
/// all-diffuse scene in the sun. Light is sampled and hit, or sampled alone: the weights include all samples and branches.
#[test]
fn branches_leave_every_mean() {
    let half = || Reflectance::Spectrum(Spectrum::constant(0.45));
    let leaf = || Surface::Leaf(Box::new(Leaf { reflectance: half(), transmittance: half() }));
    let floors =
        [(diffuse_surface(0.7), true), (diffuse_surface(0.7), false), (paint(0.6, 0.2), true), (paint(0.6, 0.0), true)];
    for (floor, glows) in floors.into_iter().chain([(leaf(), true), (aluminium(0.0), true)]) {
        let ready = corner(floor, glows);
        for strategies in [Strategies::Both, Strategies::Lights] {
            let one = measure_all(&ready, &TARGETS, 256, settings(1, strategies));
            let three = measure_all(&ready, &TARGETS, 128, settings(3, strategies));
            three.iter().zip(&one).for_each(|(a, b)| agree(a, b));
        }
    }
}

/// Settings of wet streets: smooth and glossy surfaces that send no light of light sources to diffuse ones, with widened lobes.
#[test]
fn branches_leave_what_is_left_out() {
    for floor in [paint(0.6, 0.2), paint(0.6, 0.0), aluminium(0.1)] {
        let ready = corner(floor, true);
        let of = |branches| PathSettings { caustics: false, regularize: true, ..settings(branches, Strategies::Both) };
        let (one, three) = (measure_all(&ready, &TARGETS, 256, of(1)), measure_all(&ready, &TARGETS, 128, of(3)));
        three.iter().zip(&one).for_each(|(a, b)| agree(a, b));
    }
}

/// Without a sun, which few samples hit by chance, light that is only hit has the mean of light that is sampled, too.
#[test]
fn light_that_branches_meet_is_weighed_by_all_of_them() {
    let mut ready = corner(diffuse_surface(0.7), true);
    ready.sources.suns.clear();
    let close: Vec<_> = (0..4).map(|i| [0.9 + 0.05 * i as f32, 0.5, 0.0]).collect();
    let one = measure_all(&ready, &close, 512, settings(1, Strategies::Both));
    for strategies in [Strategies::Both, Strategies::Scattering] {
        let four = measure_all(&ready, &close, 256, settings(4, strategies));
        four.iter().zip(&one).for_each(|(a, b)| agree(a, b));
        four.iter().for_each(|e| assert!(e.standard_error() < 0.01 * e.mean, "{strategies:?} {e:?}"));
    }
}

#[test]
fn branches_leave_every_mean_in_fog_and_under_a_guide() {
    let ready = corner(diffuse_surface(0.7), false);
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let fog = [fog(0.1, 0.9, Phase::Isotropic, Region::Ball { radius_m: 6.0 })];
    let media = Media::new(&fog, DVec3::ZERO, TimeInterval::default());
    let of = |branches| PathTracer::new(&view, &ready.material_table, &lights, settings(branches, Strategies::Both));
    let guide = trained_guide(&of(4), &TARGETS, 0..1 << 12);
    assert!(guide.places() > 8, "paths that would branch teach the guide as well");
    let alone = |tracer: PathTracer<'_>| estimates(&tracer, &TARGETS, 256, false);
    for [one, four] in [[1, 4].map(|n| of(n).with_media(&media)), [1, 4].map(|n| of(n).with_guide(Some(&guide)))] {
        alone(four).iter().zip(&alone(one)).for_each(|(a, b)| agree(a, b));
    }
}

/// In the sun, away from all shadows, a pixel's error comes from the second surface on.
#[test]
fn branches_lower_the_error_as_more_samples_do() {
    let ready = corner(diffuse_surface(0.7), false);
    let close: Vec<_> = (0..16).map(|i| [1.6 + 0.01 * (i % 4) as f32, -1.4 + 0.01 * (i / 4) as f32, 0.0]).collect();
    let relative = |e: &ReplicateEstimate| e.variance_of_mean / (e.mean * e.mean);
    let error = |samples, branches| {
        let estimates = measure_all(&ready, &close, samples, settings(branches, Strategies::Both));
        estimates.iter().map(relative).sum::<f64>()
    };
    let (few, branched, many) = (error(16, 1), error(16, 4), error(64, 1));
    // Variances of 16 rays by 32 replicates are good to 6 % (√(2/(16·31))); their ratio, to 9 %: three times that.
    assert!(branched < 0.4 * few && (branched / many - 1.0).abs() < 0.27, "{few} {branched} {many}");
}

/// The density of a light with n samples is n times the density with one.
#[test]
fn densities_are_those_of_all_samples() {
    let ready = corner(diffuse_surface(0.7), true);
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let one = LightSampleContext { in_view: true, ..LightSampleContext::diffuse(Vec3::new(0.2, -0.5, 0.0), Vec3::Z) };
    let five = LightSampleContext { samples: 5, ..one };
    let interval = TimeInterval::default();
    for k in 0..64 {
        let (choice, u) = ((k as f32 + 0.5) / 64.0, Vec2::new(0.3, 0.6));
        let [a, b] = [&one, &five]
            .map(|receiver| lights.sample(receiver, choice, u, 0.0, &ready.material_table, query(&interval)));
        let (Some(a), Some(b)) = (a, b) else { panic!("the floor sees every light") };
        assert!((b.pdf / a.pdf - 5.0).abs() < 1e-5 && b.direction == a.direction && b.radiance == a.radiance);
        let hit_light =
            |receiver| lights.distant(a.direction, Some(receiver), &WAVELENGTHS).map(|light| light.pdf).sum::<f32>();
        assert!((hit_light(&five) - 5.0 * hit_light(&one)).abs() <= 1e-5 * hit_light(&five), "{k}");
    }
}

/// The same bits without branches, and for the same branches repeated.
#[test]
fn one_branch_is_the_path_itself() {
    let ready = corner(paint(0.6, 0.2), true);
    let values = |branches| {
        measure_all(&ready, &TARGETS, 16, settings(branches, Strategies::Both))
            .iter()
            .map(|e| e.mean.to_bits())
            .collect::<Vec<_>>()
    };
    let plain = measure_all(&ready, &TARGETS, 16, PathSettings { max_bounces: 6, ..PathSettings::default() });
    assert_eq!(values(1), plain.iter().map(|e| e.mean.to_bits()).collect::<Vec<_>>());
    assert!(values(4) == values(4) && values(4) != values(1));
}
