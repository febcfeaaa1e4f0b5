//! `etendue measure` on images.

use crate::support::{etendue, root, text};
use etendue_core::Plane;
use etendue_core::maths::f64::{atan2, cos};
use etendue_core::quantity::{DigitalNumber, Display};
use etendue_io::photograph::Encoding;
use etendue_io::png::{encode_display, encode_raw16};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Stacks and results of the reference program: tests/oracles/photon_transfer.py.
fn oracle() -> PathBuf {
    root().join("tests/oracles/figures/emva1288")
}

fn json(arguments: &[&str]) -> Value {
    let arguments = arguments.iter().copied().chain(["--json"]);
    serde_json::from_str(&etendue(["measure"].into_iter().chain(arguments)).ok().out).expect("JSON")
}

fn figure(report: &Value, key: &str) -> f64 {
    report["figures"][key]["value"].as_f64().unwrap_or_else(|| panic!("{key} is missing in {report}"))
}

/// A 16-bit raw image.
fn raw(folder: &Path, name: &str, size: (usize, usize), reading: impl Fn(usize, usize) -> f64) -> String {
    let samples = (0..size.0 * size.1).map(|i| reading(i % size.0, i / size.0).round().clamp(0.0, 65_535.0) as u32);
    let plane = Plane::<DigitalNumber>::from_samples(size.0, size.1, samples.collect()).expect("a rectangle");
    let file = folder.join(name);
    std::fs::write(&file, encode_raw16(&plane).expect("a picture")).expect("a temporary file");
    text(&file)
}

/// A number from −1 to 1 that differs by position and frame.
fn scatter(x: usize, y: usize, frame: usize) -> f64 {
    let mixed = (x * 73_856_093) ^ (y * 19_349_663) ^ (frame * 83_492_791 + 12_345);
    let mixed = (mixed ^ (mixed >> 13)).wrapping_mul(0x5bd1_e995) % 65_537;
    mixed as f64 / 32_768.0 - 1.0
}

/// Within 1 %, the tolerance of the bench; results of the reference program are in its own units.
#[test]
fn photon_transfer_agrees_with_the_reference_program_on_its_own_stacks() {
    let report = json(&["ptc", &text(&oracle().join("EMVA1288descriptor.txt"))]);
    let stored = std::fs::read_to_string(oracle().join("figures.json")).expect("the oracle's figures");
    let stored: Value = serde_json::from_str(&stored).expect("JSON");
    for (theirs, ours, factor) in [
        ("K", "gain_dn_per_e", 1.0),
        ("R", "responsivity_dn_per_photon", 1.0),
        ("QE", "quantum_efficiency", 100.0),
        ("sigma_y_dark", "dark_noise_dn", 1.0),
        ("sigma_d", "dark_noise_e", 1.0),
        ("u_p_min", "threshold_photons", 1.0),
        ("u_e_min", "threshold_e", 1.0),
        ("u_p_sat", "saturation_photons", 1.0),
        ("u_e_sat", "saturation_e", 1.0),
        ("SNR_max", "snr_max", 1.0),
        ("DR", "dynamic_range", 1.0),
        ("LE_min", "linearity_error_min_percent", 1.0),
        ("LE_max", "linearity_error_max_percent", 1.0),
        ("u_I_mean", "dark_current_mean_e_per_s", 1.0),
        ("u_I_var", "dark_current_variance_e_per_s", 1.0),
        ("DSNU1288", "dsnu_e", 1.0),
        ("DSNU1288_row", "dsnu_e_row", 1.0),
        ("DSNU1288_col", "dsnu_e_column", 1.0),
        ("DSNU1288_pixel", "dsnu_e_pixel", 1.0),
        ("PRNU1288", "prnu_percent", 1.0),
        ("PRNU1288_row", "prnu_percent_row", 1.0),
        ("PRNU1288_col", "prnu_percent_column", 1.0),
        ("PRNU1288_pixel", "prnu_percent_pixel", 1.0),
    ] {
        let (theirs, ours) =
            (stored["figures"][theirs].as_f64().expect("a figure"), (ours, factor * figure(&report, ours)));
        assert!((ours.1 / theirs - 1.0).abs() < 0.01, "{}: {} against {theirs}", ours.0, ours.1);
    }
}

