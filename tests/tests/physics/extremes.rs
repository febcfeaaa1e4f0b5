//! Tiny and huge scenes, far away scenes, starlight and more than sunlight: the same picture, and never a NaN.
//!
//! Every [`etendue_tests::Shot`] refuses a film with a sample that is not finite.

use etendue_stats::planes::{self, Verdict};
use etendue_testkit::judge::SIGNIFICANCE;
use etendue_tests::{Job, Samples};

/// A still life with all materials, a lamp and a sky; lengths (camera and lens too) times `scale`, all of it at `at_m`,
/// radiances times `level`.
fn still_life(scale: f64, at_m: [f64; 3], level: f64) -> Job {
    let at =
        |[x, y, z]: [f64; 3]| format!("[{}, {}, {}]", at_m[0] + x * scale, at_m[1] + y * scale, at_m[2] + z * scale);
    let (lamp, sky) = (20.0 * level, level);
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = {eye}
        look_at_m = {target}
        lens = {{ type = "thin", focal_length_mm = {focal}, f_number = 2, focus_distance_m = {focus} }}
        sensor = {{ width_px = 16, height_px = 12, pixel_pitch_um = {pitch} }}
        [render]
        spp = 256
        replicates = 16
        max_bounces = 6
        wavelength_range_nm = [400, 700]
        band_width_nm = 100
        [output]
        irradiance = true
        [scene]
        materials = [
            {{ name = "matt", type = "diffuse", reflectance = [0.7, 0.5, 0.3] }},
            {{ name = "paint", type = "coated", reflectance = 0.8, alpha = 0.1 }},
            {{ name = "metal", type = "conductor", metal = "Cu", alpha = 0.3 }},
            {{ name = "lamp", type = "emitter", emission = {{ radiance_w_m2_sr_nm = {lamp} }} }},
        ]
        objects = [
            {{ name = "floor", material = "matt", position_m = {floor}, shape = {{ type = "quad", size_m = [{s20}, {s20}] }} }},
            {{ name = "box", material = "paint", position_m = {cuboid}, rotation_deg = [30, 0, 0], shape = {{ type = "box", size_m = [{s1}, {s1}, {s1}] }} }},
            {{ name = "ball", material = "metal", position_m = {ball}, shape = {{ type = "sphere", radius_m = {s05} }} }},
            {{ name = "lamp", material = "lamp", position_m = {lamp_at}, rotation_deg = [0, 180, 0], shape = {{ type = "quad", size_m = [{s1}, {s1}] }} }},
            {{ name = "bulb", material = "lamp", position_m = {bulb}, shape = {{ type = "sphere", radius_m = {s01} }} }},
        ]
        environment = {{ type = "uniform", radiance_w_m2_sr_nm = {sky} }}
        "#,
        eye = at([-4.0, 0.2, 1.5]),
        target = at([0.0, 0.0, 0.5]),
        floor = at([0.0, 0.0, 0.0]),
        cuboid = at([0.5, 0.8, 0.5]),
        ball = at([-0.2, -0.6, 0.5]),
        lamp_at = at([0.0, 0.0, 3.0]),
        bulb = at([-1.0, 0.6, 0.3]),
        focal = 20.0 * scale,
        focus = 4.0 * scale,
        pitch = 1000.0 * scale,
        s20 = 20.0 * scale,
        s1 = scale,
        s05 = 0.5 * scale,
        s01 = 0.1 * scale,
    ))
}

fn assert_same_picture(a: &Samples, b: &Samples, subject: &str) {
    let test = planes::compare(&a.estimate(), &b.estimate(), SIGNIFICANCE).expect("same size");
    assert_eq!(test.verdict, Verdict::Agree, "{subject}: {test:?}");
    let sum = |s: &Samples| s.mean.iter().map(|v| f64::from(*v)).sum::<f64>();
    let error = (a.variance.iter().chain(&b.variance).map(|v| f64::from(*v)).sum::<f64>()).sqrt();
    // The pictures' means, known to better than 0.5 %. Bands share their samples: the sum of variances is doubled to be safe.
    assert!((sum(a) - sum(b)).abs() < 2.0 * 3.5 * error, "{subject}: {} {} ± {error}", sum(a), sum(b));
    assert!(error < 5e-3 * sum(a), "{subject}: {error} of {}", sum(a));
}

