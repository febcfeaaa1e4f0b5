//! From spectra to colours: pictures of known reflectances, and metals.

use etendue_isp::WhiteBalance;
use etendue_spectra::colour::{lab, xyz_from_linear_srgb};
use etendue_spectra::{illuminant, metal, observer, reflectance};
use etendue_testkit::form_factor::simpson;
use etendue_testkit::judge::compare_with_truth;
use etendue_tests::{Job, Shot};

/// Luminance of the light, cd/m².
const LIGHT: f64 = 100.0;

/// A card of reflectance `reflectance` (in the words of a job) that fills the view, in the light of D65.
fn card(reflectance: &str, spp: u32) -> Job {
    Job::new(format!(
        r#"
        [scene]
        materials = [{{ name = "card", type = "diffuse", reflectance = {reflectance} }}]
        objects = [{{ name = "card", shape = {{ type = "quad", size_m = [50, 50] }}, material = "card" }}]
        environment = {{ type = "uniform", luminance_cd_m2 = {LIGHT}, illuminant = "D65" }}
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 3]
        look_at_m = [0, 0, 0]
        up = [1, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = 6, f_number = 4 }}
        [cameras.sensor]
        width_px = 8
        height_px = 8
        pixel_pitch_um = 5
        exposure_s = 0.01
        cfa = "rggb"
        quantum_efficiency = {{ camera = "nikon-d5100", peak = 0.5 }}
        full_well_e = 8000
        read_noise_e = 0
        dark_current_e_s = 0
        gain_dn_per_e = 8
        black_level_dn = 100
        bits = 16
        noise = false
        [cameras.isp]
        white_balance = "D65"
        colour_matrix = {{ fit = "D65" }}
        [render]
        spp = {spp}
        replicates = 1
        max_bounces = 1
        wavelengths_per_path = 8
        "#
    ))
}

/// Mean linear sRGB of the developed picture.
fn linear(shot: &Shot) -> [f64; 3] {
    let electrons = shot.light().electrons.expect("a sensor");
    let address = etendue_sensor::FrameAddress { seed: 1, camera: 0, frame: 0, capture: 0 };
    let start = etendue_sensor::SensorState::default();
    let (_, frame) = etendue_pipeline::photograph::capture(
        &shot.camera().body,
        start,
        etendue_sensor::CaptureLight::steady(&electrons),
        address,
    )
    .expect("raw");
    let largest = frame.raw.plane.samples().iter().max().expect("pixels");
    assert!(f64::from(*largest) < frame.raw.white_level_dn, "the card saturates: {largest}");
    let image = frame.picture.expect("a processing").linear;
    let n = image.samples().len() as f64;
    std::array::from_fn(|c| image.samples().iter().map(|rgb| f64::from(rgb[c])).sum::<f64>() / n)
}

#[test]
fn a_grey_card_in_the_light_of_the_white_balance_is_neutral() {
    let rgb = linear(&card("0.18", 4096).shot());
    // Shown as if its luminance were that of mid-grey: scaled to 18 % of white.
    let white = xyz_from_linear_srgb([1.0; 3]);
    let mean = (rgb[0] + rgb[1] + rgb[2]) / 3.0;
    let colour = lab(xyz_from_linear_srgb(rgb.map(|v| 0.18 * v / mean)), white);
    // Channels are known to about 1e-3 (4096 samples of 8 wavelengths a pixel; rounding to DN is 1e-4); a* = 500 (f(X) − f(Y))
    // turns a relative 1e-3 into 0.1 at this lightness.
    assert!(colour.a.abs() < 0.3 && colour.b.abs() < 0.3, "{rgb:?} {colour:?}");
}

