//! Lights whose strength changes over time: every strategy of finding them uses the mean level of the requested interval.

use super::*;
use crate::geometry::MeshId;
use crate::lights::{Cone, Lamp, LightSampleContext, Opening, OpeningBody, Profile};
use crate::materials::Modulation;
use core::num::NonZeroU32;
use etendue_core::track::{Interpolation, Key};
use etendue_core::waveform::{Pulses, Waveform};
use glam::{DMat3, DQuat};

/// A rolling shutter's frame of 30 ms.
fn frame() -> TimeInterval {
    over(0.0, 0.03)
}

fn over(start_s: f64, length_s: f64) -> TimeInterval {
    TimeInterval::new(40.0 + start_s, 40.0 + start_s + length_s).expect("in order")
}

/// Mean 1: 5 for a fifth of 8 ms.
fn pulses() -> Waveform {
    let pulses = Pulses { frequency_hz: 125.0, duty: 0.2, edges_s: [1e-3, 0.5e-3], peak: 5.0 };
    Waveform::pulses(&pulses).expect("legal").later(0.01)
}

/// Exposures of rows of 2 ms in these pulses: dark ones, edges, and the plateau.
fn rows() -> [TimeInterval; 4] {
    [over(0.0, 1.4e-3), over(1e-3, 2e-3), over(2.55e-3, 0.7e-3), over(0.0, 0.02)]
}

/// Radiance along a ray with lights averaged over `lit`.
fn measure(
    ready: &BuiltScene,
    ray: &Ray,
    light_interval: TimeInterval,
    settings: PathSettings,
    samples: u32,
) -> ReplicateEstimate {
    let view = ready.world.render_space_for_few(DVec3::ZERO, frame());
    let lights = ready.lights(&view);
    let tracer = PathTracer::new(&view, &ready.material_table, &lights, settings);
    let means: Vec<_> = (0..32).map(|r| replicate_over(&tracer, ray, light_interval, samples, r)).collect();
    ReplicateEstimate::from_replicates(&means).expect("replicates")
}

fn lamp(at: DVec3) -> Lamp {
    let axes = DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X);
    let profile = Profile::Cone(Cone::new(0.6, 1.3).expect("a spot"));
    Lamp::new(at, axes, Spectrum::constant(1.0), profile).expect("a lamp")
}

/// One light over a floor, `modulated` or not.
#[derive(Clone, Copy, Debug)]
enum LightKind {
    Point,
    Opening,
    Ball,
    Square,
    Moving,
}

const KINDS: [LightKind; 5] =
    [LightKind::Point, LightKind::Opening, LightKind::Ball, LightKind::Square, LightKind::Moving];

impl Scene {
    /// An emitting material.
    fn glowing(&mut self, radiance: f64, modulation: Option<Modulation>) -> MaterialId {
        let material = self.material(diffuse_surface(0.3), Some(TestEmission { radiance, sides: EmissionSides::Both }));
        self.materials[material.0 as usize].emission.as_mut().expect("glows").modulation = modulation;
        material
    }

    fn add_light(&mut self, kind: LightKind, at: DVec3, waveform: Option<Waveform>) {
        let modulated = |lamp: Lamp| match waveform.clone() {
            Some(waveform) => lamp.modulated(waveform).expect("not too bright"),
            None => lamp,
        };
        match kind {
            LightKind::Point => self.sources.lamps.push(modulated(lamp(at))),
            LightKind::Opening => self.add_opening(modulated(lamp(at))),
            LightKind::Ball => {
                let material = self.glowing(0.5, waveform.clone().map(Modulation::new));
                self.sphere(at, 0.3, material);
            }
            LightKind::Square | LightKind::Moving => {
                let material = self.glowing(0.5, waveform.clone().map(Modulation::new));
                let shape = Shape::Mesh(self.upright_square());
                let key = |time_s: f64| Key {
                    time_s: frame().start_s() + time_s,
                    position_m: at + DVec3::X * (20.0 * time_s),
                    rotation: DQuat::IDENTITY,
                    scale: DVec3::ONE,
                };
                let to_world = match kind {
                    LightKind::Moving => Track::new(&[key(0.0), key(0.03)], Interpolation::Linear).expect("legal"),
                    _ => Track::constant(DAffine3::from_translation(at)),
                };
                let materials = vec![material];
                self.builder.add_instance(Instance {
                    shape,
                    to_world: to_world.into(),
                    materials,
                    instance_id: 1,
                    semantic_id: 1,
                });
            }
        }
    }

    fn add_opening(&mut self, lamp: Lamp) {
        let black = self.material(Surface::Absorber, None);
        let opening = Opening::new(OpeningBody::Box, [0.1, 0.4, 0.3]).expect("an opening");
        let shape = Shape::Mesh(self.builder.add_mesh(opening.mesh().expect("a box")));
        let instance = self.builder.add_instance(Instance {
            shape,
            to_world: lamp.opening_to_world(&opening),
            materials: vec![black],
            instance_id: 9,
            semantic_id: 0,
        });
        self.sources.lamps.push(lamp.opened(opening, instance).expect("not too bright"));
    }

