//! Cameras from laboratory folders: rendered ones with a known camera, OpenCV's photographs, and unusable folders.

use crate::support::{CommandOutput, etendue, root, text};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A small laboratory of the monochrome reference camera, with its barrel distortion: the field of the large one in pixels of four times the pitch.
const SMALL: [&str; 6] = [
    "sensor.width_px=194",
    "sensor.height_px=146",
    "sensor.pixel_pitch_um=33.2",
    // Pixels with the large camera's charge.
    "sensor.exposure_s=1e-3",
    "sensor.optical_black=null",
    "sensor.smear=null",
];

/// The folder, made once for all tests.
fn laboratory() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("laboratory");
        let _ = std::fs::remove_dir_all(&folder);
        render_laboratory("charts/ccd-mono/camera.toml", &SMALL, &folder);
        folder
    })
}

fn render_laboratory(camera: &str, set: &[&str], folder: &Path) {
    let to = text(folder);
    let sizes = ["--levels", "8", "--stack", "8", "--views", "5", "--spp", "16"];
    let set = set.iter().flat_map(|change| ["--set", change]);
    etendue(["laboratory", camera, "-o", &to].into_iter().chain(sizes).chain(set)).ok();
}

/// A copy of some of its folders.
fn part(kinds: &[&str]) -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a temporary folder");
    for kind in kinds {
        copy(&laboratory().join(kind), &place.path().join(kind));
    }
    std::fs::copy(laboratory().join("laboratory.toml"), place.path().join("laboratory.toml")).expect("copied");
    place
}

fn copy(from: &Path, to: &Path) {
    if from.is_dir() {
        std::fs::create_dir_all(to).expect("a folder");
        for entry in std::fs::read_dir(from).expect("a folder") {
            let entry = entry.expect("an entry");
            copy(&entry.path(), &to.join(entry.file_name()));
        }
    } else {
        std::fs::copy(from, to).expect("copied");
    }
}

fn characterised(folder: &Path, options: &[&str]) -> (CommandOutput, tempfile::TempDir) {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (folder, to) = (text(folder), text(&place.path().join("found.toml")));
    let output = etendue(["characterise", &folder, "-o", &to].into_iter().chain(options.iter().copied()));
    (output, place)
}

fn json(place: &tempfile::TempDir) -> Value {
    let text = std::fs::read_to_string(place.path().join("found.json")).expect("a report");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_rendered_laboratory_gives_its_camera_back() {
    let (output, place) = characterised(laboratory(), &[]);
    output.ok();
    let report = json(&place);
    let parameters = &report["parameters"];
    // Values of the camera file, the principal distance of a lens of 8 mm focused at 10 m; four standard uncertainties, of 21 numbers with this seed.
    let fx = 8.0 * 10.0 / (10.0 - 0.008) / 0.0332;
    for (key, declared) in [
        ("sensor.gain_dn_per_e", 0.2),
        ("sensor.read_noise_e", 10.0),
        ("sensor.dark_current_e_s", 5.0),
        ("sensor.quantum_efficiency.mono", 0.45),
        ("sensor.non_uniformity.prnu", 0.008),
        ("sensor.non_uniformity.prnu_row", 0.0),
        ("sensor.non_uniformity.dsnu_e", 1.0),
        ("sensor.non_uniformity.dsnu_column_e", 0.0),
        ("lens.projection.fx_px", fx),
        ("lens.projection.cx_px", 97.0),
        ("lens.projection.cy_px", 73.0),
        ("lens.projection.k1", -0.1),
        ("effects.psf.variance_horizontal_px2", 0.0),
        ("effects.psf.variance_vertical_px2", 0.0),
        ("sensor.crosstalk.horizontal", 0.0),
        ("sensor.crosstalk.vertical", 0.0),
    ] {
        let (value, u) = (&parameters[key]["value"], &parameters[key]["standard_uncertainty"]);
        let (value, u) = (value.as_f64().expect(key), u.as_f64().expect(key));
        assert!((value - declared).abs() <= 4.0 * u, "{key}: {value} ± {u}, declared {declared}");
    }
    let u = |key: &str| parameters[key]["standard_uncertainty"].as_f64().expect(key);
    assert!(u("lens.projection.fx_px") < 0.005 * fx && u("sensor.gain_dn_per_e") < 0.01, "{parameters:#}");
    assert_eq!(report["stand_ins"].as_array().map(Vec::len), Some(0), "{report:#}");
    let not_known = report["not_known"].to_string();
    assert!(not_known.contains("hot pixels") && not_known.contains("one wavelength"), "{not_known}");
    page_is_whole(&place);
    // The file is a valid camera.
    let camera = text(&place.path().join("found.toml"));
    let lens = etendue(["measure", "lens", &camera, "--json"]).ok().out;
    let lens: Value = serde_json::from_str(&lens).expect("JSON");
    assert!(lens.is_object());
    let repeated = etendue(["characterise", &text(laboratory()), "-o", &camera]);
    repeated.refused(&["found.toml", "already"]);
}

/// The views of a mosaic are measured raw, and its colours by their filters.
#[test]
fn a_camera_in_colour_is_given_back_from_raw_mosaics() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let lab = place.path().join("laboratory");
    render_laboratory(
        "charts/web/camera.toml",
        &["sensor.width_px=240", "sensor.height_px=192", "sensor.pixel_pitch_um=19.2"],
        &lab,
    );
    let (output, place) = characterised(&lab, &[]);
    output.ok();
    let report = json(&place);
    let parameters = &report["parameters"];
    // Values of the camera file, the principal distance of a lens of 4 mm focused at 2 m; four standard uncertainties, of 7 numbers with this seed.
    let fx = 4.0 * 2.0 / (2.0 - 0.004) / 0.0192;
    for (key, declared, tolerance) in [
        ("lens.projection.fx_px", fx, 0.5),
        ("lens.projection.cx_px", 120.0, 0.2),
        ("lens.projection.cy_px", 96.0, 0.2),
        ("lens.projection.k1", -0.1, 0.01),
        ("lens.projection.k2", 0.02, 0.01),
        ("sensor.gain_dn_per_e", 0.106, 0.01),
        ("sensor.quantum_efficiency.green", 0.240_69, 0.01),
    ] {
        let (value, u) = (&parameters[key]["value"], &parameters[key]["standard_uncertainty"]);
        let (value, u) = (value.as_f64().expect(key), u.as_f64().expect(key));
        assert!((value - declared).abs() <= 4.0 * u && u < tolerance, "{key}: {value} ± {u}, declared {declared}");
    }
    assert!(parameters["isp.colour_matrix.green.green"]["value"].as_f64().is_some_and(|v| v > 1.0), "{parameters:#}");
}