#[test]
fn the_chart_has_the_colours_that_spectra_and_matrix_say() {
    for patch in reflectance::colorchecker() {
        let points: Vec<(f64, f64)> =
            (380..=780).map(|nm| (f64::from(nm), f64::from(patch.reflectance.at(nm as f32)))).collect();
        let shot = card("{ spectrum = \"patch.csv\" }", 1024).with_spectrum("patch.csv", &points).shot();
        let linear_rgb = linear(&shot);
        let body = &shot.camera().body;
        let sensor = body.sensor.as_ref().expect("a sensor");
        let d65 = illuminant::d65();
        // Irradiance on the axis: ρ L π/(4N²); electrons over the full well is the white level's share.
        let scale = LIGHT / observer::luminance(d65) * core::f64::consts::PI / 64.0;
        let white_e = sensor.parameters().charge.full_well.capacity_e;
        let processing = &body.development.as_ref().expect("a processing").processing;
        let colour = processing.colour.as_ref().expect("colour");
        let WhiteBalance::Gains(gains) = &colour.white_balance else { panic!("the illuminant gives gains") };
        let camera: [f64; 3] = std::array::from_fn(|c| {
            let product = |nm: f64| {
                [sensor.responsivity(c), d65, &patch.reflectance].map(|s| f64::from(s.at(nm as f32))).iter().product()
            };
            gains[c] * scale * simpson(380.0, 780.0, 800, product) / white_e
        });
        let brightest = camera.iter().copied().fold(0.0, f64::max);
        for (row, expected_row) in colour.matrix.rows().iter().zip(linear_rgb) {
            let truth: f64 = row.iter().zip(camera).map(|(m, v)| m * v).sum();
            // 64 pixels of 1024 samples of 8 wavelengths: each channel is known to about 1e-3, and the matrix's rows
            // (entries up to 2 in sum of squares 5) spread it: 5e-3 of the brightest is five standard errors.
            let allowed = 5e-3 * brightest;
            assert!((expected_row - truth).abs() < allowed, "{}: {expected_row} for {truth} ± {allowed}", patch.name);
        }
    }
}

/// Fresnel's reflectance for unpolarised light of a metal of index n + ik, by complex amplitudes.
fn fresnel(cos: f64, n: f64, k: f64) -> f64 {
    // √(m² − sin²) for the complex index m, its real part positive.
    let (re, im) = (n * n - k * k - (1.0 - cos * cos), 2.0 * n * k);
    let size = (re * re + im * im).sqrt();
    let (p, q) = ((0.5 * (size + re)).sqrt(), (0.5 * (size - re)).sqrt());
    let square = |a: f64, b: f64| a * a + b * b;
    let s = square(cos - p, q) / square(cos + p, q);
    let (mr, mi) = (n * n - k * k, 2.0 * n * k);
    let parallel = square(mr * cos - p, mi * cos - q) / square(mr * cos + p, mi * cos + q);
    0.5 * (s + parallel)
}

#[test]
fn a_metal_sphere_in_uniform_light_shows_its_fresnel_reflectance() {
    const SIDE: usize = 9;
    for (name, low_nm) in [("Al", 450.0), ("Ag", 400.0), ("Au", 500.0), ("Cu", 560.0), ("Cr", 600.0), ("Fe", 700.0)] {
        let high_nm = low_nm + 10.0;
        let shot = Job::new(format!(
            r#"
            [scene]
            materials = [{{ name = "metal", type = "conductor", metal = "{name}", alpha = 0 }}]
            objects = [{{ name = "ball", shape = {{ type = "sphere", radius_m = 1 }}, material = "metal" }}]
            environment = {{ type = "uniform", radiance_w_m2_sr_nm = 1 }}
            [[cameras]]
            name = "eye"
            position_m = [-100, 0, 0]
            look_at_m = [0, 0, 0]
            lens = {{ type = "pinhole", focal_length_mm = 1000, f_number = 8 }}
            sensor = {{ width_px = {SIDE}, height_px = 1, pixel_pitch_um = 2400, fill_factor = 1e-6, principal_point_px = [4.5, 0.5] }}
            [render]
            spp = 256
            replicates = 16
            wavelength_range_nm = [{low_nm}, {high_nm}]
            band_width_nm = 10
            "#
        ))
        .shot();
        let reflected = shot.radiance();
        let index = metal::by_name(name).expect("known");
        let reflectance = |cos: f64| {
            let fresnel_at = |nm: f64| fresnel(cos, f64::from(index.n.at(nm as f32)), f64::from(index.k.at(nm as f32)));
            simpson(low_nm, high_nm, 40, fresnel_at) / 10.0
        };
        // From 100 m, 2.4 mm of 1 m are 0.24 m aside on the sphere: the sine of the incidence is the distance at which the
        // ray passes the centre, over the radius.
        let cos = |i: usize| {
            let tangent = 2.4e-3 * (i as f64 - 4.0);
            let tangent_squared = 1e4 * tangent * tangent / (1.0 + tangent * tangent);
            (1.0 - tangent_squared).sqrt()
        };
        // f32 Fresnel terms subtract nearly equal numbers: 1e-5, and the f32 hit point moves the incidence by as much.
        let comparison = compare_with_truth(reflected.estimate(), |i| reflectance(cos(i)), |_| 3e-5);
        assert!(comparison.is_ok(), "{name}: {comparison:?}");
        assert!(cos(0) < 0.3, "from the middle to nearly the limb");
    }
}
