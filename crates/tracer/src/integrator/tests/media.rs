//! Light through fog.

use super::*;
use crate::lights::{Lamp, Profile};
use crate::media::{
    DensityVariation, ForwardPeak, Media, MediaRay, Medium, MediumRegion as Region, Noise, Phase, RandomCounter, Solid,
    cuboid,
};
use etendue_core::random::PixelAddress;
use glam::DMat3;
use std::sync::Arc;

const FORWARD: Phase = Phase::HenyeyGreenstein { g: 0.85 };

pub(super) fn fog(extinction_per_m: f64, albedo: f64, phase: Phase, shape: Region) -> Medium {
    let of = |value| Spectrum::constant(value);
    Medium::new(of(extinction_per_m), of(albedo), phase, shape, Motion::constant(DAffine3::IDENTITY)).expect("legal")
}

fn uneven(medium: Medium, amplitude: f64) -> Medium {
    let noise = Noise { scale_m: 3.0, octaves: 3, gain: 0.5, seed: 5 };
    medium.with_unevenness(DensityVariation { noise, amplitude, wind_mps: DVec3::new(1.0, 0.0, 0.0) })
}

/// Radiance along a ray through media, from 32 replicates of `samples`.
fn measure(ready: &BuiltScene, media: &[Medium], ray: &Ray, samples: u32, settings: PathSettings) -> ReplicateEstimate {
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let media = Media::new(media, DVec3::ZERO, TimeInterval::default());
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, settings).with_media(&media);
    let means: Vec<_> = (0..32).map(|r| replicate(&tracer, ray, samples, r)).collect();
    ReplicateEstimate::from_replicates(&means).expect("replicates")
}

fn even_surroundings() -> Scene {
    let sources = Sources { environment: Some(Environment::Uniform(Spectrum::constant(1.0))), ..Sources::default() };
    Scene { sources, ..Scene::default() }
}

fn up() -> Ray {
    Ray::new(Vec3::ZERO, Vec3::Z, 0.0)
}

/// In uniform light of 1 a fog that absorbs nothing shows 1, however dense, non-uniform, or forward-scattering, seen from inside and
/// outside.
#[test]
fn fog_in_a_furnace_is_not_seen() {
    let ball = Region::Ball { radius_m: 4.0 };
    let settings = PathSettings { max_bounces: 4000, roulette_start: 4000, ..PathSettings::default() };
    for (case, phase) in [("even", Phase::Isotropic), ("forward", FORWARD), ("molecules", Phase::Rayleigh)] {
        let even = fog(0.7, 1.0, phase.clone(), ball.clone());
        for (variant, medium) in [("flat", even.clone()), ("uneven", uneven(even, 0.9))] {
            let actual = measure(&even_surroundings().ready(), &[medium], &up(), 16, settings);
            assert!((actual.mean - 1.0).abs() < 3.0 * actual.standard_error() + 2e-4, "{case}, {variant}: {actual:?}");
        }
    }
}

/// A box by its centre and half sides, m.
#[derive(Clone, Copy)]
struct Cuboid {
    centre: DVec3,
    half: DVec3,
}

fn solid(boxes: [Cuboid; 2]) -> Region {
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for Cuboid { centre, half } in boxes {
        let (more, others) = cuboid(centre, half, vertices.len() as u32);
        vertices.extend(more);
        triangles.extend(others);
    }
    Region::Mesh(Arc::new(Solid::new(&vertices, &triangles).expect("closed")))
}

/// The same in a mesh of two parts, from inside one of them through a gap into the other.
#[test]
fn fog_within_a_mesh_in_a_furnace_is_not_seen() {
    let shape = solid([
        Cuboid { centre: DVec3::ZERO, half: DVec3::ONE },
        Cuboid { centre: DVec3::Z * 4.0, half: DVec3::splat(2.0) },
    ]);
    let settings = PathSettings { max_bounces: 4000, roulette_start: 4000, ..PathSettings::default() };
    let even = fog(0.7, 1.0, FORWARD, shape);
    for medium in [even.clone(), uneven(even, 0.9)] {
        let actual = measure(&even_surroundings().ready(), &[medium], &up(), 16, settings);
        assert!((actual.mean - 1.0).abs() < 3.0 * actual.standard_error() + 2e-4, "{actual:?}");
    }
}

