//! Seeded photometric defects: fall-off, tone curve.

use super::{CAMERA, ComparedQuantities, TestFolder, assert_flagged, assert_none_flagged};
use crate::support::{etendue, text};
use etendue_core::maths::f64::{atan, cos, pow};
use std::path::Path;

/// Principal distance of 2.4 mm focused at 10 m, mm.
const PRINCIPAL_MM: f64 = 2.4 * 10_000.0 / (10_000.0 - 2.4);

/// Radius of the pupil of f/2, mm.
const PUPIL_MM: f64 = 0.6;

/// Fraction of the irradiance of a hemisphere behind a disc of uniform radiance (Foote 1915): as cos⁴ θ except for the pupil's size.
fn behind_a_disc(radius_mm: f64) -> f64 {
    let (d2, p2, r2) = (PRINCIPAL_MM * PRINCIPAL_MM, PUPIL_MM * PUPIL_MM, radius_mm * radius_mm);
    let all = d2 + p2 + r2;
    0.5 * (1.0 + (p2 - d2 - r2) / (all * all - 4.0 * p2 * r2).sqrt())
}

/// The camera without distortion, which also spreads light; its fall-off is stated, over a power of the cosine.
fn fall_off(test_folder: &TestFolder, chart: &Path, over: f64) -> ComparedQuantities {
    let radii: Vec<f64> = (0..=90).map(|i| 0.025 * f64::from(i)).collect();
    let ratios: Vec<f64> =
        radii.iter().map(|r| behind_a_disc(*r) / behind_a_disc(0.0) / pow(cos(atan(r / PRINCIPAL_MM)), over)).collect();
    let lens = format!(
        "cameras.camera.lens={{ type = \"calibrated\", f_number = 2, focus_distance_m = 10, projection = {{ type = \"opencv\", \
         focal_length_mm = {PRINCIPAL_MM} }}, relative_illumination = {{ radius_mm = {radii:?}, ratio = {ratios:?} }} }}"
    );
    let options = ["--set", "render.spp=16", "--seed", "2", "--set", &lens];
    let folder = test_folder.rendered(chart, &format!("over-{over}"), &options);
    let straight = ["--set", "lens.distortion.k1=0", "--set", "lens.distortion.k2=0"];
    test_folder.compare_with_declaration(&["vignetting", &text(&folder.join("raw.0000.png"))], CAMERA, &straight)
}

#[test]
fn a_fall_off_by_the_third_power_of_the_cosine_is_flagged() {
    let folder = TestFolder::new();
    let chart = folder.chart("flat-field", CAMERA, &[]);
    let [healthy, defective] = [0.0, 1.0].map(|over| fall_off(&folder, &chart, over));
    assert_none_flagged(&healthy);
    let seeded = "`lens.relative_illumination`: the file's fall-off divided by cos θ";
    assert_flagged("cos⁴ exponent 3", seeded, "corner_percent", &defective, &healthy);
    assert!(defective["profile"].differs(), "{defective:?}");
}

/// Uniform illumination of the bare sensor, developed, at exposures from a fiftieth of saturation up to nine tenths.
#[test]
fn a_power_for_the_tone_curve_of_srgb_is_flagged() {
    let folder = TestFolder::new();
    let exposures = [2e-5, 5e-5, 1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4, 7e-4, 8e-4, 9e-4];
    let exposure_list = exposures.map(|s| s.to_string()).join(",");
    // Smear brightens in proportion to the number of rows.
    let small = ["--set", "sensor.width_px=96", "--set", "sensor.height_px=64", "--set", "isp.picture_bits=16"];
    let measured = |name: &str, changes: &[&str]| {
        let image = |exposure_s: f64| {
            let (output, exposure) =
                (text(&folder.path(&format!("{name}-{exposure_s}"))), format!("sensor.exposure_s={exposure_s}"));
            let light = ["--wavelength-nm", "550", "--irradiance-w-m2", "0.23", "--seed", "1"];
            let run = [&["flat", CAMERA, "-o", &output, "--set", &exposure][..], &light, &small, changes].concat();
            etendue(run).ok();
            format!("{output}/camera/picture.0000.png")
        };
        let images = exposures.map(image);
        let mut measure = vec!["oecf"];
        measure.extend(images.iter().map(String::as_str));
        measure.extend(["--exposures", &exposure_list, "--channel", "G"]);
        folder.compare_with_declaration(&measure, CAMERA, &small)
    };
    let healthy = measured("healthy", &[]);
    assert_none_flagged(&healthy);
    let defective = measured("gamma", &["--set", "isp.tone_curve={ gamma = 2.2 }"]);
    assert_flagged("gamma 2.2 for sRGB", "`isp.tone_curve` gamma 2.2 for srgb", "points", &defective, &healthy);
}