    /// A square of side 1 in the plane y = 0, v from 0 below to 1 above.
    fn upright_square(&mut self) -> MeshId {
        let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
        let positions = corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec();
        let uvs = corners.map(|(x, z)| Vec2::new(x + 0.5, z + 0.5)).to_vec();
        let (mesh, _) = Mesh::new(positions, vec![], uvs, vec![[0, 1, 2], [0, 2, 3]], vec![]).expect("a mesh");
        self.builder.add_mesh(mesh)
    }
}

fn lit_floor(floor: Surface, kind: LightKind, waveform: Option<Waveform>) -> BuiltScene {
    let mut scene = Scene::default();
    let floor = scene.material(floor, None);
    scene.square(Vec3::ZERO, 5.0, floor);
    scene.add_light(kind, DVec3::new(0.3, 0.2, 1.0), waveform);
    scene.ready()
}

const FROM: [f32; 3] = [-2.0, -2.0, 2.0];

/// Pulses over rows of a rolling shutter: the result is the closed form's level times the constant light, by each strategy of finding it.
#[test]
fn every_light_is_as_strong_as_its_mean_over_the_time_asked_for() {
    for (floor, kind) in KINDS.into_iter().flat_map(|kind| [(diffuse_surface(0.8), kind), (paint(0.6, 0.3), kind)]) {
        let settings = |strategies| PathSettings { max_bounces: 2, strategies, ..PathSettings::default() };
        let ray = Ray { time_s: 0.004, ..ray(FROM, [0.2, 0.1, 0.0]) };
        let steady = lit_floor(floor.clone(), kind, None);
        let expected = measure(&steady, &ray, over(0.0, 0.01), settings(Strategies::Both), 256);
        let flickering = lit_floor(floor, kind, Some(pulses()));
        for light_interval in rows() {
            let level = pulses().mean(light_interval);
            for (strategies, samples) in
                [(Strategies::Both, 256), (Strategies::Scattering, 1024), (Strategies::Lights, 512)]
            {
                if matches!((kind, strategies), (LightKind::Point, Strategies::Scattering)) {
                    continue;
                }
                let actual = measure(&flickering, &ray, light_interval, settings(strategies), samples);
                let variance = actual.variance_of_mean + level * level * expected.variance_of_mean;
                let allowed = 3.5 * variance.sqrt() + 1e-5 * expected.mean * level;
                let difference = (actual.mean - level * expected.mean).abs();
                assert!(
                    difference <= allowed,
                    "{kind:?} {strategies:?} {light_interval:?}: {actual:?} {level} {expected:?}"
                );
            }
        }
        assert!(expected.standard_error() < 0.05 * expected.mean, "{kind:?} {expected:?}");
    }
    let levels = rows().map(|light_interval| pulses().mean(light_interval));
    assert!(levels[0] == 0.0 && levels[1] > 0.1 && levels[2] > 4.0 && levels[3] > 0.9, "{levels:?}");
}

/// Seen directly, without light sampling.
#[test]
fn a_light_that_is_seen_has_the_level_of_its_row() {
    for kind in [LightKind::Opening, LightKind::Ball, LightKind::Square] {
        // From below: the lamp points down.
        let towards = ray([-0.3, -0.4, 0.1], [0.3, 0.2, 1.0]);
        let see = |waveform, light_interval| {
            measure(&lit_floor(diffuse_surface(0.5), kind, waveform), &towards, light_interval, bounces(0), 1).mean
        };
        let steady = see(None, rows()[0]);
        for light_interval in rows() {
            let expected = steady * pulses().mean(light_interval);
            // A product in f32.
            assert!(
                (see(Some(pulses()), light_interval) - expected).abs() <= 2e-7 * expected,
                "{kind:?} {light_interval:?}"
            );
        }
        assert!(steady > 0.0);
    }
}

/// A panel of five rows lit one after the other: the row of the pulse is bright, the others dark.
#[test]
fn a_panel_goes_through_its_rows_from_the_top() {
    let rows = NonZeroU32::new(5).expect("above 0");
    let pulse = Pulses { frequency_hz: 100.0, duty: 0.2, edges_s: [0.0; 2], peak: 5.0 };
    let waveform = Waveform::pulses(&pulse).expect("legal");
    let mut scene = Scene::default();
    let panel = scene.glowing(2.0, Modulation::in_rows(waveform, rows));
    let mesh = scene.upright_square();
    scene.place(Shape::Mesh(mesh), DAffine3::IDENTITY, panel);
    let ready = scene.ready();
    for lit_row in 0..5_u8 {
        let light_interval = over(0.002 * f64::from(lit_row) + 0.0005, 0.001);
        for row in 0..5_u8 {
            let z = 0.4 - 0.2 * f32::from(row);
            let actual = measure(&ready, &ray([0.1, -3.0, 0.0], [0.1, 0.0, z]), light_interval, bounces(0), 1).mean;
            let expected = if row == lit_row { 10.0 } else { 0.0 };
            // Times of 40 s are resolved to 7e-15 s, compared with 1 ms.
            assert!((actual - expected).abs() < 1e-5, "row {lit_row}, seen {row}: {actual}");
        }
    }
    let mean_at =
        |z: f32| measure(&ready, &ray([0.1, -3.0, 0.0], [0.1, 0.0, z]), over(0.003, 0.01), bounces(0), 1).mean;
    assert!([0.4, 0.0, -0.3].map(mean_at).iter().all(|mean| (mean - 2.0).abs() < 1e-5));
}

