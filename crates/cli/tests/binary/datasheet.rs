//! Camera files made from data sheets: consistent, incomplete and contradictory ones.

use crate::support::{CommandOutput, contents, etendue, root, text};
use std::path::PathBuf;

const SHEET: &str = "scenes/datasheets/made-up-cmos.toml";

/// The example with changed lines, and the path of its camera.
struct DataSheetJob {
    folder: tempfile::TempDir,
}

impl DataSheetJob {
    fn with(changes: &[(&str, &str)]) -> Self {
        let place = tempfile::tempdir().expect("a temporary folder");
        let mut sheet = std::fs::read_to_string(root().join(SHEET)).expect("the example");
        for (old, new) in changes {
            assert!(sheet.contains(old), "there is no {old}");
            sheet = sheet.replace(old, new);
        }
        std::fs::write(place.path().join("sheet.toml"), sheet).expect("written");
        Self { folder: place }
    }

    fn folder(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    fn run(&self) -> CommandOutput {
        etendue(["datasheet", &text(&self.folder.path().join("sheet.toml")), "-o", &text(&self.folder())])
    }

    /// Asserts that the written camera captures a frame.
    fn assert_captures_frame(&self) {
        let camera = text(&self.folder().join("sheet.toml"));
        let out = text(&self.folder.path().join("flat"));
        let small = ["--set", "sensor.width_px=8", "--set", "sensor.height_px=4"];
        etendue(
            ["flat", &camera, "--wavelength-nm", "525", "--irradiance-w-m2", "0.001", "-o", &out]
                .into_iter()
                .chain(small),
        )
        .ok();
    }
}

#[test]
fn the_example_is_consistent_and_its_camera_can_be_used() {
    let sheet = DataSheetJob::with(&[]);
    let output = sheet.run().ok();
    assert_eq!(output.err.lines().count(), 1, "only the linearity error is left out: {}", output.err);
    let files = contents(&sheet.folder());
    assert_eq!(files.keys().collect::<Vec<_>>(), ["sheet-mono.csv", "sheet.toml"]);
    let camera = String::from_utf8(files["sheet.toml"].clone()).expect("UTF-8");
    for line in
        ["full_well_e = 15000", "read_noise_e = 2.5", "gain_dn_per_e = 0.25", "prnu = 0.0062", "doubling_k = 7.5"]
    {
        assert!(camera.contains(line), "{line} is missing in\n{camera}");
    }
    sheet.assert_captures_frame();
}

#[test]
fn dark_noise_in_numbers_loses_its_quantisation() {
    let sheet = DataSheetJob::with(&[("temporal_dark_noise_e = 2.50\n", ""), ("= 0.69", "= 0.6883")]);
    sheet.run().ok();
    let files = contents(&sheet.folder());
    let camera = String::from_utf8(files["sheet.toml"].clone()).expect("UTF-8");
    let noise = camera.lines().find_map(|line| line.strip_prefix("read_noise_e = ")).expect("the key");
    // √(0.6883² − 1/12)/0.25, with four digits.
    assert!((noise.parse::<f64>().expect("a number") - 2.5).abs() < 1e-3, "{noise}");
}

#[test]
fn colour_cameras_have_a_curve_a_channel() {
    let curve = "quantum_efficiency_percent = { red = [[620, 40]], green = [[450, 10], [530, 52]], blue = [[460, 38]] }\ncfa = \"grbg\"";
    let mono = "quantum_efficiency_percent = [[400, 42], [465, 60], [525, 62], [630, 48], [850, 17], [1000, 3]]\nmeasured_at_nm = 525";
    let photons = [("saturation_capacity_p = 24194\n", ""), ("sensitivity_threshold_p = 5.25\n", "")];
    let sheet = DataSheetJob::with(&[&[(mono, curve)][..], &photons].concat());
    sheet.run().ok().says(&["warning", "\"red\" at 620 nm", "all wavelengths"]);
    let files = contents(&sheet.folder());
    assert_eq!(files.keys().collect::<Vec<_>>(), ["sheet-green.csv", "sheet.toml"]);
    sheet.assert_captures_frame();
}

#[test]
fn contradictions_are_refused_with_both_numbers() {
    let cases: [(&str, &str, &[&str]); 10] = [
        ("snr_max_db = 41.8", "snr_max_db = 48.1", &["snr_max_db", "48.1 dB", "41.76 dB", "SNR_max²"]),
        ("snr_max_bit = 6.94", "snr_max_bit = 9.46", &["snr_max_bit", "9.46 bit", "6.936 bit"]),
        ("dynamic_range_db = 73.3", "dynamic_range_db = 75.6", &["dynamic_range_db", "75.6 dB", "73.27 dB"]),
        ("threshold_e = 3.25", "threshold_e = 2.5", &["sensitivity_threshold_e", "2.5 e⁻", "3.254 e⁻"]),
        ("threshold_p = 5.25", "threshold_p = 6.5", &["sensitivity_threshold_p", "6.5 photons", "5.248 photons"]),
        ("per_dn = 4.0", "per_dn = 3.5", &["inverse_gain_e_per_dn", "3.5 e⁻/DN", "4.000 e⁻/DN"]),
        ("noise_dn = 0.69", "noise_dn = 0.95", &["temporal_dark_noise_dn", "0.95 DN", "0.688 DN"]),
        ("bits = 12", "bits = 10", &["saturation_capacity_e", "3750.0 DN", "largest number of 10 bits is 1023 DN"]),
        ("measured_at_nm = 525\n", "", &["saturation_capacity_p", "measured_at_nm"]),
        ("[525, 62]", "[465, 62]", &["quantum_efficiency_percent", "465 nm follows 465 nm"]),
    ];
    for (old, new, phrases) in cases {
        let sheet = DataSheetJob::with(&[(old, new)]);
        let output = sheet.run().refused(&[&["sheet.toml:"][..], phrases].concat());
        assert!(!sheet.folder().exists(), "{}", output.err);
    }
}

#[test]
fn small_differences_are_reported_and_accepted() {
    let sheet = DataSheetJob::with(&[("snr_max_db = 41.8", "snr_max_db = 42.1")]);
    sheet.run().ok().says(&["warning", "snr_max_db", "42.1 dB", "41.76 dB"]);
}

/// Many sheets state the wavelength without a value in photons.
#[test]
fn a_wavelength_that_nothing_needs_is_a_warning() {
    let sheet =
        DataSheetJob::with(&[("saturation_capacity_p = 24194\n", ""), ("sensitivity_threshold_p = 5.25\n", "")]);
    sheet.run().ok().says(&["warning", "\"measured_at_nm\" is not used", "saturation_capacity_p"]);
}

#[test]
fn nonsense_is_refused() {
    let less = DataSheetJob::with(&[("temporal_dark_noise_e = 2.50\n", ""), ("noise_dn = 0.69", "noise_dn = 0.2")]);
    less.run().refused(&["sheet.toml:", "temporal_dark_noise_dn", "0.2 DN", "0.289 DN"]);
    let none = DataSheetJob::with(&[("gain_dn_per_e = 0.25\n", ""), ("inverse_gain_e_per_dn = 4.0\n", "")]);
    none.run().refused(&["gain_dn_per_e", "both missing"]);
    DataSheetJob::with(&[("dark_current_e_s = 12\n", "")]).run().refused(&["dark_current_at_c", "no effect"]);
    DataSheetJob::with(&[("dsnu_e", "dsnu")]).run().refused(&["dsnu", "dsnu_e"]);
}