/// A mesh that is a box gives the same as the box, and one of two parts the same as two boxes; transmittance to the bit, light by its
/// estimate.
#[test]
fn fog_within_a_mesh_is_that_within_its_shape() {
    let mut scene = Scene::default();
    let wall = scene.material(Surface::Absorber, Some(TestEmission { radiance: 2.0, sides: EmissionSides::Both }));
    scene.square(Vec3::new(0.0, 0.0, 50.0), 30.0, wall);
    let ready = scene.ready();
    let half_m = DVec3::new(30.0, 30.0, 8.0);
    let moved = |shape, z: f64| {
        let place = Motion::constant(DAffine3::from_translation(DVec3::Z * z));
        Medium::new(Spectrum::constant(0.05), Spectrum::constant(0.6), FORWARD, shape, place).expect("legal")
    };
    let boxes = [moved(Region::Box { half_m }, 0.0), moved(Region::Box { half_m }, 25.0)];
    let mesh = [moved(solid([DVec3::ZERO, DVec3::Z * 25.0].map(|centre| Cuboid { centre, half: half_m })), 0.0)];
    let address = PixelAddress { frame: FrameAddress::default(), pixel: Pixel { x: 0, y: 0 }, replicate: 0 };
    let stream = PathStream::new(&address, 0);
    let wavelengths = Wavelengths::<4>::uniform(400.0, 700.0, 0.3);
    let mut segment = up();
    segment.t_max = 40.0;
    let through = |media: &[Medium]| {
        let media = Media::new(media, DVec3::ZERO, TimeInterval::default());
        let random = RandomCounter { stream: &stream, counter: 0 };
        media.transmittance(MediaRay { ray: &segment, peak: ForwardPeak::Exact }, random, &wavelengths)
    };
    assert!((through(&boxes) - through(&mesh)).max_value().abs() < 1e-7, "{:?}", through(&mesh));
    assert!((f64::from(through(&mesh)[0]) - maths::f64::exp(-0.05 * 24.0)).abs() < 1e-6);
    let settings = PathSettings { max_bounces: 8, ..PathSettings::default() };
    let [of_boxes, of_mesh] = [&boxes[..], &mesh[..]].map(|media| measure(&ready, media, &up(), 1024, settings));
    agree(&of_boxes, &of_mesh);
}

/// Airlight, and light from elsewhere, sum to the whole: for a wall, for the sky, and in a box that half encloses the camera.
#[test]
fn airlight_is_a_part_of_the_light() {
    let mut scene = even_surroundings();
    let wall = scene.material(Surface::Absorber, Some(TestEmission { radiance: 2.0, sides: EmissionSides::Both }));
    scene.square(Vec3::new(0.0, 0.0, 10.0), 30.0, wall);
    let ready = scene.ready();
    let shape = Region::Box { half_m: DVec3::new(9.0, 9.0, 6.0) };
    let media = [fog(0.1, 0.8, Phase::Isotropic, shape)];
    let settings = PathSettings { max_bounces: 64, ..PathSettings::default() };
    for (ray, behind) in [(up(), 2.0), (Ray::new(Vec3::ZERO, -Vec3::Z, 0.0), 1.0)] {
        let combined = measure(&ready, &media, &ray, 2048, settings);
        let air = measure(&ready, &media, &ray, 2048, PathSettings { only_airlight: true, ..settings });
        // The same random numbers: the difference is the light from behind, with the transmittance exp(−0.6).
        let expected = behind * maths::f64::exp(-0.6);
        let error = combined.standard_error().max(1e-4);
        assert!((combined.mean - air.mean - expected).abs() < 4.0 * error, "{combined:?} {air:?} {expected}");
        assert!(air.mean > 0.05);
    }
    let clear = measure(&ready, &[], &up(), 16, PathSettings { only_airlight: true, ..settings });
    assert_eq!(clear.mean, 0.0);
}

