//! Frames as a whole: the photon-transfer method, extremes, the order of operations.

use super::*;
use crate::SignalComponent;
use crate::parameters::SensorParameters;
use crate::parameters::tests::ideal;
use etendue_stats::Moments;

pub(crate) const ADDRESS: FrameAddress = FrameAddress { seed: 5, camera: 1, frame: 2, capture: 0 };

/// Without noise, one DN per electron, no black level, 24 bits, a large well.
pub(crate) fn quiet() -> SensorParameters {
    let mut p = ideal();
    p.noise = false;
    p.charge.full_well.capacity_e = 1e7;
    p.read_out = crate::ReadOut::linear(1.0, 0.0, 24);
    p.voltage = crate::VoltageEffects::default();
    p
}

/// The same with shot noise.
pub(crate) fn one_dn_an_electron() -> SensorParameters {
    SensorParameters { noise: true, ..quiet() }
}

/// One frame.
pub(crate) fn run(p: &SensorParameters, means: &Plane<MeanElectrons>, address: FrameAddress) -> Raw {
    Sensor::new(p.clone()).expect("legal").step(SensorState::default(), means, address).1
}

/// Covariance of pixels `dx` columns and `dy` rows apart.
pub(crate) fn covariance(raw: &Raw, dx: usize, dy: usize) -> f64 {
    let plane = &raw.plane;
    let (width, height) = (plane.width() - dx, plane.height() - dy);
    let n = plane.samples().len() as f64;
    let mean = plane.samples().iter().map(|dn| f64::from(*dn)).sum::<f64>() / n;
    let product =
        |x: usize, y: usize| (f64::from(plane.at(x, y)) - mean) * (f64::from(plane.at(x + dx, y + dy)) - mean);
    let sum: f64 = (0..height).map(|y| (0..width).map(|x| product(x, y)).sum::<f64>()).sum();
    sum / (width * height) as f64
}

pub(crate) fn expose(p: SensorParameters, mean: f32, size: usize) -> Raw {
    let sensor = Sensor::new(p).expect("legal");
    sensor.step(SensorState::default(), &Plane::filled(size, size, mean), ADDRESS).1
}

pub(crate) fn moments(raw: &Raw) -> Moments {
    Moments::from_values(raw.plane.samples().iter().map(|dn| f64::from(*dn) - raw.black_level_dn))
}

#[test]
fn signal_to_noise_is_that_of_emva_1288() {
    for (mean, expected) in [(100.0, 8.897), (1000.0, 31.21), (10_000.0, 99.87)] {
        let m = moments(&expose(ideal(), mean, 512));
        let snr = m.mean() / m.variance().expect("many").sqrt();
        // A standard deviation of 512² numbers is known to 1/√(2n) = 0.14 %; tolerance: four of those.
        assert!((snr / expected - 1.0).abs() < 0.0055, "{mean}: {snr}");
    }
}

#[test]
fn the_photon_transfer_curve_gives_the_gain_back() {
    // Slope of variance over mean by least squares, weights 1/variance² (the variance of s² is 2σ⁴/n).
    let points: Vec<(f64, f64)> = [0.0_f32, 2000.0, 8000.0, 20_000.0, 40_000.0]
        .into_iter()
        .map(|mean| moments(&expose(ideal(), mean, 256)))
        .map(|m| (m.mean(), m.variance().expect("many")))
        .collect();
    let sum = |f: &dyn Fn(f64, f64) -> f64| points.iter().map(|(m, v)| f(*m, *v) / (v * v)).sum::<f64>();
    let (w, x, y) = (sum(&|_, _| 1.0), sum(&|m, _| m), sum(&|_, v| v));
    let (xx, xy) = (sum(&|m, _| m * m), sum(&|m, v| m * v));
    let determinant = w * xx - x * x;
    let slope = (w * xy - x * y) / determinant;
    let dark_variance = (xx * y - x * xy) / determinant;
    let standard_error = (w / determinant * 2.0 / 65_536.0).sqrt();
    assert!((slope - 0.25).abs() < 4.0 * standard_error && standard_error < 1e-3, "{slope} ± {standard_error}");
    // K²σ² + 1/12 = 1.646; its standard error is that of s² at the dark point, 0.55 %.
    assert!((dark_variance / (0.0625 * 25.0 + 1.0 / 12.0) - 1.0).abs() < 4.0 * 0.0056, "{dark_variance}");
}

