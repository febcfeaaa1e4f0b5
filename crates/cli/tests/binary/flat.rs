//! Uniform illumination of bare sensors from the command line.

use crate::support::{CommandOutput, contents, etendue, text};
use etendue_io::exr::{ExrSamples, read_exr};
use etendue_io::picture::read_image;
use etendue_scene::asset::ImagePixels;
use std::collections::BTreeMap;
use std::path::PathBuf;

const WEB: &str = "scenes/cameras/web.toml";
const SMALL: [&str; 4] = ["--set", "sensor.width_px=16", "--set", "sensor.height_px=8"];

/// Runs `flat`; returns the run, and the camera's files.
fn flat(camera: &str, options: &[&str]) -> (CommandOutput, BTreeMap<String, Vec<u8>>) {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    let arguments = ["flat", camera, "--wavelength-nm", "525", "-o", &out];
    let output = etendue(arguments.iter().copied().chain(options.iter().copied()));
    let files = contents(&place.path().join("out"));
    (output, files)
}

/// A file of its own.
fn stored(bytes: &[u8], name: &str) -> (tempfile::TempDir, PathBuf) {
    let place = tempfile::tempdir().expect("a temporary folder");
    let path = place.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    (place, path)
}

/// Digital numbers of a raw, and its columns and rows.
fn numbers(bytes: &[u8]) -> (Vec<u16>, [u32; 2]) {
    let (_place, path) = stored(bytes, "raw.png");
    let image = read_image(&path).expect("a picture");
    let ImagePixels::Gray16(samples) = image.pixels else { panic!("16 bits") };
    (samples, [image.width, image.height])
}

#[test]
fn single_frames_have_raw_picture_and_side_car_and_a_seed() {
    let options = [&SMALL[..], &["--irradiance-w-m2", "0.002", "--frames", "3..5"]].concat();
    let (output, files) = flat(WEB, &options);
    output.ok();
    let names = ["camera.json", "picture.0003.png", "picture.0004.png", "raw.0003.png", "raw.0004.png"];
    assert_eq!(files.keys().cloned().collect::<Vec<_>>(), names.map(|n| format!("web/{n}")));
    assert_ne!(files["web/raw.0003.png"], files["web/raw.0004.png"]);
    let facts: serde_json::Value = serde_json::from_slice(&files["web/camera.json"]).expect("JSON");
    // 3.6 µm, 10 ms, 525 nm, 2 mW/m²: the standard's 50.34 photons.
    let photons = facts["light"]["photons_per_pixel"].as_f64().expect("a number");
    assert!((photons - 50.341_165_675_4 * 12.96 * 10.0 * 0.525 * 0.2).abs() < 1e-6 * photons, "{photons}");
    // No exposure control: the camera has it, a bench does not.
    assert!(facts["frames"].as_array().expect("frames").iter().all(|f| f["exposure_s"] == 0.01));
    let (_, repeated) = flat(WEB, &options);
    assert_eq!(files, repeated);
    let (_, other) = flat(WEB, &[&options[..], &["--seed", "7"]].concat());
    assert_ne!(files["web/raw.0003.png"], other["web/raw.0003.png"]);
}

/// Of every two columns and rows of tiles of two pixels the first: columns 0, 1, 4, 5, 8, 9, 12, 13 of 16 and rows 0, 1, 4, 5 of 8, each pixel as it
/// is without.
#[test]
fn a_thinned_picture_has_the_pixels_that_are_read() {
    let options = [&SMALL[..], &["--irradiance-w-m2", "0.002"]].concat();
    let (_, full) = flat(WEB, &options);
    let (output, thin) = flat("scenes/cameras/web-video.toml", &options);
    output.ok();
    let (full, [width, _]) = numbers(&full["web/raw.0000.png"]);
    let (thin_numbers, size) = numbers(&thin["web-video/raw.0000.png"]);
    assert_eq!(size, [8, 4]);
    let place = |i: u32| i / 2 * 4 + i % 2;
    for (x, y) in (0..32).map(|i| (i % 8, i / 8)) {
        assert_eq!(thin_numbers[(y * 8 + x) as usize], full[(place(y) * width + place(x)) as usize], "{x} {y}");
    }
    let facts: serde_json::Value = serde_json::from_slice(&thin["web-video/camera.json"]).expect("JSON");
    let rows = &facts["sensor"]["shutter"];
    assert_eq!(
        (&rows["rows"], &rows["rows_read"]["together"], &rows["rows_read"]["of"]),
        (&4.into(), &2.into(), &4.into())
    );
}