/// The transmittance of an emitting wall's light is exp(−β d) through a fog that only absorbs, exactly; and through a non-uniform one in
/// the mean over its places.
#[test]
fn the_law_of_beer_and_lambert_through_fog() {
    let mut scene = Scene::default();
    let wall = scene.material(Surface::Absorber, Some(TestEmission { radiance: 2.0, sides: EmissionSides::Both }));
    scene.square(Vec3::new(0.0, 0.0, 50.0), 30.0, wall);
    let ready = scene.ready();
    let layer = Region::Box { half_m: DVec3::new(100.0, 100.0, 20.0) };
    let actual =
        measure(&ready, &[fog(0.05, 0.0, Phase::Isotropic, layer.clone())], &up(), 2048, PathSettings::default());
    // 20 m of it.
    agrees(&actual, 2.0 * maths::f64::exp(-1.0));
    let twice =
        [fog(0.05, 0.0, Phase::Isotropic, layer), fog(0.03, 0.5, Phase::Isotropic, Region::Below { top_m: 10.0 })];
    let direct = PathSettings { max_bounces: 0, ..PathSettings::default() };
    let actual = measure(&ready, &twice, &up(), 2048, direct);
    agrees(&actual, 2.0 * maths::f64::exp(-1.3));
}

/// Noise of amplitude 0 is the same as a uniform fog, by radiance, not by bits: 1 + 0 n.
#[test]
fn noise_of_no_amplitude_is_even() {
    let even = fog(0.1, 0.9, FORWARD, Region::Everywhere);
    assert_eq!(uneven(even.clone(), 0.0), even);
}

/// A box and a ball around all that is lit, filled with the fog, equal the fog everywhere: light from beyond is attenuated by exp(−50).
#[test]
fn fog_about_the_whole_scene_is_that_everywhere() {
    let mut scene = Scene::default();
    let wall = scene.material(Surface::Absorber, Some(TestEmission { radiance: 2.0, sides: EmissionSides::Both }));
    scene.square(Vec3::new(0.0, 0.0, 50.0), 30.0, wall);
    let ready = scene.ready();
    let settings = PathSettings { max_bounces: 8, ..PathSettings::default() };
    let of = |shape| measure(&ready, &[fog(0.05, 0.8, FORWARD, shape)], &up(), 1024, settings);
    let everywhere = of(Region::Everywhere);
    agree(&everywhere, &of(Region::Box { half_m: DVec3::splat(1000.0) }));
    agree(&everywhere, &of(Region::Ball { radius_m: 1000.0 }));
}

