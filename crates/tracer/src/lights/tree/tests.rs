//! The tree's probabilities: they sum to one, are equal in both functions, and are never zero where light arrives.

use super::*;
use crate::lights::LightSampleContext;
use crate::lights::lamp::LampLight;
use crate::lights::{Cone, Lamp, Profile};
use etendue_core::{TimeInterval, WavelengthRange};
use etendue_spectra::Spectrum;
use glam::{DMat3, DVec3, Vec3};

/// A fixed sequence of numbers in [0, 1): multiples of irrational numbers.
pub(super) fn number(i: u32, k: u32) -> f64 {
    let steps = [0.618_033_988_75, 0.754_877_666_25, 0.569_840_290_998, 0.819_172_513_396, 0.324_717_957_24];
    (steps[k as usize % 5] * f64::from(i + 1) + 0.137 * f64::from(k)).fract()
}

pub(super) fn direction(i: u32, k: u32) -> DVec3 {
    etendue_core::warp::uniform_sphere(glam::Vec2::new(number(i, k) as f32, number(i, k + 1) as f32)).as_dvec3()
}

pub(super) fn lamp(at: DVec3, towards: DVec3, intensity: f64, profile: Profile) -> LampLight {
    let basis = etendue_core::Basis::about(towards.as_vec3().normalize());
    let axes = DMat3::from_cols(basis.z.as_dvec3(), basis.x.as_dvec3(), basis.y.as_dvec3());
    let lamp = Lamp::new(at, axes, Spectrum::constant(intensity), profile).expect("a lamp");
    let to_render = lamp.to_world().at(0.0);
    LampLight::new(lamp, &to_render, TimeInterval::default(), WavelengthRange { low_nm: 400.0, high_nm: 700.0 })
}

/// Lamps in a box of `size`, about `centre`, every third a spot, of powers over `decades`.
pub(super) fn lamps(count: u32, centre: DVec3, size: f64, decades: f64) -> Vec<LampLight> {
    let one = |i: u32| {
        let at = centre + size * (DVec3::new(number(i, 0), number(i, 1), number(i, 2)) - 0.5);
        let intensity = etendue_core::maths::f64::pow(10.0, decades * (number(i, 3) - 0.5));
        let spot = || Profile::Cone(Cone::new(0.3, 0.5 + 2.0 * number(i, 4)).expect("a spot"));
        lamp(at, direction(i, 3), intensity, if i.is_multiple_of(3) { spot() } else { Profile::Isotropic })
    };
    (0..count).map(one).collect()
}

/// Calls `f` with a tree over lamps and queries of receivers near and far, facing all directions or none, in view or not.
fn for_each_receiver(
    lamps: &[LampLight],
    size: f64,
    centre: DVec3,
    f: impl Fn(&LightTree, &LightSampleContext, &dyn Fn(u32) -> LampIrradiance),
) {
    let bounds: Vec<_> = lamps.iter().map(LampLight::bounds).collect();
    let tree = LightTree::new(&bounds).expect("lamps that shine");
    for i in 0..12 {
        let position = (centre + direction(i, 0) * size * [0.01, 0.3, 1.0, 20.0][i as usize % 4]).as_vec3();
        let normal = if i % 3 == 0 { Vec3::ZERO } else { direction(i, 2).as_vec3().normalize() };
        for in_view in [false, true] {
            let receiver = LightSampleContext { in_view, ..LightSampleContext::diffuse(position, normal) };
            f(&tree, &receiver, &|lamp| lamps[lamp as usize].irradiance(&receiver));
        }
    }
}

/// Relative variance of one sample for a receiver: the contribution of each lamp, over the probability of its selection.
fn variance_of_a_sample(lamps: &[LampLight], tree: &LightTree, receiver: &LightSampleContext) -> f64 {
    let query = TreeQuery { receiver, lamp: |i| lamps[i as usize].irradiance(receiver) };
    let start = tree.start(&query);
    let (mut sum, mut square) = (0.0, 0.0);
    for (i, light) in lamps.iter().enumerate() {
        let value = f64::from(light.irradiance(receiver).with_gloss);
        if value > 0.0 {
            sum += value;
            square += value * value / f64::from(tree.probability(&query, &start, i));
        }
    }
    square / (sum * sum) - 1.0
}

#[test]
fn samples_follow_the_reported_probabilities() {
    let sets = [
        (lamps(1, DVec3::ZERO, 1.0, 0.0), 1.0),
        (lamps(50, DVec3::new(5.0, 0.0, 3.0), 100.0, 2.0), 100.0),
        (lamps(700, DVec3::ZERO, 300.0, 4.0), 300.0),
    ];
    for (lamps, size) in &sets {
        for_each_receiver(lamps, *size, DVec3::ZERO, |tree, receiver, lamp| {
            let query = TreeQuery { receiver, lamp };
            let start = tree.start(&query);
            let n = 1 << 14;
            let mut counts = vec![0.0; lamps.len()];
            let mut none = 0.0;
            for i in 0..n {
                match tree.sample(&query, &start, (f64::from(i) + 0.5) / f64::from(n)) {
                    Some((light, probability)) => {
                        counts[light] += 1.0;
                        assert_eq!(probability.to_bits(), tree.probability(&query, &start, light).to_bits());
                    }
                    None => none += 1.0,
                }
            }
            let probabilities: Vec<_> =
                (0..lamps.len()).map(|i| f64::from(tree.probability(&query, &start, i))).collect();
            for (count, probability) in counts.iter().zip(&probabilities) {
                // Each light has one interval of u: its points of the grid differ from its length by less than one, and
                // a few more where rounding in f32 moves both ends.
                assert!(
                    (count - probability * f64::from(n)).abs() < 1.0 + 2e-6 * f64::from(n),
                    "{count} {probability}"
                );
            }
            let sum: f64 = probabilities.iter().sum();
            assert!((sum + none / f64::from(n) - 1.0).abs() < 2e-3, "{sum} and {none} of {n} in vain");
        });
    }
}