#[test]
fn dark_current_has_its_own_shot_noise() {
    let mut p = ideal();
    (p.charge.dark.current_e_s, p.exposure.exposure_s, p.voltage.noise.white_e, p.read_out.gain_dn_e) =
        (400.0, 0.1, 0.0, 1.0);
    let m = moments(&expose(p, 0.0, 512));
    assert!((m.mean() - 40.0).abs() < 4.0 * (40.0_f64 / 262_144.0).sqrt());
    assert!((m.variance().expect("many") / 40.0 - 1.0).abs() < 4.0 * (2.03_f64 / 262_144.0).sqrt());
}

#[test]
fn without_noise_an_image_is_its_mean() {
    let mut p = ideal();
    (p.noise, p.charge.dark.current_e_s) = (false, 400.0);
    assert!(expose(p.clone(), 100.0, 8).plane.samples().iter().all(|dn| *dn == 126));
    assert!(expose(p, 1e9, 8).plane.samples().iter().all(|dn| *dn == 15_100));
}

#[test]
fn the_well_clips_before_the_read_noise() {
    let raw = expose(ideal(), 1e6, 128);
    let m = moments(&raw);
    assert!((m.mean() - 15_000.0).abs() < 0.1);
    // Only K²σ² + 1/12 is left.
    assert!((m.variance().expect("many") / 1.6458 - 1.0).abs() < 0.05);
}

#[test]
fn means_that_are_none_are_counted_and_harm_no_neighbour() {
    let sensor = Sensor::new(ideal()).expect("legal");
    let mut means = Plane::filled(4, 3, 500.0_f32);
    let clean = sensor.step(SensorState::default(), &means, ADDRESS).1;
    for (x, y, mean) in [(1, 0, f32::NAN), (3, 1, f32::INFINITY), (0, 2, -1.0)] {
        means.set(x, y, mean);
    }
    let raw = sensor.step(SensorState::default(), &means, ADDRESS).1;
    assert_eq!(raw.invalid, [(1, 0), (3, 1), (0, 2)].map(|(x, y)| Pixel { x, y }));
    for (i, (a, b)) in raw.plane.samples().iter().zip(clean.plane.samples()).enumerate() {
        assert_eq!(*a, if [1, 7, 8].contains(&i) { 0 } else { *b });
    }
}

#[test]
fn threads_change_no_bit_and_addresses_change_all() {
    let mut p = ideal();
    p.charge.dark.current_e_s = 50.0;
    let sensor = Sensor::new(p).expect("legal");
    let means = Plane::from_samples(97, 61, (0..97 * 61).map(|i| (i * 7 % 5000) as f32).collect()).expect("filled");
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| sensor.step(SensorState::default(), &means, ADDRESS).1)
    };
    assert_eq!(with(1), with(3));
    let other = sensor.step(SensorState::default(), &means, FrameAddress { frame: 3, ..ADDRESS }).1;
    let same = other.plane.samples().iter().zip(with(1).plane.samples()).filter(|(a, b)| a == b).count();
    assert!(same < means.samples().len() / 5, "{same} pixels alike");
}

#[test]
fn bits_are_pinned() {
    let mut p = ideal();
    p.charge.dark.current_e_s = 700.0;
    let raw = expose(p, 1234.0, 3);
    assert_eq!(raw.plane.samples(), PINNED, "changed bits change every raw picture: is it meant?");
}

const PINNED: [u32; 9] = [404, 399, 400, 400, 408, 417, 416, 418, 421];

