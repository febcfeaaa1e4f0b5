//! Sources of an image's encoding for measurements: options, side-car, chunks of the file, assumption.

use crate::support::{CommandOutput, etendue, text};
use etendue_core::Plane;
use etendue_core::maths::f64::{log10, pow};
use etendue_core::quantity::{DigitalNumber, Display};
use etendue_io::photograph::Encoding;
use etendue_io::png::{encode_companded16, encode_display};
use etendue_spectra::colour::encode;
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// Light of an edge over square pixels, turned by about 5°: dark 0.1, bright 0.8.
fn light(i: usize) -> f32 {
    let (x, y) = ((i % 80) as f32, (i / 80) as f32);
    0.1 + 0.7 * (x - 39.0 - 0.0875 * (y - 39.5)).clamp(0.0, 1.0)
}

struct TestImages {
    folder: TempDir,
}

impl TestImages {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    fn write(&self, name: &str, bytes: &[u8]) -> String {
        let file = self.folder.path().join(name);
        std::fs::write(&file, bytes).expect("written");
        text(&file)
    }

    /// A 16-bit grey image whose file states no encoding.
    fn grey(&self, name: &str, number: impl Fn(f32) -> f32) -> String {
        let samples = (0..80 * 80).map(|i| (65_535.0 * number(light(i))).round() as u32).collect();
        let plane = Plane::<DigitalNumber>::from_samples(80, 80, samples).expect("a square");
        self.write(name, &encode_companded16(&plane).expect("a picture"))
    }

    /// An 8-bit image whose file states its encoding.
    fn image_with_encoding(&self, name: &str, encoding: &Encoding, number: impl Fn(f32) -> f32) -> String {
        let plane = Plane::<Display>::from_samples(80, 80, (0..80 * 80).map(|i| [number(light(i)); 3]).collect());
        self.write(name, &encode_display(&plane.expect("a square"), encoding).expect("a picture"))
    }
}

fn sfr(image: &str, options: &[&str]) -> CommandOutput {
    etendue(["measure", "sfr", image].into_iter().chain(options.iter().copied()))
}

/// Frequency of half response, and the encoding used with its reason.
fn measured_encoding(image: &str, options: &[&str]) -> (f64, String, String) {
    let report: Value = serde_json::from_str(&sfr(image, &[options, &["--json"]].concat()).ok().out).expect("JSON");
    let mtf50 = report["tables"]["edges"][0]["mtf50_cycles_per_px"]["value"].as_f64();
    let words = |key: &str| report["encodings"][0][key].as_str().unwrap_or_default().to_owned();
    (mtf50.unwrap_or_else(|| panic!("no MTF50 in {report}")), words("encoding"), words("reason"))
}

#[test]
fn pictures_of_any_encoding_give_one_response() {
    let images = TestImages::new();
    let (linear, as_is) = (Encoding::Linear, |l: f32| l);
    let (truth, encoding, reason) = measured_encoding(&images.grey("linear.png", as_is), &[]);
    assert!(encoding == "linear" && reason.starts_with("assumed") && reason.contains("--encoding"), "{reason}");
    let same = |image: &str, options: &[&str], encoding: &str, phrase: &str| {
        let (mtf50, mode, reason) = measured_encoding(image, options);
        assert!((mtf50 - truth).abs() < 0.003, "{image} {options:?}: {mtf50} for {truth}");
        assert!(mode == encoding && reason.contains(phrase), "{image} {options:?}: {mode}, {reason}");
    };
    same(&images.grey("srgb.png", encode), &["--encoding", "srgb"], "sRGB", "--encoding");
    same(&images.image_with_encoding("linear8.png", &linear, as_is), &[], "linear", "gAMA chunk");
    same(&images.image_with_encoding("srgb8.png", &Encoding::Srgb, encode), &[], "sRGB", "sRGB chunk");
    same(
        &images.image_with_encoding("gamma8.png", &Encoding::Gamma(1.8), |l| pow(f64::from(l), 1.0 / 1.8) as f32),
        &[],
        "gamma 1.8",
        "gAMA",
    );
    same(
        &images.image_with_encoding("lying.png", &Encoding::Srgb, as_is),
        &["--encoding", "linear"],
        "linear",
        "--encoding",
    );
    let table = images.write("curve.csv", b"light, number\n0, 0\n0.2, 0.5\n1, 1\n");
    let bent = |l: f32| if l < 0.2 { 2.5 * l } else { 0.5 + 0.625 * (l - 0.2) };
    same(&images.grey("bent.png", bent), &["--encoding", &table], "tone curve of 3 points", "curve.csv");
    // A measured function: linear in the logarithm of the exposure, in the image's own numbers.
    let oecf = images.write("oecf.csv", b"# cd/m2, DN\n1 6553.5\n100 58981.5\n");
    let log = |l: f32| 0.1 + 0.4 * log10(100.0 * f64::from(l)) as f32;
    same(&images.grey("log.png", log), &["--encoding", &oecf], "OECF of 2 points", "oecf.csv");
}