#[test]
fn light_is_given_by_its_photons_too() {
    let (output, files) = flat(WEB, &[&SMALL[..], &["--photons", "1234.5"]].concat());
    output.ok();
    let facts: serde_json::Value = serde_json::from_slice(&files["web/camera.json"]).expect("JSON");
    let number = |key: &str| facts["light"][key].as_f64().expect("a number");
    assert!((number("photons_per_pixel") / 1234.5 - 1.0).abs() < 1e-12);
    // 3.6 µm, 10 ms, 525 nm: the standard's 50.34 photons for 2 mW/m² of a square micrometre and a millisecond … as above.
    let expected = 0.002 * 1234.5 / (50.341_165_675_4 * 12.96 * 10.0 * 0.525 * 0.2);
    assert!((number("irradiance_w_m2") / expected - 1.0).abs() < 1e-9, "{facts}");
    let (_, same) = flat(WEB, &[&SMALL[..], &["--irradiance-w-m2", &number("irradiance_w_m2").to_string()]].concat());
    assert_eq!(files["web/raw.0000.png"], same["web/raw.0000.png"]);
    flat(WEB, &["--photons", "1", "--irradiance-w-m2", "1"]).0.refused(&["--photons", "--irradiance-w-m2"]);
    flat(WEB, &["--photons", "-1"]).0.refused(&["expected 0 photons per pixel or more"]);
    flat("scenes/cameras/automotive.toml", &["--photons", "5", "--set", "sensor.exposure_s=0"]).0.refused(&[
        "--photons 5",
        "exposure_s",
        "longer",
    ]);
}