/// Two lamps, one of which is dark during the view's interval: it is never sampled.
#[test]
fn a_light_that_is_dark_throughout_is_never_sampled() {
    let blink = Waveform::programme(&[(10.0, 0.0), (1.0, 1.0)], true).expect("legal").later(35.0);
    let mut scene = Scene::default();
    scene.add_light(LightKind::Point, DVec3::new(0.0, 0.0, 1.0), None);
    scene.add_light(LightKind::Opening, DVec3::new(0.0, 2.0, 1.0), Some(blink.clone()));
    scene.add_light(LightKind::Square, DVec3::new(2.0, 0.0, 1.0), Some(blink.clone()));
    let ready = scene.ready();
    let sample_time = |interval: TimeInterval| {
        let view = ready.world.render_space_for_few(DVec3::ZERO, interval);
        let lights = ready.lights(&view);
        assert_eq!(
            (lights.light_counts().lamps, lights.light_counts().openings, lights.light_counts().triangles),
            (1, 1, 2)
        );
        let receiver = LightSampleContext::diffuse(Vec3::new(0.5, 0.5, 0.0), Vec3::Z);
        let sample_at = |i: u16| {
            let (choice, u) = (f32::from(i) / 200.0, Vec2::new(0.3, 0.6));
            lights.sample(&receiver, choice, u, 0.0, &ready.material_table, query(&interval))
        };
        let actual: Vec<_> = (0..200).filter_map(sample_at).collect();
        assert!(actual.iter().all(|sample| sample.radiance[1] > 0.0));
        (actual.len(), actual.iter().filter(|sample| sample.delta).count())
    };
    assert_eq!(blink.mean(frame()), 0.0);
    assert_eq!(sample_time(frame()), (200, 200));
    let (all, of_lamp) = sample_time(over(5.0, 0.03));
    assert!(all == 200 && of_lamp > 20 && of_lamp < 180, "{all} {of_lamp}");
}

/// Two rays of a group that see the lamp's pulse and pause: sharing tails between them would mix the two.
#[test]
fn tails_are_shared_under_one_light_only() {
    let mut scene = Scene::default();
    let wall = scene.material(diffuse_surface(0.8), None);
    scene.square(Vec3::ZERO, 5.0, wall);
    let corners = [[-5.0, 1.0, 0.0], [5.0, 1.0, 0.0], [5.0, 1.0, 5.0], [-5.0, 1.0, 5.0]].map(Vec3::from);
    scene.mesh(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]], wall);
    scene.add_light(LightKind::Opening, DVec3::new(0.3, 0.2, 1.0), Some(pulses()));
    let room = scene.ready();
    let view = room.world.render_space_for_few(DVec3::ZERO, frame());
    let lights = room.lights(&view);
    let samples = 512;
    let settings = PathSettings { max_bounces: 3, samples, ..PathSettings::default() };
    let tracer = PathTracer::new(&view, &room.material_table, &lights, settings);
    let light_interval = [rows()[2], rows()[0], rows()[2], rows()[3]];
    let means = |replicate: u32, size: usize| {
        let mut sums = [0.0; 4];
        for sample in 0..samples {
            let of = |(x, light_interval): (usize, &TimeInterval)| {
                let pixel = Pixel { x: x as u32, y: 4 };
                let frame = FrameAddress { seed: 5, ..FrameAddress::default() };
                let stream = PathStream::new(&PixelAddress { frame, pixel, replicate }, sample);
                FieldRay { ray: ray(FROM, [0.2, 0.1 + 0.05 * x as f32, 0.0]), stream, light_interval: *light_interval }
            };
            let rays: Vec<_> = light_interval.iter().enumerate().map(of).collect();
            let mut radiance = vec![];
            rays.chunks(size).for_each(|group| tracer.radiance_of_group(group, &WAVELENGTHS, &mut radiance));
            sums.iter_mut().zip(&radiance).for_each(|(sum, radiance)| *sum += f64::from(radiance[1]));
        }
        sums.map(|sum| sum / f64::from(samples))
    };
    let [alone, together] = [1, 4].map(|size| (0..32).map(|replicate| means(replicate, size)).collect::<Vec<_>>());
    let of = |means: &[[f64; 4]], x: usize| {
        ReplicateEstimate::from_replicates(&means.iter().map(|m| m[x]).collect::<Vec<_>>()).expect("replicates")
    };
    (0..4).for_each(|x| agree(&of(&together, x), &of(&alone, x)));
    assert_eq!(of(&together, 1).mean, 0.0, "nothing shines in the pause");
}