#[test]
fn a_side_car_goes_before_what_the_file_says_and_options_before_both() {
    let images = TestImages::new();
    let (truth, ..) = measured_encoding(&images.grey("linear.png", |l| l), &[]);
    let image = images.image_with_encoding("picture.0000.png", &Encoding::Srgb, |l| l);
    let sidecar = |encoding: &str| {
        let sidecar_text =
            format!(r#"{{"program": "etendue", "files": {{"picture.0000.png": {{"encoding": {encoding}}}}}}}"#);
        images.write("develop.json", sidecar_text.as_bytes());
    };
    sidecar("\"linear\"");
    let (mtf50, encoding, reason) = measured_encoding(&image, &[]);
    assert!((mtf50 - truth).abs() < 0.003 && encoding == "linear" && reason == "develop.json next to it", "{reason}");
    let (wrong, _, reason) = measured_encoding(&image, &["--encoding", "srgb"]);
    assert!((wrong - truth).abs() > 0.02 && reason == "--encoding", "{wrong} {truth} {reason}");
    sidecar("\"sepia\"");
    sfr(&image, &[]).refused(&["develop.json", "unknown encoding of picture.0000.png"]);
}

#[test]
fn tables_and_words_that_are_no_encoding_are_refused() {
    let images = TestImages::new();
    let image = images.grey("a.png", |l| l);
    sfr(&image, &["--encoding", "gamma"]).refused(&["--encoding", "linear, srgb or a table"]);
    sfr(&image, &["--encoding", "none.csv"]).refused(&["none.csv"]);
    let falling = images.write("falling.csv", b"0, 0\n0.5, 0.9\n1, 0.8\n");
    sfr(&image, &["--encoding", &falling]).refused(&["a.png", "falling.csv", "outputs must not decrease"]);
    let wide = images.write("wide.csv", b"0, 0, 1\n1, 1, 1\n");
    sfr(&image, &["--encoding", &wide]).refused(&["wide.csv", "number of columns is 3", "expected two"]);
}

/// Photon transfer measures linear numbers: a frame that states an encoding is refused.
#[test]
fn frames_that_say_they_are_encoded_are_no_raws() {
    let stacks = crate::support::root().join("tests/oracles/figures/emva1288");
    let stored = std::fs::read_to_string(stacks.join("EMVA1288descriptor.txt")).expect("a descriptor");
    let stored = stored.replace("images\\", &(text(&stacks.join("images")) + "/"));
    let images = TestImages::new();
    let descriptor = images.write("descriptor.txt", stored.as_bytes());
    let ptc = |options: &[&str]| etendue(["measure", "ptc", &descriptor].into_iter().chain(options.iter().copied()));
    let report = ptc(&[]).ok().out;
    assert!(report.contains("encoding: linear (raw numbers are measured as stored)"), "{report}");
    ptc(&["--encoding", "linear"]).ok();
    ptc(&["--encoding", "srgb"]).refused(&["sRGB numbers (--encoding)", "proportional to charge", "leave it out"]);
    assert!(Path::new(&descriptor).is_file());
}