#[test]
fn photon_transfer_refuses_what_it_cannot_measure() {
    let folder = tempfile::tempdir().expect("a folder");
    let stored = std::fs::read_to_string(oracle().join("EMVA1288descriptor.txt")).expect("the oracle's descriptor");
    let images = text(&oracle().join("images")) + "/";
    let stored = stored.replace("images\\", &images);
    let describe = |content: String| {
        let file = folder.path().join("descriptor.txt");
        std::fs::write(&file, content).expect("a temporary file");
        etendue(["measure", "ptc", &text(&file)])
    };
    describe(stored.clone()).ok();
    describe(stored.replace("image5.png", "image4.png")).refused(&["image4.png", "equal in every pixel"]);
    let one: Vec<&str> = stored.lines().take(8).collect();
    describe(one.join("\n")).refused(&["at least three levels", "not 1"]);
    describe(stored.replace("n 12 48 40", "n 12 40 48")).refused(&["the same size"]);
    let colour = Plane::<Display>::filled(48, 40, [0.9, 0.8, 0.7]);
    let file = folder.path().join("colour.png");
    std::fs::write(&file, encode_display(&colour, &Encoding::Srgb).expect("a picture")).expect("a temporary file");
    let coloured = stored.replacen(&format!("{images}image4.png"), &text(&file), 1);
    describe(coloured).refused(&["colour.png", "expected linear raw"]);
    // Readings beyond the stated bits, as of grabbers that store 12 bits in the upper part of 16.
    describe(stored.replace("n 12 48 40", "n 8 48 40"))
        .refused(&["exceed the 8 bits of the descriptor, which end at 255"]);
    let upper: Vec<u32> = (0..48 * 40).map(|i| 16 * (2000 + i % 2000)).collect();
    let upper = Plane::<DigitalNumber>::from_samples(48, 40, upper).expect("a rectangle");
    let file_of_upper = folder.path().join("upper.png");
    std::fs::write(&file_of_upper, encode_raw16(&upper).expect("a picture")).expect("a temporary file");
    describe(stored.replacen(&format!("{images}image0.png"), &text(&file_of_upper), 1)).refused(&[
        "upper.png",
        "all are multiples of 16",
        "exceed the 12 bits of the descriptor",
    ]);
    describe(stored.replace("i ", "j ")).refused(&["line 4", "v, n, b, d or i"]);
    // Frames of one channel without a side-car: the positions of green pixels are unknown and not stated.
    std::fs::write(folder.path().join("descriptor.txt"), &stored).expect("a temporary file");
    let descriptor = text(&folder.path().join("descriptor.txt"));
    etendue(["measure", "ptc", &descriptor, "--channel", "green"]).refused(&["--channel green", "give --cfa"]);
    etendue(["measure", "vignetting", &text(&file), "--cfa", "RGGB", "--channel", "G"]).refused(&[
        "colour.png",
        "--cfa RGGB has no effect",
        "leave it out",
    ]);
}