#[test]
fn causes_make_up_the_numbers_and_do_not_change_them() {
    let options = [&SMALL[..], &["--irradiance-w-m2", "0.05"]].concat();
    for camera in [WEB, "scenes/cameras/ccd-mono.toml", "scenes/cameras/ccd-bayer.toml"] {
        let (output, plain) = flat(camera, &options);
        output.ok();
        let (output, files) = flat(camera, &[&options[..], &["--signal-breakdown"]].concat());
        output.ok();
        let name = files.keys().find(|n| n.ends_with("signal_breakdown.0000.exr")).expect("signal_breakdown").clone();
        let raw = name.replace("signal_breakdown.0000.exr", "raw.0000.png");
        assert_eq!(files[&raw], plain[&raw], "{camera}");
        let (_place, path) = stored(&files[&name], "signal_breakdown.exr");
        let signal_breakdown = read_exr(&path).expect("an EXR");
        let (raw, _) = numbers(&files[&raw]);
        let electronics: serde_json::Value =
            serde_json::from_slice(&files[&name.replace("signal_breakdown.0000.exr", "camera.json")]).expect("JSON");
        let electronics = &electronics["sensor"]["electronics"];
        let [gain, black] = ["gain_dn_per_e", "black_level_dn"].map(|k| electronics[k].as_f64().expect("a number"));
        let layers: Vec<&Vec<f32>> = signal_breakdown
            .channels
            .iter()
            .filter(|channel| channel.name != "saturated")
            .map(|channel| match &channel.samples {
                ExrSamples::Float(values) => values,
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(layers.len(), 9, "{camera}");
        for (i, dn) in raw.iter().enumerate() {
            let sum: f64 = layers.iter().map(|layer| f64::from(layer[i])).sum();
            let electrons = (f64::from(*dn) - black) / gain;
            // Layers are f32, of up to 20 000 electrons.
            assert!((sum - electrons).abs() < 0.02, "{camera}: pixel {i}: {sum}, {electrons}");
        }
    }
}

#[test]
fn a_picture_of_no_time_is_dark() {
    let no_time = [&SMALL[..], &["--set", "sensor.exposure_s=0"]].concat();
    let lit = [&no_time[..], &["--irradiance-w-m2", "1"]].concat();
    let (output, files) = flat("scenes/cameras/automotive.toml", &lit);
    output.ok();
    assert!(files.contains_key("automotive/picture.0000.png"));
    let (_, dark) = flat("scenes/cameras/automotive.toml", &[&no_time[..], &["--irradiance-w-m2", "0"]].concat());
    assert_eq!(files["automotive/raw.0000.png"], dark["automotive/raw.0000.png"]);
    let series = [&no_time[..], &["--photon-transfer", "3"]].concat();
    flat("scenes/cameras/automotive.toml", &series).0.refused(&["\"exposure_s\"", "which is 0"]);
    // Effects that need a rate of light are refused at zero exposure time.
    flat("scenes/cameras/ccd-mono.toml", &lit).0.refused(&["smear", "exposure_s of 0"]);
}

#[test]
fn sensors_that_cannot_be_are_refused() {
    let assert_refused = |set: &str, phrases: &[&str]| {
        flat(WEB, &[&SMALL[..], &["--set", set, "--irradiance-w-m2", "1"]].concat()).0.refused(phrases)
    };
    assert_refused("sensor.gain_dn_per_e=1e-30", &["gain_dn_per_e", "so small"]);
    assert_refused("sensor.roi_px=[1e300,0,4,4]", &["roi_px", "beyond the image"]);
}

#[test]
fn the_series_of_the_standard_names_all_its_frames() {
    let options = [&SMALL[..], &["--photon-transfer", "4", "--stack", "3"]].concat();
    let (output, files) = flat("scenes/cameras/ccd-mono.toml", &options);
    output.ok();
    assert_eq!(files.len(), 4 * 4 + 6 + 2);
    let descriptor = String::from_utf8(files["ccd-mono/emva1288.txt"].clone()).expect("UTF-8");
    let lines: Vec<&str> = descriptor.lines().collect();
    // Bits, columns and rows of the image: the optical black is excluded.
    assert_eq!(lines[..2], ["v 4.0", "n 12 16 8"]);
    let headings: Vec<&str> = lines.iter().filter(|l| !l.starts_with('i')).skip(2).copied().collect();
    assert_eq!(headings.len(), 10);
    assert!(headings[0].starts_with("b 250000.000 ") && headings[1] == "d 250000.000", "{headings:?}");
    let images = lines.iter().filter_map(|l| l.strip_prefix("i "));
    assert!(images.clone().all(|name| files.contains_key(&format!("ccd-mono/{name}"))));
    assert_eq!(images.count(), 22);
    assert_eq!(numbers(&files["ccd-mono/raw.0000.png"]).1, [16, 8]);
}

/// Its frames are raws like those of a job: shot and read noise at 0.2 DN per electron, in eight frames of 160 × 120 px.
#[test]
fn frames_are_measured_by_their_side_car() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    let size = ["--set", "sensor.width_px=160", "--set", "sensor.height_px=120", "--set", "sensor.smear=null"];
    let camera = ["flat", "scenes/cameras/ccd-mono.toml", "--wavelength-nm", "525", "--photons", "1000"];
    etendue(camera.iter().chain(&size).chain(&["--frames", "0..8", "-o", &out]).copied()).ok();
    let frames: Vec<String> = (0..8).map(|n| format!("{out}/ccd-mono/raw.{n:04}.png")).collect();
    let measured = etendue(["measure", "noise", "--json"].into_iter().chain(frames.iter().map(String::as_str)));
    let report: serde_json::Value = serde_json::from_str(&measured.ok().out).expect("JSON");
    let figure = |name: &str| {
        let figure = &report["figures"][name];
        (figure["value"].as_f64().expect("a number"), figure["standard_uncertainty"].as_f64().expect("a number"))
    };
    let (signal_dn, _) = figure("signal");
    let (noise_dn, uncertainty_dn) = figure("temporal_noise");
    // Shot noise of the collected charge, read noise of 10 e⁻, and a twelfth of a step's square.
    let expected_dn = (0.2 * signal_dn + 0.04 * 100.0 + 1.0 / 12.0_f64).sqrt();
    assert!((noise_dn - expected_dn).abs() < 4.0 * uncertainty_dn, "{noise_dn} ± {uncertainty_dn}, not {expected_dn}");
}

#[test]
fn what_cannot_be_measured_is_refused() {
    flat("scenes/cameras/laboratory.toml", &["--irradiance-w-m2", "1"])
        .0
        .refused(&["laboratory.toml", "no electronics"]);
    flat("scenes/cameras/automotive-hdr.toml", &["--photon-transfer", "9"]).0.refused(&["automotive-hdr.toml", "hdr"]);
    for wrong in [
        &["--irradiance-w-m2", "-1"][..],
        &["--photon-transfer", "2"],
        &["--irradiance-w-m2", "1", "--photon-transfer", "9"],
        &["--irradiance-w-m2", "1", "--stack", "9"],
        &["--photon-transfer", "9", "--signal-breakdown"],
        &[],
    ] {
        assert_eq!(flat(WEB, wrong).0.status, 2, "{wrong:?}");
    }
    for (option, value, phrase) in [
        ("--irradiance-w-m2", "-0.01", "expected an irradiance of 0 W/m² or more"),
        ("--irradiance-w-m2", "1e300", "--irradiance-w-m2 1e300: gives inf electrons"),
        ("--irradiance-w-m2", "1e15", "at most 9e15"),
        ("--photon-transfer", "2", "expected a whole number from 3 to 10000"),
    ] {
        let (output, files) = flat(WEB, &[&SMALL[..], &[option, value]].concat());
        assert_eq!((output.status, files.len()), (2, 0), "{value}");
        output.says(&[phrase]);
    }
    let (output, _) = flat(WEB, &[&SMALL[..], &["--photon-transfer", "3", "--stack", "3"]].concat());
    output.ok().says(&["warning", "3 channels"]);
}
