//! Motion blur and shutters against closed forms.

use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_pipeline::NullObserver;
use etendue_pipeline::photograph::{Light, capture};
use etendue_pipeline::render::{FrameCapture as Picture, LightRequest, light};
use etendue_pipeline::truth::ground_truth;
use etendue_sensor::{CaptureLight, FrameAddress, SensorState};
use etendue_tests::{Job, Shot};
use etendue_tracer::accel::Simd;

/// Columns and rows of the picture. A metre of the plane z = 0 is 500 px; the world's y goes to the left of the picture, its x up.
pub(crate) const SIZE: [usize; 2] = [100, 60];

/// A white shape on black, lit from afar along its normal, before a pinhole that looks down from 1 m.
pub(crate) fn job(object: &str, sensor: &str, spp: u32) -> Job {
    Job::new(format!(
        r#"
        [scene]
        [[scene.materials]]
        name = "white"
        type = "diffuse"
        reflectance = 0.8
        [[scene.objects]]
        name = "bar"
        material = "white"
        {object}
        [[scene.lights]]
        name = "sun"
        type = "sun"
        elevation_deg = 90
        azimuth_deg = 0
        illuminance_lx = 10000
        temperature_k = 5000
        [[cameras]]
        name = "cam"
        position_m = [0, 0, 1]
        look_at_m = [0, 0, 0]
        up = [1, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = 5, f_number = 2 }}
        [cameras.sensor]
        width_px = {width}
        height_px = {height}
        pixel_pitch_um = 10
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
        frame_rate_hz = 10
        start_s = 1000
        [render]
        spp = {spp}
        replicates = 1
        integrator = "direct"
        "#,
        width = SIZE[0],
        height = SIZE[1],
    ))
}

/// A bar of 10 px that crosses the picture to the right at 1 000 px/s, its middle at column 20 at 1 000 s.
const BAR: &str = "shape = { type = \"quad\", size_m = [1, 0.02] }\nkeys = [{ time_s = 999, position_m = [0, 2.06, 0] }, \
                   { time_s = 1001, position_m = [0, -1.94, 0] }]";

pub(crate) fn electrons(shot: &Shot, frame: u32) -> Plane<MeanElectrons> {
    let request = LightRequest { frame_capture: Picture { frame, capture: 0 }, ..LightRequest::default() };
    let film = light(&shot.plan, shot.camera(), request, &NullObserver).expect("nobody cancels");
    Light::from_film(shot.camera(), film, None).expect("finite").electrons.expect("electronics")
}

/// Length of [a, b] ∩ [c, d].
pub(crate) fn overlap(a: f64, b: f64, c: f64, d: f64) -> f64 {
    (b.min(d) - a.max(c)).max(0.0)
}

/// cos⁴ of the angle from the axis at a pixel's middle: the pinhole's irradiance over that on its axis.
pub(crate) fn falloff(x: usize, y: usize) -> f64 {
    let [x, y] = [x as f64 + 0.5 - 50.0, y as f64 + 0.5 - 30.0];
    1.0 / ((1.0 + (x * x + y * y) / 250_000.0) * (1.0 + (x * x + y * y) / 250_000.0))
}

/// Mean cover of a pixel [x, x + 1] by a bar [start, start + 10] whose start goes evenly from `from` over `travel` px.
fn blurred(x: f64, from: f64, travel: f64) -> f64 {
    const STEPS: usize = 20_000;
    let at = |i: usize| from + travel * (i as f64 + 0.5) / STEPS as f64;
    (0..STEPS).map(|i| overlap(x, x + 1.0, at(i), at(i) + 10.0)).sum::<f64>() / STEPS as f64
}

/// 50 px of travel during the exposure: the profile is the bar's own box spread over the box of its travel, to half a per cent of
/// the bar's full light, the mean of 60 rows of 2048 stratified samples (some 40 of which cannot tell on which side of an edge
/// they lie: 0.02 % of the full light a pixel's mean). The level is that of the bar at rest.
#[test]
fn a_bar_at_constant_speed_is_blurred_over_the_box_of_its_travel() {
    let shutter = "exposure_s = 0.05\nshutter = { type = \"global\" }";
    let moving = electrons(&job(BAR, shutter, 2048).shot(), 0);
    let still = BAR.split("keys").next().unwrap_or_default();
    let still = electrons(&job(still, shutter, 2048).shot(), 0);
    let mean = |plane: &Plane<MeanElectrons>, x: usize| {
        (0..SIZE[1]).map(|y| f64::from(plane.at(x, y)) / falloff(x, y)).sum::<f64>() / SIZE[1] as f64
    };
    let full = (46..54).map(|x| mean(&still, x)).sum::<f64>() / 8.0;
    let worst = (0..SIZE[0]).map(|x| (mean(&moving, x) / full - blurred(x as f64, 15.0, 50.0)).abs());
    let worst = worst.fold(0.0, f64::max);
    assert!(worst < 0.2 * 0.005, "{worst}: half a per cent of the plateau, a fifth of the bar's light");
}