#[test]
fn what_was_found_is_written_as_keys_of_a_camera_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let (camera, descriptor) = (folder.path().join("sensor.toml"), text(&oracle().join("EMVA1288descriptor.txt")));
    etendue(["measure", "ptc", &descriptor, "--camera-out", &text(&camera)]).ok();
    let written = std::fs::read_to_string(&camera).expect("a file");
    for key in ["gain_dn_per_e = 0.196", "read_noise_e = 10.1", "[sensor.non_uniformity]", "prnu_row = 0.0074"] {
        assert!(written.contains(key), "{key} is missing in:\n{written}");
    }
    let flat = raw(folder.path(), "flat.png", (64, 64), |x, y| 9000.0 + 50.0 * scatter(x, y, 0));
    etendue(["measure", "vignetting", &flat, "--camera-out", &text(&camera)]).refused(&["--pixel-pitch-um"]);
    let repeated = ["measure", "vignetting", &flat, "--camera-out", &text(&camera), "--pixel-pitch-um", "5"];
    etendue(repeated).refused(&["sensor.toml", "already exists", "--overwrite"]);
    assert_eq!(std::fs::read_to_string(&camera).expect("a file"), written);
    etendue(repeated.into_iter().chain(["--overwrite"])).ok();
    let written = std::fs::read_to_string(&camera).expect("a file");
    assert!(written.contains("[lens.relative_illumination]") && written.contains("ratio = [1.000000, "), "{written}");
    // The green pixels of a mosaic extend as far as the image: 64 √2 px of 5 µm.
    let mosaic = raw(folder.path(), "mosaic.png", (128, 128), |x, y| 9000.0 + 50.0 * scatter(x, y, 0));
    let green = ["measure", "vignetting", &mosaic, "--cfa", "RGGB", "--channel", "G", "--pixel-pitch-um", "5"];
    etendue(green.into_iter().chain(["--camera-out", &text(&camera), "--overwrite"])).ok();
    let written = std::fs::read_to_string(&camera).expect("a file");
    assert!(written.contains(", 0.452549]"), "{written}");
    let covered = |x: usize, y: usize| (x as f64 - 29.0 - 0.1 * (y as f64 - 31.5)).clamp(0.0, 1.0);
    let edge = raw(folder.path(), "edge.png", (64, 64), |x, y| 900.0 + 8_100.0 * covered(x, y));
    etendue(["measure", "sfr", &edge, "--camera-out", &text(&camera)]).refused(&["--camera-out"]);
}

/// A flat field whose red is clipped, though its luminance is not.
#[test]
fn clipped_colours_do_not_hide_in_the_luminance() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut plane = Plane::<Display>::filled(64, 64, [1.0, 0.5, 0.5]);
    let samples = plane.samples_mut();
    (0..64 * 64).for_each(|i| samples[i][1] += 0.02 * scatter(i % 64, i / 64, 0) as f32);
    let file = text(&folder.path().join("red.png"));
    std::fs::write(&file, encode_display(&plane, &Encoding::Srgb).expect("a picture")).expect("a temporary file");
    etendue(["measure", "vignetting", &file]).refused(&["red.png", "saturated"]);
    json(&["vignetting", &file, "--channel", "G"]);
}

#[test]
fn a_dark_current_needs_three_temperatures() {
    let descriptor = text(&oracle().join("EMVA1288descriptor.txt"));
    let at = |celsius: u32| format!("{celsius}:{descriptor}");
    etendue(["measure", "dark-current", &at(20), &at(30), &at(40)]).refused(&["contain the same measurement"]);
    etendue(["measure", "dark-current", &at(20), &at(30)]).refused(&["at least three different temperatures"]);
    etendue(["measure", "dark-current", &at(25), &at(25), &at(25)]).refused(&["three different temperatures, not 1"]);
    let impossible = format!("nan:{descriptor}");
    etendue(["measure", "dark-current", &impossible, &at(30), &at(40)])
        .refused(&["invalid: expected a number above -273.15"]);
    etendue(["measure", "dark-current", &descriptor]).refused(&["CELSIUS"]);
}