/// Light of a point lamp scattered once, against ∫ β exp(−β (t + d)) p(cos) I/d² dt by Simpson's rule: within 1 %, and three standard errors.
#[test]
fn light_of_a_lamp_scattered_once() {
    let (beta, lamp_at) = (0.04, DVec3::new(3.0, 0.0, 8.0));
    let lamp = Lamp::new(lamp_at, DMat3::IDENTITY, Spectrum::constant(5.0), Profile::Isotropic).expect("legal");
    for (case, phase) in
        [("isotropic", Phase::Isotropic), ("forward", FORWARD), ("backward", Phase::HenyeyGreenstein { g: -0.5 })]
    {
        let mut scene =
            Scene { sources: Sources { lamps: vec![lamp.clone()], ..Sources::default() }, ..Scene::default() };
        let wall = scene.material(Surface::Absorber, None);
        scene.square(Vec3::new(0.0, 0.0, 30.0), 30.0, wall);
        let ready = scene.ready();
        let integrand = |t: f64| {
            let to = lamp_at - DVec3::new(0.0, 0.0, t);
            let d = to.length();
            let p = f64::from(phase.density(Vec3::Z, (to / d).as_vec3(), &WAVELENGTHS));
            beta * maths::f64::exp(-beta * (t + d)) * p * 5.0 / (d * d)
        };
        let n = 30_000_u32;
        let h = 30.0 / f64::from(n);
        let weight = |i: u32| {
            if i == 0 || i == n {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        let expected: f64 = (0..=n).map(|i| weight(i) * integrand(f64::from(i) * h)).sum::<f64>() * h / 3.0;
        let medium = [fog(beta, 1.0, phase, Region::Everywhere)];
        let settings = PathSettings { max_bounces: 1, ..PathSettings::default() };
        let actual = measure(&ready, &medium, &up(), 4096, settings);
        agrees(&actual, expected);
        assert!((actual.mean / expected - 1.0).abs() < 0.01, "{case}: {} {expected}", actual.mean);
    }
}

/// The same in two overlapping non-uniform fogs, and where media lie apart with nothing between them. Transmittances of both legs and of
/// both media are estimates that are multiplied, so that their random numbers must be independent.
#[test]
fn light_of_a_lamp_scattered_once_in_uneven_fog() {
    let lamp_at = DVec3::new(3.0, 0.0, 8.0);
    let lamp = Lamp::new(lamp_at, DMat3::IDENTITY, Spectrum::constant(5.0), Profile::Isotropic).expect("legal");
    let sources = Sources { lamps: vec![lamp], ..Sources::default() };
    let mut scene = Scene { sources, ..Scene::default() };
    let wall = scene.material(Surface::Absorber, None);
    scene.square(Vec3::new(0.0, 0.0, 30.0), 30.0, wall);
    let ready = scene.ready();
    let ball = |z: f64| {
        let to_world = Motion::constant(DAffine3::from_translation(DVec3::Z * z));
        let of = Spectrum::constant;
        Medium::new(of(0.2), of(1.0), Phase::Isotropic, Region::Ball { radius_m: 2.0 }, to_world).expect("legal")
    };
    let thick = |seed| {
        let noise = Noise { scale_m: 6.0, octaves: 2, gain: 0.5, seed };
        let unevenness = DensityVariation { noise, amplitude: 0.9, wind_mps: DVec3::ZERO };
        fog(0.06, 1.0, Phase::Isotropic, Region::Everywhere).with_unevenness(unevenness)
    };
    let uneven = [thick(5), thick(6)];
    for (case, media) in [("in one another", uneven), ("apart", [ball(4.0), ball(25.0)])] {
        let placed = Media::new(&media, DVec3::ZERO, TimeInterval::default());
        // β of both, by the columns of a short ray.
        let extinctions: Vec<f64> = media.iter().map(|medium| f64::from(medium.extinction().at(550.0))).collect();
        let depth = |from: DVec3, to: DVec3| {
            let mut ray = Ray::new(from.as_vec3(), (to - from).normalize().as_vec3(), 0.0);
            ray.t_max = (to - from).length() as f32;
            placed.columns_m(&ray).iter().zip(&extinctions).map(|(column_m, of)| column_m * of).sum::<f64>()
        };
        let n = 3000_u32;
        let step = 30.0 / f64::from(n);
        let at = |i: u32| {
            let (here, before) = (DVec3::Z * step * (f64::from(i) + 0.5), DVec3::Z * step * f64::from(i));
            let beta = depth(before, before + DVec3::Z * step) / step;
            let d2 = (lamp_at - here).length_squared();
            let through = maths::f64::exp(-depth(DVec3::ZERO, here) - depth(here, lamp_at));
            beta * through * 0.25 / core::f64::consts::PI * 5.0 / d2
        };
        let expected = (0..n).map(at).sum::<f64>() * step;
        let settings = PathSettings { max_bounces: 1, ..PathSettings::default() };
        let actual = measure(&ready, &media, &up(), 4096, settings);
        assert!(
            (actual.mean - expected).abs() < 4.0 * actual.standard_error() + 2e-3 * expected,
            "{case}: {actual:?} {expected}"
        );
        assert!(actual.standard_error() < 0.01 * expected, "{case}");
    }
}

/// Without caustics light of the forward peak counts as not scattered. In a furnace nothing changes; for a lamp's light the sum over all
/// scatterings stays the same as far as directions within 20° are equal. Compared through thick fog on a diffuse floor under a sun.
#[test]
fn without_the_peak_a_floor_in_fog_is_as_bright() {
    let actual = |caustics| {
        let sun =
            Sun::from_irradiance(DVec3::new(0.3, 0.1, 0.9).normalize(), 0.53, &Spectrum::constant(1.0)).expect("a sun");
        let mut scene = Scene { sources: Sources { suns: vec![sun], ..Sources::default() }, ..Scene::default() };
        let floor = scene.material(diffuse_surface(0.5), None);
        scene.square(Vec3::new(0.0, 0.0, -3.0), 50.0, floor);
        let layer = [fog(0.1, 1.0, FORWARD, Region::Below { top_m: 20.0 })];
        let settings = PathSettings { max_bounces: 64, caustics, ..PathSettings::default() };
        measure(&scene.ready(), &layer, &Ray::new(Vec3::ZERO, Vec3::NEG_Z, 0.0), 1024, settings)
    };
    let (all, cut) = (actual(true), actual(false));
    // The peak's half-angle of 20° lowers the sun's mean cosine by at most 3 % (half of its square), and usually by far less.
    assert!((all.mean / cut.mean - 1.0).abs() < 0.02 + 4.0 * all.standard_error() / all.mean);
    assert!(cut.standard_error() < all.standard_error());
}

/// Contrast between fog and a black disc of an angular diameter at a distance, in uniform light: exp(−β d) if it is small.
fn contrast(distance_m: f64, diameter_rad: f64, extinction_per_m: f64, samples: u32) -> ReplicateEstimate {
    let mut scene = even_surroundings();
    let black = scene.material(Surface::Absorber, None);
    let (far, half) = (distance_m as f32, (0.5 * diameter_rad * distance_m) as f32);
    scene.square(Vec3::new(0.0, 0.0, far), half, black);
    let to_world = Motion::constant(DAffine3::from_translation(DVec3::Z * 0.5 * distance_m));
    // A ball around target and camera.
    let ball = Region::Ball { radius_m: 0.75 * distance_m };
    let (extinction, albedo) = (Spectrum::constant(extinction_per_m), Spectrum::constant(1.0));
    let medium = [Medium::new(extinction, albedo, FORWARD, ball, to_world).expect("legal")];
    let settings = PathSettings { max_bounces: 4000, roulette_start: 4000, ..PathSettings::default() };
    measure(&scene.ready(), &medium, &up(), samples, settings)
}

/// A black target of 0.04° in fog of 100 m visibility at 2 %: |T − exp(−β d)| < 0.002 at any distance, and 2 % at 100 m. Fog in front of
/// it, within a distance of its width, lies in its shadow, so that it looks darker by some exp(−β d) β a, a its half width and the factor
/// that of the forward peak: with g = 0.85 one of 0.1° at 30 m shows 0.3116 instead of 0.3092.
#[test]
fn the_contrast_of_a_small_target_falls_as_koschmieder_says() {
    let beta = -maths::f64::ln(0.02) / 100.0;
    for distance_m in [10.0, 30.0, 60.0, 100.0] {
        let actual = contrast(distance_m, 0.04_f64.to_radians(), beta, 2048);
        let through = 1.0 - actual.mean;
        let law = maths::f64::exp(-beta * distance_m);
        assert!(actual.standard_error() < 0.0007, "{}", actual.standard_error());
        assert!((through - law).abs() < 0.002, "{distance_m}: {through} {law} ± {}", actual.standard_error());
    }
    // For a wide one this effect is noticeable.
    let wide = contrast(60.0, 20_f64.to_radians(), beta, 1024);
    assert!(1.0 - wide.mean > maths::f64::exp(-beta * 60.0) + 4.0 * wide.standard_error(), "{}", 1.0 - wide.mean);
}