/// Rows that begin 300 µs after each other see the bar 0.3 px farther each: a leaning bar, in light and in truth.
#[test]
fn a_rolling_shutter_leans_an_upright_bar_by_speed_times_row_time() {
    for (direction, sign) in [("down", 1.0), ("up", -1.0)] {
        let sensor = format!(
            "exposure_s = 0.004\nshutter = {{ type = \"rolling\", row_time_us = 300, direction = \"{direction}\" }}"
        );
        let shot = job(BAR, &sensor, 256).shot();
        let light = electrons(&shot, 0);
        let truth = ground_truth(&shot.plan, shot.camera(), 0, Simd::Auto).instance;
        let rows: Vec<f64> = (0..SIZE[1]).map(|y| y as f64).collect();
        let centre = |weight: &dyn Fn(usize) -> f64| {
            let sum: f64 = (0..SIZE[0]).map(weight).sum();
            (0..SIZE[0]).map(|x| (x as f64 + 0.5) * weight(x)).sum::<f64>() / sum
        };
        let centres: Vec<f64> = (0..SIZE[1]).map(|y| centre(&|x| f64::from(light.at(x, y)))).collect();
        let true_centres: Vec<f64> = (0..SIZE[1]).map(|y| centre(&|x| f64::from(truth.at(x, y).min(1)))).collect();
        let read = |y: usize| if sign > 0.0 { y } else { SIZE[1] - 1 - y };
        for y in 0..SIZE[1] {
            // The middle of the row's exposure, 2 ms after its beginning, on the bar's way from column 20.
            let expected = 20.0 + 1000.0 * (0.002 + 300e-6 * read(y) as f64);
            // Means of 64 stratified samples of an edge 4 px wide: 0.1 px; a point-sampled box of 10 px: half a pixel.
            assert!(
                (centres[y] - expected).abs() < 0.1 && (true_centres[y] - expected).abs() < 0.51,
                "{y}: {} {expected}",
                centres[y]
            );
        }
        let lean = slope(&rows, &centres);
        // 60 rows of 0.04 px scatter a slope by 0.04 √12/60^1.5 = 3e-4 px a row; three of those.
        assert!((lean - sign * 0.3).abs() < 1e-3, "{lean}");
    }
}

/// Of every three rows the first is read: the 20 rows of the raw follow each other by the row time, and the bar leans by as much from one of them to the
/// next as without skipping, a third of that over the rows of the sensor.
#[test]
fn rows_that_are_skipped_take_no_time_of_a_rolling_shutter() {
    let sensor = "exposure_s = 0.004\nnoise = false\nskipping = { rows = 3 }\n\
                  shutter = { type = \"rolling\", row_time_us = 300 }";
    // Dim enough for the well.
    let shot = job(BAR, sensor, 256).replaced("illuminance_lx = 10000", "illuminance_lx = 100").shot();
    let light = electrons(&shot, 0);
    let captures = CaptureLight { first: &light, further: &[] };
    let address = FrameAddress { seed: 0, camera: 0, frame: 0, capture: 0 };
    let frames = capture(&shot.camera().body, SensorState::default(), captures, address);
    let raw = frames.expect("electronics").1.raw.plane;
    assert_eq!((raw.width(), raw.height()), (SIZE[0], SIZE[1] / 3));
    let centre = |y: usize| {
        let weight = |x: usize| f64::from(raw.at(x, y)) - 64.0;
        let sum: f64 = (0..SIZE[0]).map(weight).sum();
        (0..SIZE[0]).map(|x| (x as f64 + 0.5) * weight(x)).sum::<f64>() / sum
    };
    let centres: Vec<f64> = (0..raw.height()).map(centre).collect();
    let rows: Vec<f64> = (0..raw.height()).map(|y| y as f64).collect();
    for (y, row_centre) in centres.iter().enumerate() {
        let expected = 20.0 + 1000.0 * (0.002 + 300e-6 * y as f64);
        // As above, 0.1 px; rounding to digital numbers of a bar of some hundreds adds less than a hundredth of that.
        assert!((row_centre - expected).abs() < 0.1, "{y}: {row_centre} {expected}");
    }
    // 20 rows of 0.04 px scatter a slope by 0.04 √12/20^1.5 = 1.5e-3 px a row; three of those.
    let lean = slope(&rows, &centres);
    assert!((lean - 0.3).abs() < 5e-3, "{lean}");
}

fn slope(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len() as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let sums = x.iter().zip(y).map(|(x, y)| ((x - mx) * (y - my), (x - mx) * (x - mx)));
    let (xy, xx) = sums.fold((0.0, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1));
    xy / xx
}

/// Frame 1 is 0.1 s, 100 px, later; a moving camera sees a still bar as a still camera sees the bar that moves the other way.
#[test]
fn a_camera_that_moves_sees_what_a_still_one_sees_of_a_world_that_moves_the_other_way() {
    let still = BAR.split("keys").next().unwrap_or_default();
    let shutter = "exposure_s = 0.05\nshutter = { type = \"rolling\", row_time_us = 100 }";
    let world_moves = job(BAR, shutter, 64).shot();
    let text = job(&format!("{still}position_m = [0, 0.06, 0]"), shutter, 64);
    let camera_moves = text
        .replaced(
            "position_m = [0, 0, 1]\n        look_at_m = [0, 0, 0]\n        up = [1, 0, 0]",
            "keys = [{ time_s = 999, position_m = [0, -2, 1], look_at_m = [0, -2, 0], up = [1, 0, 0] }, \
             { time_s = 1001, position_m = [0, 2, 1], look_at_m = [0, 2, 0], up = [1, 0, 0] }]",
        )
        .shot();
    let (a, b) = (electrons(&world_moves, 0), electrons(&camera_moves, 0));
    // The same random numbers: but for samples whose rounding crosses an edge of the bar, the same electrons.
    let differing = a.samples().iter().zip(b.samples()).filter(|(a, b)| (*a - *b).abs() > 1e-3 * a.max(**b)).count();
    assert!(differing * 200 < a.samples().len(), "{differing}");
    assert!(electrons(&world_moves, 1).samples().iter().all(|e| *e == 0.0), "the bar has left the picture");
}