#[test]
fn stars_and_textures_give_their_response() {
    let folder = tempfile::tempdir().expect("a folder");
    let wave = |x: usize, y: usize| cos(24.0 * atan2(y as f64 + 0.5 - 64.0, x as f64 + 0.5 - 64.0));
    let star = raw(folder.path(), "star.png", (128, 128), |x, y| 20_000.0 + 9_000.0 * wave(x, y));
    let places = ["--centre-px", "64,64", "--cycles", "24", "--inner-px", "15", "--outer-px", "55"];
    let report = json(&[&["star", star.as_str()], &places[..]].concat());
    let circles = report["tables"]["circles"].as_array().expect("circles");
    // With point samples nothing is lost.
    assert!(circles.iter().all(|c| (c["response"]["value"].as_f64().expect("a value") - 1.0).abs() < 0.01), "{report}");
    let uniform = raw(folder.path(), "even.png", (128, 128), |_, _| 20_000.0);
    etendue([&["measure", "star", uniform.as_str()], &places[..]].concat()).refused(&["star"]);
    let options = ["--centre-px", "67,61", "--cycles", "24", "--inner-px", "15", "--outer-px", "55"];
    etendue([&["measure", "star", star.as_str()], &options[..]].concat()).refused(&["star.png", "within two pixels"]);
    let clipped = [&["measure", "star", star.as_str()], &places[..], &["--full-scale", "28000"]].concat();
    etendue(clipped).refused(&["saturated"]);
    let leaves = raw(folder.path(), "leaves.png", (128, 128), |x, y| 20_000.0 + 9_000.0 * scatter(x, y, 1));
    let report = json(&["texture", &leaves, &leaves]);
    assert_eq!(report["tables"]["bands"][20]["coherence"].as_f64().map(|c| c > 0.999_999), Some(true));
    etendue(["measure", "texture", &uniform, &leaves]).refused(&["no common texture"]);
}

#[test]
fn a_flat_field_gives_its_fall_off_and_a_saturated_one_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let falloff = |x: usize, y: usize| {
        let (x, y) = (x as f64 + 0.5 - 60.0, y as f64 + 0.5 - 45.0);
        1.0 - 0.3 * (x * x + y * y) / (60.0 * 60.0 + 45.0 * 45.0)
    };
    let flat =
        raw(folder.path(), "flat.png", (120, 90), |x, y| 200.0 + 30_000.0 * falloff(x, y) + 30.0 * scatter(x, y, 0));
    let plot = text(&folder.path().join("plot.svg"));
    let page = text(&folder.path().join("page.html"));
    let report = json(&["vignetting", &flat, "--black", "200", "--plot", &plot, "--html", &page]);
    // Quantised noise of 17 counts in 30 000 over 10 800 pixels: the corner is known to about 1e-4.
    assert!((figure(&report, "corner_percent") - 70.0).abs() < 0.1, "{report}");
    let svg = std::fs::read_to_string(&plot).expect("a plot");
    assert!(svg.starts_with("<svg"));
    // The page has the same curves, each result with its unit, and each row of each table.
    let page = std::fs::read_to_string(&page).expect("a page");
    assert!(page.starts_with("<!doctype html>") && page.contains(&svg));
    let figures = report["figures"].as_object().expect("figures").len();
    assert_eq!(page.matches("<tr><th scope=\"row\">").count(), figures, "{page}");
    let rows: usize =
        report["tables"].as_object().expect("tables").values().map(|t| t.as_array().map_or(0, Vec::len)).sum();
    assert_eq!(page.matches("<tr><td").count(), rows);
    etendue(["measure", "vignetting", &flat, "--html", &flat]).refused(&["--html", "ends in .html"]);
    let map = json(&["shading", &flat, "--black", "200"]);
    assert!(figure(&map, "illumination_least_percent") > 72.0);
    etendue(["measure", "vignetting", &flat, "--full-scale", "29000"]).refused(&["flat.png", "saturated"]);
    etendue(["measure", "shading", &flat, "--blocks", "10"]).refused(&["odd number of blocks"]);
    let cfa = json(&["vignetting", &flat, "--black", "200", "--cfa", "RGGB", "--channel", "G"]);
    assert!((figure(&cfa, "corner_percent") - 70.0).abs() < 0.5, "{cfa}");
    etendue(["measure", "vignetting", &flat, "--cfa", "RGGB"]).refused(&["--channel"]);
}