/// A camera with all effects.
fn everything() -> SensorParameters {
    use crate::effects::{angle_response, dark_current, full_well, lag, neighbours, smear, two_level};
    use crate::effects::{neighbours::Neighbours, two_level::TwoLevel};
    let mut p = ideal();
    (p.charge.full_well.capacity_e, p.read_out.bits) = (20_000.0, 14);
    (p.exposure.frame_period_s, p.read_out.digital_gain) = (Some(0.04), 1.5);
    let table = vec![[0.0, 1.0], [30.0, 0.8]];
    p.light.angle_response =
        Some(angle_response::AngleResponse { table, exit_pupil_mm: 2.0, principal_px: [30.0, 20.0] });
    let crosstalk_to_neighbours = Neighbours { horizontal: 0.01, vertical: 0.01, corner: 0.002 };
    p.light.crosstalk = Some(neighbours::Crosstalk(crosstalk_to_neighbours));
    p.light.photo_response = crate::effects::photo_response::PhotoResponse { white: 0.01, row: 0.002, column: 0.003 };
    p.voltage.offset = crate::effects::offset_pattern::OffsetPattern { white_e: 2.0, row_e: 1.0, column_e: 1.0 };
    p.charge.dead_pixels.fraction = 1e-3;
    let two = |mean| TwoLevel { fraction: 0.01, mean, dwell_frames: 3.0 };
    p.charge.dark = dark_current::DarkCurrent {
        spread: dark_current::DarkSpread {
            white: 0.3,
            row: 0.05,
            column: 0.05,
            distribution: dark_current::SpreadDistribution::LogNormal,
        },
        hot: Some(dark_current::HotPixels { fraction: 0.01, mean_e_s: 1e5 }),
        dark_current_rts: Some(two(1e5)),
        ..dark_current::DarkCurrent::uniform(2000.0)
    };
    p.light.smear = Some(smear::Smear::Interline { smear_db: -70.0, measured_exposure_ratio: 1.0 });
    p.charge.lag.traps = vec![lag::Trap { fraction: 0.02, time_constant_s: 0.1 }];
    p.charge.brighter_fatter.shift_per_e = 2e-6;
    p.charge.full_well.blooming = Some(full_well::Blooming::Around { overflow_fraction: 0.6 });
    let knee = crate::effects::response::Knee { at_e: 10_000.0, slope: 0.5 };
    p.read_out.response = crate::effects::response::Response::Knees(vec![knee]);
    p.voltage.capacitance = Some(neighbours::InterPixelCapacitance(crosstalk_to_neighbours));
    (p.voltage.noise.row_e, p.voltage.noise.column_e) = (1.0, 1.0);
    p.voltage.rts_noise = Some(two_level::RtsNoise(two(20.0)));
    p
}

fn scene() -> Plane<MeanElectrons> {
    let mut means = Plane::from_samples(64, 48, (0..64 * 48).map(|i| (i * 7 % 5000) as f32).collect()).expect("filled");
    means.set(30, 20, 3e5);
    means.set(31, 20, 3e5);
    means
}

#[test]
fn causes_add_up_to_the_digital_number_and_do_not_change_it() {
    for p in [one_dn_an_electron(), everything()] {
        let sensor = Sensor::new(p).expect("legal");
        let (after, raw) = sensor.step(SensorState::default(), &scene(), ADDRESS);
        let (state, raw_with_breakdown, signal_breakdown) =
            sensor.step_with_breakdown(SensorState::default(), &scene(), ADDRESS);
        assert_eq!((&after, &raw), (&state, &raw_with_breakdown));
        let read_out = &sensor.parameters().read_out;
        let gain = read_out.gain_dn_e * read_out.digital_gain;
        for (i, dn) in raw.plane.samples().iter().enumerate() {
            let parts = SignalComponent::ALL.into_iter().filter(|c| *c != SignalComponent::Saturated);
            let sum: f64 = parts.clone().map(|c| f64::from(signal_breakdown.layer(c).samples()[i])).sum();
            let largest = parts.map(|c| f64::from(signal_breakdown.layer(c).samples()[i]).abs()).fold(1.0, f64::max);
            // Layers and planes are f32: a few roundings of the largest of them.
            let expected = (f64::from(*dn) - raw.black_level_dn) / gain;
            assert!((sum - expected).abs() < 1e-6 * largest + 1e-3, "{i}: {sum} {expected}");
        }
        let saturated = signal_breakdown.layer(SignalComponent::Saturated).samples();
        let at_white = |dn: &u32| f64::from(*dn) >= raw.white_level_dn.floor();
        assert!(raw.plane.samples().iter().zip(saturated).all(|(dn, s)| at_white(dn) == (*s == 1.0)));
    }
}