#[test]
fn scale_and_place_do_not_change_the_picture() {
    let reference = still_life(1.0, [0.0; 3], 1.0).with_seed(1).shot().irradiance();
    let cases = [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e6), (1.0, -1e6), (1e-3, 1e3), (1e3, 1e6)];
    for (seed, (scale, offset)) in (2..).zip(cases) {
        let moved = still_life(scale, [offset, -offset, offset], 1.0).with_seed(seed).shot().irradiance();
        assert_same_picture(&reference, &moved, &format!("scale {scale}, offset {offset} m"));
    }
}

#[test]
fn pictures_are_linear_in_the_light_over_twenty_one_orders() {
    let one = still_life(1.0, [0.0; 3], 1.0).shot().irradiance();
    for level in [1e-9, 1e-3, 1e6, 1e12] {
        let other = still_life(1.0, [0.0; 3], level).shot().irradiance();
        for (a, b) in one.mean.iter().zip(&other.mean) {
            // The same samples: only f32 rounding differs, in sums of a few dozen terms a path.
            assert!((f64::from(*b) / (f64::from(*a) * level) - 1.0).abs() < 1e-5, "level {level}: {b} for {a}");
        }
        for (a, b) in one.variance.iter().zip(&other.variance) {
            // A variance is a difference of such sums: it keeps fewer digits where replicates nearly agree.
            let spread = (f64::from(*b).sqrt() / level - f64::from(*a).sqrt()).abs();
            assert!(spread < 1e-4 * f64::from(a.sqrt()) + 1e-6, "level {level}: {b} for {a}");
        }
    }
}

#[test]
fn starlight_beside_more_than_sunlight_stays_finite() {
    let text = "environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }";
    let sun = "environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1e-9 }\n[[scene.lights]]\nname = \"sun\"\ntype = \"sun\"\n\
               elevation_deg = 30\nazimuth_deg = 100\nilluminant = \"solar\"\nirradiance_w_m2 = 1e12\nangular_diameter_deg = 0.01";
    let irradiance = still_life(1.0, [0.0; 3], 1.0).replacing(text, sun).shot().irradiance();
    assert!(irradiance.mean.iter().chain(&irradiance.variance).all(|v| v.is_finite() && *v >= 0.0));
    assert!(irradiance.mean.iter().copied().fold(0.0, f32::max) > 1e6);
}

#[test]
fn no_light_is_exactly_dark() {
    let dark = still_life(1.0, [0.0; 3], 0.0).shot().irradiance();
    assert!(dark.mean.iter().chain(&dark.variance).all(|v| *v == 0.0));
}

#[test]
fn one_pixel_of_one_sample_is_a_picture() {
    let small = still_life(1.0, [0.0; 3], 1.0)
        .replacing("width_px = 16, height_px = 12", "width_px = 1, height_px = 1")
        .replacing("spp = 256", "spp = 1")
        .replacing("replicates = 16", "replicates = 1")
        .shot();
    let irradiance = small.irradiance();
    assert!(irradiance.mean.iter().all(|v| v.is_finite()), "{irradiance:?}");
    assert!(irradiance.variance.iter().all(|v| v.is_nan()), "one replicate knows no variance and says so");
}

#[test]
#[should_panic(expected = "seed")]
fn a_seed_that_no_description_may_have_is_refused_to_tests_too() {
    let text = "[scene]\n[[cameras]]\nlens = { type = \"pinhole\", focal_length_mm = 2, f_number = 8 }\n\
                sensor = { width_px = 2, height_px = 2, pixel_pitch_um = 6 }\n";
    let _ = Job::new(text).with_seed(u64::MAX).plan();
}