#[test]
fn a_slanted_edge_gives_its_response() {
    let folder = tempfile::tempdir().expect("a folder");
    // The box filter of a pixel, 5.7° steep: tan = 0.1, along rows exactly a ramp.
    let edge = |x: usize, y: usize| (x as f64 + 0.5 - 30.0 - 0.1 * (y as f64 - 31.5) + 0.5).clamp(0.0, 1.0);
    let file =
        raw(folder.path(), "edge.png", (64, 64), |x, y| 5_000.0 + 40_000.0 * edge(x, y) + 20.0 * scatter(x, y, 0));
    let plot = text(&folder.path().join("sfr.svg"));
    let report = json(&["sfr", &file, "--plot", &plot]);
    let angle = report["tables"]["edges"][0]["angle_deg"].as_f64().expect("an angle");
    assert!((angle - 5.711).abs() < 0.01, "{report}");
    let half = report["tables"]["edges"][0]["response_at_half"]["value"].as_f64().expect("a response");
    // A ramp of one pixel along rows is cos θ = 0.995037 wide along the normal: sinc(0.5 cos θ).
    assert!((half - 0.639_78).abs() < 0.005, "{half}");
    assert_eq!(std::fs::read_to_string(&plot).expect("a plot").matches("<polyline").count(), 2);
    let truth = folder.path().join("truth.json");
    let ends = r#""chart":"slanted-edges","sizes":{},"seen":{"fills_the_field":true},"light":{"luminance_cd_m2":1,"xyz":[1,1,1]},"inks":[],"features":[{"kind":"edge"},{"kind":"edge"}],"cameras":[{"name":"a","dark":false,"picture_px":[64,64],"features_px":[[[26.8,0],[33.2,64]],[null,null]]}]"#;
    std::fs::write(&truth, format!("{{{ends}}}")).expect("a temporary file");
    let truth_report = json(&["sfr", &file, "--truth", &text(&truth)]);
    // Only the visible edge: 0.5 of its length across it, 0.6 along it, about its middle.
    assert_eq!(truth_report["tables"]["edges"].as_array().map(Vec::len), Some(1), "{truth_report}");
    assert_eq!(truth_report["tables"]["edges"][0]["at_px"], "14,13", "{truth_report}");
    // In a mosaic every other pixel is used.
    let mosaic = json(&["sfr", &file, "--truth", &text(&truth), "--cfa", "RGGB", "--channel", "R"]);
    assert_eq!(mosaic["tables"]["edges"][0]["at_px"], "14,13", "{mosaic}");
    // A second edge in the reference data that the image does not show is listed with the reason.
    let truth_text = std::fs::read_to_string(&truth).expect("a truth").replace("[null,null]", "[[50,2],[54,42]]");
    let two = folder.path().join("two.json");
    std::fs::write(&two, truth_text).expect("a temporary file");
    let partly = json(&["sfr", &file, "--truth", &text(&two)]);
    assert_eq!(partly["tables"]["edges"].as_array().map(Vec::len), Some(1), "{partly}");
    let refused = partly["tables"]["refused"].as_array().expect("a table of refusals");
    assert_eq!((refused.len(), &refused[0]["at_px"]), (1, &Value::from("42,10")), "{partly}");
    assert!(refused[0]["reason"].as_str().is_some_and(|reason| reason.contains("no slanted edge")), "{partly}");
    assert!(
        partly["notes"].as_array().expect("notes").contains(&"1 of 2 edges could not be measured".into()),
        "{partly}"
    );
    etendue(["measure", "sfr", &file, "--truth", &text(&truth), "--camera", "b"]).refused(&["no camera 'b'", "a"]);
    let upright = raw(folder.path(), "upright.png", (64, 64), |x, _| if x < 30 { 5_000.0 } else { 40_000.0 });
    etendue(["measure", "sfr", &upright]).refused(&["upright.png", "0.00°", "2° to 43°"]);
    let flat = raw(folder.path(), "flat.png", (64, 64), |x, y| 5_000.0 + 100.0 * scatter(x, y, 3));
    etendue(["measure", "sfr", &flat]).refused(&["no slanted edge"]);
    let cut = raw(folder.path(), "cut.png", (64, 64), |x, y| 40_000.0 * edge(x, y) - 2_000.0);
    etendue(["measure", "sfr", &cut]).refused(&["cut.png", "read 0, where dark values are clipped"]);
    etendue(["measure", "sfr", &file, "--full-scale", "44000"]).refused(&["edge.png", "saturated"]);
    etendue(["measure", "sfr", &file, "--camera-out", "x.toml", "--edge", "0,0,9999,9"]).refused(&["--camera-out"]);
    let mosaic = json(&["sfr", &file, "--cfa", "RGGB", "--channel", "R"]);
    // In cycles per pixel, independent of the colour's own spacing: sinc(0.5 cos θ).
    let half = mosaic["tables"]["edges"][0]["response_at_half"]["value"].as_f64().expect("a response");
    assert!((half - 0.639_78).abs() < 0.01, "{half}");
}

