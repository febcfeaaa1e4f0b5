//! Reflection models other than metals and coats, by the same tests.

use super::chi_square::{DirectionGrid, check_p_values, p_of_samples};
use super::*;

/// A diffuse base under a mirror, an off-specular and a retro lobe.
fn lobes() -> Surface {
    let weight = |v| Spectrum::from_fn(move |nm| v * (0.5 + nm / 2200.0));
    let lobes = vec![
        Lobe::mirror(200.0, &weight(0.2)),
        Lobe { tangential: -1.0, normal: 0.9, exponent: 15.0, weight: weight(0.4) },
        Lobe::retro(40.0, &weight(0.1)),
    ];
    Surface::Lafortune(Box::new(Lafortune::new(grey(0.2), lobes).expect("lobes that lose energy")))
}

fn blinn_phong(base: f64, gloss: f64, n: f64) -> Surface {
    Surface::BlinnPhong(Box::new(BlinnPhong::new(grey(base), Spectrum::constant(gloss), n).expect("a legal model")))
}

pub(super) fn rough(index: &metal::ComplexIndex, alpha: f64, distribution: Distribution, all: bool) -> Surface {
    let metal = Conductor::new(index.clone(), alpha).expect("a metal").with_distribution(distribution);
    Surface::Conductor(Box::new(if all { metal.with_interreflection() } else { metal }))
}

pub(super) fn white() -> metal::ComplexIndex {
    metal::ComplexIndex { n: Spectrum::constant(0.0), k: Spectrum::constant(3.0) }
}

fn gold() -> metal::ComplexIndex {
    metal::by_name("Au").expect("gold").clone()
}

fn glazed_surface(alpha: f64) -> Surface {
    let index = Spectrum::from_fn(|nm| 1.5 + 0.1 * (600.0 - nm) / 600.0);
    Surface::Conductor(Box::new(Conductor::dielectric(index, alpha).expect("a glaze").with_interreflection()))
}

fn marking() -> Surface {
    let white = Spectrum::constant(1.0);
    Surface::Marking(Box::new(RoadMarking::new(300.0, DaytimeBrightness::Qd(130.0), &white).expect("a marking")))
}

pub(super) fn car_paint(pigment: f64, flakes: f64, coverage: f64, flake_alpha: f64, coat_alpha: f64) -> Surface {
    let parts = CarPaintParts {
        pigment: grey(pigment),
        flakes: Spectrum::constant(flakes),
        coverage,
        flake_alpha,
        coat_index: 1.5,
        coat_alpha,
    };
    Surface::CarPaint(Box::new(CarPaint::new(parts).expect("a paint")))
}

pub(super) fn cloth(base: f64, sheen: f64, alpha: f64) -> Surface {
    let sheen = Spectrum::constant(sheen);
    Surface::Cloth(Box::new(Cloth::new(grey(base), sheen, alpha).expect("a cloth")))
}

/// Surfaces for the tests that all materials pass.
pub(super) fn surfaces() -> Vec<Surface> {
    vec![
        lobes(),
        blinn_phong(0.0, 1.0, 0.0),
        blinn_phong(0.3, 0.7, 20.0),
        blinn_phong(0.0, 1.0, 5000.0),
        rough(&white(), 1.0, Distribution::Beckmann, false),
        rough(&gold(), 0.02, Distribution::Beckmann, false),
        rough(&gold(), 0.4, Distribution::Beckmann, true),
        rough(&white(), 0.7, Distribution::Ggx, true),
        rough(&gold(), 0.01, Distribution::Ggx, true),
        glazed_surface(0.5),
        marking(),
        car_paint(0.05, 0.85, 0.6, 0.3, 0.0),
        car_paint(1.0, 1.0, 0.5, 0.1, 0.0),
        car_paint(0.0, 1.0, 1.0, 0.6, 0.05),
        cloth(1.0, 1.0, 0.3),
        cloth(0.2, 0.5, 1.0),
        cloth(0.0, 1.0, 0.1),
    ]
}

