//! Luminances of seven decades in one frame of the camera of high dynamic range, and head lamps in sensors that have none.

use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_pipeline::{Choices, Plan, compile};
use etendue_scene::asset::Assets;
use etendue_scene::{Description, Overrides};
use etendue_sensor::figures::db;
use etendue_sensor::{FrameAddress, Raw, Sensor, SensorState};
use etendue_stats::Moments;
use etendue_tests::Shot;
use std::path::Path;

/// The plan of a job that ships and needs no files but descriptions.
fn shipped(job: &str) -> Plan {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(job);
    let read = |file: &Path| std::fs::read_to_string(file).map_err(|error| error.to_string().into());
    let description =
        Description::load(&path, &read, &Overrides::default()).unwrap_or_else(|errors| panic!("{errors}"));
    compile(&description, &Assets::default(), &Choices::default()).unwrap_or_else(|errors| panic!("{errors:?}"))
}

fn frame(sensor: &Sensor, means: &Plane<MeanElectrons>, frame: u32) -> Raw {
    sensor.step(SensorState::default(), means, FrameAddress { seed: 3, camera: 0, frame, capture: 0 }).1
}

/// Numbers above black, in e⁻ of the first capture.
fn electrons(sensor: &Sensor, raw: &Raw) -> Vec<f64> {
    let (linear, gain) = (raw.linear(), sensor.parameters().read_out.gain_dn_e);
    linear.plane.samples().iter().map(|dn| (f64::from(*dn) - linear.black_level_dn) / gain).collect()
}

/// Mean and temporal standard deviation of some pixels, by two frames: patterns cancel in their difference.
fn pair_statistics(frames: &[Vec<f64>; 2], places: impl Iterator<Item = usize> + Clone) -> (f64, f64) {
    let mean = Moments::from_values(places.clone().map(|i| frames[0][i])).mean();
    let differences = Moments::from_values(places.map(|i| frames[0][i] - frames[1][i]));
    (mean, (0.5 * differences.variance().expect("many")).sqrt())
}

/// The same of a flat field.
fn flat(sensor: &Sensor, mean_e: f64) -> (f64, f64) {
    const SIZE: usize = 128;
    let means = Plane::filled(SIZE, SIZE, mean_e as f32);
    pair_statistics(&[0, 1].map(|k| electrons(sensor, &frame(sensor, &means, k))), 0..SIZE * SIZE)
}

#[test]
fn one_frame_holds_seven_decades() {
    const HALF: usize = 50;
    let shot = Shot::render(shipped("sensors/range.toml"));
    let sensor = shot.camera().body.sensor.clone().expect("electronics");
    let means = shot.light().electrons.expect("electrons");
    let frames = [0, 1].map(|k| electrons(&sensor, &frame(&sensor, &means, k)));
    let ratios = [(200, [200, 390, 570, 760]), (390, [200, 390, 570, 760])].map(|(y, columns)| {
        columns.map(|x| {
            let square = (y - HALF..y + HALF).flat_map(|y| (x - HALF..x + HALF).map(move |x| (x, y)));
            let green = square.filter(|(x, y)| sensor.channel_at(*x, *y) == 1).map(|(x, y)| y * means.width() + x);
            let (signal, sigma) = pair_statistics(&frames, green.clone());
            let true_e = Moments::from_values(green.clone().map(|i| f64::from(means.samples()[i]))).mean();
            // Noise of 5000 pixels, PRNU of 0.6 % over them; offsets and dark current are a fraction of an electron.
            let tolerance = 4.0 * sigma / 70.0 + 4.0 * 0.006 / 70.0 * true_e + 0.4;
            assert!((signal - true_e).abs() < tolerance, "{signal} ± {tolerance} for {true_e}");
            signal / sigma
        })
    });
    let snr = ratios.concat();
    // 0.1 cd/m² stands above its noise, 1 cd/m² clearly; from 10 cd/m² on 20 dB hold everywhere.
    assert!(snr[0] > 1.0 && snr[1] > 5.0 && snr[2..].iter().all(|r| *r > 10.0), "{snr:?}");
}

#[test]
fn the_declared_range_is_that_of_its_frames() {
    let plan = shipped("sensors/range.toml");
    let sensor = plan.cameras[0].body.sensor.clone().expect("electronics");
    let declared = sensor.dynamic_range();
    let (_, dark_e) = flat(&sensor, 0.0);
    let least_e = 0.5 * (1.0 + (1.0 + 4.0 * dark_e * dark_e).sqrt());
    // A ramp of 1 % steps, 64 rows: the last column that stays half a per cent below white.
    let ramp = |x: usize| (declared.upper_e * (0.5 + 0.005 * x as f64)) as f32;
    let means = Plane::from_samples(200, 64, (0..200 * 64).map(|i| ramp(i % 200)).collect()).expect("filled");
    let e = electrons(&sensor, &frame(&sensor, &means, 0));
    let column = |x: usize| Moments::from_values((0..64).map(|y| e[y * 200 + x])).mean();
    let last = (0..200).rev().find(|x| column(*x) < 0.995 * declared.upper_e).expect("half the range is not white");
    assert!(last < 199, "white is reached");
    let most_e = f64::from(ramp(last));
    let measured_db = db(most_e / least_e);
    assert!((measured_db - declared.db()).abs() < 1.0, "{measured_db} dB, declared {}", declared.db());
    assert!(declared.db() > 140.0);
    for switch in &declared.switches {
        // σ of 16 384 differences is known to 0.55 %; four of those, and 4 % that the light is off the switch.
        let near = |declared: f64, (signal, sigma): (f64, f64)| (signal / sigma / declared - 1.0).abs() < 0.05;
        assert!(near(switch.before, flat(&sensor, 0.96 * switch.at_e)), "{switch:?}");
        assert!(near(switch.after, flat(&sensor, 1.04 * switch.at_e)), "{switch:?}");
    }
}