#[test]
fn exposures_give_a_tone_curve_and_copies_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let shot = |i: usize| {
        let light = 3_000.0 * i as f64;
        raw(folder.path(), &format!("{i}.png"), (32, 32), |x, y| {
            (400.0 + light + 60.0 * scatter(x, y, i)).min(40_000.0)
        })
    };
    let files: Vec<String> = (1..=15).map(shot).collect();
    let exposures: Vec<String> = (1..=15).map(|i| (f64::from(i) / 1000.0).to_string()).collect();
    let exposures = exposures.join(",");
    let all: Vec<&str> = std::iter::once("oecf").chain(files.iter().map(String::as_str)).collect();
    let report = json(&[&all[..], &["--exposures", &exposures, "--black", "400"]].concat());
    assert!((figure(&report, "slope") / 3e6 - 1.0).abs() < 1e-3, "{report}");
    assert_eq!(figure(&report, "saturation_exposure"), 0.014);
    etendue(["measure", "oecf", &files[0]]).refused(&["--exposures"]);
    etendue(["measure", "oecf", &files[0], "--exposures", "1"]).refused(&["at least three exposures", "not 1"]);
    etendue(["measure", "oecf", &files[0], &files[1], &files[0], "--exposures", "1,2,3"]).refused(&["copies"]);
    let table = folder.path().join("steps.csv");
    std::fs::write(&table, "# x, y, width, height, luminance\n0,0,16,16,10\n").expect("a temporary file");
    etendue(["measure", "oecf", &files[0], "--steps", &text(&table)]).refused(&["at least three exposures"]);
    std::fs::write(&table, "0,0,16,16,10,foo\n").expect("a temporary file");
    etendue(["measure", "oecf", &files[0], "--steps", &text(&table)]).refused(&["line 1", "expected x, y, width"]);
}

#[test]
fn patches_give_noise_flare_and_contrast() {
    let folder = tempfile::tempdir().expect("a folder");
    let patches = |frame: usize| {
        move |x: usize, y: usize| {
            let level = [600.0, 20_000.0, 30_000.0][x / 20];
            level + 300.0 * scatter(x, y, frame)
        }
    };
    let files: Vec<String> = (0..8).map(|i| raw(folder.path(), &format!("{i}.png"), (60, 20), patches(i))).collect();
    let names: Vec<&str> = std::iter::once("noise").chain(files.iter().map(String::as_str)).collect();
    let noise = json(&[&names[..], &["--region", "20,0,20,20"]].concat());
    // Uniform over ±300: 300/√3.
    assert!((figure(&noise, "temporal_noise") / 173.2 - 1.0).abs() < 0.05, "{noise}");
    etendue(["measure", "noise", &files[0], &files[1]]).refused(&["at least 8 frames"]);
    let flare = json(&["flare", &files[0], "--trap", "0,0,20,20", "--white", "40,0,20,20", "--black", "300"]);
    assert!((figure(&flare, "flare_percent") - 100.0 * 300.0 / 29_700.0).abs() < 0.15, "{flare}");
    let pair = ["--darker", "20,0,20,20", "--brighter", "40,0,20,20", "--contrast", "0.5"];
    let cdp = json(&[&["cdp", files[0].as_str()], &pair[..]].concat());
    let actual = cdp["tables"]["pairs"][0]["cdp"]["value"].as_f64().expect("a probability");
    assert!(actual > 0.99, "{cdp}");
    etendue([&["measure"], &names[..], &["--region", "20,0,20,20", "--black", "25000"]].concat())
        .refused(&["not above black"]);
    etendue([&["measure"], &names[..], &["--region", "20,0,20,20", "--full-scale", "20000"]].concat())
        .refused(&["0.png", "saturated"]);
    let swapped = ["--darker", "40,0,20,20", "--brighter", "20,0,20,20", "--contrast", "0.5"];
    let cdp = |options: &[&str]| etendue([&["measure", "cdp", files[0].as_str()], options].concat());
    cdp(&swapped).refused(&["0.png", "the darker patch first"]);
    cdp(&[&pair[..], &["--full-scale", "30000"]].concat()).refused(&["saturated"]);
    etendue(["measure", "cdp", &files[0], "--darker", "0,0,9,9", "--brighter", "0,0,9,9", "--contrast", "-1"])
        .refused(&["contrast of the scene must be a number above 0"]);
}