/// One file with every part, without references to other files.
fn page_is_whole(place: &tempfile::TempDir) {
    let page = std::fs::read_to_string(place.path().join("found.html")).expect("a page");
    for part in [
        "Parameters",
        "Not known",
        "Photon transfer",
        "Fall-off",
        "Projection and distortion",
        "Response",
        "Camera file",
    ] {
        assert!(page.contains(part), "{part} is missing");
    }
    assert!(page.matches("<svg").count() >= 4);
    assert!(
        !page.contains("<script") && !page.contains("<link") && !page.contains("src=") && !page.contains("@import")
    );
}

#[test]
fn missing_data_is_reported_and_omitted_or_taken_from_a_base() {
    let some = part(&["dark", "flat"]);
    let (output, place) = characterised(some.path(), &[]);
    output.ok().says(&["not known: focal length", "no images in chart/"]);
    let report = json(&place);
    assert!(
        report["parameters"]["sensor.gain_dn_per_e"].is_object()
            && report["parameters"]["lens.projection.fx_px"].is_null()
    );
    assert!(report["stand_ins"].to_string().contains("lens.f_number"), "{report:#}");
    let camera_text = std::fs::read_to_string(place.path().join("found.toml")).expect("a camera file");
    assert!(
        camera_text.contains("f_number = 4") && camera_text.contains("a placeholder: not measured"),
        "{camera_text}"
    );
    let amplified = text(&root().join("scenes/cameras/web-night.toml"));
    let (output, _) = characterised(some.path(), &["--base", &amplified]);
    output.refused(&["web-night.toml", "sensor.analogue_gain", "which already includes it"]);
    let base = text(&root().join("scenes/cameras/ccd-mono.toml"));
    let (output, place) = characterised(some.path(), &["--base", &base]);
    output.ok();
    let merged_text = std::fs::read_to_string(place.path().join("found.toml")).expect("a camera file");
    assert!(
        !merged_text.contains("placeholder") && !merged_text.contains("[lens]") && merged_text.contains("base = "),
        "{merged_text}"
    );
    etendue(["measure", "lens", &text(&place.path().join("found.toml"))]).ok();
}

/// The first file with an extension in a folder.
fn first(folder: &Path, ending: &str) -> PathBuf {
    let mut files: Vec<PathBuf> = walk(folder);
    files.sort();
    files.into_iter().find(|file| text(file).ends_with(ending)).expect("such a file")
}

fn walk(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] }).collect()
}