#[test]
fn threads_change_no_bit_of_any_effect() {
    let sensor = Sensor::new(everything()).expect("legal");
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let (state, _) = sensor.step(SensorState::default(), &scene(), ADDRESS);
            sensor.step_with_breakdown(state, &scene(), FrameAddress { frame: 3, ..ADDRESS })
        })
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn counts_are_poisson_at_every_mean() {
    use etendue_stats::{chi_square, special};
    for mean in [0.1, 1.0, 50.0, 1e4, 1e6_f32] {
        let raw = run(&one_dn_an_electron(), &Plane::filled(400, 400, mean), ADDRESS);
        let mu = f64::from(mean);
        let step = (mu.sqrt() / 5.0).ceil().max(1.0);
        let edge = |i: i32| (mu.floor() + step * f64::from(i - 20)).max(0.0);
        let edges: Vec<f64> = (0..41).map(edge).collect();
        let mut counts = vec![0_u64; 42];
        raw.plane.samples().iter().for_each(|dn| counts[edges.partition_point(|e| *e <= f64::from(*dn))] += 1);
        let below = |e: f64| if e <= 0.0 { 0.0 } else { special::gamma_q(e, mu) };
        let cumulative: Vec<f64> = edges.iter().map(|e| below(*e)).chain([1.0]).collect();
        let fractions = std::iter::once(cumulative[0]).chain(cumulative.windows(2).map(|w| w[1] - w[0]));
        let expected: Vec<f64> = fractions.map(|fraction| fraction * 160_000.0).collect();
        let test = chi_square::goodness_of_fit(&counts, &expected).expect("bins");
        assert!(test.p > 1e-3, "{mean}: {test:?}");
    }
    assert!(run(&one_dn_an_electron(), &Plane::filled(40, 40, 0.0), ADDRESS).plane.samples().iter().all(|dn| *dn == 0));
}

#[test]
fn traps_outlast_a_frame_without_lag_and_what_blinked_does_not() {
    let trapped_e = vec![vec![3.0; 4]];
    let high = vec![true];
    let before = SensorState {
        trapped_e: trapped_e.clone(),
        dark_current_rts_high: high.clone(),
        rts_noise_high: high,
        ..SensorState::default()
    };
    let sensor = Sensor::new(quiet()).expect("legal");
    let (after, _) = sensor.step(before, &Plane::filled(2, 2, 10.0), ADDRESS);
    assert_eq!(after, SensorState { trapped_e, ..SensorState::default() });
}

#[test]
fn companding_of_a_single_capture_is_undone() {
    let mut p = quiet();
    p.read_out.bits = 16;
    let knees = vec![[1024.0, 1024.0], [65_535.0, 4095.0]];
    p.hdr.companding = Some(crate::hdr::companding::Companding { knees, bits: 12 });
    let raw = run(&p, &Plane::from_samples(3, 1, vec![500.0, 10_000.0, 1e6]).expect("filled"), ADDRESS);
    assert_eq!((raw.bits, raw.plane.at(0, 0), raw.plane.at(2, 0), raw.white_level_dn), (12, 500, 4095, 4095.0));
    let linear = raw.linear();
    assert_eq!((linear.plane.at(0, 0), linear.plane.at(2, 0), linear.white_level_dn), (500, 65_535, 65_535.0));
    // A step of the second line is 21 numbers.
    assert!(linear.plane.at(1, 0).abs_diff(10_000) <= 11);
}
