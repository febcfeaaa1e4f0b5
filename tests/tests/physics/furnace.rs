//! Conservation of energy: furnaces and closed boxes.

use etendue_testkit::judge::{compare_with_truth, is_near, mean_and_error};
use etendue_tests::{Job, Samples};

/// f32 arithmetic of a few bounces, and the f32 sums of the densities: 1e-5 as the house demands.
const ARITHMETIC: f64 = 1e-5;

/// A body in a uniform radiance of 1; a single band, so that the draw of wavelengths adds no noise.
fn furnace(material: &str, shape: &str, band_width_nm: u32) -> Samples {
    Job::new(format!(
        r#"
        [scene]
        materials = [{{ name = "white", {material} }}]
        objects = [{{ name = "body", shape = {{ {shape} }}, material = "white", rotation_deg = [30, 20, 10] }}]
        environment = {{ type = "uniform", radiance_w_m2_sr_nm = 1 }}
        [[cameras]]
        name = "eye"
        position_m = [-4, 0, 0]
        look_at_m = [0, 0, 0]
        lens = {{ type = "thin", focal_length_mm = 8, f_number = 2, focus_distance_m = 4 }}
        sensor = {{ width_px = 12, height_px = 12, pixel_pitch_um = 500 }}
        [render]
        spp = 256
        replicates = 16
        max_bounces = 32
        wavelength_range_nm = [500, 600]
        band_width_nm = {band_width_nm}
        "#
    ))
    .shot()
    .radiance()
}

fn assert_is_one(radiance: &Samples, allowance: f64, subject: &str) {
    let comparison = compare_with_truth(radiance.estimate(), |_| 1.0, |_| allowance);
    assert!(comparison.is_ok(), "{subject}: {comparison:?}");
    let mean = mean_and_error(radiance.estimate());
    assert!(is_near(mean, 1.0, allowance, 30.0), "{subject}: the picture's mean is {mean:?}");
}

#[test]
fn a_white_body_is_indistinguishable_from_its_surroundings() {
    for shape in ["type = \"sphere\", radius_m = 1", "type = \"box\", size_m = [1, 2, 1.5]"] {
        let radiance = furnace("type = \"diffuse\", reflectance = 1", shape, 100);
        assert_is_one(&radiance, ARITHMETIC, shape);
        // Cosine-weighted directions reflect exactly the albedo, so nothing scatters: three standard errors are nothing.
        let worst = radiance.mean.iter().map(|v| (f64::from(*v) - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst <= ARITHMETIC, "{shape}: {worst}");
    }
}

#[test]
fn a_white_body_is_white_in_every_band() {
    let sphere = "type = \"sphere\", radius_m = 1";
    assert_is_one(&furnace("type = \"diffuse\", reflectance = 1", sphere, 20), ARITHMETIC, "five bands");
}

#[test]
fn scenes_may_state_the_coats_that_the_tracer_has() {
    assert_eq!(etendue_scene::asset::COAT_INDICES, etendue_tracer::materials::COAT_INDICES);
}

#[test]
fn a_coat_over_white_loses_nothing() {
    // The coat's reflectance is tabulated at 128 steps and interpolated: a smooth one is exact at the steps and bends by
    // less than 5e-4 between them; a rough one is integrated by a lattice besides, good to 2e-3.
    for (alpha, table) in [(0.0, 5e-4), (0.1, 2e-3), (0.4, 2e-3), (1.0, 2e-3)] {
        let paint = format!("type = \"coated\", reflectance = 1, alpha = {alpha}");
        assert_is_one(&furnace(&paint, "type = \"sphere\", radius_m = 1", 100), table, &paint);
    }
}

/// The inside of a cube whose six walls glow with 1 and reflect `albedo`.
fn closed_box(albedo: f64, max_bounces: u32) -> Samples {
    // Position and rotation: the front of each wall looks inward.
    let walls = [
        ([0, 0, -1], [0, 0, 0]),
        ([0, 0, 1], [0, 180, 0]),
        ([1, 0, 0], [0, -90, 0]),
        ([-1, 0, 0], [0, 90, 0]),
        ([0, 1, 0], [0, 0, 90]),
        ([0, -1, 0], [0, 0, -90]),
    ];
    let wall = |(position, rotation): &([i32; 3], [i32; 3])| {
        format!("{{ position_m = {position:?}, rotation_deg = {rotation:?} }}")
    };
    let walls: Vec<String> = walls.iter().map(wall).collect();
    Job::new(format!(
        r#"
        [[scene.materials]]
        name = "wall"
        type = "diffuse"
        reflectance = {albedo}
        emission = {{ radiance_w_m2_sr_nm = 1 }}
        [[scene.objects]]
        name = "walls"
        material = "wall"
        shape = {{ type = "quad", size_m = [2, 2] }}
        instances = [{}]
        [[cameras]]
        name = "eye"
        position_m = [-0.3, 0.2, 0.1]
        rotation_deg = [25, 15, 5]
        lens = {{ type = "pinhole", focal_length_mm = 5, f_number = 8 }}
        sensor = {{ width_px = 10, height_px = 10, pixel_pitch_um = 1000 }}
        [render]
        spp = 256
        replicates = 16
        max_bounces = {max_bounces}
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        "#,
        walls.join(", ")
    ))
    .shot()
    .radiance()
}

#[test]
fn a_closed_box_fills_with_the_geometric_series() {
    // The series is cut at ρ^(bounces + 1) of itself: 5e-20, 2e-12 and 1e-9. A path adds up to 1024 numbers in f32.
    for (albedo, max_bounces) in [(0.5, 64), (0.9, 256), (0.98, 1024)] {
        let radiance = closed_box(albedo, max_bounces);
        let truth = 1.0 / (1.0 - albedo);
        let allowance = ARITHMETIC * truth;
        let comparison = compare_with_truth(radiance.estimate(), |_| truth, |_| allowance);
        assert!(comparison.is_ok(), "albedo {albedo}: {comparison:?}");
        let mean = mean_and_error(radiance.estimate());
        assert!(is_near(mean, truth, allowance, 30.0), "albedo {albedo}: mean {mean:?} for {truth}");
        // A test that could not fail would be of no use: the picture's mean is known to 1 %.
        assert!(mean.1 < 0.01 * truth, "albedo {albedo}: standard error {}", mean.1);
    }
}

#[test]
fn a_limit_of_bounces_cuts_the_series_where_it_says() {
    for bounces in [1, 2, 3] {
        let truth: f64 = (0..=bounces).map(|k| etendue_core::maths::f64::pow(0.5, f64::from(k))).sum();
        let radiance = closed_box(0.5, bounces);
        let comparison = compare_with_truth(radiance.estimate(), |_| truth, |_| ARITHMETIC * truth);
        assert!(comparison.is_ok(), "{bounces} bounces: {comparison:?}");
    }
}