#[test]
fn folders_that_cannot_be_used_are_refused() {
    let lab = part(&["dark", "flat"]);
    let (flat, dark) = (lab.path().join("flat"), lab.path().join("dark"));
    let frame = first(&flat, "raw.0000.png");
    let assert_refused = |phrases: &[&str]| {
        let (output, place) = characterised(lab.path(), &[]);
        output.refused(phrases);
        assert_eq!(std::fs::read_dir(place.path()).expect("a folder").count(), 0, "nothing is written");
    };
    // A copy under another name.
    let copied = frame.with_file_name("raw.0900.png");
    std::fs::copy(&frame, &copied).expect("copied");
    assert_refused(&["raw.0900.png", "copy of", "raw.0000.png"]);
    std::fs::remove_file(&copied).expect("removed");
    // Another camera.
    let other = root().join("tests/oracles/figures/checkerboard/left05.jpg");
    std::fs::copy(other, dark.join("other.jpg")).expect("copied");
    assert_refused(&["other.jpg", "camera or setting differs", "640 × 480 pixels", "194 × 146 pixels"]);
    std::fs::remove_file(dark.join("other.jpg")).expect("removed");
    // A truncated file.
    let bytes = std::fs::read(&frame).expect("a picture");
    std::fs::write(&frame, &bytes[..bytes.len() / 2]).expect("written");
    assert_refused(&["raw.0000.png"]);
    std::fs::write(&frame, &bytes).expect("written");
    // A key without effect, and an unknown key.
    let file = lab.path().join("laboratory.toml");
    let stated = std::fs::read_to_string(&file).expect("text");
    std::fs::write(&file, format!("{stated}\n[chart]\npitch_mm = 30\n")).expect("written");
    assert_refused(&["laboratory.toml", "[chart] has no effect without a folder chart/"]);
    std::fs::write(&file, "format = 1\npixel_pich_um = 3\n").expect("written");
    assert_refused(&["laboratory.toml:2", "pixel_pich_um", "pixel_pitch_um"]);
    std::fs::write(&file, &stated).expect("written");
    // Flats at ten times saturation.
    std::fs::remove_dir_all(&flat).expect("removed");
    let camera = text(&laboratory().join("declared.toml"));
    for (name, exposure) in [("a", "sensor.exposure_s=0.0005"), ("b", "sensor.exposure_s=0.001")] {
        let to = text(&flat.join(name));
        let light = [
            "--wavelength-nm",
            "550",
            "--photons",
            "500000",
            "--frames",
            "0..2",
            "--set",
            exposure,
            "--set",
            "isp=null",
        ];
        etendue(["flat", &camera, "-o", &to].into_iter().chain(light)).ok();
    }
    assert_refused(&["flat/: 4 of 4 frames are saturated", "reduce the exposure"]);
    let empty = tempfile::tempdir().expect("a temporary folder");
    characterised(empty.path(), &[])
        .0
        .refused(&["contains no images to characterise a camera", "dark/ (frames without light)"]);
    characterised(&empty.path().join("lost"), &[]).0.refused(&["lost", "folder not found"]);
}

/// OpenCV's own photographs of its checkerboard: they determine a calibration, and nothing else.
#[test]
fn photographs_of_a_checkerboard_give_a_calibration_and_no_more() {
    let captures = root().join("tests/oracles/figures/checkerboard");
    let lab = tempfile::tempdir().expect("a temporary folder");
    let chart = lab.path().join("chart");
    std::fs::create_dir(&chart).expect("a folder");
    for i in (1..=14).filter(|i| *i != 10) {
        let name = format!("left{i:02}.jpg");
        std::fs::copy(captures.join(&name), chart.join(&name)).expect("copied");
    }
    std::fs::write(lab.path().join("laboratory.toml"), "format = 1\n[chart]\npitch_mm = 30\ngrid = [9, 6]\n")
        .expect("written");
    let (output, place) = characterised(lab.path(), &[]);
    output.ok().says(&["not known: gain", "no images in dark/"]);
    let report = json(&place);
    // OpenCV's calibration of the same photographs by its own corners (docs/measurements.md, k1 k2 p1 p2 k3): 532.8, 342.5 + 0.5, with an uncertainty
    // of 0.5.
    for (key, opencv, within) in [("fx_px", 532.83, 3.0), ("cx_px", 342.99, 3.0), ("cy_px", 234.2, 3.0)] {
        let value = report["parameters"][format!("lens.projection.{key}")]["value"].as_f64().expect(key);
        assert!((value - opencv).abs() < within, "{key}: {value}");
    }
    let known: Vec<&String> = report["parameters"].as_object().expect("parameters").keys().collect();
    assert!(known.iter().all(|key| key.starts_with("lens.projection.")), "{known:?}");
    for what in ["gain", "relative illumination", "point spread", "white balance", "colour matrix"] {
        assert!(report["not_known"].to_string().contains(what), "{what}: {report:#}");
    }
    let camera = std::fs::read_to_string(place.path().join("found.toml")).expect("a camera file");
    assert!(!camera.contains("gain_dn_per_e") && camera.contains("pixel_pitch_um = 5"), "{camera}");
}
