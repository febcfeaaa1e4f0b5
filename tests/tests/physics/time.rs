//! Rows and captures in time: what a shutter makes of lights that change.

use etendue_core::maths::f64::sin;
use etendue_pipeline::NullObserver;
use etendue_pipeline::photograph::Light;
use etendue_pipeline::render::{FrameCapture as Picture, LightRequest, light};
use etendue_tests::{Job, Shot};

/// A wall lit by one lamp without a size, seen by a narrow pinhole: every sample of a pixel finds the lamp.
fn job(rows: u32, modulation: &str, sensor: &str, more: &str) -> Job {
    Job::new(format!(
        r#"
        [scene]
        [[scene.materials]]
        name = "white"
        type = "diffuse"
        reflectance = 0.8
        [[scene.objects]]
        name = "wall"
        material = "white"
        shape = {{ type = "quad", size_m = [4, 4] }}
        [[scene.lights]]
        name = "led"
        type = "point"
        position_m = [0, 0, 2]
        luminous_flux_lm = 1000
        temperature_k = 5000
        {modulation}
        [[cameras]]
        name = "cam"
        position_m = [0, 0, 3]
        look_at_m = [0, 0, 0]
        up = [1, 0, 0]
        {more}
        lens = {{ type = "pinhole", focal_length_mm = 200, f_number = 2 }}
        [cameras.sensor]
        width_px = 2
        height_px = {rows}
        pixel_pitch_um = 5
        {sensor}
        cfa = "mono"
        quantum_efficiency = 0.6
        full_well_e = 20000
        read_noise_e = 2
        dark_current_e_s = 5
        gain_dn_per_e = 0.2
        black_level_dn = 64
        bits = 12
        [sequence]
        frame_rate_hz = 25
        start_s = 0.25
        [render]
        spp = 16
        replicates = 1
        "#
    ))
}

/// Electrons of each row of a frame, the first capture's.
fn rows(shot: &Shot, frame: u32) -> Vec<f64> {
    let request = LightRequest { frame_capture: Picture { frame, capture: 0 }, ..LightRequest::default() };
    let film = light(&shot.plan, shot.camera(), request, &NullObserver).expect("nobody cancels");
    let electrons = Light::from_film(shot.camera(), film, None).expect("finite").electrons.expect("electronics");
    (0..electrons.height()).map(|y| f64::from(electrons.at(0, y))).collect()
}

/// Share of [start, start + length] in which a pulse of `duty` at the beginning of each period of `period_s` shines.
fn lit(start_s: f64, length_s: f64, period_s: f64, duty: f64) -> f64 {
    let integral_to = |t: f64| (t / period_s).floor() * duty * period_s + (t.rem_euclid(period_s)).min(duty * period_s);
    (integral_to(start_s + length_s) - integral_to(start_s)) / length_s
}

/// The rows of a rolling shutter under pulses: the analytic integral over each row's own exposure, in every frame. The same random numbers
/// as under steady light: what is left is the rounding of electrons to 32-bit floats.
#[test]
fn rows_under_pulses_have_the_analytic_integral_of_their_exposure() {
    let sensor = "exposure_s = 0.002\nshutter = { type = \"rolling\", row_time_us = 150 }";
    let (frequency_hz, duty) = (90.0, 0.3);
    let pulses = format!("modulation = {{ type = \"pwm\", frequency_hz = {frequency_hz}, duty_cycle = {duty} }}");
    let (pulsed, steady) = (job(120, &pulses, sensor, "").shot(), job(120, "", sensor, "").shot());
    for frame in [0, 1, 7] {
        let mean = rows(&steady, frame);
        for (y, (actual, mean)) in rows(&pulsed, frame).iter().zip(&mean).enumerate() {
            let start_s = 0.25 + 0.04 * f64::from(frame) + 150e-6 * y as f64;
            let expected = mean * lit(start_s, 0.002, 1.0 / frequency_hz, duty) / duty;
            assert!((actual - expected).abs() <= 1e-6 * mean, "frame {frame}, row {y}: {actual} for {expected}");
        }
    }
    let (bands, mean) = (rows(&pulsed, 0), rows(&steady, 0));
    assert!(bands.contains(&0.0) && bands.iter().any(|e| *e > 3.0 * mean[0]), "dark and bright bands");
}