/// A dark street of 10 e⁻ a pixel with a lamp of 3000 wells, 13 pixels across.
fn lamp(sensor: &Sensor) -> Plane<MeanElectrons> {
    let mut means = Plane::filled(161, 301, 10.0);
    let inside = |x: usize, y: usize| x.abs_diff(80).pow(2) + y.abs_diff(150).pow(2) <= 36;
    for (x, y) in (0..301).flat_map(|y| (0..161).map(move |x| (x, y))).filter(|(x, y)| inside(*x, *y)) {
        means.set(x, y, (3000.0 * sensor.parameters().charge.full_well.capacity_e) as f32);
    }
    means
}

/// The frame of a camera of the job before the lamp, and its pixels (of the picture) that are full.
fn before_the_lamp(camera: usize) -> (Sensor, Vec<f64>, Vec<(usize, usize)>) {
    let sensor = shipped("sensors/sensors.toml").cameras[camera].body.sensor.clone().expect("electronics");
    let mut parameters = sensor.parameters().clone();
    parameters.cfa = etendue_sensor::Cfa::mono();
    parameters.channels.truncate(1);
    (parameters.light.angle_response, parameters.light.crosstalk) = (None, None);
    parameters.exposure.control = None;
    let sensor = Sensor::new(parameters).expect("legal");
    let raw = frame(&sensor, &lamp(&sensor), 0);
    let well = sensor.parameters().charge.full_well.capacity_e;
    let e = electrons(&sensor, &raw);
    // What stands above the well is noise of the chain: six standard deviations, 50 000 pixels; a number of rounding.
    let noise_e =
        6.0 * (sensor.parameters().voltage.noise.white_e + 3.0) + 1.0 / sensor.parameters().read_out.gain_dn_e;
    assert!(e.iter().all(|e| *e < well + noise_e), "the well is never exceeded");
    let (_, charge_account) = raw.accounts[0];
    assert!(charge_account.imbalance_e().abs() < 1e-5 * charge_account.generated_e && charge_account.drained_e > 0.0);
    let full = (0..e.len()).filter(|i| e[*i] > 0.97 * well - noise_e).map(|i| (i % 161, i / 161)).collect();
    (sensor, e, full)
}

/// First and last of some numbers.
fn extent(rows: impl Iterator<Item = usize> + Clone) -> (usize, usize) {
    (rows.clone().min().expect("some"), rows.max().expect("some"))
}

#[test]
fn a_ccd_shows_the_column() {
    let (sensor, e, full) = before_the_lamp(1);
    // Full pixels: the lamp's own columns, and some rows beyond it.
    assert_eq!(extent(full.iter().map(|(x, _)| *x)), (74, 86));
    let (top, bottom) = extent(full.iter().map(|(_, y)| *y));
    assert!((100..140).contains(&top) && (160..200).contains(&bottom), "{top} {bottom}");
    // Smear: ε t_line Σ μ/t_exp, as faint at the top as at the bottom, in the lamp's columns alone.
    let column = |x: usize, rows: core::ops::Range<usize>| Moments::from_values(rows.map(|y| e[y * 161 + x])).mean();
    let p = sensor.parameters();
    let rows = 301.0 + p.read_out.layout.optical_black.rows as f64;
    let lit = 13.0 * 3000.0 * p.charge.full_well.capacity_e;
    let leak = p.light.smear.as_ref().expect("a CCD").leak();
    let smear_e = leak * p.exposure.frame_period_s.expect("stated") / rows * lit / p.exposure.exposure_s;
    for rows in [0..90, 211..301] {
        let difference = column(80, rows.clone()) - column(20, rows);
        // 90 pixels of that mean, the street's 10 e⁻ and read noise of 10 e⁻, twice; PRNU of 0.8 %.
        let tolerance = 4.0 * ((smear_e + 110.0 + 110.0) / 90.0).sqrt() + 0.004 * smear_e;
        assert!((difference - smear_e).abs() < tolerance, "{difference} for {smear_e}");
    }
}

#[test]
fn a_cmos_sensor_shows_a_round_halo() {
    let (_, e, full) = before_the_lamp(0);
    let ((left, right), (top, bottom)) = (extent(full.iter().map(|f| f.0)), extent(full.iter().map(|f| f.1)));
    // Wider than the lamp by some pixels, as wide as high.
    let (width, high) = (right - left + 1, bottom - top + 1);
    assert!((19..=45).contains(&width) && width.abs_diff(high) <= 2, "{width} × {high}");
    // Nothing in the rest of the lamp's column.
    let column = |x: usize| Moments::from_values((0..100).map(|y| e[y * 161 + x])).mean();
    // A hundred pixels of 8 e⁻ each, twice, and column patterns of 2 e⁻.
    assert!((column(80) - column(20)).abs() < 4.0 * (2.0 * 64.0 / 100.0_f64 + 8.0).sqrt());
}
