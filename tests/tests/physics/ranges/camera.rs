//! Cameras at the ends of their keys: sizes, apertures, exposures, wells, converters, temperatures.

use etendue_core::maths::f64::exp2;
use etendue_sensor::{FrameAddress, SensorState};
use etendue_testkit::page::{Row, check, figure};
use etendue_tests::{Job, Shot};
use std::time::Instant;

const LENS: &str = "type = \"thin\", focal_length_mm = 6, f_number = 2, focus_distance_m = 5";

/// A camera before a white wall under an even sky, 1 ms.
fn camera() -> Job {
    Job::new(format!(
        r#"
        [scene]
        materials = [{{ name = "white", type = "diffuse", reflectance = 0.8 }}]
        environment = {{ type = "uniform", radiance_w_m2_sr_nm = 0.01 }}
        [[scene.objects]]
        name = "wall"
        material = "white"
        position_m = [5, 0, 0]
        rotation_deg = [0, -90, 0]
        shape = {{ type = "quad", size_m = [100, 100] }}
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        lens = {{ {LENS} }}
        [cameras.sensor]
        width_px = 16
        height_px = 16
        pixel_pitch_um = 3
        exposure_s = 0.001
        cfa = "mono"
        quantum_efficiency = 0.5
        full_well_e = 1e5
        read_noise_e = 2
        dark_current_e_s = 5
        gain_dn_per_e = 0.5
        black_level_dn = 64
        bits = 16
        [render]
        spp = 16
        wavelength_range_nm = [500, 600]
        [output]
        electrons = true
        "#
    ))
}

