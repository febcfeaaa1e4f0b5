//! Photo-electrons of a known luminance.

use core::f64::consts::PI;
use etendue_stats::Moments;
use etendue_tests::Job;

/// A luminance of 100 cd/m² at 555 nm (683 lm/W), N = 2 at infinity, a pixel of 3 µm, 10 ms, τ = 1, QE = 1:
/// π L/(1 + 4N²) · A t · λ/(hc).
fn photons() -> f64 {
    let irradiance = PI * (100.0 / 683.0) / (1.0 + 4.0 * 2.0 * 2.0);
    irradiance * 9e-12 * 0.01 * 555e-9 / (6.626_070_15e-34 * 299_792_458.0)
}

/// Sixteen pixels about the axis of a camera in a light of one line.
fn job(emission: &str, range_nm: [f64; 2], render: &str) -> Job {
    Job::new(format!(
        r#"
        [scene]
        environment = {{ type = "uniform", {emission} }}
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        lens = {{ type = "thin", focal_length_mm = 6, f_number = 2, focus_distance_m = "infinity" }}
        [cameras.sensor]
        width_px = 4
        height_px = 4
        pixel_pitch_um = 3
        exposure_s = 0.01
        cfa = "mono"
        quantum_efficiency = 1
        full_well_e = 1e5
        read_noise_e = 0
        dark_current_e_s = 0
        gain_dn_per_e = 0.5
        black_level_dn = 0
        bits = 16
        noise = false
        [render]
        spp = 1024
        replicates = 16
        wavelength_range_nm = {range_nm:?}
        {render}
        [output]
        electrons = true
        "#
    ))
}

/// A line as a spectrum file can hold it on the program's grid of 1 nm: a triangle from 554 to 556 nm of 1 nm area. Its mean
/// wavelength is 555 nm, so that the width costs no photons.
const LINE: [(f64, f64); 3] = [(554.0, 0.0), (555.0, 1.0), (556.0, 0.0)];

fn electrons(job: &Job) -> Moments {
    Moments::from_values(job.shot().electrons().iter().map(|e| f64::from(*e)))
}

#[test]
fn the_check_value() {
    assert!((photons() - 6803.6).abs() < 0.05, "{}", photons());
}

#[test]
fn a_known_radiance_gives_its_photons_by_both_routes_to_electrons() {
    let radiance = "radiance_w_m2_sr_nm = { spectrum = \"line.csv\" }";
    let line = LINE.map(|(nm, v)| (nm, v * 100.0 / 683.0));
    for (render, range_nm, bias) in [
        ("accumulate = \"electrons\"", [554.0, 556.0], 0.0),
        ("accumulate = \"cube\"\nband_width_nm = 1", [554.0, 556.0], 0.0),
        ("accumulate = \"cube\"\nband_width_nm = 2", [554.0, 556.0], 0.0),
        ("accumulate = \"cube\"\nband_width_nm = 5", [552.5, 557.5], 0.0),
        // A band that is not centred on the line counts its light at the band's middle, 557.5 nm for 555 nm.
        ("accumulate = \"cube\"\nband_width_nm = 10", [552.5, 562.5], 2.5 / 555.0),
    ] {
        let samples = electrons(&job(radiance, range_nm, render).with_spectrum("line.csv", &line));
        let truth = photons() * (1.0 + bias);
        let error = samples.variance_of_mean().expect("16 pixels").sqrt();
        // Pixels at most 1.5 pitches off the axis: cos⁴ costs 1e-6. Electrons are stored as f32.
        assert!(
            (samples.mean() - truth).abs() < 4.0 * error + 3e-6 * truth,
            "{render}: {} ± {error} for {truth}",
            samples.mean()
        );
        assert!(error < 2e-3 * truth, "{render}: scatter {error}");
    }
}

#[test]
fn a_declared_luminance_gives_its_photons() {
    let luminance = "luminance_cd_m2 = 100, spectrum = \"line.csv\"";
    let samples =
        electrons(&job(luminance, [554.0, 556.0], "accumulate = \"electrons\"").with_spectrum("line.csv", &LINE));
    let error = samples.variance_of_mean().expect("16 pixels").sqrt();
    // V(555 nm) = 1.0000 in the table of the observer and K = 683.002 lm/W for 683: 1e-5.
    assert!((samples.mean() / photons() - 1.0).abs() < 4.0 * error / photons() + 1e-5, "{} ± {error}", samples.mean());
}

#[test]
fn digital_numbers_are_electrons_times_the_gain() {
    let radiance = "radiance_w_m2_sr_nm = { spectrum = \"line.csv\" }";
    let line = LINE.map(|(nm, v)| (nm, v * 100.0 / 683.0));
    let shot = job(radiance, [554.0, 556.0], "").with_spectrum("line.csv", &line).shot();
    let electrons = shot.light().electrons.expect("a sensor");
    let body = &shot.camera().body;
    let sensor = body.sensor.as_ref().expect("a sensor");
    let address = etendue_sensor::FrameAddress { seed: 1, camera: 0, frame: 0, capture: 0 };
    let start = etendue_sensor::SensorState::default();
    let (_, frame) =
        etendue_pipeline::photograph::capture(body, start, etendue_sensor::CaptureLight::steady(&electrons), address)
            .expect("a sensor");
    assert!(!sensor.parameters().noise);
    for (dn, e) in frame.raw.plane.samples().iter().zip(electrons.samples()) {
        // Without noise the converter rounds to the nearest whole number.
        assert!((f64::from(*dn) - 0.5 * f64::from(*e)).abs() <= 0.5, "{dn} for {e}");
    }
}
