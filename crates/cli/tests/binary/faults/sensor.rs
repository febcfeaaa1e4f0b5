//! Seeded defects of the sensor: gain, noise, patterns, filters, dark current.

use super::{CAMERA, COLOUR, ComparedQuantities, TestFolder, assert_flagged, assert_none_flagged};
use crate::support::{etendue, text};

const SMALL: [&str; 4] = ["--set", "sensor.width_px=240", "--set", "sensor.height_px=180"];

/// The photon-transfer series of a camera at a wavelength: its descriptor.
fn series(test_folder: &TestFolder, camera: &str, name: &str, nm: &str, options: &[&str]) -> String {
    let folder = test_folder.path(name);
    let output = text(&folder);
    etendue([&["flat", camera, "--wavelength-nm", nm, "-o", &output], options].concat()).ok();
    let stem = std::path::Path::new(camera).file_stem().expect("a file");
    text(&folder.join(stem).join("emva1288.txt"))
}

#[test]
fn faults_of_gain_noise_and_pattern_are_flagged() {
    let folder = TestFolder::new();
    let measured = |name: &str, changes: &[&str]| {
        let levels = ["--photon-transfer", "15", "--stack", "16", "--seed", "1"];
        let descriptor = series(&folder, CAMERA, name, "550", &[&SMALL[..], &levels, changes].concat());
        folder.compare_with_declaration(&["ptc", &descriptor], CAMERA, &["--wavelength-nm", "550"])
    };
    let healthy = measured("healthy", &[]);
    assert_none_flagged(&healthy);
    let flags = |defect: &str, key: &str, set: &str, declared: &str, quantity: &str| {
        let defective = measured(&defect.replace(' ', "-"), &["--set", &format!("{key}={set}")]);
        assert_flagged(defect, &format!("`{key}` {set} for {declared}"), quantity, &defective, &healthy);
    };
    flags("gain + 2 %", "sensor.gain_dn_per_e", "0.204", "0.2", "gain_dn_per_e");
    flags("read noise + 10 %", "sensor.read_noise_e", "11", "10", "dark_noise_e");
    flags("PRNU doubled", "sensor.non_uniformity.prnu", "0.016", "0.008", "prnu_percent_pixel");
}

/// Blue pixels are at the positions declared as red, so the measured quantum efficiency is that of another colour. Red light is used, of which green
/// pixels smear little into the red ones of their columns.
#[test]
fn a_swapped_phase_of_the_filters_is_flagged() {
    let folder = TestFolder::new();
    let measured = |name: &str, changes: &[&str]| -> ComparedQuantities {
        let levels = ["--photon-transfer", "12", "--stack", "3", "--seed", "1"];
        let descriptor = series(&folder, COLOUR, name, "600", &[&SMALL[..], &levels, changes].concat());
        // The list of levels does not state the filters: the declared ones count.
        let declared = ["ptc", &descriptor, "--cfa", "RGGB", "--channel", "R"];
        folder.compare_with_declaration(&declared, COLOUR, &["--wavelength-nm", "600"])
    };
    let healthy = measured("healthy", &[]);
    assert_none_flagged(&healthy);
    let defective = measured("swapped", &["--set", "sensor.cfa=\"bggr\""]);
    assert_flagged("Bayer phase swapped", "`sensor.cfa` bggr for rggb", "quantum_efficiency", &defective, &healthy);
}

/// The declared law is a doubling every 8 K.
#[test]
fn a_swapped_law_of_the_dark_current_is_flagged() {
    let test_folder = TestFolder::new();
    let law = ["--set", "sensor.dark.reference_c=25", "--set", "sensor.dark.doubling_k=8"];
    let declared = [&law[..], &["--set", "sensor.dark.temperature_c=25"]].concat();
    let measured = |name: &str, law: &[&str]| {
        let at = |celsius: &str| {
            let warm = format!("sensor.dark.temperature_c={celsius}");
            let long = ["--set", "sensor.exposure_s=40", "--set", "sensor.frame_period_s=50"];
            let levels = ["--photon-transfer", "8", "--stack", "3", "--set", &warm];
            let small = ["--set", "sensor.width_px=96", "--set", "sensor.height_px=64"];
            let folder = format!("{name}-{celsius}");
            format!(
                "{celsius}:{}",
                series(&test_folder, CAMERA, &folder, "550", &[&small[..], &long, &levels, law].concat())
            )
        };
        let [a, b, c, d] = ["25", "35", "45", "55"].map(at);
        test_folder.compare_with_declaration(
            &["dark-current", &a, &b, &c, &d, "--reference-c", "25"],
            CAMERA,
            &declared,
        )
    };
    let healthy = measured("healthy", &law);
    assert_none_flagged(&healthy);
    let defective = measured("swapped", &["--set", "sensor.dark.reference_c=25"]);
    let seeded = "silicon's band gap for `sensor.dark.doubling_k` 8";
    assert_flagged("dark current law swapped", seeded, "temperatures", &defective, &healthy);
    assert!(defective["doubling_doubling_k"].differs(), "{defective:?}");
}
