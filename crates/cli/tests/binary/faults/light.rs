//! Faults of light: fall-off, tone curve.

use super::{Bench, CAMERA, Compared, flagged, sound};
use crate::support::{etendue, text};
use etendue_core::maths::f64::{atan, cos, pow};
use std::path::Path;

/// Principal distance of 2.4 mm focused at 10 m, mm.
const PRINCIPAL_MM: f64 = 2.4 * 10_000.0 / (10_000.0 - 2.4);

/// The camera without distortion, which spreads light as well.
const STRAIGHT: [&str; 4] = ["--set", "lens.distortion.k1=0", "--set", "lens.distortion.k2=0"];

fn vignetting(bench: &Bench, folder: &Path) -> Compared {
    bench.beside(&["vignetting", &text(&folder.join("raw.0000.png"))], CAMERA, &STRAIGHT)
}

#[test]
fn a_fall_off_by_the_third_power_of_the_cosine_is_flagged() {
    let bench = Bench::new();
    let chart = bench.chart("flat-field", CAMERA, &[]);
    let render = |name: &str, fault: &[&str]| {
        let options = [&["--set", "render.spp=16", "--seed", "2"], fault].concat();
        bench.rendered(&chart, name, &options)
    };
    let straight = ["cameras.camera.lens.distortion.k1=0", "cameras.camera.lens.distortion.k2=0"];
    let healthy = vignetting(&bench, &render("healthy", &["--set", straight[0], "--set", straight[1]]));
    sound(&healthy);
    let radii: Vec<f64> = (0..=45).map(|i| 0.05 * f64::from(i)).collect();
    let cubes: Vec<f64> = radii.iter().map(|r| pow(cos(atan(r / PRINCIPAL_MM)), 3.0)).collect();
    let lens = format!(
        "cameras.camera.lens={{ model = \"calibrated\", f_number = 2, focus_distance_m = 10, projection = {{ type = \"opencv\", \
         focal_length_mm = {PRINCIPAL_MM} }}, relative_illumination = {{ radius_mm = {radii:?}, ratio = {cubes:?} }} }}"
    );
    let faulty = vignetting(&bench, &render("cubes", &["--set", &lens]));
    flagged("cos⁴ exponent 3", "`lens.relative_illumination` cos³ θ", "corner_percent", &faulty, &healthy);
    assert!(faulty["profile"].differs(), "{faulty:?}");
}

/// Even light on the bare sensor, developed, at exposures from a fiftieth of saturation up to nine tenths.
#[test]
fn a_power_for_the_tone_curve_of_srgb_is_flagged() {
    let bench = Bench::new();
    let exposures = [2e-5, 5e-5, 1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4, 7e-4, 8e-4, 9e-4];
    let told = exposures.map(|s| s.to_string()).join(",");
    // As bright by smear as its rows are many.
    let small = ["--set", "sensor.width_px=96", "--set", "sensor.height_px=64", "--set", "processing.picture_bits=16"];
    let measured = |name: &str, fault: &[&str]| {
        let picture = |exposure_s: f64| {
            let (output, exposure) =
                (text(&bench.path(&format!("{name}-{exposure_s}"))), format!("sensor.exposure_s={exposure_s}"));
            let light = ["--wavelength-nm", "550", "--irradiance-w-m2", "0.23", "--seed", "1"];
            let run = [&["flat", CAMERA, "-o", &output, "--set", &exposure][..], &light, &small, fault].concat();
            etendue(run).ok();
            format!("{output}/camera/picture.0000.png")
        };
        let pictures = exposures.map(picture);
        let mut measure = vec!["oecf"];
        measure.extend(pictures.iter().map(String::as_str));
        measure.extend(["--exposures", &told, "--channel", "G"]);
        bench.beside(&measure, CAMERA, &small)
    };
    let healthy = measured("healthy", &[]);
    sound(&healthy);
    let faulty = measured("gamma", &["--set", "processing.tone_curve={ gamma = 2.2 }"]);
    flagged("gamma 2.2 for sRGB", "`processing.tone_curve` gamma 2.2 for srgb", "points", &faulty, &healthy);
}