#[test]
fn depth_is_judged_by_range() {
    let folder = tempfile::tempdir().expect("a folder");
    let truth = raw(folder.path(), "truth.png", (64, 48), |x, _| if x < 32 { 4_000.0 } else { 20_000.0 });
    let estimate = raw(folder.path(), "estimate.png", (64, 48), |x, _| if x < 32 { 4_100.0 } else { 22_000.0 });
    let units = ["--estimate-unit-m", "0.001", "--truth-unit-m", "0.001", "--ranges-m", "0,10,100"];
    let report = json(&[&["depth", estimate.as_str(), truth.as_str()], &units[..]].concat());
    let near = &report["tables"]["ranges"][1];
    assert!((near["bias_m"]["value"].as_f64().expect("a bias") - 0.1).abs() < 1e-6, "{report}");
    assert_eq!(report["tables"]["ranges"][2]["outliers_percent"]["value"].as_f64(), Some(100.0));
    let small = raw(folder.path(), "small.png", (32, 48), |_, _| 4_000.0);
    etendue(["measure", "depth", &small, &truth]).refused(&["the same size"]);
}

#[test]
fn a_colour_chart_needs_colours() {
    let folder = tempfile::tempdir().expect("a folder");
    let grey = raw(folder.path(), "grey.png", (60, 40), |x, _| 100.0 * x as f64);
    let corners = ["--corners", "5,5", "55,5", "55,35", "5,35"];
    etendue([&["measure", "colour", grey.as_str()], &corners[..]].concat())
        .refused(&["grey.png", "channels R, G and B"]);
}

/// Light absent from one frame has a modulation of 1 without scatter: the frame is named.
#[test]
fn flicker_names_frames_that_are_black_or_cut() {
    let folder = tempfile::tempdir().expect("a folder");
    let level =
        |name: &str, level: f64| raw(folder.path(), name, (64, 48), |x, y| level * (1.0 + 0.01 * scatter(x, y, 1)));
    let frames = [level("a.png", 20_000.0), level("b.png", 0.0)];
    let run = etendue(["measure", "flicker", &frames[0], &frames[1], "--frame-rate-hz", "30"]).ok();
    let output = run.out + &run.err;
    let named =
        |name: &str| output.lines().any(|line| line.contains(name) && line.contains("entirely black or saturated"));
    assert!(named("b.png") && !named("a.png"), "{output}");
}

#[test]
fn a_flat_field_of_another_camera_or_without_light_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = |name: &str, size, level: f64| raw(folder.path(), name, size, |x, _| level * (1.0 + 0.01 * x as f64));
    let patches = image("patches.png", (60, 20), 10_000.0);
    let pair = ["--darker", "0,0,20,20", "--brighter", "40,0,20,20", "--contrast", "0.35"];
    let cdp = |flat: &str| etendue([&["measure", "cdp", &patches], &pair[..], &["--flat", flat]].concat());
    cdp(&image("small.png", (8, 8), 9_000.0)).refused(&["--flat: ", "small.png has another size", "same camera"]);
    cdp(&image("dark.png", (60, 20), 0.0)).refused(&["dark.png", "no light above black; increase its exposure"]);
    cdp(&image("full.png", (60, 20), 70_000.0)).refused(&["full.png", "saturated; reduce its exposure"]);
    cdp("nowhere.png").refused(&["nowhere.png"]);
}