#[test]
fn no_light_that_arrives_is_lost() {
    let huge = DVec3::new(3e6, -2e6, 1e5);
    for (lamps, size, centre) in [
        (lamps(300, DVec3::ZERO, 50.0, 21.0), 50.0, DVec3::ZERO),
        (lamps(10_000, DVec3::ZERO, 2000.0, 1.0), 2000.0, DVec3::ZERO),
        (lamps(100, huge, 500.0, 3.0), 500.0, huge),
        (lamps(100, DVec3::ONE, 0.0, 3.0), 10.0, DVec3::ONE),
    ] {
        for_each_receiver(&lamps, size, centre, |tree, receiver, lamp| {
            let query = TreeQuery { receiver, lamp };
            let start = tree.start(&query);
            for (i, light) in lamps.iter().enumerate() {
                let (probability, arrives) =
                    (tree.probability(&query, &start, i), light.irradiance(receiver).with_gloss > 0.0);
                assert!(
                    probability.is_finite() && (probability > 0.0) == arrives,
                    "lamp {i}: {probability}, {arrives}"
                );
            }
            assert!(tree.irradiance(&query, &start).is_finite());
        });
    }
}

/// Relative variance of one sample of 80 lamps, mean of 40 receivers; measured: 0.13, and 1.11 out of view.
const MAX_IN_VIEW_VARIANCE: f64 = 0.26;

/// A receiver in view uses the lamps inside the clusters around it.
#[test]
fn in_view_lamps_are_sampled_as_they_count() {
    let lamps = lamps(80, DVec3::ZERO, 60.0, 1.0);
    let bounds: Vec<_> = lamps.iter().map(LampLight::bounds).collect();
    let tree = LightTree::new(&bounds).expect("lamps that shine");
    let (mut in_view, mut unseen) = (0.0, 0.0);
    let receivers = 40;
    for i in 0..receivers {
        let position = (direction(i, 0) * 40.0 * number(i, 2)).as_vec3();
        let out_of_view = LightSampleContext::diffuse(position, direction(i, 2).as_vec3().normalize());
        unseen += variance_of_a_sample(&lamps, &tree, &out_of_view) / f64::from(receivers);
        in_view += variance_of_a_sample(&lamps, &tree, &LightSampleContext { in_view: true, ..out_of_view })
            / f64::from(receivers);
    }
    assert!(in_view < MAX_IN_VIEW_VARIANCE && unseen > 4.0 * MAX_IN_VIEW_VARIANCE, "{in_view}, out of view {unseen}");
}

/// Two spots near the receiver that point past it, back to back so that their cluster seems to emit everywhere, must not remove the weak
/// light of far lamps.
#[test]
fn an_estimate_is_zero_only_where_nothing_arrives() {
    let narrow = || Profile::Cone(Cone::new(0.1, 0.2).expect("a spot"));
    let spot = |towards: DVec3| lamp(DVec3::X * 0.1 + towards * 0.08, towards, 1.0, narrow());
    let far = |i| lamp(DVec3::new(1e5, 1e3 * f64::from(i), 0.0), DVec3::X, 1.0, Profile::Isotropic);
    let lamps: Vec<_> = [spot(DVec3::Y), spot(DVec3::NEG_Y)].into_iter().chain((0..12).map(far)).collect();
    let bounds: Vec<_> = lamps.iter().map(LampLight::bounds).collect();
    let tree = LightTree::new(&bounds).expect("lamps that shine");
    let receiver = LightSampleContext::diffuse(Vec3::ZERO, Vec3::ZERO);
    let query = TreeQuery { receiver: &receiver, lamp: |i| lamps[i as usize].irradiance(&receiver) };
    let irradiance = tree.irradiance(&query, &tree.start(&query));
    // Twelve lamps of 1 W/sr at 100 km.
    assert!((0.5..2.0).contains(&(irradiance / 12e-10)), "{irradiance}");
}

#[test]
fn estimates_are_of_the_size_of_what_arrives() {
    let lamps = lamps(400, DVec3::ZERO, 200.0, 1.0);
    for_each_receiver(&lamps, 200.0, DVec3::ZERO, |tree, receiver, lamp| {
        if receiver.normal == Vec3::ZERO {
            let exact: f64 = lamps.iter().map(|l| f64::from(l.irradiance(receiver).with_gloss)).sum();
            let query = TreeQuery { receiver, lamp };
            let ratio = tree.irradiance(&query, &tree.start(&query)) / exact;
            assert!((0.2..5.0).contains(&ratio), "{ratio}");
        }
    });
}

#[test]
fn dark_lamps_make_no_tree() {
    assert!(LightTree::new(&[]).is_none());
    assert!(LightTree::new(&[lamp(DVec3::ZERO, DVec3::X, 0.0, Profile::Isotropic).bounds()]).is_none());
    let lamps =
        [lamp(DVec3::ZERO, DVec3::X, 0.0, Profile::Isotropic), lamp(DVec3::X, DVec3::X, 1.0, Profile::Isotropic)];
    for_each_receiver(&lamps, 3.0, DVec3::ZERO, |tree, receiver, lamp| {
        let query = TreeQuery { receiver, lamp };
        assert_eq!(tree.probability(&query, &tree.start(&query), 0), 0.0);
    });
}