#[test]
fn directions_are_sampled_by_the_density_stated() {
    let cases = [
        (lobes(), 0.3),
        (blinn_phong(0.3, 0.7, 1.0), 1.0),
        (blinn_phong(0.3, 0.5, 200.0), 0.2),
        (rough(&gold(), 0.05, Distribution::Beckmann, false), 0.05),
        (rough(&white(), 0.8, Distribution::Beckmann, true), 0.8),
        (rough(&gold(), 0.1, Distribution::Ggx, true), 0.1),
        (rough(&white(), 1.0, Distribution::Ggx, true), 1.0),
        (glazed_surface(0.5), 0.5),
        (car_paint(0.2, 0.8, 0.7, 0.2, 0.0), 0.4),
        (car_paint(0.1, 0.9, 0.5, 0.5, 0.1), 0.2),
        (cloth(0.3, 0.8, 0.3), 1.0),
    ];
    let mut p_values = vec![];
    for (k, (surface, scale)) in cases.into_iter().enumerate() {
        let material_table = material_table(surface);
        for (i, degrees) in [0.0, 30.0, 70.0, 86.0].into_iter().enumerate() {
            let wo = at_degrees(degrees);
            let p = p_of_samples(
                &bsdf(&material_table),
                wo,
                &DirectionGrid::about_mirror(wo, scale),
                1000 + (k * 4 + i) as u32,
            );
            p_values.push((p, format!("case {k} at {degrees}°")));
        }
    }
    check_p_values(&p_values);
}

#[test]
fn interreflection_gives_back_less_where_metals_absorb() {
    // Gold at 450 nm reflects four tenths, at 680 nm nearly all: light scattered twice is redder.
    let [once, all] = [false, true].map(|all| material_table(rough(&gold(), 0.9, Distribution::Ggx, all)));
    let (once, all) = (albedo(&bsdf(&once), at_degrees(40.0)), albedo(&bsdf(&all), at_degrees(40.0)));
    let gain = [0, 3].map(|i| all[i] / once[i]);
    assert!(gain[0] > 1.0 && gain[1] > gain[0] + 0.05, "{once:?} {all:?}");
}

#[test]
fn paint_without_flakes_is_a_solid_paint() {
    for (d, coat_alpha) in [(0.6, 0.0), (0.9, 0.2)] {
        let (metallic, solid) =
            (material_table(car_paint(d, 0.9, 0.0, 0.3, coat_alpha)), material_table(paint(d, 1.5, coat_alpha)));
        for (wo, wi) in [(10.0, 40.0), (60.0, 5.0), (80.0, 70.0)] {
            let pair = (at_degrees(wo), at_degrees(wi));
            let [a, b] = [&metallic, &solid].map(|p| bsdf(p).evaluate(pair.0, pair.1).value_cos[0]);
            assert!((a / b - 1.0).abs() < 1e-4, "{d} {coat_alpha} {wo} {wi}: {a} {b}");
        }
    }
}

#[test]
fn metallic_paint_is_darker_away_from_the_mirror() {
    // Silver: the flop index of car makers compares 15°, 45° and 110° off the mirror direction of light at 45°.
    let material_table = material_table(car_paint(0.02, 0.87, 0.7, 0.25, 0.0));
    let at = |off: f32| {
        let (s, c) = etendue_core::maths::f32::sin_cos((45.0 - off).to_radians());
        let light = Vec3::new(-core::f32::consts::FRAC_1_SQRT_2, 0.0, core::f32::consts::FRAC_1_SQRT_2);
        bsdf(&material_table).evaluate(Vec3::new(s, 0.0, c), light).value_cos[0]
    };
    assert!(at(15.0) > 2.5 * at(45.0) && at(45.0) > 2.5 * at(110.0), "{} {} {}", at(15.0), at(45.0), at(110.0));
}