/// 90 Hz, duty 0.1, 1 ms: a pulse lasts 1.11 ms, and 81 % of exposures of any phase miss it (1 − (0.1 + 1 ms · 90 Hz)).
#[test]
fn short_exposures_miss_pulses_as_often_as_predicted() {
    let pulses = "modulation = { type = \"pwm\", frequency_hz = 90, duty_cycle = 0.1 }";
    // Even over ± half a period: all phases alike.
    let jitter = format!("trigger_jitter_s = {}", 0.5 / 90.0);
    let shot = job(1, pulses, "exposure_s = 0.001\nshutter = { type = \"global\" }", &jitter).shot();
    let frames = 600_u32;
    let missed = (0..frames).filter(|frame| rows(&shot, *frame)[0] == 0.0).count() as f64 / f64::from(frames);
    // Four binomial standard deviations.
    let sigma = (0.81_f64 * 0.19 / f64::from(frames)).sqrt();
    assert!((missed - 0.81).abs() < 4.0 * sigma, "{missed}");
}

/// Global reset: each row is exposed longer than the one before it, in steady light as well.
#[test]
fn rows_of_a_global_reset_gather_light_until_they_are_read() {
    let sensor = |shutter: &str| format!("exposure_s = 0.002\nshutter = {{ type = \"{shutter}\" }}");
    let reset = sensor("global_reset\", row_time_us = 100, direction = \"up");
    let (reset, global) = (job(120, "", &reset, "").shot(), job(120, "", &sensor("global"), "").shot());
    for (y, (actual, mean)) in rows(&reset, 0).iter().zip(rows(&global, 0)).enumerate() {
        let expected = mean * (1.0 + (119 - y) as f64 * 100e-6 / 0.002);
        assert!((actual - expected).abs() <= 1e-6 * expected, "row {y}: {actual} for {expected}");
    }
}

/// A second exposure follows the first and sees another part of the mains' period.
#[test]
fn exposures_that_follow_each_other_see_different_light() {
    let mains = "modulation = { type = \"mains\", frequency_hz = 50, modulation_depth = 0.8 }";
    let sensor = "exposure_s = 0.004\nhdr = { captures = [{ exposure_ratio = 0.25 }], merged_bits = 16 }";
    let (changing, steady) = (job(120, mains, sensor, "").shot(), job(120, "", sensor, "").shot());
    let mean = |start_s: f64, length_s: f64| {
        let w = std::f64::consts::TAU * 100.0;
        1.0 + 0.8 * (sin(w * (start_s + length_s)) - sin(w * start_s)) / (w * length_s)
    };
    let captures = |shot: &Shot| {
        let film = |capture| {
            let request = LightRequest { frame_capture: Picture { frame: 0, capture }, ..LightRequest::default() };
            light(&shot.plan, shot.camera(), request, &NullObserver).expect("nobody cancels")
        };
        Light::from_captures(shot.camera(), vec![film(0), film(1)], None).expect("finite")
    };
    let (varying, steady) = (captures(&changing), captures(&steady));
    let planes = |light: &Light| [light.electrons.clone().expect("electrons"), light.further_electrons[0].clone()];
    let parts = [mean(0.25, 0.004), mean(0.254, 0.001)];
    for ((varying, steady), part) in planes(&varying).iter().zip(planes(&steady)).zip(parts) {
        let (actual, expected) = (f64::from(varying.at(0, 60)), part * f64::from(steady.at(0, 60)));
        assert!((actual - expected).abs() <= 1e-6 * expected, "{actual} for {expected}");
    }
}