/// Digital numbers of a frame.
fn numbers(shot: &Shot) -> Vec<f64> {
    let sensor = shot.camera().body.sensor.as_ref().expect("electronics");
    let means = shot.light().electrons.expect("the camera has electronics");
    let address = FrameAddress { seed: 3, camera: 0, frame: 0, capture: 0 };
    let raw = sensor.step(SensorState::default(), &means, address).1;
    raw.plane.samples().iter().map(|dn| f64::from(*dn)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn electrons(job: &Job) -> f64 {
    mean(&job.shot().electrons().iter().map(|e| f64::from(*e)).collect::<Vec<_>>())
}

fn optics() -> Vec<Row> {
    let at = |f_number: f64| electrons(&camera().replaced("f_number = 2", &format!("f_number = {f_number}")));
    // E = π L/(1 + 4 N²), the lens at 1 + m of its stop number by focus: 6 mm at 5 m, m = 0.0012.
    let falls = |a: f64, b: f64| at(a) / at(b) / ((1.0 + 4.0 * b * b) / (1.0 + 4.0 * a * a)) - 1.0;
    let focus = |m: &str| electrons(&camera().replaced("focus_distance_m = 5", &format!("focus_distance_m = {m}")));
    vec![
        Row::at_most("f/0.5 against f/2", "light as 1/(1 + 4 N²) (relative error)", falls(0.5, 2.0).abs(), 2e-2),
        Row::at_most("f/1000 against f/2", "light as 1/(1 + 4 N²) (relative error)", falls(1000.0, 2.0).abs(), 2e-2),
        Row::at_most(
            "focus at infinity and at 10⁹ m",
            "equal images (relative difference)",
            (focus("\"infinity\"") / focus("1e9") - 1.0).abs(),
            1e-6,
        ),
        out_of_focus("a wall with focus at 1 cm: blur circles of 1 500 px", "0.01", 1.5),
        out_of_focus("the same with focus at 6.06 mm, 0.06 mm beyond the focal length: 100 000 px", "0.00606", 100.0),
        at_pupil("the wall at 1 500 px on the pupil route", "0.01", 1.5, 16),
        at_pupil("the wall at 100 000 px on the pupil route", "0.00606", 100.0, 16),
        at_pupil("the wall at 1 500 px on the pupil route, 128 × 128 px", "0.01", 1.5, 128),
        lamp_at_pupil(),
        refused(
            "focus at 6 mm, the focal length",
            "refused: the image would be at infinity",
            &camera().replaced("focus_distance_m = 5", "focus_distance_m = 0.006"),
            "focus_distance_m",
        ),
        refused(
            "focus at 1 mm, within the focal length",
            "refused: there would be no image",
            &camera().replaced("focus_distance_m = 5", "focus_distance_m = 0.001"),
            "focus_distance_m",
        ),
        refused(
            "distortion that folds over within the image",
            "refused with the radius of the fold",
            &camera()
                .replaced("pixel_pitch_um = 3", "pixel_pitch_um = 600")
                .replaced("focus_distance_m = 5", "focus_distance_m = 5, distortion = { k1 = -0.5, direction = \"ideal_to_observed\", radius_unit = \"focal_lengths\" }"),
            "distortion",
        ),
    ]
}

/// A wall behind blur circles: light by how far the lens is drawn out, whose image of focus is `m` times as large as it.
fn out_of_focus(extreme: &str, focus_m: &str, m: f64) -> Row {
    let light = |m: f64| 1.0 / (1.0 + 16.0 * (1.0 + m) * (1.0 + m));
    let at =
        |focus_m: &str| electrons(&camera().replaced("focus_distance_m = 5", &format!("focus_distance_m = {focus_m}")));
    let expected = format!("light as 1/(1 + 4 N² (1 + m)²), m {} and 0.0012 (relative error)", figure(m));
    Row::at_most(extreme, &expected, (at(focus_m) / at("5") / (light(m) / light(0.0012)) - 1.0).abs(), 2e-2)
}

/// How long a picture that is spread over blur circles may take, s by the clock of a busy machine: some hundred times what it does.
const MAX_TIME_S: f64 = 60.0;

/// The camera on the route at the pupil, square.
fn camera_at_pupil(focus_m: &str, size_px: u32) -> Job {
    camera()
        .replaced("[render]", "[render]\n        route = \"pupil\"")
        .replaced("width_px = 16", &format!("width_px = {size_px}"))
        .replaced("height_px = 16", &format!("height_px = {size_px}"))
        .replaced("focus_distance_m = 5", &format!("focus_distance_m = {focus_m}"))
}

/// The same where radiance is stored at the pupil and spread over blur circles afterwards, within a bounded time.
fn at_pupil(extreme: &str, focus_m: &str, m: f64, size_px: u32) -> Row {
    let light = |m: f64| 1.0 / (1.0 + 16.0 * (1.0 + m) * (1.0 + m));
    let in_focus = electrons(&camera());
    let start = Instant::now();
    let actual = electrons(&camera_at_pupil(focus_m, size_px)) / in_focus / (light(m) / light(0.0012)) - 1.0;
    let is_quick = start.elapsed().as_secs_f64() < MAX_TIME_S;
    let expected = format!("light as 1/(1 + 4 N² (1 + m)²) (relative error), in less than {MAX_TIME_S} s");
    let row = Row::at_most(extreme, &expected, actual.abs(), 2e-2);
    Row { holds: row.holds && is_quick, ..row }
}

/// A lamp in the plane of the wall, amid darkness, in a circle that is much wider than the picture: what lies beyond what is stored, 96 × 96 px, counts as
/// its mean.
fn lamp_at_pupil() -> Row {
    // A pixel is 1 mm at 5 m, with the lens 15 mm before the sensor.
    const LAMP_PX: f64 = 10.0;
    const STORED_PX: f64 = 96.0;
    let wall = camera_at_pupil("0.01", 64);
    let lamp = "materials = [{ name = \"white\", type = \"emitter\", emission = { radiance_w_m2_sr_nm = 0.008, sides = \"both\" } }]";
    let lamp = wall
        .clone()
        .replaced("materials = [{ name = \"white\", type = \"diffuse\", reflectance = 0.8 }]", lamp)
        .replaced("radiance_w_m2_sr_nm = 0.01", "radiance_w_m2_sr_nm = 0")
        .replaced("size_m = [100, 100]", "size_m = [0.01, 0.01]");
    let fraction = (LAMP_PX / STORED_PX) * (LAMP_PX / STORED_PX);
    let row = Row::at_most(
        "the same, a light of 10 × 10 px in darkness, 64 × 64 px with a margin of 16 px: 1 500 px",
        "the mean of the stored image in every pixel (docs/lenses.md; relative error), and a warning of the plan",
        (electrons(&lamp) / electrons(&wall) / fraction - 1.0).abs(),
        2e-2,
    );
    let is_noted = lamp.plan().notes.iter().any(|remark| remark.text.contains("16 px are stored around the image"));
    Row { holds: row.holds && is_noted, ..row }
}

/// A job that is refused, with the message, which must name something.
fn refused(extreme: &str, expected: &str, job: &Job, named: &str) -> Row {
    let message = job.compiled().err().unwrap_or_else(|| "no fault was found".to_owned());
    Row {
        extreme: extreme.to_owned(),
        expected: expected.to_owned(),
        holds: message.contains(named) && message.lines().count() == 1,
        actual: message.replace('|', "\\|"),
    }
}

fn sizes() -> Vec<Row> {
    let sized_job = |width: u32, height: u32| {
        camera()
            .replaced("width_px = 16", &format!("width_px = {width}"))
            .replaced("height_px = 16", &format!("height_px = {height}"))
            .replaced("spp = 16", "spp = 1")
    };
    let bad = |job: &Job, pixels: usize| {
        let numbers = numbers(&job.shot());
        numbers.iter().filter(|dn| **dn <= 64.0).count().max(pixels.abs_diff(numbers.len())) as f64
    };
    let lit = "light in every pixel (pixels without)";
    vec![
        Row::at_most("an image of 1 × 1 px", lit, bad(&sized_job(1, 1), 1), 0.0),
        Row::at_most(
            "an image of 65 535 × 64 px, pixels of 0.1 µm",
            lit,
            bad(
                &sized_job(65_535, 64)
                    .replaced("pixel_pitch_um = 3", "pixel_pitch_um = 0.1")
                    .replaced("exposure_s = 0.001", "exposure_s = 1"),
                65_535 * 64,
            ),
            0.0,
        ),
    ]
}

fn electronics() -> Vec<Row> {
    let with = |changes: &[(&str, &str)]| changes.iter().fold(camera(), |job, (old, new)| job.replaced(old, new));
    let signal = |job: &Job| mean(&numbers(&job.shot()));
    let dark_e = |celsius: f64| {
        let dark = format!(
            "dark_current_e_s = 5\n        dark = {{ temperature_c = {celsius}, reference_c = 20, doubling_k = 8 }}"
        );
        let job = with(&[
            ("dark_current_e_s = 5", &dark),
            ("radiance_w_m2_sr_nm = 0.01", "radiance_w_m2_sr_nm = 0"),
            ("read_noise_e = 2", "read_noise_e = 0"),
            ("exposure_s = 0.001", "exposure_s = 1e4"),
            ("full_well_e = 1e5", "full_well_e = 1e12"),
            ("bits = 16", "bits = 24"),
            ("gain_dn_per_e = 0.5", &format!("gain_dn_per_e = {:e}", 200.0 * exp2(-(celsius - 20.0) / 8.0))),
        ]);
        (signal(&job) - 64.0) / (200.0 * exp2(-(celsius - 20.0) / 8.0))
    };
    let law = |celsius: f64| (dark_e(celsius) / (5e4 * exp2((celsius - 20.0) / 8.0)) - 1.0).abs();
    let full = with(&[("exposure_s = 0.001", "exposure_s = 1e6")]);
    let photon = with(&[
        ("exposure_s = 0.001", "exposure_s = 1e-10"),
        ("read_noise_e = 2", "read_noise_e = 0"),
        ("gain_dn_per_e = 0.5", "gain_dn_per_e = 100"),
        ("black_level_dn = 64", "black_level_dn = 0"),
        ("width_px = 16", "width_px = 256"),
        ("height_px = 16", "height_px = 256"),
        ("pixel_pitch_um = 3", "pixel_pitch_um = 1"),
        ("spp = 16", "spp = 4"),
    ]);
    let one_electron = with(&[
        ("full_well_e = 1e5", "full_well_e = 1"),
        ("read_noise_e = 2", "read_noise_e = 0"),
        ("gain_dn_per_e = 0.5", "gain_dn_per_e = 10"),
    ]);
    let one_electron = numbers(&one_electron.shot());
    let shot = photon.shot();
    let (expected, actual) =
        (shot.electrons().iter().map(|e| f64::from(*e)).sum::<f64>(), numbers(&shot).iter().sum::<f64>() / 100.0);
    vec![
        Row::at_most(
            "an exposure of 0 s",
            "the black level within the read noise of 256 pixels (difference, DN)",
            (signal(&with(&[("exposure_s = 0.001", "exposure_s = 0")])) - 64.0).abs(),
            0.25,
        ),
        Row::at_most(
            "an exposure of 10⁶ s",
            "the full well in every pixel (relative error)",
            (signal(&full) / 50_064.0 - 1.0).abs(),
            1e-3,
        ),
        Row {
            extreme: "a pixel that holds one electron".to_owned(),
            expected: "0 or 1 electron: at most 64 + 10 DN".to_owned(),
            actual: format!("largest {} DN", figure(one_electron.iter().copied().fold(0.0, f64::max))),
            holds: one_electron.iter().all(|dn| *dn <= 74.0 && *dn >= 64.0),
        },
        Row {
            extreme: format!("{expected:.2} photons in a frame of 65 536 pixels"),
            expected: "an integer, Poisson: within four deviations".to_owned(),
            actual: format!("{actual} electrons"),
            holds: actual.fract() == 0.0 && (actual - expected).abs() <= 4.0 * expected.sqrt() + 1.0,
        },
        Row::at_most(
            "−50 °C, doubling every 8 K",
            "the model's dark current over 10⁴ s (relative error with shot noise)",
            law(-50.0),
            0.05,
        ),
        Row::at_most(
            "+150 °C, doubling every 8 K",
            "the model's dark current over 10⁴ s (relative error)",
            law(150.0),
            0.01,
        ),
        Row::at_most(
            "24 bits, 100 DN per electron",
            "the mean signal of 16 bits (relative error)",
            ((signal(&with(&[("bits = 16", "bits = 24"), ("gain_dn_per_e = 0.5", "gain_dn_per_e = 100")])) - 64.0)
                / 200.0
                / (signal(&camera()) - 64.0)
                - 1.0)
                .abs(),
            2e-2,
        ),
    ]
}

#[test]
fn cameras() {
    let mut rows = optics();
    rows.extend(sizes());
    rows.extend(electronics());
    let introduction = "A camera of 6 mm in front of a white wall, 1 ms, 16 × 16 pixels of 3 µm.";
    check("Cameras", introduction, &rows);
}
